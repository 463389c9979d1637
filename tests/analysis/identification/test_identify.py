"""Vehicles that MuJoCo flew, identified from their logs; against scipy.optimize on a plain model; bad input."""

import json
from dataclasses import replace

import numpy as np
import pytest
from plain_vehicle import PlainVehicle, fitted, squares

import tandemlift as tl
from tandemlift.analysis.identification.equations import ROBUST
from tandemlift.analysis.identification.fit import VehicleSearch
from tandemlift.analysis.identification.identify import reference_rows
from tandemlift.analysis.identification.judgement import covariance_of
from tandemlift.analysis.identification.prediction import Predictor
from tandemlift.analysis.identification.sensor_errors import sensor_priors
from tandemlift.analysis.identification.vehicle_unknowns import UNLIKE, driven_numbers, unknowns_of
from tandemlift.analysis.identification.windows import windows_of
from tandemlift.analysis.logs.log import IMU, JOINTS, MOTION, Log, Stream, log_of, quaternion_product
from tandemlift.core.errors import InputError
from tandemlift.missions import load_mission
from tandemlift.pictures.report.identification_report import draw_estimates, write_identification

pytest.importorskip("mujoco")
START = "iris"
TRUTH = {
    "vehicle.payload.mass": 0.55,
    "vehicle.payload.center_of_mass": [0.01, -0.06, 0.01],
    "vehicle.quadrotors.0.mass": 1.62,
    "vehicle.quadrotors.1.mass": 1.41,
    "actuators.delay": 0.012,
}
for place in (0, 1):
    TRUTH |= {
        f"vehicle.quadrotors.{place}.{name}": value
        for name, value in {
            "inertia": [0.032, 0.027, 0.05],
            "thrust_constant": 6.4e-6,
            "torque_per_thrust": 0.053,
            "lag_up": 0.0145,
            "lag_down": 0.022,
        }.items()
    }
BEGIN, END, PUSH = 9.0, 30.0, 20.0  # s, of the excitation; of a push
EXCITED = (("thrust", 1.5), ("roll", 1.0), ("pitch", 0.1), ("yaw", 0.3))
FLOWN = {
    "mission.duration": END,
    "mission.seed": 4,
    "mission.log_interval": 0.001,
    "phases.lift_start": 0.5,
    "phases.lift_duration": 3.0,
    "phases.height": 1.5,
    "phases.land_start": 100.0,
    "estimator.tare_start": 4.0,
    "excitation.model": "multisine",
    "excitation.begin": BEGIN,
    "excitation.duration": END - BEGIN,
    "excitation.lines": [
        {"axis": axis, "frequency": f * (1.0 + 0.03 * i), "amplitude": size, "phase": 0.7 * k * k}
        for i, (axis, size) in enumerate(EXCITED)
        for k, f in enumerate((0.3, 0.5, 0.8, 1.3, 2.1, 3.4, 5.5, 8.0))
        if axis != "pitch" or f > 0.6
    ],
    "pushes": [{"force": [1.5, 0.0, 0.0], "time": PUSH, "sigma": 0.3}],
}
WEIGHED = {"vehicle.payload.mass": TRUTH["vehicle.payload.mass"]}
SILENT = {"progress": lambda done, of: None}
pytestmark = pytest.mark.filterwarnings("ignore::tandemlift.FlightWarning")


def blind(log):
    """The log without what only a simulation knows."""
    return Log(
        {n: s for n, s in log.items() if not n.startswith("push_") and n != "rotor_commands"}, "blind", stamp_offset=0.0
    )


@pytest.fixture(scope="module")
def flight():
    return tl.fly(load_mission(START, TRUTH | FLOWN), engine="mujoco")


@pytest.fixture(scope="module")
def log(flight):
    return blind(log_of(flight))


@pytest.fixture(scope="module")
def found(log):
    return tl.identify(log, START, weighed=WEIGHED, **SILENT)


