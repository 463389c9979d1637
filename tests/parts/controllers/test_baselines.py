"""The baseline controllers: what all of them share, LQR against SciPy, and flights against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from law_values import array, paper_vehicle, seeds
from scipy.linalg import solve_continuous_are
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.core.trajectories import Trajectory
from tandemlift.core.types import GRAVITY
from tandemlift.core.vector import ZERO, Quat, Vec3, vec3
from tandemlift.parts.controllers import CONTROLLERS, Disturbance, Measured, Reference, control, controller
from tandemlift.parts.controllers.lqr import LQRSettings, integrator_chain, regulator
from tandemlift.parts.mechanics.rigid_body import State
from tandemlift.parts.mechanics.rotation import quaternion_from_euler, rotation_from_quaternion

VEHICLE, STEP = paper_vehicle(), 0.001
MASS, J = VEHICLE.mass, np.diag(VEHICLE.inertia)
BASELINES = sorted(CONTROLLERS.keys() - {"nftsmc"})
EACH = pytest.mark.parametrize("name", BASELINES)
STILL = Trajectory(ZERO, ZERO, ZERO)
LEVEL = Quat(1.0, 0.0, 0.0, 0.0)


def started(name, **settings):
    """Gains and first memory of a controller on the paper's vehicle."""
    chosen = controller(name)
    return chosen.start(chosen.settings.model_validate({"name": name, **settings}), VEHICLE, STEP)


def command(name, state=None, push=ZERO, disturbance=None, reference=None, **settings):
    """The first command of a controller at rest at its reference, but for what is given."""
    gains, memory = started(name, **settings)
    measured = Measured(state or State(ZERO, ZERO, LEVEL, ZERO), push, disturbance or Disturbance(ZERO, ZERO))
    return control(gains, memory, measured, reference or Reference(STILL, 0.0))[0]


# What all share


FORCE, MOMENT, LEAD = Vec3(0.0, 0.0, 1.5), Vec3(0.3, -0.2, 0.1), Vec3(0.5, -0.4, 0.3)
COMMANDS = {  # what differs from rest at the reference: the thrust beside the weight [N], the moment [N m]
    "nothing": ({}, 0.0, ZERO),
    "a vertical disturbance": ({"disturbance": Disturbance(FORCE, ZERO)}, -1.5, ZERO),
    "a push": ({"push": FORCE}, -1.5, ZERO),
    "a push that is not fed forward": ({"push": FORCE, "human_force_feedforward": False}, 0.0, ZERO),
    "a disturbing moment": ({"disturbance": Disturbance(ZERO, MOMENT)}, 0.0, -MOMENT),
    "a yaw acceleration": ({"reference": Reference(STILL, 0.0, 0.0, 0.7)}, 0.0, Vec3(0.0, 0.0, 0.7 * J[2])),
    "a turn at the rate of the reference": (
        {"state": State(ZERO, ZERO, LEVEL, Vec3(0.0, 0.0, 0.4)), "reference": Reference(STILL, 0.0, 0.4)}, 0.0, ZERO
    ),
}  # fmt: skip


@EACH
def test_what_is_known_is_fed_forward_whole_and_nothing_else(name):
    for case, (changes, force, moment) in COMMANDS.items():
        wrench = command(name, **changes).wrench
        assert wrench.thrust == pytest.approx(MASS * GRAVITY + force, rel=1e-12), case
        assert array(wrench.moment) == pytest.approx(array(moment), abs=1e-12), case


@EACH
def test_the_lead_acts_as_acceleration_of_the_reference_does(name):
    led = command(name, reference=Reference(STILL, 0.0, 0.0, 0.0, LEAD)).wrench
    told = command(name, reference=Reference(STILL._replace(acceleration=LEAD), 0.0)).wrench
    assert array(led.moment) == pytest.approx(array(told.moment), abs=1e-12)
    assert led.thrust == pytest.approx(MASS * (GRAVITY + 0.3), rel=1e-12) == told.thrust


@EACH
@pytest.mark.parametrize("yaw", [0.0, -2.5])
def test_an_error_tilts_the_vehicle_towards_the_reference_whatever_its_yaw(name, yaw):
    """The tilt tracked in the end turns the thrust towards the reference: its horizontal part points there."""
    gains, memory = started(name)
    state = State(ZERO, ZERO, quaternion_from_euler(Vec3(0.0, 0.0, yaw)), ZERO)
    there = Trajectory(Vec3(0.02, 0.05, 0.0), ZERO, ZERO)
    for _ in range(1500):
        found, memory = control(gains, memory, Measured(state, ZERO), Reference(there, yaw))
    roll, pitch, _ = found.euler
    up = array(rotation_from_quaternion(quaternion_from_euler(Vec3(roll, pitch, yaw)))) @ [0.0, 0.0, 1.0]
    assert up[:2] @ [0.02, 0.05] > 0.0
    for axis, way in enumerate((up[0], up[1])):
        assert way * (0.02, 0.05)[axis] > 0.0


