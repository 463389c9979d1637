"""Controllers: their interface and the registered ones. docs/reference/controllers.md describes how to add one.

A controller is one file. It names its settings (the keys of `[controller]`), makes its gains and its first memory from
them, and gives the law

    control(gains, memory, measured, reference) -> (command, memory)

for its own type of gains. Written as a law it compiles into the loop; registered with `compiled=False` any Python
function will do, at a few microseconds a step.

A user's controller imports from here, from `tandemlift.core.algebra` and from
`tandemlift.core.keys`.
"""

from tandemlift.core.trajectories import Reference, Trajectory
from tandemlift.parts.controllers.attitude_reference import AttitudeReference, CommandFilterState
from tandemlift.parts.controllers.cascade import (
    LEVEL,
    CascadeTable,
    ControllerModel,
    command_from,
    controller_model,
    tracked_attitude,
    wanted_force,
)
from tandemlift.parts.controllers.interface import (
    NO_DISTURBANCE,
    Command,
    ControllerTable,
    Disturbance,
    Measured,
    NoMemory,
    control,
)
from tandemlift.parts.controllers.interface import tilt_limit_of as tilt_limit_of
from tandemlift.parts.controllers.registry import CONTROLLERS, Controller, error_text, file_of, register
from tandemlift.parts.controllers.user_controller import controller, load_controller
from tandemlift.parts.mechanics.rigid_body import UP, State, Wrench, apply_inertia, gyroscopic, inertia_value
from tandemlift.parts.mechanics.rotation import (
    Euler,
    TiltLimit,
    TiltZXY,
    desired_orientation,
    euler_from_quaternion,
    euler_rates_from_rates,
    limit_tilt,
    quaternion_from_euler,
    rates_from_euler_rates,
    rotation_from_euler,
    total_thrust,
    wrap_angle,
)

# isort: split
from tandemlift.parts.controllers import geometric, lqr, nftsmc, pid, smc, super_twisting  # register themselves

__all__ = [
    "CONTROLLERS",
    "LEVEL",
    "NO_DISTURBANCE",
    "UP",
    "AttitudeReference",
    "CascadeTable",
    "Command",
    "CommandFilterState",
    "Controller",
    "ControllerModel",
    "ControllerTable",
    "Disturbance",
    "Euler",
    "Measured",
    "NoMemory",
    "Reference",
    "State",
    "TiltLimit",
    "TiltZXY",
    "Trajectory",
    "Wrench",
    "apply_inertia",
    "command_from",
    "control",
    "controller",
    "controller_model",
    "desired_orientation",
    "error_text",
    "euler_from_quaternion",
    "euler_rates_from_rates",
    "file_of",
    "geometric",
    "gyroscopic",
    "inertia_value",
    "limit_tilt",
    "load_controller",
    "lqr",
    "nftsmc",
    "pid",
    "quaternion_from_euler",
    "rates_from_euler_rates",
    "register",
    "rotation_from_euler",
    "smc",
    "super_twisting",
    "total_thrust",
    "tracked_attitude",
    "wanted_force",
    "wrap_angle",
]