@pytest.mark.thorough
def test_the_driven_vehicle_moves_as_mujoco_moved_it(flight, log):
    true = load_mission(START, TRUTH)
    quiet = windows_of(log.between(BEGIN, PUSH - 3.0), true, 0.5)
    predictor = Predictor(quiet, unknowns_of(true.vehicle, true.actuators.delay), true)
    rows = np.round(quiet.times() / 0.001).astype(int)
    starts = np.concatenate([flight[n][rows] for n in ("position", "velocity", "attitude", "rates")], axis=1)
    n = driven_numbers(true.vehicle, true.actuators.delay)
    seen = predictor.predicted(starts, n, predictor.squares(n, False)[0], np.zeros(3))
    every = rows[:, None] + np.arange(quiet.length)
    for name, within in (("position", 2e-5), ("velocity", 5e-5), ("rates", 5e-5), ("joint_force", 5e-4)):
        assert seen[f"measured_{name}"][:, : quiet.length] == pytest.approx(flight[name][every], abs=within)


def test_derivatives_are_central_differences_of_predictions(log):
    start = load_mission(START)
    w = windows_of(log.between(BEGIN, PUSH - 3.0), start, 0.5)
    unknowns = unknowns_of(start.vehicle, start.actuators.delay)
    predictor, point = Predictor(w, unknowns, start), np.array([0.01, 0.02, -0.01])
    starts, q = predictor.starts(), 0.02 * np.cos(np.arange(len(unknowns))) * np.minimum(unknowns.sd, 0.3)
    n = unknowns.numbers(q)
    derivatives = predictor.derivatives(starts, q, n, *predictor.squares(n, True), point)
    for i, u in enumerate(unknowns.unknowns):
        h = 1e-3 * u.sd * np.eye(len(q))[i]
        ends = []
        for x in (q + h, q - h):
            m = unknowns.numbers(x)
            p = predictor.predicted(starts, m, predictor.squares(m, False)[0], point)
            ends.append(p["measured_velocity"][:, :: w.block][:, :-1])
        J = derivatives.streams["measured_velocity"][:, 12 + i, :-1]
        expected = (ends[0] - ends[1]) / (2.0 * h[i])
        assert J[:, : expected.shape[1]] == pytest.approx(expected, abs=0.02 * np.abs(expected).max() + 1e-9), u.name


@pytest.mark.thorough
def test_estimates_are_near_the_truth_and_within_their_intervals(found):
    truth = reference_rows(load_mission(START, TRUTH))
    rows = [row for row in (*found.rows, *found.whole) if row.excited]
    off = {row.key: abs(row.value - truth[row.key]) / (row.half / 1.96) for row in rows}
    assert max(off.values()) < 4.0, max(off.items(), key=lambda item: item[1])
    assert np.mean([size < 1.96 for size in off.values()]) > 0.8
    assert found["mass"].value == pytest.approx(truth["mass"], rel=0.003)
    for axis in "xyz":
        assert found[f"inertia.{axis}"].value == pytest.approx(truth[f"inertia.{axis}"], rel=0.02)
        assert found[f"center_of_mass.{axis}"].value == pytest.approx(truth[f"center_of_mass.{axis}"], abs=0.002)
    assert found["actuators.delay"].value == pytest.approx(0.012, abs=0.0002)
    assert found["vehicle.quadrotors.*.lag_up"].value == pytest.approx(0.0145, rel=0.05)


def test_a_push_is_left_out_and_what_was_held_back_is_predicted(found):
    assert 1 <= found.details["windows"]["left_out"] <= 5
    assert any("left out" in text for text in found.remarks)
    assert all(0.8 < ratio < 1.5 for ratio in found.details["held_back"]["ratio"].values())
    assert 0.5 < found.details["efficiency"] <= 1.0


