"""Linear models as users meet them: names, units, points, kinks, files, python-control, errors."""

from __future__ import annotations

import json
import re
import subprocess
from importlib.resources import files

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.linearization.frequency_response import frequency_response
from tandemlift.analysis.linearization.linear_model import modes_of
from tandemlift.analysis.linearization.step_graph import CONSTANT, DISCRETE, UNSEEN
from tandemlift.parts.controllers import control
from tandemlift.simulation.plan import FlightPlan
from tools import need


@pytest.fixture(scope="module")
def paper():
    return tl.linearize(tl.load_mission("paper"))


@pytest.fixture(scope="module")
def iris():
    return tl.linearize(tl.load_mission("iris"))


@pytest.mark.thorough
def test_the_inputs_at_the_point_have_the_mean_wind():
    changes = [{"time": 2.0, "key": "wind.velocity", "value": [2.0, 1.0, 0.0]}]
    wind = {"wind.velocity": [3.0, 0.0, 0.0], "wind.turbulence": 0.0, "changes": changes}
    mission = tl.load_mission("gusts", {**wind, "mission.duration": 4.0})
    for at, velocity in ((1.0, [3.0, 0.0, 0.0]), (3.0, [2.0, 1.0, 0.0])):
        model = tl.linearize(mission, at=at, inputs=["wind_velocity"], outputs=["wind_velocity"])
        assert model.point.u0.tolist() == model.point.y0.tolist() == velocity


@pytest.mark.thorough
def test_states_have_units(paper, iris):
    short = [tl.load_mission(name, {"mission.duration": 0.4}) for name in ("rotor-loss", "doorway")]
    for model in (paper, iris, *(tl.linearize(mission, 0.3, steps=1) for mission in short)):
        named = [v for v in model.states if not v.name.startswith(("estimator.push.sums", "detection"))]
        assert [v.name for v in named if not v.unit] == []
        assert {v.unit for v in model.outputs} <= {"m", "m/s", "rad", "rad/s", "N", "N m"}


def test_an_output_is_the_first_sample_of_the_flight(paper):
    flight = tl.fly(tl.load_mission("paper", {"mission.duration": 9.5}))
    names = [v.name for v in paper.outputs]
    thrusts = [paper.point.y0[names.index(f"rotor_thrusts_rotor_{i}")] for i in range(1, 9)]
    assert thrusts == pytest.approx(flight["rotor_thrusts"][-1], rel=1e-12)


def test_a_simulation_is_linearized_as_it_stands(paper):
    simulation = tl.Simulation(tl.load_mission("paper"))
    while simulation.time < 9.5 - 1e-9:
        simulation.step()
    before = simulation.state
    model = tl.linearize(simulation)
    assert pytest.approx(paper.A, rel=1e-12, abs=1e-15) == model.A
    assert (simulation.state == before).all()
    simulation.step()
    assert simulation.k == 9501


def test_what_is_no_state_is_listed_with_the_reason(iris):
    left = iris.left_out
    assert left["sensing.imu.reading.fresh"] == left["guidance.phase.phase"] == DISCRETE
    assert left["guidance.phase.hover_time"] == left["sensing.imu.wait"] == UNSEEN
    assert CONSTANT not in left.values()
    assert not {v.name for v in iris.states} & set(left)


def test_delayed_commands_are_states(iris):
    names = [v.name for v in iris.states]
    assert [f"rotors.arriving.r0[-{n}]" in names for n in (1, 9, 10)] == [True, True, False]
    assert iris.step == pytest.approx(0.005)


def test_a_gate_on_its_edge_is_reported_with_its_law():
    mission = tl.load_mission("paper", {"pushes": [], "admittance.threshold": 0.0, "admittance.gate": "hard"})
    (kink,) = tl.linearize(mission, 9.5).kinks
    assert (kink.law, kink.distance) == ("hard_threshold", 0.0)
    assert kink.file.startswith("parts/guidance/admittance.py, line ")
    assert tl.linearize(tl.load_mission("paper", {"pushes": []}), 9.5).kinks == ()


def test_a_sign_at_zero_is_reported_and_a_tanh_is_not():
    at_rest = {"initial.euler": 0.0, "initial.position": 0.0, "pushes": [], "phases.lift_start": 2.0}
    found = {}
    for switching in ("sign", "tanh"):
        mission = tl.load_mission("paper", at_rest | {"controller.switching": switching})
        found[switching] = [kink.file for kink in tl.linearize(mission, 0.0).kinks]
    assert [file.partition(",")[0] for file in found["sign"]] == ["parts/controllers/sliding_surface.py"]
    assert found["tanh"] == []


def test_connected_states_answer_as_all_states_do(iris):
    few = iris.connected()
    assert len(few.states) < len(iris.states)
    frequencies = np.array([0.1, 1.0, 10.0])
    all_of_them = frequency_response(iris, frequencies)
    assert frequency_response(few, frequencies) == pytest.approx(all_of_them, rel=1e-6, abs=1e-9)


def test_every_mode_of_hover_decays():
    modes = modes_of(tl.linearize(tl.load_mission("hover")).connected())
    assert modes.modes
    assert all(mode.s.real < 0.0 for mode in modes.modes)
    assert modes.deadbeat == 1  # the length of the quaternion


@pytest.mark.parametrize("ending", ["npz", "json"])
def test_a_saved_model_holds_all_of_it(paper, ending, tmp_path):
    path = tmp_path / f"model.{ending}"
    paper.save(path)
    found = json.loads(path.read_text("utf-8")) if ending == "json" else dict(np.load(path))
    assert np.array_equal(np.array(found["A"]), paper.A)
    assert [list(row) for row in found["states"]] == [list(v) for v in paper.states]
    about = found if ending == "json" else json.loads(str(found["about"]))
    assert (about["mission"], about["assumptions"]) == ("paper", list(paper.assumptions))


