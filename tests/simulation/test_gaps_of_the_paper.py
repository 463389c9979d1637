"""What the paper assumes or leaves out, by the numbers that its errata name."""

from __future__ import annotations

import numpy as np
import pytest
from newton_euler import Given, paper_parts, solved
from scipy.integrate import tplquad
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.core.trajectories import Trajectory
from tandemlift.core.vector import ZERO, Quat, Vec3
from tandemlift.parts.controllers.nftsmc import position_law
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.simulation.preparation.assemble import assemble

MASS, LENGTH, RADIUS = 0.5, 2.0, 0.05  # of the payload; Table II
EVERY_STEP = {"mission.log_interval": 0.001}


def test_the_papers_payload_is_a_thin_rod_about_x_and_a_solid_cylinder_about_y():
    """By integrals over the solid cylinder along y: those of Table II mix two bodies."""
    density = MASS / (np.pi * RADIUS**2 * LENGTH)

    def moment(square) -> float:
        return tplquad(lambda y, a, r: density * r * square(r * np.cos(a), y, r * np.sin(a)), 0.0, RADIUS, 0.0,
                       2.0 * np.pi, -LENGTH / 2.0, LENGTH / 2.0)[0]  # fmt: skip

    about_x, about_y = moment(lambda x, y, z: y * y + z * z), moment(lambda x, y, z: x * x + z * z)
    payload = tl.load_mission("paper").hover.vehicle.payload
    assert payload.moments[0] == pytest.approx(MASS * LENGTH**2 / 12.0, rel=1e-12)
    assert payload.moments[1] == pytest.approx(about_y, rel=1e-9)
    assert about_x - payload.moments[0] == pytest.approx(3.125e-4, rel=1e-6)


def test_the_papers_beam_is_a_fifth_as_dense_as_balsa_wood():
    assert MASS / (np.pi * RADIUS**2 * LENGTH) == pytest.approx(31.83, abs=0.01)


def test_a_hard_gate_makes_the_desired_pitch_jump_by_the_threshold_over_the_weight_of_the_virtual_mass():
    """At rest θ_d = atan(ẍ_r/g), and ẍ_r jumps by threshold/M; a soft gate lets it begin at 0."""
    changes = {**EVERY_STEP, "mission.duration": 24.0}
    gates = {gate: tl.fly(tl.load_mission("paper", {**changes, "admittance.gate": gate})) for gate in ("hard", "soft")}
    jumps = {}
    for gate, flight in gates.items():
        late = (flight.time > 15.0) & (flight.time < 22.0)  # until the first push along x is at its peak
        jumps[gate] = np.degrees(np.abs(np.diff(flight["reference_euler"][late, 1])).max())
    assert jumps["hard"] == pytest.approx(np.degrees(np.arctan(0.3 / 1.0 / 9.81)), abs=0.01)  # 1.75°
    assert jumps["soft"] < 0.02


def test_without_a_spring_pushes_take_the_reference_as_far_as_they_like():
    pushes = [{"force": [3.0, 0.0, 0.0], "time": 12.0 + 6.0 * i, "sigma": 0.6} for i in range(8)]
    ends = []
    for count in (4, 8):
        flight = tl.fly(tl.load_mission("paper", {"pushes": pushes[:count], "phases.land_start": 70.0}))
        ends.append(flight["admittance_position"][-1, 0])
    assert ends[1] == pytest.approx(2.0 * ends[0], rel=1e-6)