def test_the_identified_mission_is_written_with_its_intervals(found, tmp_path):
    mission, data = found.save(tmp_path)
    loaded = load_mission(mission)
    assert loaded.vehicle.quadrotors[1].mass == pytest.approx(found["vehicle.quadrotors.1.mass"].value, rel=1e-6)
    assert loaded.actuators.delay == pytest.approx(found["actuators.delay"].value, rel=1e-6)
    line = next(text for text in mission.read_text("utf-8").splitlines() if text.startswith("thrust_constant"))
    assert f"± {found['vehicle.quadrotors.0.thrust_constant'].half:.2g}" in line
    written = found.details["written"]
    drag = [written[f"vehicle.drag.force.{axis}"] for axis in "xyz"]
    assert loaded.vehicle.drag.force == pytest.approx(drag, abs=1e-12)
    assert drag == pytest.approx([max(found[f"vehicle.drag.force.{axis}"].value, 0.0) for axis in "xyz"], rel=1e-6)
    assert json.loads(data.read_text("utf-8"))["whole_vehicle"][0]["key"] == "mass"


@pytest.mark.thorough
def test_the_page_shows_each_estimate(found, tmp_path):
    text = write_identification(found.as_dict(), tmp_path).read_text("utf-8")
    assert all(row.key in text for row in (*found.rows, *found.whole))
    (axes,) = draw_estimates([{**found.rows[0]._asdict(), "start": found.rows[0].value / 2.6}]).axes
    assert axes.lines[1].get_xydata().tolist() == [[axes.get_xlim()[1], 0.0]]  # an arrow at the edge


@pytest.mark.thorough
def test_biases_that_walk_within_a_window_widen_the_intervals(log):
    """Steps from drawn readings spread as the covariance says; by constant biases alone it says a fifth of that."""
    drifts = {"accelerometer.drift": 0.01, "gyroscope.drift": 0.001, "joints.force_drift": 0.05}
    mission = load_mission(START, TRUTH | {f"sensors.{name}": value for name, value in drifts.items()})
    w, s = windows_of(log.between(BEGIN, PUSH - 2.0), mission), mission.sensors
    unknowns = unknowns_of(mission.vehicle, mission.actuators.delay, ["vehicle.drag.force"])
    predictor, joint_count = Predictor(w, unknowns, mission), len(mission.vehicle.quadrotors)
    priors = sensor_priors(s, joint_count, frozenset(w.samples))
    search = VehicleSearch([predictor], unknowns, priors)
    own, joints, motion = (s.accelerometer, s.gyroscope), s.joints, s.motion
    sizes = (*[k.noise for k in own], joints.force_noise, joints.torque_noise)
    sizes = [*sizes, motion.position_noise, motion.velocity_noise, motion.attitude_noise]
    noise = dict(zip((*IMU, *JOINTS, *MOTION), sizes, strict=True))
    walk = dict(zip((*IMU, *JOINTS), (*[k.drift for k in own], joints.force_drift, joints.torque_drift), strict=True))
    search.estimate.noise = noise
    n, part, chance = unknowns.numbers(search.estimate.q), search.parts[0], np.random.default_rng(8)
    p = predictor.predicted(part.starts, n, predictor.squares(n, False)[0], search.estimate.point)
    off = []
    for _ in range(30):
        drawn = {}
        for name, samples in w.samples.items():
            exact = p[name][samples.window, samples.step]
            turns = name == MOTION[2]
            error = noise[name] * chance.standard_normal((len(exact), 3 if turns else exact.shape[1]))
            time = (w.first[samples.window] + samples.step) * w.step
            gone = np.sqrt(np.diff(time, prepend=time[0]))[:, None] * chance.standard_normal(error.shape)
            error += np.cumsum(walk.get(name, 0.0) * gone, axis=0)
            half = np.insert(0.5 * error, 0, 1.0, axis=1)
            drawn[name] = samples._replace(values=quaternion_product(exact, half) if turns else exact + error)
        part.predictor = replace(predictor, windows=replace(w, samples=drawn))
        equations, normal = search.linearised(ROBUST)
        sd = np.sqrt(np.diag(covariance_of(search, equations, normal, dict.fromkeys(noise, 1.0)).covariance))
        off.append(np.linalg.solve(normal.information, normal.side)[:3] / sd)
    assert 0.75 < np.std(off) < 1.25


