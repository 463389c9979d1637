import numpy as np
import pytest

import tandemlift as tl
from tandemlift.flight.channels import DERIVED

AFTER_10S = [
    *("position_rmse_after_10s_m", "position_max_error_after_10s_m", "velocity_max_error_after_10s_m_s"),
    *("max_tilt_after_10s_rad", "thrust_min_after_10s_n", "thrust_max_after_10s_n"),
    "moment_max_abs_after_10s_n_m",
]
WILD = {  # gains that lose the attitude
    "controller.gains.lambda_1": 0,
    "controller.gains.lambda_2": 0,
    "controller.gains.xi": [4, 2, 11, 0.1, 0.1, 0.1],
}


@pytest.fixture(scope="session")
def flown():
    """Flights by name and changes, each flown once."""
    kept = {}

    def fly(name, **changes):
        changes = {key.replace("__", "."): value for key, value in changes.items()}
        key = name, repr(changes)
        if key not in kept:
            kept[key] = tl.fly(tl.load_mission(name, changes))
        return kept[key]

    return fly


@pytest.fixture(scope="session")
def short(flown):
    return flown("paper", mission__duration=1.0)


@pytest.fixture(scope="session")
def pushed(flown):
    """Every step of 16 s with two pushes after 10 s, one off the centre, and one before."""
    pushes = [
        {"force": [2.0, -1.0, 0.5], "time": 6.0, "sigma": 0.5},
        {"force": [3.0, 1.0, -1.0], "time": 12.0, "sigma": 0.4, "point": [0.0, 0.3, -0.06]},
        {"force": [0.0, -2.0, 0.0], "time": 13.0, "sigma": 0.6},
    ]
    return flown("paper", mission__duration=16.0, mission__log_interval=0.001, pushes=pushes)


@pytest.fixture(scope="session")
def lost(flown):
    """Every step of a flight that diverges."""
    return flown("paper", mission__log_interval=0.001, **{k.replace(".", "__"): v for k, v in WILD.items()})


def test_an_unknown_channel_is_told_with_a_suggestion(short):
    with pytest.raises(KeyError, match=r"no channel 'positon'; there are position, .* Did you mean 'position'\?"):
        short["positon"]
    assert short.get("positon") is None
    assert "position" in short
    assert "positon" not in short


def test_a_flight_tells_what_it_is_and_what_its_channels_are(short):
    assert repr(short) == "<Flight paper: 101 samples to 1 s, 20 channels>"
    assert short.info("velocity") == ("m/s", "world", "velocity of the centre of mass", 3, "")
    assert short.info("velocity_error").unit == "m/s"
    assert short.info("time").unit == "s"
    assert short["time"] is short.time
    assert np.array_equal(short.time, np.arange(101) * 10 * 0.001)


def test_errors_are_desired_minus_actual(pushed):
    assert set(DERIVED) == {"position_error", "velocity_error", "attitude_error"}
    for name, (desired, actual) in {
        "position_error": ("reference_position", "position"),
        "velocity_error": ("reference_velocity", "velocity"),
        "attitude_error": ("reference_euler", "euler"),
    }.items():
        assert np.array_equal(pushed[name], pushed[desired] - pushed[actual])
        assert pushed.info(name).unit == pushed.info(actual).unit == pushed.info(desired).unit


def test_in_hover_each_joint_carries_half_of_the_beam_one_vector_after_another(flown):
    flight = flown("hover", mission__duration=0.05)
    assert flight["joint_force"] == pytest.approx(np.tile([0.0, 0.0, 0.25 * 9.81], (6, 2)), abs=1e-9)
    assert flight["joint_torque"] == pytest.approx(0.0, abs=1e-9)


