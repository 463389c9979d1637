"""The pilot in C: its bits, its self-tests, what its code may contain, and what its header refuses."""

import ctypes
import re
import subprocess
from functools import cache

import numpy as np
import pytest
from c_flights import STRICT, same, unfused

import tandemlift as tl
from tandemlift.codegen.c_package import MARK, code_texts, pilot_selftest, pilot_vectors, source_file, write_c, written
from tandemlift.core.files import check_own
from tandemlift.core.types import leaves
from tandemlift.simulation.pilot_api import INPUT, pilot_at_start
from tools import need

SANITIZERS = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g")


class PilotInC:
    """A mission's pilot as a shared library."""

    def __init__(self, mission, folder, texts, *, single=False):
        files = written(texts, folder)
        source = next(f for f in files if f.name.endswith("_pilot.c"))
        library = folder / "pilot.so"
        subprocess.run(["gcc", *STRICT, "-O0", "-shared", "-fPIC", source, "-o", library, "-lm"], check=True)
        self.real = np.float32 if single else np.float64
        name, self.library = source.name.removesuffix("_pilot.c"), ctypes.CDLL(str(library))
        self.name = name
        self.numbers = np.zeros(leaves(pilot_at_start(mission)), self.real)
        self.input = np.zeros(leaves(INPUT), self.real)
        self.thrusts = np.zeros(4 * len(mission.vehicle.quadrotors), self.real)
        self._step = getattr(self.library, f"{name}_pilot_step")
        self._step.restype = ctypes.c_bool
        self._places = [ctypes.c_void_p(a.ctypes.data) for a in (self.numbers, self.input, self.thrusts)]
        getattr(self.library, f"{name}_pilot_start")(self._places[0])

    def step(self, measurement):
        """Thrusts [N] for a measurement, as of `tl.Pilot`."""
        self.input[:16], self.input[22] = measurement, 1.0
        self.takes = self._step(*self._places)
        return self.thrusts


def measurements(mission, hold):
    """States and pushes all over a flight, each for `hold` samples."""
    flight = tl.fly(mission)
    names = ("position", "velocity", "attitude", "rates", "push_force")
    return np.repeat(np.hstack([flight[name] for name in names])[::20], hold, axis=0)


def build(source, *options, compiler="gcc"):
    """Compile a self-test with what it tests."""
    folder, program = source.parent, source.with_suffix("")
    part = source.name.removesuffix("_selftest.c") + ".c"
    subprocess.run([compiler, *STRICT, *(options or ("-O1",)), source, folder / part, "-o", program, "-lm"], check=True)
    return program


@cache
def flown_in_c(name):
    """A mission, the pilot of `iris` with a policy, and its C."""
    policy = {"compliance.policy.model": "network"} if name == "iris" else {}
    mission = unfused(tl.load_mission(name, {"mission.duration": 30.0, **policy}))
    return mission, code_texts(mission)


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["paper", "iris"])
def test_its_thrusts_have_the_bits_of_the_native_pilot(name, tmp_path):
    need("gcc")
    mission, texts = flown_in_c(name)
    in_c, native = PilotInC(mission, tmp_path, texts), tl.Pilot(mission)
    rows = measurements(mission, 60)
    found = np.array([(in_c.step(row).copy(), native.step(row).copy()) for row in rows])
    assert same(found[:, 0], found[:, 1])
    assert len(np.unique(found[:, 1])) > 1000


@pytest.mark.thorough
@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
def test_a_number_that_is_not_finite_changes_nothing_as_in_the_native_pilot(wrong, tmp_path):
    need("gcc")
    mission = unfused(tl.load_mission("hover"))
    in_c, native, still = PilotInC(mission, tmp_path, code_texts(mission)), tl.Pilot(mission), np.eye(16)[6]
    for _ in range(100):
        in_c.step(still)
        native.step(still)
    assert in_c.takes
    for at in range(16):
        numbers, thrusts, bad = in_c.numbers.copy(), in_c.thrusts.copy(), still.copy()
        bad[at] = wrong
        in_c.step(bad)
        assert not in_c.takes
        assert same(in_c.numbers, numbers)
        assert same(in_c.thrusts, thrusts)
        with pytest.raises(tl.InputError, match="must be a finite number without supervision"):
            native.step(bad)
    in_c.input[16] = wrong  # the moment
    in_c.step(still)
    assert not in_c.takes
    in_c.input[16] = 0.0
    for _ in range(100):
        assert same(in_c.step(still), native.step(still))
        assert in_c.takes