def thrust_at(times, log, delay, k, up, down):
    """Thrust [N] of all rotors at increasing times [s], by the closed form of a lag between delayed commands."""
    time, speeds = log["rotor_speed_commands"]
    speed, since, j, found = speeds[0], time[0] + delay, 0, []

    def after(span):
        return speeds[j] + (speed - speeds[j]) * np.exp(-span / np.where(speeds[j] > speed, up, down))

    for at in times:
        while j + 1 < len(time) and time[j + 1] + delay <= at + 1e-9:
            speed, since, j = after(time[j + 1] + delay - since), time[j + 1] + delay, j + 1
        found.append(k * np.sum(after(at - since) ** 2))
    return np.array(found)


def test_a_joint_of_a_simulated_flight_reads_the_thrust_of_half_a_step_later(flight):
    """A step of 1 ms has one thrust, its mean; so what is stamped t is of t + 0.5 ms.

    The joints' sum along z is a share of the thrust at an instant, by the closed form of the rotors' lag, and of what
    moves (rates, their change, the velocity). The share of the thrust's change over that of the thrust is the shift.
    """
    step, some = 1e-3, (flight.time > BEGIN + 1.0) & (flight.time < BEGIN + 5.0)
    own = (TRUTH[f"vehicle.quadrotors.0.{name}"] for name in ("thrust_constant", "lag_up", "lag_down"))
    thrust = thrust_at(flight.time, log_of(flight), TRUTH["actuators.delay"], *own)
    w = flight["rates"]
    turning, slope = (np.diff(v, axis=0, append=v[-1:]) / step for v in (w, thrust))
    moved = np.column_stack([np.ones(len(w)), w, w * w, w * np.roll(w, 1, axis=1), turning, flight["velocity"]])
    X = np.column_stack([thrust, slope, moved])[some]
    y = flight["joint_force"].reshape(len(w), -1, 3).sum(axis=1)[some, 2]
    (share, by_slope, *_), (rest,), *_ = np.linalg.lstsq(X, y, rcond=None)
    assert rest < 1e-6 * np.sum((y - y.mean()) ** 2)
    assert by_slope / share == pytest.approx(0.5 * step, rel=0.05)


@pytest.mark.thorough
def test_outliers_gaps_and_clocks_of_their_own_change_little(log, found):
    """Offsets and drifts of the sources' clocks are found beside the vehicle; the correlation does not see 1.3 ms."""
    chance, bad = np.random.default_rng(3), {}
    for name, (time, values) in log.items():
        kept = chance.random(len(time)) > 0.05
        values = values.copy()
        if name.startswith("measured") and "attitude" not in name:
            hit = chance.random(len(time)) < 0.01
            values[hit] += 20.0 * values.std(axis=0)
        bad[name] = Stream(time[kept], values[kept]) if name.startswith("measured") else Stream(time, values)
    bad = Log(bad, "bad")
    joints, motion = ([n for n in bad if any(part in n for part in names)] for names in (("joint",), MOTION))
    bad = bad.aligned(joints, 1.3e-3, 2e-5, 20.0).aligned(motion, -0.7e-3, -3e-5, 20.0)
    again = tl.identify(bad, START, weighed=WEIGHED, predict=log.between(22.0, 30.0), window=0.8, **SILENT)
    ahead = 0.5e-3  # what the joints of a simulated flight read early, as the test above has it
    assert again.details["clocks"]["measured_joint_force"] == pytest.approx(-1.3e-3 + ahead, abs=2e-4)
    assert again.details["clocks"]["measured_position"] == pytest.approx(0.7e-3, abs=3e-4)
    assert all(0.8 < ratio < 1.5 for ratio in again.details["predicted"]["ratio"].values())
    for row in (*found.rows, *found.whole):
        assert abs(again[row.key].value - row.value) < 1.5 * row.half, row.key


