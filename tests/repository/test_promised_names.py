"""What the project promises to the outside keeps its name: commands, exit codes, Python names, mission keys, metrics.

These are written here as data, by hand, and compared with what there is. There may be more; none may go or be renamed.
"""

import numpy as np
import pytest
from mission_schema import SCHEMA

import tandemlift as tl
from tandemlift.apps.cli.main import cli

COMMANDS = {  # each with its arguments and options
    "run": {"MISSION", "--engine", "--out", "--set", "--no-figures"},
    "missions": set(),
    "controllers": set(),
    "engines": set(),
}

KEYS = {  # table: the keys in it
    "mission": "name duration step log_interval seed",
    "vehicle.payload": "mass length radius inertia",
    "vehicle.quadrotors.0": (
        "mass inertia position layout arm thrust_constant max_speed torque_per_thrust lag_up lag_down"
    ),
    "vehicle.drag": "force moment",
    "controller": (
        "name switching boundary_layer attitude_reference_derivatives filter_bandwidth euler_rates tilt_inverse "
        "human_force_feedforward"
    ),
    "controller.gains": "xi eta lambda_1 lambda_2 a",
    "admittance": "mass damping stiffness threshold gate hold_after_release",
    "allocation": "method weights",
    "initial": "position velocity euler rates",
    "phases": "lift_start lift_duration height land_start land_duration",
    "pushes.0": "force time sigma point",
    "disturbance": "force moment",
    "plant": "mass_scale inertia_scale",
    "actuators": "model",
}
PROMISED = {f"{table}.{key}" for table, keys in KEYS.items() for key in keys.split()}
METRICS = {  # name: how many numbers, 0 for one that is no list; 4 for U₁ to U₄
    "position_rmse_m": 3,
    "position_rmse_after_10s_m": 3,
    "position_max_error_m": 3,
    "position_max_error_after_10s_m": 3,
    "attitude_rmse_rad": 3,
    "velocity_max_error_after_10s_m_s": 3,
    "max_tilt_after_10s_rad": 3,
    "final_position_m": 3,
    "final_reference_m": 3,
    "thrust_min_after_10s_n": 0,
    "thrust_max_after_10s_n": 0,
    "moment_max_abs_after_10s_n_m": 3,
    "command_at_start": 4,
    "human_impulse_n_s": 3,
    "human_work_j": 0,
    "rotor_saturated_share": 0,
    "steps": 0,
    "wall_s": 0,
}


# ---- Commands


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_has_its_arguments_and_options(command):
    found = {
        name
        for p in cli.commands[command].params
        for name in (p.opts if p.opts[0][0] == "-" else [p.human_readable_name])
    }
    assert found >= COMMANDS[command]


# ---- Python


# ---- Mission keys


def test_a_mission_has_the_promised_keys():
    assert sorted(PROMISED - set(SCHEMA)) == []


# ---- Metrics


def test_a_flown_mission_has_the_promised_metrics():
    metrics = tl.fly(tl.load_mission("one-push")).metrics()
    assert {name: np.size(metrics[name]) * isinstance(metrics[name], list) for name in METRICS} == METRICS