@pytest.mark.thorough
def test_with_supervision_a_number_that_is_not_finite_stays_out_of_the_memory(tmp_path):
    need("gcc")
    mission = unfused(tl.load_mission("iris", {"pilot.guidance": "interactive", "supervision.model": "on"}))
    texts = code_texts(mission)
    in_c, still = PilotInC(mission, tmp_path, texts), np.eye(16)[6]
    for at in range(16):
        bad = still.copy()
        bad[at] = np.nan
        in_c.step(still)
        in_c.step(bad)
        assert in_c.takes
        assert np.isfinite(in_c.step(still)).all()
    assert np.isfinite(in_c.numbers).all()
    assert "supervision detects numbers that are not finite" in texts[f"{in_c.name}_pilot.h"]


@pytest.mark.thorough
def test_the_self_tests_pass_and_fail_when_a_bit_is_other(tmp_path):
    need("gcc")
    files = write_c(tl.load_mission("one-push"), tmp_path)
    for name in ("CMakeLists.txt", "README.md"):
        check_own(tmp_path / name, MARK)  # it may be written again
    for part in ("pilot", "flight"):
        source = next(f for f in files if f.name.endswith(f"_{part}_selftest.c"))
        assert subprocess.run([build(source)], check=False, capture_output=True).stdout.startswith(b"ok")
        text = source.read_text()
        data = text[: text.index("\n};")]  # its last number is one that must come
        digit = [place.end() - 1 for place in re.finditer(r"\d\.\d{3,}", data)][-1]
        source.write_text(text[:digit] + str((int(text[digit]) + 5) % 10) + text[digit + 1 :])
        assert subprocess.run([build(source, "-O0")], check=False, capture_output=True).returncode == 1


def test_a_pilot_in_single_precision_passes_where_the_thrusts_of_its_flight_are_constant(tmp_path):
    need("gcc")
    mission = tl.load_mission("hover", {"mission.duration": 0.1, "mission.fma": False})
    vectors = pilot_vectors(mission)
    assert np.ptp([thrusts for *_, thrusts in vectors]) == 0.0
    text = pilot_selftest(source_file(mission, True), vectors)
    written(code_texts(mission, True) | {"hover_pilot_selftest.c": text}, tmp_path)
    run = subprocess.run([build(tmp_path / "hover_pilot_selftest.c")], check=False, capture_output=True)
    assert run.stdout.startswith(b"ok"), run.stdout


@pytest.mark.parametrize("name", ["CMakeLists.txt", "README.md"])
def test_files_of_another_project_are_not_replaced(name, tmp_path):
    (tmp_path / name).write_text("# mine", "utf-8")
    with pytest.raises(tl.InputError, match=f"{name}: tandemlift did not write it, so it stays: give"):
        write_c(tl.load_mission("hover"), tmp_path)
    assert [path.read_text("utf-8") for path in tmp_path.iterdir()] == ["# mine"]


def test_its_header_refuses_arithmetic_that_is_not_exact(tmp_path):
    need("gcc")
    files = written(code_texts(tl.load_mission("hover")), tmp_path)
    source = next(f for f in files if f.name.endswith("_pilot.c"))
    for option in ("-ffast-math", "-ffinite-math-only", "-fassociative-math -fno-signed-zeros"):
        options = [*option.split(), "-fno-trapping-math", "-fsyntax-only"]
        run = subprocess.run(["gcc", "-std=c99", *options, source], check=False, capture_output=True, text=True)
        assert run.returncode != 0, option
        assert "compile without -ffast-math" in run.stderr


def functions_of(text):
    """Lines of each function of a source, by name."""
    found, begin = {}, None
    for i, line in enumerate(text.split("\n")):
        if line == "{":
            begin = i
        elif line == "}" and begin is not None:
            head = "\n".join(text.split("\n")[max(0, begin - 4) : begin])
            found[re.findall(r"(\w+)\(", head)[-1], i] = i - begin
            begin = None
    return found


@pytest.mark.thorough
def test_its_functions_are_short_allocate_nothing_and_name_their_laws():
    _, texts = flown_in_c("iris")
    source = texts["iris_pilot.c"] + texts["iris_flight.c"]
    lengths = functions_of(source)
    assert lengths
    assert max(lengths.values()) <= 300
    assert not re.search(r"\b(malloc|calloc|realloc|alloca|free)\(", source)
    assert set(re.findall(r"#include <(.+)>", source)) <= {"math.h", "stdbool.h", "stddef.h", "stdint.h", "string.h"}
    assert "\n/* tandemlift." in source
    assert "\n * paper: " in source
    assert len(texts["README.md"].split("\n")) <= 60


