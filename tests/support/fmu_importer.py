"""An importer of FMUs, written from the standards of FMI 2.0 and 3.0 alone: their functions, by ctypes."""

from __future__ import annotations

import ctypes
import platform
import zipfile
from ctypes import CFUNCTYPE, POINTER, Structure, byref, c_bool, c_char_p, c_double, c_int, c_size_t, c_uint32, c_void_p
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

OK, DISCARD, ERROR = 0, 2, 3
FOLDERS = {2: "linux64", 3: f"{platform.machine()}-linux"}
LOGGER2 = CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p)
LOGGER3 = CFUNCTYPE(None, c_void_p, c_int, c_char_p, c_char_p)


class Callbacks(Structure):
    _fields_ = [(name, c_void_p) for name in ("logger", "allocate", "free", "finished", "environment")]


class Fmu:
    """An FMU's description and library; `library`: another one of the same sources, if it has none for this machine."""

    def __init__(self, path: Path, library: Path | None = None) -> None:
        with zipfile.ZipFile(path) as archive:
            self.files = archive.namelist()
            self.root = ElementTree.fromstring(archive.read("modelDescription.xml"))
            self.fmi = int(self.root.get("fmiVersion")[0])
            identifier = self.root.find("CoSimulation").get("modelIdentifier")
            inside = f"binaries/{FOLDERS[self.fmi]}/{identifier}.so"
            if library is None:
                library = path.with_suffix(f".{self.fmi}.so")
                library.write_bytes(archive.read(inside))
        self.library, self.path = ctypes.CDLL(str(library)), library
        self.token = self.root.get("guid" if self.fmi == 2 else "instantiationToken")
        self.variables = list(self.root.find("ModelVariables"))
        self.places = {v.get("name"): int(v.get("valueReference")) for v in self.variables}

    def size(self, name: str) -> int:
        """How many numbers the variable has."""
        found = next(v for v in self.variables if v.get("name") == name)
        return int(np.prod([int(d.get("start")) for d in found.findall("Dimension")], dtype=int))

    def of(self, causality: str) -> list[str]:
        """The names of its variables of a causality."""
        return [v.get("name") for v in self.variables if v.get("causality") == causality]


class Instance:
    """An instance in initialization mode."""

    def __init__(self, fmu: Fmu, start: float = 0.0, token: str | None = None) -> None:
        self.fmu, self.said = fmu, list[str]()
        token = (fmu.token if token is None else token).encode()
        if fmu.fmi == 2:
            self._logger = LOGGER2(lambda *given: self.said.append(given[-1].decode()))
            self._callbacks = Callbacks(ctypes.cast(self._logger, c_void_p).value)
            new = fmu.library.fmi2Instantiate
            new.restype = c_void_p
            self.at = new(b"one", 1, token, b"", byref(self._callbacks), 0, 0)
        else:
            self._logger = LOGGER3(lambda *given: self.said.append(given[-1].decode()))
            new = fmu.library.fmi3InstantiateCoSimulation
            new.restype = c_void_p
            no, none = c_bool(False), c_void_p()
            self.at = new(b"one", token, b"", no, no, no, no, none, c_size_t(0), none, self._logger, none)
        self.start = start
        if self.at:
            self.initialize()

    def __call__(self, name: str, *given) -> int:
        """A function of the standard without its prefix."""
        return getattr(self.fmu.library, f"fmi{self.fmu.fmi}{name}")(c_void_p(self.at), *given)

    def initialize(self) -> None:
        if self.fmu.fmi == 2:
            no, zero = c_int(0), c_double(0.0)
            assert self("SetupExperiment", no, zero, c_double(self.start), no, zero) == OK
            assert self("EnterInitializationMode") == OK
        else:
            no, zero = c_bool(False), c_double(0.0)
            assert self("EnterInitializationMode", no, zero, c_double(self.start), no, zero) == OK

    def begin(self) -> int:
        return self("ExitInitializationMode")

    def step(self, time: float, size: float) -> int:
        time, size = c_double(time), c_double(size)
        if self.fmu.fmi == 2:
            return self("DoStep", time, size, c_int(1))
        self.flags, reached = [c_bool() for _ in range(3)], c_double()
        return self("DoStep", time, size, c_bool(True), *map(byref, self.flags), byref(reached))

    def references(self, names: list[str]):
        """Value references, and how many numbers they have."""
        places = [self.fmu.places[name] for name in names]
        return (c_uint32 * len(places))(*places), sum(map(self.fmu.size, names))

    def get(self, references, count: int) -> np.ndarray:
        values = np.zeros(count)
        pointer = values.ctypes.data_as(POINTER(c_double))
        more = () if self.fmu.fmi == 2 else (c_size_t(count),)
        name = "GetReal" if self.fmu.fmi == 2 else "GetFloat64"
        assert self(name, references, c_size_t(len(references)), pointer, *more) == OK, self.said
        return values

    def set(self, name: str, values) -> int:
        """Set a number, or an array: in FMI 2, from the scalar with this place on."""
        values = np.atleast_1d(np.asarray(values, float))
        pointer = values.ctypes.data_as(POINTER(c_double))
        if self.fmu.fmi == 3:
            size = c_size_t(len(values))
            return self("SetFloat64", (c_uint32 * 1)(self.fmu.places[name]), c_size_t(1), pointer, size)
        first = self.fmu.places[name] if name in self.fmu.places else self.first_of(name)
        references = (c_uint32 * len(values))(*range(first, first + len(values)))
        return self("SetReal", references, c_size_t(len(values)), pointer)

    def truth(self, name: str, value: bool | None = None) -> bool | int:
        """A truth value; or set it, and return the status."""
        own = c_int if self.fmu.fmi == 2 else c_bool
        references, values = (c_uint32 * 1)(self.fmu.places[name]), (own * 1)(bool(value))
        more = () if self.fmu.fmi == 2 else (c_size_t(1),)
        status = self(f"{'Get' if value is None else 'Set'}Boolean", references, c_size_t(1), values, *more)
        if value is not None:
            return status
        assert status == OK, self.said
        return bool(values[0])

    def first_of(self, name: str) -> int:
        """The reference of the first scalar of an array in FMI 2."""
        return next(at for key, at in self.fmu.places.items() if key.startswith((f"{name}_", f"{name}.")))

    def number(self, name: str, count: int) -> np.ndarray:
        """An array, in either version."""
        if self.fmu.fmi == 3:
            return self.get((c_uint32 * 1)(self.fmu.places[name]), count)
        first = self.first_of(name) if count > 1 else self.fmu.places[name]
        return self.get((c_uint32 * count)(*range(first, first + count)), count)

    # states

    def saved(self) -> c_void_p:
        state = c_void_p()
        assert self("GetFMUstate" if self.fmu.fmi == 2 else "GetFMUState", byref(state)) == OK
        return state

    def restore(self, state: c_void_p) -> int:
        return self("SetFMUstate" if self.fmu.fmi == 2 else "SetFMUState", state)

    def packed(self, state: c_void_p) -> bytes:
        size, word = c_size_t(), "FMUstate" if self.fmu.fmi == 2 else "FMUState"
        assert self(f"Serialized{word}Size", state, byref(size)) == OK
        data = ctypes.create_string_buffer(size.value)
        assert self(f"Serialize{word}", state, data, size) == OK
        return data.raw

    def unpacked(self, data: bytes) -> tuple[int, c_void_p]:
        state, name = c_void_p(), "DeSerializeFMUstate" if self.fmu.fmi == 2 else "DeserializeFMUState"
        return self(name, data, c_size_t(len(data)), byref(state)), state
