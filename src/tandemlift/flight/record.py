"""The record of a flight: named channels (`flight.channels`), the resolved mission, and the metrics."""

from __future__ import annotations

import json
import math
import os
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

import numpy as np

from tandemlift.core.errors import InputError, suggestion, unknown
from tandemlift.core.files import FLIGHT_FILE, atomic_write, unpacked_size
from tandemlift.core.findings import Finding, finding_from
from tandemlift.core.phases import FAILURES, INTERRUPTED
from tandemlift.core.types import Array
from tandemlift.flight.channels import CHANNELS, DERIVED, OTHER, STAMP, Channel, channel_of, reading_stamps
from tandemlift.flight.data_frames import to_pandas, to_xarray

if TYPE_CHECKING:  # what few readers of a flight need, they load
    import pandas
    import xarray

    from tandemlift.parts.mechanics.vehicle import Vehicle

FORMAT = 2
LATE = 10.0  # s, from which metrics with `after_10s` in their names are computed, to exclude a disturbed start

ENDING_TEXT = "{outcome} at {time:.6g} s: {quantity} = {value:.6g}, {limit}"
CAUSE_TEXT = "{outcome} at {time:.6g} s: {cause}"
INTERRUPTION_TEXT = "{outcome} at {time:.6g} s: {limit}"


def is_flight_file(path: Path) -> bool:
    """Whether a path is that of a saved flight: by its ending .npz, or, since `save` takes any name, by what it is."""
    others = (".bag", ".mcap", ".zip", ".fmu")
    return path.suffix == ".npz" or (path.suffix not in others and path.is_file() and zipfile.is_zipfile(path))


class Ending(NamedTuple):
    """The end of a flight that was stopped: the quantity, time [s] and value, the violated limit, and the outcome.

    An interruption has no quantity (""), no value (nan), and the reason instead of a limit. An impact has a `cause`:
    what was hit, and how hard.
    """

    quantity: str
    time: float
    value: float
    limit: str
    outcome: str = "diverged"
    cause: str = ""

    def __str__(self) -> str:
        text = CAUSE_TEXT if self.cause else ENDING_TEXT if self.quantity else INTERRUPTION_TEXT
        return text.format(**self._asdict())


def interruption(time: float, reason: object) -> Ending:
    """The ending of a flight whose engine was lost at a time [s], with the reason in words."""
    return Ending("", time, math.nan, str(reason), INTERRUPTED)