def recomputed(flight):
    """The metrics from the channels of a flight that logged every step, as the design words them."""
    step, k = flight.mission["mission"]["step"], flight.metrics()["steps"]
    every = {name: array[:k] for name, array in flight.items()}  # what follows the last step is no step
    time = np.arange(k) * step
    late = time >= 10.0 - 1e-9
    error = {name: (flight[f"{name}_error"])[:k] for name in ("position", "velocity", "attitude")}

    def rms(x):
        return np.sqrt(np.mean(x**2, axis=0))

    def peak(x):
        return np.max(np.abs(x), axis=0)

    power = np.sum(every["push_force"] * every["velocity"] + every["push_moment"] * every["rates"], axis=1)
    formed = {
        "position_rmse_m": rms(error["position"]),
        "position_max_error_m": peak(error["position"]),
        "attitude_rmse_rad": rms(error["attitude"]),
        "command_at_start": np.array([flight["thrust"][0], *flight["moment"][0]]),
        "human_impulse_n_s": every["push_force"].sum(axis=0) * step,
        "human_work_j": power.sum() * step,
        "rotor_saturated_share": 0.0,
        "push_triggers_after_10s": None,  # the guidance is scheduled
        "steps": k,
        **dict.fromkeys(AFTER_10S),
    }
    if late.any():
        thrust = every["thrust"][late]
        formed |= {
            "position_rmse_after_10s_m": rms(error["position"][late]),
            "position_max_error_after_10s_m": peak(error["position"][late]),
            "velocity_max_error_after_10s_m_s": peak(error["velocity"][late]),
            "max_tilt_after_10s_rad": peak(every["euler"][late]),
            "thrust_min_after_10s_n": thrust.min(),
            "thrust_max_after_10s_n": thrust.max(),
            "moment_max_abs_after_10s_n_m": peak(every["moment"][late]),
        }
    if flight.ending is None:
        formed |= {"final_position_m": flight["position"][-1], "final_reference_m": flight["reference_position"][-1]}
    return formed


@pytest.mark.parametrize("which", ["pushed", "lost", "before 10 s"])
def test_the_metrics_are_those_of_every_step(which, request, flown):
    if which == "before 10 s":
        flight = flown("paper", mission__duration=8.0, mission__log_interval=0.001)
    else:
        flight = request.getfixturevalue(which)
    metrics = flight.metrics()
    assert (metrics["human_work_j"] > 1.0) == (which == "pushed")
    for name, expected in recomputed(flight).items():
        if expected is None:
            assert metrics[name] is None, name
        else:
            np.testing.assert_allclose(metrics[name], expected, rtol=1e-9, atol=1e-15, err_msg=name)
    assert metrics["wall_s"] > 0.0


def test_the_metrics_do_not_depend_on_the_log(flown, pushed):
    coarse = flown("paper", mission__duration=16.0, mission__log_interval=1.0, pushes=pushed.mission["pushes"])
    assert len(coarse.time) == 17
    assert coarse.metrics() | {"wall_s": 0} == pushed.metrics() | {"wall_s": 0}


@pytest.mark.parametrize(("duration", "formed"), [(10.0, False), (10.001, True)])
def test_after_10_s_there_must_be_a_step(duration, formed, flown):
    metrics = flown("hover", mission__duration=duration).metrics()
    assert [metrics[name] is not None for name in AFTER_10S] == [formed] * len(AFTER_10S)
    assert metrics["position_rmse_m"] is not None


def test_a_step_that_does_not_divide_10_s_starts_its_count_after_them(flown):
    metrics = flown("hover", mission__duration=10.01, mission__step=0.003, mission__log_interval=0.003).metrics()
    assert metrics["steps"] == 3337
    assert metrics["position_rmse_after_10s_m"] is not None  # of steps 3334, 3335, 3336


def test_a_flight_that_diverges_keeps_what_was_flown_and_says_why(lost):
    quantity, at, value, limit, outcome, _ = lost.ending
    assert (quantity, limit) == ("distance from the origin [m]", "must stay below 1000 m")
    assert outcome == lost.outcome == "diverged"
    assert 1000.0 <= value < 1000.2
    assert lost.metrics()["steps"] == len(lost.time) == round(at / 0.001)
    assert str(lost.ending).startswith(f"diverged at {at:.6g} s: distance from the origin [m] = 1000")
    assert all(np.isfinite(array).all() for array in lost.values())
    assert lost.metrics()["final_position_m"] is not None
    assert lost.metrics()["final_reference_m"] is None


def test_metrics_are_a_copy(short):
    short.metrics()["steps"] = -1
    assert short.metrics()["steps"] == 1000