@pytest.mark.thorough
def test_gaps_of_a_stream_cost_no_more_than_their_windows(log, tmp_path):
    """The last windows, of which one is the example and two are held back, have no joints."""
    kept = dict(log.between(BEGIN, PUSH - 3.0))
    gaps = (10.2, 11.7, MOTION), (12.3, 12.8, MOTION[1:2]), (13.5, 14.2, IMU[1:]), (14.9, 16.9, JOINTS)
    for begin, end, names in gaps:
        for name in names:
            time, values = kept[name]
            there = (time < begin) | (time > end)
            kept[name] = Stream(time[there], values[there])
    true, keys = load_mission(START, TRUTH), ["vehicle.payload.mass", "vehicle.quadrotors.*.thrust_constant"]
    gapped = tl.identify(Log(kept, "gaps"), true, parameters=keys, weighed=WEIGHED, window=0.4, **SILENT)
    assert gapped.details["windows"] == {"used": 10, "left_out": 0}  # of 18: six begin in a gap, two are held back
    for row in gapped.rows:
        assert abs(row.value - row.start) < 1.5 * row.half < 0.003 * row.start, row.key
    _, data = gapped.save(tmp_path)
    told = json.loads(data.read_text("utf-8"))
    sizes = {name: len(points) for name, points in told["misfit"].items()}
    assert sizes == dict.fromkeys((*IMU, *MOTION), 10) | dict.fromkeys(JOINTS, 8)
    assert {*told["held_back"]["ratio"]} == {*IMU, *MOTION}
    assert write_identification(told, tmp_path).is_file()


@pytest.mark.thorough
def test_the_estimate_is_that_of_scipy_on_a_plain_model(log):
    known = {key: value for key, value in TRUTH.items() if "thrust" not in key}
    start = load_mission(START, known | {"vehicle.drag.force": 0.0, "vehicle.drag.moment": 0.0, "ground.effect": False})
    part = Log({n: s for n, s in log.items() if "joint" not in n}, "part").between(11.0, 14.8)
    keys = ["vehicle.quadrotors.*.thrust_constant", "vehicle.quadrotors.*.torque_per_thrust"]
    ours = tl.identify(part, start, parameters=keys, window=0.4, held_back=0.0, **SILENT)
    w = windows_of(part, start, 0.4)
    q = start.vehicle.quadrotors
    steps = np.arange(w.count)
    every = squares(*w.commands, w.begin + steps * w.step, w.step, start.actuators.delay, q[0].lag_up, q[0].lag_down)
    cut = every[w.first[:, None] + np.arange(w.length)]
    data = {}
    for name, s in w.samples.items():
        data[name] = s.step[s.window == 0], s.values.reshape(len(w.first), -1, s.values.shape[1])
    starts = Predictor(w, unknowns_of(start.vehicle, start.actuators.delay), start).starts()
    nominal = [q[0].thrust_constant, q[1].thrust_constant, q[0].torque_per_thrust]
    priors = [0.3] * 3 + [UNLIKE] + [0.1] * 3 + [0.02] * 3 + [0.03] * 3
    plain = PlainVehicle(tl.Vehicle.from_settings(start.vehicle), w.step)
    logs, covariance = fitted(plain, cut, data, starts, np.array(nominal), ours.details["noise"], priors)
    off = np.sqrt(0.5)  # of the two torques from what they share
    every = {key.replace("*", str(i)): [i == 0, i == 1, 0, 0] for i in (0, 1) for key in keys[:1]}
    every |= {key.replace("*", str(i)): [0, 0, 1, (off, -off)[i]] for i in (0, 1) for key in keys[1:]}
    for key, along in every.items():
        row, way = ours[key], np.array([*along, *[0.0] * (len(logs) - 4)], float)
        sd = np.sqrt(way @ covariance @ way)
        assert np.log(row.value / row.start) == pytest.approx(way @ logs, abs=0.3 * sd), key
        assert row.half * np.sqrt(row.efficiency) == pytest.approx(1.96 * sd * row.value, rel=0.15), key


