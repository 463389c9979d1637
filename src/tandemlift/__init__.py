"""tandemlift: an open laboratory for carrying a load with quadrotors that a person steers by pushing it.

import tandemlift as tl

flight = tl.fly(tl.load_mission("paper"))
flight.metrics()["final_position_m"]
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from tandemlift.common.version import __version__ as __version__

if TYPE_CHECKING:
    from tandemlift.common.errors import FlightWarning, InputError
    from tandemlift.controllers.user_controller import load_controller
    from tandemlift.flight.record import Flight
    from tandemlift.interactive.simulation import Simulation
    from tandemlift.linearization.linear_model import LinearModel
    from tandemlift.linearization.linearize import linearize
    from tandemlift.linearization.mission_check import check
    from tandemlift.missions import load_mission
    from tandemlift.report.tuning.feel_report import feel
    from tandemlift.settings import Mission
    from tandemlift.simulation.fly import fly, fly_many
    from tandemlift.simulation.pilot_api import Pilot
    from tandemlift.studies.reading.table import Study, load_study
    from tandemlift.studies.study import study
    from tandemlift.studies.tuning.tune import tune
    from tandemlift.targets.compiling import compile_mission
    from tandemlift.vehicle import Vehicle

_HOMES = {  # loaded when first used, so that `import tandemlift` is quick
    "Flight": "flight.record",
    "FlightWarning": "common.errors",
    "InputError": "common.errors",
    "LinearModel": "linearization.linear_model",
    "Mission": "settings",
    "Pilot": "simulation.pilot_api",
    "Simulation": "interactive.simulation",
    "Study": "studies.reading.table",
    "Vehicle": "vehicle",
    "check": "linearization.mission_check",
    "compile_mission": "targets.compiling",
    "feel": "report.tuning.feel_report",
    "fly": "simulation.fly",
    "fly_many": "simulation.fly",
    "linearize": "linearization.linearize",
    "load_controller": "controllers.user_controller",
    "load_mission": "missions",
    "load_study": "studies.reading.table",
    "study": "studies.study",
    "tune": "studies.tuning.tune",
}

__all__ = [
    "Flight",
    "FlightWarning",
    "InputError",
    "LinearModel",
    "Mission",
    "Pilot",
    "Simulation",
    "Study",
    "Vehicle",
    "check",
    "compile_mission",
    "feel",
    "fly",
    "fly_many",
    "linearize",
    "load_controller",
    "load_mission",
    "load_study",
    "study",
    "tune",
]


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(importlib.import_module(f"tandemlift.{_HOMES[name]}"), name)
    raise AttributeError(f"module 'tandemlift' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])