def test_a_file_of_matlab_holds_all_of_it_beside_a_script_that_names_it(paper, tmp_path):
    scipy_io = pytest.importorskip("scipy.io")
    paper.save(tmp_path / "my-model.mat")
    found = scipy_io.loadmat(tmp_path / "my-model.mat")
    for name in ("A", "B", "C", "D"):
        assert np.array_equal(found[name], getattr(paper, name))
    assert found["step"].item() == paper.step
    assert [[cell.item() for cell in row] for row in found["inputs"]] == [list(v) for v in paper.inputs]
    assert json.loads(found["about"].item())["mission"] == "paper"
    script = (tmp_path / "my_model_plots.m").read_text("utf-8")
    assert '"my-model.mat"' in script
    assert "@" not in script


def test_python_control_gets_the_model_with_its_names(paper):
    pytest.importorskip("control")
    few = paper.connected()
    system = few.to_control()
    assert (system.A == few.A).all()
    assert (system.D == few.D).all()
    assert (system.state_labels, system.dt) == ([v.name for v in few.states], 0.001)
    ours = frequency_response(few, np.array([0.5]))[0]
    assert system(np.exp(2j * np.pi * 0.5 * system.dt)) == pytest.approx(ours, rel=1e-7, abs=1e-9)


def test_without_python_control_its_command_is_named(paper, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "control", None)
    with pytest.raises(tl.InputError, match=r"pip install 'tandemlift\[control\]'"):
        paper.to_control()


@pytest.mark.parametrize(
    ("arguments", "pieces"),
    [
        ({"at": 91.0}, ["at = 91", "mission.duration = 90 s"]),
        ({"at": -1.0}, ["at = -1"]),
        ({"of": "pilot"}, ["'pilot'", "loop, body"]),
        ({"inputs": ["push_forc"]}, ["'push_forc'", "Did you mean 'push_force'?"]),
        ({"inputs": ["wind_velocity"]}, ["no wind", 'wind.model = "air"']),
        ({"inputs": ["rotor_thrusts"]}, ["input of the loop"]),
        ({"outputs": ["positon"]}, ["'positon'", "Did you mean 'position'?"]),
        ({"outputs": ["reference_position"], "of": "body"}, ["output of the body"]),
        ({"steps": 0}, ["steps = 0"]),
    ],
)
def test_a_bad_argument_is_refused(arguments, pieces):
    with pytest.raises(tl.InputError) as refused:
        tl.linearize(tl.load_mission("paper"), **arguments)
    assert all(piece in str(refused.value) for piece in pieces), str(refused.value)


def test_a_controller_in_plain_python_is_refused_by_its_name(monkeypatch):
    mission = tl.load_mission("paper")
    gains = type(FlightPlan(mission).model.pilot.controller)
    monkeypatch.setattr(control, "interpreted", {gains})
    with pytest.raises(tl.InputError, match="'nftsmc' is plain Python, which has no derivative"):
        tl.linearize(mission)


def test_a_lost_flight_and_a_simulation_that_is_over_are_refused():
    lost = tl.load_mission("paper", {"controller.gains.xi": 2000.0})
    with pytest.raises(tl.InputError, match="diverges at"):
        tl.linearize(lost, 60.0)
    simulation = tl.Simulation(tl.load_mission("paper", {"mission.duration": 0.01}))
    with pytest.raises(tl.InputError, match="at its own time"):
        tl.linearize(simulation, 0.005)
    for _ in range(10):
        simulation.step()
    with pytest.raises(tl.InputError, match="is over"):
        tl.linearize(simulation)


@pytest.mark.targets
@pytest.mark.filterwarnings("ignore:stability_margins")  # it says how it computes
def test_octave_runs_the_script_and_finds_the_margins_of_python_control(tmp_path):
    need("octave-cli", "gnuplot")
    control, scipy_io = pytest.importorskip("control"), pytest.importorskip("scipy.io")
    step = 0.01
    loop = control.c2d(control.tf([40.0], [1.0, 9.0, 18.0, 0.0]), step)  # a loop with an integrator and two lags
    cut = control.ss(1.0 / (1.0 + loop))
    names = {"inputs": [["thrust_offsets.0", "N"]], "outputs": [["rotor_thrusts.0", "N"]]}
    matrices = {name: np.atleast_2d(getattr(cut, name)) for name in "ABCD"}
    texts = {kind: np.array(rows, dtype=object) for kind, rows in names.items()}
    scipy_io.savemat(tmp_path / "cut.mat", {**matrices, "step": step, **texts})
    script = (files("tandemlift") / "data" / "linear_model.m").read_text("utf-8")
    (tmp_path / "cut_plots.m").write_text(script.replace("@FILE@", "cut.mat").replace("@NAME@", "cut_plots"))
    words = "graphics_toolkit('gnuplot'); set(0, 'defaultfigurevisible', 'off'); cut_plots"
    command = ["octave-cli", "--no-init-file", "--eval", words]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found = re.findall(r"gain margin (\S+) dB, phase margin (\S+) deg at (\S+) rad/s", done.stdout)
    gain, phase, _, crossover = control.margin(loop)
    assert np.array(found, dtype=float) == pytest.approx(
        np.array([[20.0 * np.log10(gain), phase, crossover]]), abs=0.06
    )