def test_a_calm_hover_excites_no_drag_and_says_so(log):
    calm = tl.identify(log.between(4.5, BEGIN), START, weighed=WEIGHED, window=0.4, **SILENT)
    drag = calm["vehicle.drag.force.z"]
    assert not drag.excited
    assert drag.low < drag.start < drag.high
    assert drag.key in next(text for text in calm.remarks if "did not excite" in text)


@pytest.mark.thorough
def test_in_moving_air_the_drag_area_of_the_payload_is_found():
    """A slow motion along x tells the area there, apart from a linear drag; nothing tells that along the beam."""
    air, slow = {"wind.model": "air"}, {"axis": "x", "frequency": 0.15, "amplitude": 0.5, "phase": 0.0}
    flown = {
        "mission.duration": 24.0,
        "excitation.duration": 15.0,
        "excitation.lines": [*FLOWN["excitation.lines"], slow],
        "pushes": [],
    }
    real = TRUTH | air | {"vehicle.payload.drag_area": [0.3, 0.01, 0.2]}
    log = blind(log_of(tl.fly(load_mission(START, real | FLOWN | flown), engine="mujoco")))
    keys = ["vehicle.payload.drag_area", "vehicle.drag.force"]
    found = tl.identify(log.between(BEGIN, 24.0), load_mission(START, TRUTH | air), parameters=keys, **SILENT)
    area = found["vehicle.payload.drag_area.x"]
    assert abs(area.value - 0.3) < 1.5 * area.half
    assert area.half < 0.03 < abs(area.value - area.start)
    assert found.mission.vehicle.payload.drag_area[0] == pytest.approx(area.value, rel=1e-6)
    assert not found["vehicle.payload.drag_area.y"].excited


def test_without_joints_and_scale_masses_and_thrust_constants_are_a_pair(log):
    part = Log({n: s for n, s in log.items() if "joint" not in n}, "part").between(BEGIN, PUSH - 3.0)
    alone = tl.identify(part, START, window=0.8, **SILENT)
    assert any("cannot be told apart" in text and "thrust constants" in text for text in alone.remarks)
    ratio = alone["mass"].value / alone["vehicle.quadrotors.0.thrust_constant"].value
    truth = reference_rows(load_mission(START, TRUTH))
    assert ratio == pytest.approx(truth["mass"] / truth["vehicle.quadrotors.0.thrust_constant"], rel=0.01)


@pytest.mark.thorough
def test_without_joints_and_scale_pushes_of_a_force_gauge_tell_masses_and_yaw_drag(flight):
    """A doublet along x and one that turns, flown by MuJoCo; the gauge logs force and moment."""
    ways = [([3.0, 0.0, 0.0], [0.0, 0.0, 0.0]), ([0.0, 0.0, 3.0], [0.0, 0.0, 0.0]), ([3.0, 0.0, 0.0], [0.0, 0.5, 0.0])]
    pushes = [
        {"force": [sign * f for f in force], "point": point, "time": BEGIN + 3.0 + 3.0 * (2 * i + k), "sigma": 0.4}
        for i, (force, point) in enumerate(ways)
        for k, sign in enumerate((1.0, -1.0))
    ]
    log = log_of(tl.fly(load_mission(START, TRUTH | FLOWN | {"pushes": pushes}), engine="mujoco"))
    log = Log({n: s for n, s in log.items() if "joint" not in n and n != "rotor_commands"}, "gauge")
    found, truth = tl.identify(log, START, held_back=0.0, **SILENT), reference_rows(load_mission(START, TRUTH))
    assert not any("cannot be told apart: only their ratios" in text for text in found.remarks)
    for key in ("mass", "inertia.z", "vehicle.quadrotors.0.thrust_constant", "vehicle.quadrotors.*.torque_per_thrust"):
        assert abs(found[key].value - truth[key]) < 1.5 * found[key].half, key
        assert found[key].half < 0.01 * truth[key], key


