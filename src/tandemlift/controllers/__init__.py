"""Controllers: what a controller is, and which there are. docs/reference/controllers.md says how to add one.

A controller is one file. It names its settings (the keys of `[controller]`), makes its gains and its first memory from
them, and gives the law

    control(gains, memory, measured, reference) -> (command, memory)

for its own type of gains. Written as a law it compiles into the loop; registered with `compiled=False` any Python
function will do, at a few microseconds a step.
"""

from tandemlift.controllers.interface import NO_DISTURBANCE, Command, Disturbance, Measured, NoMemory, control
from tandemlift.controllers.registry import CONTROLLERS, Controller, controller, file_of, register
from tandemlift.controllers.trial_run import error_text
from tandemlift.controllers.user_controller import load_controller
from tandemlift.laws.signals.trajectories import Reference

# isort: split
from tandemlift.controllers import geometric, lqr, nftsmc, pid, smc, super_twisting  # register themselves

__all__ = [
    "CONTROLLERS",
    "NO_DISTURBANCE",
    "Command",
    "Controller",
    "Disturbance",
    "Measured",
    "NoMemory",
    "Reference",
    "control",
    "controller",
    "error_text",
    "file_of",
    "geometric",
    "load_controller",
    "lqr",
    "nftsmc",
    "pid",
    "register",
    "smc",
    "super_twisting",
]
