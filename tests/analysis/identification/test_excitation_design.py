"""The excitation that tells most of a vehicle: its promise against flights, its limits in two engines, bad input."""

import inspect
import re

import numpy as np
import pytest
from click.testing import CliRunner
from repository import ROOT

import tandemlift as tl
from tandemlift.analysis.identification import excitation_design
from tandemlift.analysis.identification.excitation_design import (
    LINES,
    best_lines,
    best_shares,
    excite,
    limits_of,
    used_of,
)
from tandemlift.analysis.identification.excitation_information import (
    PARAMETERS,
    WEIGHED,
    body_response,
    densities,
    deviating,
    readings,
)
from tandemlift.analysis.identification.identify import reference_rows
from tandemlift.analysis.linearization.loop_margins import calm_mission
from tandemlift.apps.cli.main import cli
from tandemlift.missions import check, load_mission, mission_from_text, tables_of

pytestmark = pytest.mark.thorough

ROOM = (2.0, 1.5, 1.0)
TRUTH = {"pilot.state": "truth", "pilot.push": "truth", "estimator.identify_mass": False}


@pytest.fixture(scope="module")
def commanded(tmp_path_factory):
    """The design of a command, its file, and what it printed."""
    path, made = tmp_path_factory.mktemp("excited") / "excited.toml", []
    options = ["--time", "30", "--room", "2x1.5x1", "--push", "2", "--out", str(path), "--set", "mission.seed=3"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tl, "excite", lambda *args, **more: made.append(excite(*args, **more)) or made[0])
        result = CliRunner().invoke(cli, ["excite", "iris", *options], catch_exceptions=False)
    return made[0], path, result.output


@pytest.fixture(scope="module")
def design(commanded):
    return commanded[0]


def test_the_file_is_the_design_and_the_promise_is_printed(commanded):
    design, path, printed = commanded
    mission = load_mission(path)
    assert mission.mission.seed == 3
    assert (mission.excitation.duration, mission.excitation.room) == (30.0, ROOM)
    assert mission_from_text("excited.toml", design.text()) == design.mission
    assert path.read_text("utf-8") == design.text()
    for line in design.text().split("\n\n")[0].splitlines()[:12]:
        assert line.removeprefix("# ") in printed


def test_the_python_of_the_guide_runs(design, monkeypatch):
    """With the design that is there, for arguments that `excite` takes."""
    guide = (ROOT / "docs" / "how-to" / "excite-a-vehicle.md").read_text("utf-8")
    (block,), names = re.findall(r"^```python\n(.*?)^```", guide, re.M | re.S), {}
    monkeypatch.setattr(tl, "excite", lambda *args, **more: inspect.signature(excite).bind(*args, **more) and design)
    exec(compile(block, "excite-a-vehicle.md", "exec"), names)
    assert names["flight"].outcome == "landed"


def test_the_excited_flight_keeps_its_limits_in_both_engines(design):
    pytest.importorskip("mujoco")
    limits = limits_of(design.mission, ROOM)
    for engine in ("compiled", "mujoco"):
        flight = tl.fly(design.mission, engine=engine)
        assert flight.outcome == "landed"
        assert not flight.findings
        for name, (value, limit) in used_of(flight, limits).items():
            assert value < limit, (engine, name)


def test_the_promise_tells_yaw_inertia_and_yaw_drag_apart_and_holds_the_truth(design):
    truth = reference_rows(design.mission)
    promised = {row.key: row for row in design.promised}
    assert len(promised) == 16  # 13, if the two quadrotors had one lag_up, lag_down and torque_per_thrust
    for key in ("inertia.z", "vehicle.quadrotors.1.torque_per_thrust"):
        assert promised[key].half < 0.01 * truth[key]
    for key, row in promised.items():
        assert abs(row.value - truth[key]) < 2.0 * row.half, key


def test_a_person_is_asked_for_doublets_along_all_axes_and_one_that_turns(design):
    pushes = design.mission.pushes
    assert len(pushes) == 8
    for one, back in zip(pushes[::2], pushes[1::2], strict=True):
        assert np.add(one.force, back.force) == pytest.approx(0.0)
        assert one.point == back.point
        assert f"{one.time:g} s: a person pushes" in design.text()
    assert [np.argmax(np.abs(p.force)) for p in pushes[::2]] == [0, 1, 2, 0]
    assert np.cross(pushes[6].point, pushes[6].force)[2] != 0.0
    end = design.mission.excitation.begin + design.mission.excitation.duration
    assert end < pushes[0].time < pushes[-1].time < design.mission.phases.land_start


def calm(tables):
    """Tables of a mission whose sensors have no errors and whose reference rests."""
    for part in tables["sensors"].values():
        if isinstance(part, dict):
            part |= {k: 0.0 for k in part if k.endswith(("noise", "bias", "drift", "misalignment", "resolution"))}
    tables["mission"]["log_interval"] = 0.001
    for q in tables["vehicle"]["quadrotors"]:
        q["lag_up"] = q["lag_down"] = 0.5 * (q["lag_up"] + q["lag_down"])
    tables["pushes"] = []
    tables["excitation"]["lines"] = [line for line in tables["excitation"]["lines"] if line["axis"] not in "xy"]
    return tables


