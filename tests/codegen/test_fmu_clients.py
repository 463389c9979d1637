"""FMUs in importers of others, FMPy 0.3.32 and fmuloader 0.1.2rc0, and for each platform by ziglang."""

import shutil
import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from c_flights import same, unfused
from fmu_importer import Fmu

import tandemlift as tl
from tandemlift.codegen.fmu_binaries import zig
from tandemlift.flight.channels import column_names
from tandemlift.missions import built_in

pytestmark = pytest.mark.clients
WINE = next(filter(shutil.which, ("wine64", "wine", "/usr/lib/wine/wine64")), None)
STEPS = Path(__file__).parent.parent / "support" / "fmu_steps.c"
BOTH = pytest.mark.parametrize("fmi", [2, 3])


@pytest.fixture(scope="module", params=sorted(built_in()))
def flown(request, tmp_path_factory):
    """A flight, and its FMUs of both versions, compiled for this machine."""
    mission, folder = unfused(tl.load_mission(request.param)), tmp_path_factory.mktemp("fmus")
    files = {fmi: tl.compile_mission(mission, "fmu", folder / str(fmi), fmi=fmi) for fmi in (2, 3)}
    return tl.fly(mission), files


def without_stamps(flight):
    """The channels that exported code has, too."""
    return [name for name in flight.channels if not name.endswith("_stamp")]


def labels_of(flight, name, fmi):
    shape = flight[name].shape[1:]
    return [name] if fmi == 3 else column_names(name, flight.info(name), shape)


@BOTH
def test_fmpy_finds_no_problem_and_flies_the_same_bits(flown, fmi):
    from fmpy import read_model_description, simulate_fmu
    from fmpy.validation import validate_fmu

    flight, files = flown
    assert [validate_fmu(str(path)) for path in files[fmi]] == [[], [], []]
    whole, end = str(files[fmi][2]), float(flight.time[-1])
    names = [v.name for v in read_model_description(whole).modelVariables if v.causality == "output"]
    rows = simulate_fmu(whole, stop_time=end, output_interval=float(flight.time[1]), output=names)
    for name in without_stamps(flight):
        found = np.stack([rows[label] for label in labels_of(flight, name, fmi)], axis=-1).reshape(flight[name].shape)
        assert same(found, flight[name]), name


@BOTH
def test_fmuloader_flies_the_same_bits(flown, fmi, tmp_path):
    from fmuloader import fmi2, fmi3

    flight, files = flown
    path = files[fmi][2]
    with zipfile.ZipFile(path) as archive:
        root = ElementTree.fromstring(archive.read("modelDescription.xml"))
    places = {v.get("name"): int(v.get("valueReference")) for v in root.find("ModelVariables")}
    if fmi == 2:
        slave = fmi2.Fmi2Slave(path, model_identifier=path.stem, unpack_dir=tmp_path)
        slave.instantiate("one", fmi2.Fmi2Type.CO_SIMULATION, guid=root.get("guid"))
        slave.setup_experiment(start_time=0.0)
        slave.enter_initialization_mode()
        names = [label for name in without_stamps(flight) for label in labels_of(flight, name, 2)]
        wanted = np.hstack([np.reshape(flight[name], (len(flight.time), -1)) for name in without_stamps(flight)])
    else:
        slave = fmi3.Fmi3Slave(path, model_identifier=path.stem, unpack_dir=tmp_path)
        slave.instantiate_co_simulation("one", instantiation_token=root.get("instantiationToken"))
        slave.enter_initialization_mode(0.0)
        names = [name for name in without_stamps(flight) if flight[name].ndim == 1]  # it reads no arrays
        wanted = np.stack([flight[name] for name in names], axis=1)
    slave.exit_initialization_mode()
    read, size = slave.get_real if fmi == 2 else slave.get_float64, float(flight.time[1])
    rows = [read([places[name] for name in names])]
    for k in range(len(flight.time) - 1):
        slave.do_step(k * size, size)
        rows.append(read([places[name] for name in names]))
    assert same(np.array(rows), wanted)


@pytest.mark.parametrize("fmi", [2, 3])
def test_ziglang_compiles_for_every_platform(fmi, tmp_path):
    pytest.importorskip("ziglang")
    names = ["linux", "linux-arm64", "windows", "macos"]
    for path in tl.compile_mission("hover", "fmu", tmp_path, fmi=fmi, platforms=names):
        with zipfile.ZipFile(path) as archive:
            found = {name.split("/")[1]: archive.read(name)[:4] for name in archive.namelist() if "binaries/" in name}
        elf, dll, macho = b"\x7fELF", b"MZ", b"\xcf\xfa\xed\xfe"
        folders = {2: ("linux64", "aarch64-linux", "win64"), 3: ("x86_64-linux", "aarch64-linux", "x86_64-windows")}
        assert [found[f][:4] for f in folders[fmi][:2]] == [elf, elf]
        assert found[folders[fmi][2]][:2] == dll
        if fmi == 2:
            assert found["darwin64"] == b"\xca\xfe\xba\xbe"
        else:
            assert found["aarch64-darwin"] == found["x86_64-darwin"] == macho


@pytest.mark.skipif(WINE is None, reason="needs wine (apt-get install --no-install-recommends wine64)")
@BOTH
def test_a_flight_under_windows_has_the_same_bits(fmi, tmp_path, monkeypatch):
    monkeypatch.setenv("WINEPREFIX", str(tmp_path / "wine"))
    mission = unfused(tl.load_mission("paper"))
    flight = tl.fly(mission)
    path = tl.compile_mission(mission, "fmu", tmp_path, fmi=fmi, platforms=["linux", "windows"])[2]
    fmu, importer, out = Fmu(path), tmp_path / "steps.exe", tmp_path / "numbers"
    with zipfile.ZipFile(path) as archive:
        inside = next(name for name in archive.namelist() if name.endswith(".dll"))
        library = Path(archive.extract(inside, tmp_path))
    subprocess.run([*zig("wine"), "-target", "x86_64-windows-gnu", "-O1", "-w", "-o", importer, STEPS], check=True)
    names = [label for name in without_stamps(flight) for label in labels_of(flight, name, fmi)]
    wanted = np.hstack([np.reshape(flight[name], (len(flight.time), -1)) for name in without_stamps(flight)])
    counts = [repr(float(flight.time[1])), str(len(wanted) - 1), str(wanted.shape[1])]
    references = [str(fmu.places[name]) for name in names]
    subprocess.run([WINE, importer, str(fmi), library, fmu.token, *counts, out, *references], check=True)
    assert same(np.fromfile(out).reshape(wanted.shape), wanted)
