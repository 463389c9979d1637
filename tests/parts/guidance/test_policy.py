"""The policy: its network against NumPy, what no weights can break, its flights, and bad input."""

import math

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.errors import InputError
from tandemlift.core.low_pass import LowPassState
from tandemlift.core.vector import Vec3, dot
from tandemlift.parts.guidance.admittance import AdmittanceTable
from tandemlift.parts.guidance.policy import (
    FORCE,
    INPUTS,
    LEAST_FORCE,
    OUTPUTS,
    RATE,
    SPEED,
    PolicyTable,
    policy_damping,
    start_policy,
)

DAMPING = np.array([1.6, 1.3, 2.0])  # N s/m
UNITS = 3
LED = {  # through the first bend of a corridor, without sensors
    "sensors.model": "none",
    "pilot.state": "truth",
    "pilot.push": "truth",
    "contact.model": "none",
    "person.start_time": 3.0,
    "mission.duration": 10.0,
    "mission.step": 0.002,
    "mission.log_interval": 0.002,
    "compliance.policy.model": "network",
}


def random_weights(rng, size=1.0, units=UNITS):
    return rng.normal(0.0, size, units * (INPUTS + 1 + OUTPUTS) + OUTPUTS).tolist()


def policy_of(weights, factor=4.0):
    admittance = AdmittanceTable(mass=1.0, damping=DAMPING.tolist(), threshold=0.0)
    return start_policy(PolicyTable(model="network", weights=weights, factor=factor), admittance)


def samples(rng, count=200):
    """Pushes with their rates, and velocities."""
    for size in rng.choice([0.0, 0.05, 1.0, 5.0], count):
        push = LowPassState(Vec3(*rng.normal(0.0, size, 3)), Vec3(*rng.normal(0.0, 5.0, 3)))
        yield push, Vec3(*rng.normal(0.0, 0.7, 3))


def by_numpy(weights, x, units=UNITS, factor=4.0):
    """The factors along and across for inputs x (n, 6)."""
    cut = units * (INPUTS + 1)
    hidden, outputs = np.reshape(weights[:cut], (units, -1)), np.reshape(weights[cut:], (OUTPUTS, -1))
    h = np.tanh(x @ hidden[:, :-1].T + hidden[:, -1])
    return factor ** np.tanh(h @ outputs[:, :-1].T + outputs[:, -1])


def inputs_by_numpy(F, R, v):
    """The inputs of the network (n, 6) of pushes [N], their rates [N/s] and velocities [m/s] (n, 2)."""
    size = np.linalg.norm(F, axis=1)
    e = F / (size + LEAST_FORCE)[:, None]
    across = np.column_stack([-e[:, 1], e[:, 0]])
    return np.column_stack(
        [
            size / FORCE,
            np.sum(e * R, axis=1) / RATE,
            np.abs(np.sum(across * R, axis=1)) / RATE,
            np.sum(e * v, axis=1) / SPEED,
            np.abs(np.sum(across * v, axis=1)) / SPEED,
            np.linalg.norm(v, axis=1) / SPEED,
        ]
    )


def test_factors_and_force_are_those_of_matrices():
    """The force is C v − D v with D = c₂ C + (c₁ − c₂) √C e eᵀ √C in the plane."""
    rng = np.random.default_rng(1)
    weights = random_weights(rng)
    policy = policy_of(weights)
    for push, v in samples(rng):
        F, R, flat_v = (np.array(a)[None, :2] for a in (*push, v))
        ((along, across),) = by_numpy(weights, inputs_by_numpy(F, R, flat_v))
        eased, channels = policy_damping(policy, push, v, 1.0)
        assert channels == pytest.approx((along, across), rel=1e-10)
        e, root = F[0] / (np.linalg.norm(F) + LEAST_FORCE), np.sqrt(DAMPING[:2])
        D = across * np.diag(DAMPING[:2]) + (along - across) * np.outer(root * e, root * e)
        assert eased == pytest.approx([*((np.diag(DAMPING[:2]) - D) @ flat_v[0]), 0.0], abs=1e-10)


@pytest.mark.parametrize("size", [1.0, 30.0])
def test_the_admittance_is_passive_whatever_the_weights_are(size):
    """All damping takes power out of any motion in the plane, at least C v² over the factor, at most times it."""
    rng = np.random.default_rng(2)
    for _ in range(20):
        policy = policy_of(random_weights(rng, size))
        for push, v in samples(rng, 30):
            v = Vec3(v.x, v.y, 0.0)
            own = dot(Vec3(*DAMPING) * v, v)
            eased, _ = policy_damping(policy, push, v, 1.0)
            assert own / 4.0 * (1.0 - 1e-9) <= own - dot(eased, v) <= own * 4.0 * (1.0 + 1e-9)


