"""Random vehicles, faults and pushes: no NaN leaves the loop, and a flight that fails says what broke, and when."""

import numpy as np
import pytest

import tandemlift as tl


def anything(seed):
    """Random numbers in the mission whose rotor fails; no type changes, so one compiled loop serves all."""
    chance = np.random.default_rng(seed)
    fault = {
        "quadrotor": int(chance.integers(1, 3)),
        "rotor": int(chance.integers(1, 5)),
        "time": float(chance.uniform(2.0, 8.0)),
        "efficiency": float(chance.choice([0.0, 0.3, 0.8])),
        "known_after": float(chance.uniform(0.0, 0.5)),
    }
    return {
        "mission.duration": 10.0,
        "mission.seed": seed,
        "plant.mass_scale": float(chance.uniform(0.8, 1.2)),
        "plant.inertia_scale": chance.uniform(0.7, 1.4, 3).tolist(),
        "vehicle.payload.mass": float(chance.uniform(0.1, 1.0)),
        "sensors.joints.force_noise": float(chance.uniform(0.0, 1.0)),
        "disturbance.force": chance.normal(0.0, 2.0, 3).tolist(),
        "faults": [fault],
    }


@pytest.mark.parametrize("seed", range(12))
def test_no_nan_leaves_the_loop_and_what_cannot_be_flown_says_so(seed):
    flight = tl.fly(tl.load_mission("rotor-loss", anything(seed)))
    assert all(np.isfinite(flight[name]).all() for name in flight)
    if flight.ending is None:
        assert flight.time[-1] == pytest.approx(10.0)
    else:
        assert flight.ending.quantity
        assert flight.time[-1] <= flight.ending.time <= 10.0
