"""Files of FMUs: their content, units and platforms, and what is refused before anything is written."""

import re
import struct
import subprocess
import sys
import zipfile
from xml.etree import ElementTree

import pytest
from c_flights import STRICT
from click.testing import CliRunner

import tandemlift as tl
from tandemlift.apps.cli.export import compile as compile_command
from tandemlift.codegen import fmu_binaries
from tandemlift.codegen.c_package import written
from tandemlift.codegen.fmu_binaries import universal
from tandemlift.codegen.fmu_description import base_unit
from tandemlift.codegen.fmu_sources import flight_part, pilot_part
from tandemlift.simulation.caller_values import portable_mission
from tools import need

NAMES = ["hover_pilot.fmu", "hover_vehicle.fmu", "hover_flight.fmu"]


@pytest.fixture(scope="module", params=[2, 3])
def sources(request, tmp_path_factory):
    """FMUs of sources alone, written twice: the version, and both lists of files."""
    fmi, mission = request.param, tl.load_mission("hover")
    folders = [tmp_path_factory.mktemp("fmus") for _ in range(2)]
    return fmi, [tl.compile_mission(mission, "fmu", f, fmi=fmi, platforms=["none"]) for f in folders]


@pytest.mark.thorough
def test_each_has_a_description_and_sources_alike_each_time(sources):
    fmi, (one, two) = sources
    assert [path.name for path in one] == NAMES
    assert [path.read_bytes() for path in one] == [path.read_bytes() for path in two]
    for path in one:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
            root = ElementTree.fromstring(archive.read("modelDescription.xml"))
            described = {f"sources/{file.get('name')}" for file in root.iter("File")}
            if fmi == 3:
                build = ElementTree.fromstring(archive.read("sources/buildDescription.xml"))
                described = {f"sources/{file.get('name')}" for file in build.iter("SourceFile")}
                assert "-ffp-contract=off" in build.find(".//SourceFileSet").get("compilerOptions")
            header = archive.read(f"sources/{path.stem.partition('_')[0]}_fmu.h").decode()
        assert f"tandemlift {tl.__version__}" in header
        assert re.search(r"with the hash [0-9a-f]{16}\.", header)
        assert described == {name for name in names if name.endswith(".c")}
        assert not any(name.startswith("binaries/") for name in names)


@pytest.mark.parametrize(
    ("unit", "exponents"),
    [
        ("N s/m", {"kg": 1, "s": -1}),
        ("N/(rad/s)²", {"kg": 1, "m": 1, "rad": -2}),
        ("N m/rad", {"kg": 1, "m": 2, "s": -2, "rad": -1}),
        ("kg m²", {"kg": 1, "m": 2}),
        ("m/s^2", {"m": 1, "s": -2}),
        ("Hz", {"s": -1}),
        ("1", {}),
        ("N/√s", None),
        ("m/s, rad/s", None),
    ],
)
def test_units_are_products_of_powers_of_base_units(unit, exponents):
    assert base_unit(unit) == exponents


def test_a_universal_file_has_each_library_at_its_place():
    given = {"aarch64-darwin": b"one" * 9000, "x86_64-darwin": b"other"}
    whole = universal(given)
    magic, count = struct.unpack_from(">II", whole)
    assert (magic, count) == (0xCAFEBABE, 2)
    for i, code in enumerate(given.values()):
        _, _, at, size, bits = struct.unpack_from(">IIIII", whole, 8 + 20 * i)
        assert at % (1 << bits) == 0
        assert whole[at : at + size] == code


def refusal(tmp_path, **how):
    with pytest.raises(tl.InputError) as caught:
        tl.compile_mission("hover", how.pop("target", "fmu"), tmp_path / "out", **how)
    assert not (tmp_path / "out").exists()
    return str(caught.value)


def test_unknown_platforms_versions_and_targets_are_refused(tmp_path):
    said = refusal(tmp_path, platforms=["linus"])
    assert said == (
        "unknown platform 'linus'; there are linux, linux-arm64, windows, macos, none. Did you mean 'linux'?"
    )
    for version in (0, 1, True):
        assert refusal(tmp_path, fmi=version) == f"fmi = {version}: must be 2 or 3"
    said = refusal(tmp_path, platforms=["none", "linux"])
    assert said == "platforms = none, linux: 'none' is for sources alone; leave it or the others out"
    for names in ("linux", [], ()):
        said = refusal(tmp_path, platforms=names)
        assert said.startswith(f"platforms = {names!r}: must be a list of names of linux,")
    assert "only for target 'fmu'" in refusal(tmp_path, target="c", fmi=2)


def test_without_a_compiler_it_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setattr(fmu_binaries.shutil, "which", lambda name: None)
    monkeypatch.setitem(sys.modules, "ziglang", None)
    here = re.escape("without cc, gcc or clang needs ziglang: pip install 'tandemlift[fmu]'")
    assert re.fullmatch(rf"a library for \S+ {here}", refusal(tmp_path))
    for name, folder in (("windows", "x86_64-windows"), ("macos", "aarch64-darwin")):
        said = refusal(tmp_path, platforms=[name])
        assert said == f"a library for {folder} needs ziglang: pip install 'tandemlift[fmu]'"


def test_a_compiler_that_fails_is_quoted(tmp_path, monkeypatch):
    monkeypatch.setattr(fmu_binaries, "local_compiler", lambda: "false")
    assert re.match(r"platforms: false failed for \S+: ", refusal(tmp_path))


def test_the_command_refuses_platforms_without_a_name(tmp_path):
    given = ["hover", "--target", "fmu", "--platforms=", "--out", str(tmp_path)]
    result = CliRunner().invoke(compile_command, given)
    assert str(result.exception).startswith("unknown platform ''; there are linux,")


@pytest.mark.thorough
def test_one_program_links_the_sources_of_several_fmus_by_their_prefixes(tmp_path):
    need("gcc", "nm")
    mission, objects = portable_mission(tl.load_mission("hover")), []
    for described in (pilot_part(mission), *(flight_part(mission, part) for part in ("vehicle", "flight"))):
        folder, prefix = tmp_path / described.identifier, f"{described.identifier}_"
        for source in [f for f in written(described.texts, folder) if f.suffix == ".c"]:
            objects.append(source.with_suffix(".o"))
            options = (*STRICT, "-O0", f"-DFMI2_FUNCTION_PREFIX={prefix}", "-c", source, "-o", objects[-1])
            subprocess.run(["gcc", *options], check=True)
            seen = subprocess.run(
                ["nm", "-g", "--defined-only", objects[-1]], capture_output=True, text=True, check=True
            )
            assert all(line.split()[-1].startswith(prefix) for line in seen.stdout.splitlines())
    main = tmp_path / "main.c"
    calls = [f"{name.removesuffix('.fmu')}_fmi2GetVersion" for name in NAMES]
    heads = "\n".join(f"const char *{call}(void);" for call in calls)
    main.write_text(f"{heads}\nint main(void)\n{{\n    return !({' && '.join(f'{c}()' for c in calls)});\n}}\n")
    subprocess.run(["gcc", "-std=c99", main, *objects, "-o", tmp_path / "main", "-lm"], check=True)
    subprocess.run([tmp_path / "main"], check=True)


@pytest.mark.thorough
def test_the_command_writes_three(tmp_path):
    given = ["hover", "--target", "fmu", "--fmi", "3", "--platforms", "none", "--out", str(tmp_path)]
    result = CliRunner().invoke(compile_command, given)
    assert result.exit_code == 0, result.output
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(NAMES)
    assert "hover_vehicle.fmu (" in result.output