def test_while_pushes_are_not_followed_the_damping_is_the_missions():
    rng = np.random.default_rng(4)
    policy = policy_of(random_weights(rng))
    for push, v in samples(rng, 20):
        eased, channels = policy_damping(policy, push, v, 0.0)
        assert channels == (1.0, 1.0)
        assert eased == (0.0, 0.0, 0.0)


def test_a_network_makes_no_force_where_there_is_no_damping_to_multiply():
    mission = tl.load_mission("iris", {"compliance.policy.model": "network", "admittance.damping": 0.0})
    policy = start_policy(mission.compliance.policy, mission.admittance)
    for push, v in samples(np.random.default_rng(8), 20):
        assert policy_damping(policy, push, v, 1.0)[0] == (0.0, 0.0, 0.0)


@pytest.mark.thorough
def test_weights_of_zero_are_the_admittance_to_the_bit():
    with_policy = tl.fly(tl.load_mission("zigzag", {**LED, "compliance.policy.weights": PolicyTable.zeros(2)}))
    without = tl.fly(tl.load_mission("zigzag", {**LED, "compliance.policy.model": "none"}))
    assert (with_policy["damping_factor_along"] == 1.0).all()
    assert "damping_factor_along" not in without
    for channel in ("position", "admittance_velocity", "push_force"):
        assert (with_policy[channel] == without[channel]).all()


@pytest.mark.thorough
def test_the_factors_of_a_flight_are_those_of_its_push_and_motion():
    """By NumPy, from other channels; the push's rate, which no channel has, gets no weight."""
    rng = np.random.default_rng(5)
    weights = np.array(random_weights(rng))
    weights[: UNITS * (INPUTS + 1)].reshape(UNITS, -1)[:, 1:3] = 0.0
    flight = tl.fly(tl.load_mission("zigzag", {**LED, "compliance.policy.weights": weights.tolist()}))
    led = np.flatnonzero(flight["phase"] == 2.0)[1:]
    F, v = flight["admittance_force"][led - 1, :2], flight["admittance_velocity"][led, :2]
    found = np.column_stack([flight["damping_factor_along"][led], flight["damping_factor_across"][led]])
    assert np.ptp(found, axis=0).min() > 0.1
    assert np.linalg.norm(F, axis=1).max() > 0.5
    np.testing.assert_allclose(found, by_numpy(weights, inputs_by_numpy(F, np.zeros_like(F), v)), rtol=1e-4)


@pytest.mark.thorough
def test_flights_with_other_weights_fly_together_as_alone():
    rng = np.random.default_rng(6)
    changes = [{**LED, "compliance.policy.weights": random_weights(rng)} for _ in range(2)]
    missions = [tl.load_mission("zigzag", change) for change in changes]
    together = tl.fly_many(missions)
    for flight, mission in zip(together, missions, strict=True):
        alone = tl.fly(mission)
        for channel in ("position", "damping_factor_along", "damping_factor_across"):
            assert (flight[channel] == alone[channel]).all()
    assert not np.array_equal(together[0]["position"], together[1]["position"])


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"compliance.policy.weights": [0.0] * 12}, "weights has 12 numbers: must be 9 H + 2"),
        ({"compliance.policy.weights": []}, "weights has 0 numbers: must be 9 H + 2"),
        ({"compliance.policy.weights": [101.0] * 11}, "weights has 101: each must be from -100 to 100"),
        ({"compliance.policy.weights": [math.nan] * 11}, "compliance.policy.weights"),
        ({"compliance.policy.weights": "mine.toml"}, "compliance.policy.weights"),
        ({"compliance.policy.factor": 0.5}, "compliance.policy.factor = 0.5"),
        ({"compliance.policy.factor": 2000.0}, "compliance.policy.factor = 2000: must be at most 1250"),
        ({"pilot.guidance": "scheduled"}, 'compliance.policy.model = "network": must be "none" where'),
    ],
    ids=str,
)
def test_bad_input_is_refused(changes, said):
    name = "one-push" if "pilot.guidance" in changes else "iris"
    with pytest.raises(InputError) as refused:
        tl.load_mission(name, {"compliance.policy.model": "network", **changes})
    assert said in str(refused.value)