@pytest.mark.thorough
def test_bad_input_is_named(log):
    log = log.between(BEGIN, BEGIN + 9.5)
    without = Log({n: s for n, s in log.items() if n != "measured_rates"}, "half")
    for given, options, text in (
        (without, {}, "half: has no measured_rates"),
        (log.between(BEGIN, BEGIN + 2.0), {}, "windows"),
        (log, {"parameters": ["vehicle.payload.weight"]}, "vehicle.payload.weight"),
        (log, {"weighed": {"vehicle.payload.length": 2.0}}, "vehicle.payload.length"),
        (log, {"window": 0.01}, "window"),
        ([], {}, "logs"),
    ):
        with pytest.raises(InputError, match=text):
            tl.identify(given, START, **SILENT, **options)
    with pytest.raises(InputError, match="has 6 columns: must be 3 for each of the 4 quadrotors of mission four"):
        tl.identify(log, "four", **SILENT)
    commands = log["rotor_speed_commands"]
    swapped = Stream(commands.time, np.roll(commands.values, 4, axis=1))
    other_order = Log({**log, "rotor_speed_commands": swapped}, "blind")
    moments = "blind: stream measured_rates, rotor_speed_commands: the angular acceleration .*: scale .* y 0.0"
    with pytest.raises(InputError, match=f"{moments}.*No single change .*: .* no log of about such a vehicle"):
        tl.identify(log, "paper", **SILENT)  # whose rotors stand along and across the beam
    with pytest.raises(InputError, match=r"of quadrotors in the order 1, 0: \[rotor_speed_commands\] columns = "):
        tl.identify(other_order, START, **SILENT)
    dead = Log(
        {**log, "rotor_speed_commands": Stream(commands.time, commands.values * np.arange(8).clip(0, 1))}, "dead"
    )
    with pytest.raises(InputError, match="rotor_speed_commands: column 0 is constant"):
        tl.identify(dead, START, **SILENT)
    still = dict(log.items())
    still["measured_rates"] = Stream(log["measured_rates"].time, 0.0 * log["measured_rates"].values)
    with pytest.raises(InputError, match="measured_rates: column 0 is constant"):
        tl.identify(Log(still, "dead"), START, **SILENT)


@pytest.mark.thorough
@pytest.mark.parametrize(("said", "wider"), [(0.0, 0.0), (0.0004, 0.0004), (None, 0.001)])
def test_the_interval_of_a_delay_has_an_offset_of_stamps_that_nobody_knows(said, wider, log, found):
    """A log whose readings are stamped a step late: the data are those of a delay that is a step longer."""
    late = replace(log.aligned([n for n in log if n.startswith("measured_")], 0.001), stamp_offset=said)
    row = tl.identify(late, START, weighed=WEIGHED, **SILENT)["actuators.delay"]
    own = found["actuators.delay"]
    assert row.value - own.value == pytest.approx(0.001, abs=2e-5)
    assert row.half - own.half == pytest.approx(wider, abs=5e-6)
    assert (row.low < 0.012 < row.high) == (said is None)


def test_a_log_whose_stamps_nobody_vouched_for_says_so_and_a_wrong_offset_is_refused(log):
    unknown = replace(log, stamp_offset=None)
    (note,) = windows_of(unknown, load_mission(START)).notes
    assert "interval of the imu, 1 ms: the interval of actuators.delay has it in it" in note
    assert windows_of(log, load_mission(START)).notes == ()
    for wrong in (-0.001, 0.2, float("nan"), "0"):
        with pytest.raises(InputError, match=r"blind: stamp_offset = .*: must be a number from 0 to 0\.1 s"):
            replace(log, stamp_offset=wrong)