def test_a_sensor_within_the_beam_reads_half_of_a_push_with_the_sign_of_its_side():
    """Two equal halves, a push along the beam through the centre of mass: each half takes half of the acceleration."""
    p, push = paper_parts(), np.array([0.0, 3.0, 0.0])
    centre = np.array([0.0, 0.0, p.centre[2]])
    thrusts = np.full(2, 3.5 * 9.81 / 2.0)
    answer = solved(
        p, Rotation.identity(), np.zeros(3), Given(thrusts, np.zeros((2, 3)), push, centre, np.zeros((2, 3)))
    )
    assert np.abs(answer.angular).max() < 1e-9  # no rotation: both halves move alike
    half = 3.5 / 2.0 * answer.linear  # rate of momentum of a half, whose thrust carries its weight
    readings = [half - push, half]  # force of the other half on this one: pushed here, pushed there
    assert readings[0] == pytest.approx([0.0, -1.5, 0.0], abs=1e-9)
    assert readings[1] == pytest.approx([0.0, 1.5, 0.0], abs=1e-9)


def test_the_push_follows_from_the_joints_only_with_weight_inertia_and_frames():
    """`F_ext = R(m_L a − F₁ − F₂)`, and the errors of what leaves one of them out, in the flight of `flight-ready`."""
    flight = tl.fly(tl.load_mission("flight-ready", EVERY_STEP))
    late = (flight.time > 15.0) & (flight.time < 69.0)
    R = Rotation.from_quat(flight["attitude"], scalar_first=True)
    joints = flight["joint_force"].reshape(-1, 2, 3).sum(axis=1)
    centre = flight["position"] + R.apply(flight.vehicle.payload_center)
    acceleration = np.gradient(np.gradient(centre, 0.001, axis=0), 0.001, axis=0)
    weight = np.array([0.0, 0.0, MASS * 9.81])
    ways = {
        "whole": MASS * acceleration + weight - R.apply(joints),
        "no weight": MASS * acceleration - R.apply(joints),
        "no inertia": weight - R.apply(joints),
        "no frames": MASS * acceleration + weight - joints,
    }
    errors = {name: np.linalg.norm(force - flight["push_force"], axis=1)[late].max() for name, force in ways.items()}
    assert errors["whole"] < 0.02  # the difference quotients' own
    assert errors["no weight"] == pytest.approx(4.91, abs=0.01)
    assert errors["no inertia"] == pytest.approx(0.83, abs=0.01)
    assert errors["no frames"] == pytest.approx(0.95, abs=0.01)


@pytest.mark.parametrize(
    ("mission", "system", "payload"), [("paper", 2.517, 2.513), ("flight-ready", 79.26, 49.20), ("iris", 1.64, 1.49)]
)
def test_a_push_at_the_payloads_centre_moves_the_vehicle_with_less_error_than_at_the_systems(mission, system, payload):
    """It is 64 mm lower: its moment tilts the vehicle the way that it is pushed. RMSE along x after 10 s [mm]."""
    given = tl.load_mission(mission)
    x, y, z = given.hover.vehicle.payload_center.tolist()
    assert (x, y) == (0.0, 0.0)
    assert z == pytest.approx(-0.0642857, abs=1e-7)
    below = {f"pushes.{i}.point": [0.0, 0.0, z] for i in range(len(given.pushes))}
    for changes, expected in (({}, system), (below, payload)):
        error = tl.fly(tl.load_mission(mission, changes)).metrics()["position_rmse_after_10s_m"][0]
        assert 1e3 * error == pytest.approx(expected, rel=4e-3)


def test_less_than_a_millimetre_above_its_reference_the_printed_gains_ask_for_thrust_downwards():
    k = assemble(tl.load_mission("paper")).model.pilot.controller
    rest = Trajectory(ZERO, ZERO, ZERO)

    def u_z(height: float) -> float:
        state = State(Vec3(0.0, 0.0, height), ZERO, Quat(1.0, 0.0, 0.0, 0.0), ZERO)
        return position_law(k, state, rest, ZERO).z

    assert brentq(u_z, 0.0, 0.1) == pytest.approx(0.74e-3, abs=0.01e-3)
    assert u_z(0.1) == pytest.approx(3.5 * (9.81 - 200.0 * 1.1002 - 100.0), rel=1e-6)  # S = 11 e + 0.2 e³