def phasors(flight, frequencies, steady):
    """Readings (F × 12) and commands (F × 8) of a flight at its lines, over whole periods of all of them."""
    e = flight.mission["excitation"]
    first = np.searchsorted(flight.time, e["begin"] + e["ramp"] - 1e-9)
    within = slice(first, first + round(steady / 0.001))
    t = flight.time[within]
    names = ("measured_rates", "measured_specific_force", "measured_position", "euler", "rotor_commands")
    values = np.column_stack([flight[name][within].reshape(len(t), -1) for name in names])
    hann = 1.0 - np.cos(
        2.0 * np.pi * np.arange(len(t)) / len(t)
    )  # what is left of the start does not leak into the lines
    found = (
        2.0 / len(t) * np.exp(-2j * np.pi * np.outer(frequencies, t)) @ (hann[:, None] * (values - values.mean(axis=0)))
    )
    return found[:, :12], found[:, 12:]


def test_the_information_of_the_lines_is_that_of_differences_of_flights(design):
    """∂G/∂θ u = Δy − G Δu, from flights whose body, lag or delay is a little other: in closed loop, with no noise."""
    m = design.mission
    tables = calm(tables_of(m))
    e = m.excitation
    steady = e.duration - 3.0 * e.ramp
    lines = [line for line in e.lines if line.axis not in "xy"]
    f = np.array(sorted(line.frequency for line in lines))
    hover, at = calm_mission(m, slow=1.0)
    s = 2j * np.pi * f
    rotor = np.exp(-s * (m.actuators.delay + m.mission.step)) / (1.0 + s * m.hover.lag)  # held, and read a step later
    lever = np.array(hover.hover.vehicle.payload_center)
    G = readings(body_response(hover, at, f), s, lever) * rotor[:, None, None]

    def flown(parameter):
        changed = tables_of(check(tables, "calm", quiet=True))
        if parameter and parameter.key:
            return tl.fly(deviating(check(changed, "calm", quiet=True), parameter, 1e-3))
        if parameter and parameter.name == "lag of rotors":
            for q in changed["vehicle"]["quadrotors"]:
                q["lag_up"], q["lag_down"] = 1.01 * q["lag_up"], 1.01 * q["lag_down"]
        if parameter and parameter.name == "delay of rotors":
            changed["actuators"]["delay"] += 1e-3
        return tl.fly(check(changed, "calm", quiet=True))

    y, u = phasors(flown(None), f, steady)
    slopes = []
    for p in PARAMETERS:
        if p.name == "thrust constant":
            slopes.append((G @ u[:, :, None])[:, :, 0])
            continue
        dy, du = (a - b for a, b in zip(phasors(flown(p), f, steady), (y, u), strict=True))
        slopes.append((dy - (G @ du[:, :, None])[:, :, 0]) / (1e-2 if p.name == "lag of rotors" else 1e-3))
    information = (
        0.5 * steady * np.einsum("ifc,jfc,c->ij", np.conj(slopes), slopes, densities(m.sensors, m.mission.step)).real
    )
    plain = load_mission("iris")
    rows, expected = best_lines(plain, steady, limits_of(plain, ROOM))
    lowered = lines[0].amplitude / rows[0]["amplitude"]  # until the flight kept its limits
    scale = np.array([p.target for p in PARAMETERS])
    prior = np.diag(np.arange(len(scale)) == 0) / WEIGHED**2
    ours, theirs = (
        np.sqrt(np.diag(np.linalg.inv((whole + prior) * np.outer(scale, scale))))
        for whole in (lowered**2 * expected, information)
    )
    assert ours == pytest.approx(theirs, rel=0.25)


def test_the_shares_are_optimal_by_the_equivalence_theorem(monkeypatch):
    """At the optimum no line of an axis gains more than the axis' mean: Kiefer and Wolfowitz, 1960."""
    monkeypatch.setattr(excitation_design, "EVEN", 0.0)
    monkeypatch.setattr(excitation_design, "ROUNDS", 20000)
    targets = np.array([p.target for p in PARAMETERS])
    roots = np.random.default_rng(3).normal(size=(4, LINES, 4, len(targets))) / targets
    information = np.einsum("akmi,akmj->akij", roots, roots)
    q = best_shares(information)
    scaled = information * np.outer(targets, targets)
    whole = np.einsum("ak,akij->ij", q, scaled)
    whole[0, 0] += (targets[0] / WEIGHED) ** 2
    inverse = np.linalg.inv(whole)
    gain = np.einsum("akij,ji->ak", scaled, inverse @ inverse)
    assert q.sum(axis=1) == pytest.approx(np.ones(4))
    assert gain.max(axis=1) == pytest.approx((q * gain).sum(axis=1), rel=1e-2)


@pytest.mark.parametrize(
    ("mission", "keys", "how", "words"),
    [
        ("iris", {}, {"time": 20.0}, "time = 20: must be at least 21 s"),
        ("iris", {}, {"room": (2.0, 0.1, 1.0)}, "room = .* at least 0.2 m"),
        ("iris", {}, {"push": -1.0}, "push = -1: must be a force in N"),
        ("paper", {}, {}, "actuators.model"),
        ("iris", {"sensors.model": "none", **TRUTH}, {}, 'sensors.model = "none"'),
        ("iris", {"sensors.gyroscope.noise": 0.0}, {}, "sensors.gyroscope.noise = 0"),
    ],
)
def test_what_cannot_be_excited_is_refused_by_name(mission, keys, how, words):
    with pytest.raises(tl.InputError, match=words):
        excite(load_mission(mission, keys), **how)


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["iris", "--room", "2 by 2"], "--room 2 by 2: must be three sizes in m"),
        (["iris", "--out", "mine.json"], "--out mine.json: must end in .toml"),
    ],
)
def test_what_the_command_cannot_do_is_refused_and_nothing_is_written(args, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(cli, ["excite", *args])
    assert isinstance(result.exception, tl.InputError)
    assert words in str(result.exception)
    assert not list(tmp_path.iterdir())