@dataclass(frozen=True, eq=False)
class Flight(Mapping[str, Array]):
    """A flight's channels by name, each an array (T,) or (T, n) over the logged times.

    Attributes:
        time: logged times (T,) [s].
        channels: the recorded arrays by name; `flight[name]` also gives the differences in `DERIVED`.
        mission: the resolved mission as nested tables.
        results: the metrics, computed from every step and not from the log.
        ending: the reason if the flight was stopped early as crashed, diverged or interrupted, else None.
        version: versions of tandemlift and of the packages that it used.
        findings: the findings in the order of time, computed from every step.
    """

    time: Array
    channels: dict[str, Array]
    mission: dict[str, Any]
    results: dict[str, Any]
    ending: Ending | None = None
    version: dict[str, str] = field(default_factory=dict)
    findings: tuple[Finding, ...] = ()

    @property
    def name(self) -> str:
        """The mission's name."""
        return self.mission["mission"]["name"]

    @property
    def vehicle(self) -> Vehicle:
        """The mission's vehicle, as the pilot assumes it."""
        from tandemlift.parts.mechanics.vehicle import Vehicle

        return Vehicle.from_mission(self.mission)

    @property
    def walls(self) -> list[dict[str, Any]]:
        """The mission's walls as tables: those of `walls`, then the corridor's."""
        from tandemlift.parts.contact.corridor import wall_tables

        return wall_tables(self.mission)

    @property
    def outcome(self) -> str:
        """The outcome, one of `core.phases.OUTCOMES`; "unknown" for a flight that was read from a bag."""
        return self.results.get("outcome", "unknown")

    @property
    def failure(self) -> str:
        """The reason of a failure (crashed, diverged, interrupted, not lifted) in one sentence; "" if there is none."""
        return str(self.ending or FAILURES.get(self.outcome, ""))

    def __getitem__(self, name: str) -> Array:
        if name in self.channels:
            return self.channels[name]
        if name in DERIVED:
            desired, actual, _ = DERIVED[name]
            return self.channels[desired] - self.channels[actual]
        if name == "time":
            return self.time
        known = [*self.channels, *DERIVED]
        raise KeyError(f"no channel {name!r}; there are {', '.join(known)}.{suggestion(name, known)}")

    def __iter__(self) -> Iterator[str]:
        return iter(self.channels)

    def __len__(self) -> int:
        return len(self.channels)

    def __repr__(self) -> str:
        last = f"{self.time[-1]:g} s" if len(self.time) else "nothing logged"
        return f"<Flight {self.name}: {len(self.time)} samples to {last}, {len(self.channels)} channels>"

    def _repr_html_(self) -> str:
        """HTML for a notebook: mission, outcome, findings, main metrics, and a small picture."""
        from tandemlift.flight.notebook_view import flight_html

        return flight_html(self, self.outcome, self.failure, self.findings)

    def __eq__(self, other: object) -> bool:
        """Compare two flights bit by bit, including their records."""
        return isinstance(other, Flight) and self._parts() == other._parts()

    def __hash__(self) -> int:
        return hash(self.time.tobytes())

    def _parts(self) -> tuple[Any, ...]:
        arrays = {name: (a.shape, a.tobytes()) for name, a in {"time": self.time, **self.channels}.items()}
        return arrays, self.mission, self.results, str(self.ending), self.version, self.findings

    def info(self, name: str) -> Channel:
        """Unit, frame and meaning of a channel."""
        self[name]
        return DERIVED[name][2] if name in DERIVED else channel_of(name)

    def metrics(self) -> dict[str, Any]:
        """The flight's metrics: flat, SI, the unit at the end of each name; None if one could not be computed."""
        return dict(self.results)

    def to_pandas(self) -> pandas.DataFrame:
        """The channels as a table: a row for each sample, a column for each component, indexed by `time` [s].

        Columns are called `position_x`, `attitude_w`, `euler_roll`, `rotor_thrusts_rotor_1`,
        `joint_force_quadrotor_1_x`, and `thrust` where there is one component. `attrs` holds `name`, `units` by column,
        `metrics`, and `ending` as text or None.

        Raises:
            InputError: pandas is not installed (extra: pandas).
        """
        return to_pandas(self)

    def to_xarray(self) -> xarray.Dataset:
        """The channels as variables over `time` [s] and `axis`, `angle`, `quaternion`, `rotor` or `quadrotor`.

        Each has `units`, `frame` and `long_name` in its `attrs`, where they say something. Those of the dataset are
        texts: `name`; `mission`, `metrics` and `version` in JSON; `ending`, if the flight has one.

        Raises:
            InputError: xarray is not installed (extra: xarray).
        """
        return to_xarray(self)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the flight without loss to an .npz file, atomically, and return its path."""
        path = Path(path)
        header = {
            "format": FORMAT,
            "mission": self.mission,
            "metrics": self.results,
            "ending": _written(self.ending),
            "version": self.version,
            "findings": [f.as_table() for f in self.findings],
            "channels": {name: self.info(name).described for name in self.channels},
        }
        text = np.array(json.dumps(header, allow_nan=False))
        with atomic_write(path) as partial, partial.open("wb") as file:
            np.savez(file, header=text, time=self.time, **self.channels)  # type: ignore
        return path

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Flight:
        """Read a flight that `save` wrote, from its file or from the folder of a run.

        Raises:
            InputError: the file is missing, damaged, no flight, of another format, or has an unknown channel.
        """
        path = Path(path)
        path = path / FLIGHT_FILE if path.is_dir() else path
        try:
            with path.open("rb") as file:
                header, arrays = _read(file)
            return _flight(header, arrays)
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
        except OSError as error:
            raise InputError(f"{path}: {error.strerror or error}") from None
        except Exception as error:  # all errors that arbitrary content can cause in the readers of ZIP, NPY and JSON
            raise InputError(f"{path} is damaged or no flight that tandemlift saved ({error})") from error


def counted_until(flight: Flight) -> float | None:
    """Time [s] of a crash after which the flight goes on, and at which its metrics end; None of any other flight."""
    end = flight.ending
    return end.time if end and end.outcome == "crashed" and flight.time[-1:].sum() > end.time else None


def _written(ending: Ending | None) -> list[Any] | None:
    """An ending as strict JSON: its value, which may be nan, is a text."""
    return ending and [ending.quantity, ending.time, repr(ending.value), *ending[3:]]


def _read(file: BinaryIO) -> tuple[dict[str, Any], dict[str, Array]]:
    """The header and the arrays of a flight's file."""
    if not zipfile.is_zipfile(file):
        raise InputError("no flight that tandemlift saved, or only a part of one")
    file.seek(0)
    with np.load(file, allow_pickle=False) as content:
        packed, unpacked = os.fstat(file.fileno()).st_size, unpacked_size(content.zip)
        if unpacked > packed:
            raise InputError(f"no flight that tandemlift saved: {packed} bytes that unpack to {unpacked}")
        if "header" not in content.files:
            raise InputError("no flight that tandemlift saved: it has no header")
        header = json.loads(str(content["header"]))
        number = header["format"]
        if number != FORMAT:  # no earlier format has been released
            raise InputError(
                f"written by another version of tandemlift: its format is {number}, this one reads {FORMAT}"
            )
        return header, {name: content[name] for name in dict.fromkeys(("time", *header["channels"]))}