@pytest.mark.thorough
def test_its_headers_say_version_hash_units_frames_and_meanings():
    texts, other = (code_texts(tl.load_mission("paper", changes)) for changes in ({}, {"mission.seed": 7}))
    assert code_texts(tl.load_mission("paper")) == texts
    pilot, flight, guide = texts["paper_pilot.h"], texts["paper_flight.h"], texts["README.md"]
    assert all(f"tandemlift {tl.__version__}" in text for text in (pilot, flight, guide))
    found, elsewhere = (re.search(r"hash ([0-9a-f]{16});", t["paper_pilot.h"])[1] for t in (texts, other))
    assert found != elsewhere
    assert f"`{found}`" in guide
    assert "paper_Vec3 velocity; /* m/s, world: velocity of the centre of mass */" in pilot
    assert "paper_Each8 thrusts; /* N, body z: commanded thrust of each rotor" in flight
    key = "/* vehicle.payload.mass [kg]: mass of the payload, > 0 */\n    double vehicle_payload_mass;"
    assert key in texts["paper_pilot_prepare.h"]
    for filled in ("State", "PilotInput", "OperatorRequest", "VehicleStatus"):  # what a caller fills, field by field
        body = re.search(rf"struct \{{\n((?:    .+\n)+)\}} paper_{filled};", pilot)[1]
        kinds = ("/*", "paper_State", "_Operator", "_Vehicle")
        assert all(any(kind in line for kind in kinds) for line in body.splitlines())
    for word in ("operator_.lift", "input.land", "operator_.stop", "status.rotor_failed", "status.state_invalid"):
        assert word in guide


@pytest.mark.targets
@pytest.mark.parametrize("name", ["paper", "iris", "zigzag", "rotor-loss"])
def test_the_self_tests_pass_under_sanitizers_and_on_aarch64(name, tmp_path):
    need("gcc", "clang", "aarch64-linux-gnu-gcc", "qemu-aarch64")
    files = write_c(tl.load_mission(name), tmp_path)
    for part in ("pilot", "flight"):
        source = next(f for f in files if f.name.endswith(f"_{part}_selftest.c"))
        for compiler in ("gcc", "clang"):
            run = subprocess.run(
                [build(source, "-O1", *SANITIZERS, compiler=compiler)], check=False, capture_output=True
            )
            assert run.stdout.startswith(b"ok"), run.stderr.decode()
        program = build(source, "-O2", "-static", compiler="aarch64-linux-gnu-gcc")
        run = subprocess.run(["qemu-aarch64", program], check=False, capture_output=True)
        assert run.stdout.startswith(b"ok"), run.stdout.decode()


def test_in_single_precision_its_clock_goes_on_beyond_the_integers_of_a_float(tmp_path):
    """At 1 kHz these end after 4 h 40 min."""
    need("gcc")
    mission = unfused(tl.load_mission("paper"))
    pilot, last = PilotInC(mission, tmp_path, code_texts(mission, True), single=True), 2**24
    pilot.numbers[:1].view(np.uint32)[0] = last
    for count in (last + 1, last + 2):
        pilot.step(np.eye(16)[6])
        assert pilot.numbers[:1].view(np.uint32)[0] == count


@pytest.mark.targets
@pytest.mark.parametrize("name", ["paper", "iris"])
def test_in_single_precision_it_flies_within_a_thousandth_of_the_range_of_thrusts(name, tmp_path):
    need("gcc")
    mission = unfused(tl.load_mission(name))
    exact, single = tl.Pilot(mission), PilotInC(mission, tmp_path, code_texts(mission, True), single=True)
    pushes = tl.fly(unfused(tl.load_mission(name, {"mission.log_interval": mission.mission.step})))["push_force"]
    flown = []
    for pilot in (exact, single):
        sim, thrusts = tl.Simulation(mission), []
        for push in pushes[:-1]:
            thrusts.append(np.array(pilot.step(np.concatenate([sim.state, push])), float))
            sim.step(thrusts=thrusts[-1])
        flown.append(np.array(thrusts))
    assert np.abs(flown[1] - flown[0]).max() <= 1e-3 * np.ptp(flown[0])
    assert not same(flown[0], flown[1])


@pytest.mark.targets
def test_eight_quadrotors_are_written_out_in_short_functions_with_the_same_bits(tmp_path):
    need("gcc")
    one = tl.load_mission("iris").vehicle.quadrotors[0].model_dump(mode="json")
    many = [{**one, "position": [0.0, float(y), 0.075]} for y in np.linspace(2.8, -2.8, 8)]
    mission = unfused(tl.load_mission("iris", {"vehicle.quadrotors": many, "mission.duration": 20.0}))
    files = write_c(mission, tmp_path)
    for part in ("pilot", "flight"):
        source = next(f for f in files if f.name.endswith(f"_{part}_selftest.c"))
        assert subprocess.run([build(source)], check=False, capture_output=True).stdout.startswith(b"ok")
        assert max(functions_of((tmp_path / f"iris_{part}.c").read_text()).values()) <= 300