@EACH
def test_the_drag_at_the_present_velocity_is_added_to_the_thrust(name):
    """At the wanted velocity: m g + D_z v_z, level."""
    gains, memory = started(name)
    drag = gains.vehicle._replace(drag_force=Vec3(0.3, 0.4, 0.5))
    climbing = Vec3(0.0, 0.0, 1.2)
    state = State(ZERO, climbing, LEVEL, ZERO)
    reference = Reference(STILL._replace(velocity=climbing), 0.0)
    found, _ = control(gains._replace(vehicle=drag), memory, Measured(state, ZERO), reference)
    assert found.wrench.thrust == pytest.approx(MASS * GRAVITY + 0.5 * 1.2, rel=1e-9)


def test_the_thrust_of_the_geometric_controller_is_the_wanted_force_along_the_body_s_own_axis():
    """f = (m g e_z − D) · R e_z, at rest at the reference, with R from SciPy."""
    turned, wind = Rotation.from_euler("zxy", [0.8, 0.3, -0.2]), np.array([1.0, -2.0, 0.5])
    state = State(ZERO, ZERO, Quat(*turned.as_quat(scalar_first=True).tolist()), ZERO)
    found = command("geometric", state, disturbance=Disturbance(vec3(wind), ZERO)).wrench.thrust
    assert found == pytest.approx(turned.apply([0.0, 0.0, 1.0]) @ ([0.0, 0.0, MASS * GRAVITY] - wind), rel=1e-12)


# LQR


def riccati_gain(A, B, Q, R):
    """K by SciPy's solver, which uses ordered generalised Schur vectors."""
    X = solve_continuous_are(A, B, Q, np.array([[R]]))
    return (B.T @ X / R)[0]


@given(seeds)
def test_the_gain_is_that_of_scipy_s_riccati_equation(seed):
    rng = np.random.default_rng(seed)
    length, lag = int(rng.integers(2, 5)), float(rng.uniform(0.01, 0.2))
    A, B = integrator_chain(length, lag, gravity=length == 4)
    Q = np.diag([*rng.uniform(0.1, 30.0, length), 0.0])
    R = float(10.0 ** rng.uniform(-3.0, 1.0))
    wanted = riccati_gain(A, B, Q, R)
    assert regulator(A, B, Q, R) == pytest.approx(wanted, rel=1e-6, abs=1e-7 * np.abs(wanted).max())


def weights(s: LQRSettings, place: int, turned: int):
    return np.diag(
        [s.position_weight[place], s.velocity_weight[place], s.attitude_weight[turned], s.rates_weight[turned], 0.0]
    )


@pytest.mark.parametrize(("place", "turned", "sign"), [(0, 1, 1.0), (1, 0, -1.0)], ids=["x, pitch", "y, roll"])
def test_about_hover_the_moment_is_the_feedback_of_the_linear_chain(place, turned, sign):
    """U = −J K x, with x = (position, velocity, tilt, rate) off hover; roll tilts towards −y."""
    s = LQRSettings(name="lqr")
    A, B = integrator_chain(4, s.lag, gravity=True)
    K = riccati_gain(A, B, weights(s, place, turned), s.moment_weight[turned])
    size = 1e-6
    for part in range(4):
        x = [np.zeros(3) for _ in range(4)]
        x[part][place if part < 2 else turned] = size * (sign if part >= 2 else 1.0)
        position, velocity, tilt, rates = map(vec3, x)
        state = State(position, velocity, quaternion_from_euler(tilt), rates)
        moment = array(command("lqr", state).wrench.moment)
        assert sign * moment[turned] == pytest.approx(-J[turned] * K[part] * size, rel=1e-4)
    assert started("lqr")[0].accelerations[turned] == pytest.approx(K[4], rel=1e-6)


# In flight, without an observer: what a constant force of 1 N leaves is known in closed form


def offset_of(name, settings):
    """The steady offset [m] along x against 1 N, per controller."""
    a = 1.0 / MASS
    if name in ("pid", "super-twisting"):
        return 0.0
    if name == "geometric":
        return a / settings.position_stiffness[0]
    if name == "smc":
        return a * settings.boundary_layer[0] / (settings.gain[0] * settings.slope[0])
    A, B = integrator_chain(4, settings.lag, gravity=True)
    K = riccati_gain(A, B, weights(settings, 0, 1), settings.moment_weight[1])
    return np.arctan(a / GRAVITY) * K[2] / K[0]


@EACH
def test_it_holds_its_place_against_1_n_but_for_the_offset_of_the_closed_form(name):
    changes = {"mission.duration": 60.0, "disturbance.force": [1.0, 0.0, 0.0]}
    mission = tl.load_mission("hover", changes, controller=name)
    flight = tl.fly(mission)
    assert flight.ending is None
    found = flight["position_error"][-1]
    assert found[0] == pytest.approx(-offset_of(name, mission.controller), rel=0.02, abs=1e-4)
    assert found[1:] == pytest.approx(np.zeros(2), abs=1e-3)