def _check_names(header: dict[str, Any]) -> None:
    """Reject channels of other versions; channels of user code keep their own description."""
    for name, said in header["channels"].items():
        if channel_of(name) == OTHER and said != OTHER.described and not name.startswith("measured_"):
            raise unknown("channel", name, CHANNELS)


def moment_of(place: Array, attitude: Array, force: Array) -> Array:
    """Moments [N·m, body axes] (T, 3) of forces [N, world axes] (T, 3) at a place [m, body axes] (3)."""
    from tandemlift.core.vector import Quat, Vec3, apply_transposed
    from tandemlift.parts.mechanics.rotation import rotation_from_quaternion

    turned = rotation_from_quaternion(Quat(*attitude.T))
    return np.cross(place, np.stack(apply_transposed(turned, Vec3(*force.T)), axis=1))


def _flight(header: dict[str, Any], arrays: dict[str, Array]) -> Flight:
    """The flight of a header and its arrays, if they are consistent."""
    _check_names(header)
    time = arrays.pop("time")
    for name, array in {"time": time, **arrays}.items():
        if array.dtype != np.float64 or array.ndim not in (1, 2) or len(array) != len(time):
            raise InputError(f"damaged: channel {name} is {array.dtype} {array.shape}, beside {len(time)} times")
    if (ending := header["ending"]) is not None:
        quantity, at, value, *rest = ending
        ending = Ending(quantity, at, float(value), *rest)
    mission, metrics, version = (dict(header[key]) for key in ("mission", "metrics", "version"))
    findings = tuple(finding_from(table) for table in header.get("findings", ()))
    moment = "push_moment_estimate"
    if "payload" in header["channels"].get(moment, {}).get("meaning", ""):  # about that centre, in version 1.0
        center, push = Flight(time, {}, mission, {}).vehicle.payload_center, arrays["push_estimate"]
        arrays[moment] = arrays[moment] + moment_of(center, arrays["estimated_attitude"], push)
    known = "sensors" in mission and np.isfinite(time).all()
    if known and not STAMP.keys() & arrays.keys():  # a record of version 1.0
        arrays |= reading_stamps(mission, time, arrays)
    return Flight(time, arrays, mission, metrics, ending, version, findings)
