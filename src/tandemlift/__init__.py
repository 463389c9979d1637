"""tandemlift: an open laboratory for carrying a load with quadrotors that a person steers by pushing it.

import tandemlift as tl

flight = tl.fly("paper")
flight.metrics()["final_position_m"]
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from tandemlift.core.files import __version__ as __version__

if TYPE_CHECKING:
    from tandemlift.analysis.certification.certify import certify
    from tandemlift.analysis.certification.mission_check import check
    from tandemlift.analysis.differentiable.differentiable_step import jax_step, torch_step
    from tandemlift.analysis.identification.excitation_design import excite
    from tandemlift.analysis.identification.identify import identify
    from tandemlift.analysis.identification.shadow import shadow
    from tandemlift.analysis.learning.block import Block
    from tandemlift.analysis.learning.registration import register_environments
    from tandemlift.analysis.linearization.linear_model import LinearModel
    from tandemlift.analysis.linearization.linearize import linearize
    from tandemlift.analysis.studies.feel import feel
    from tandemlift.analysis.studies.study import study
    from tandemlift.analysis.studies.table import Study, load_study
    from tandemlift.analysis.studies.tuning.tune import train, tune
    from tandemlift.apps.export.logs import read_log
    from tandemlift.apps.live.notebook_page import page
    from tandemlift.apps.teaching.grading import grade
    from tandemlift.codegen.mission_module import compile_mission
    from tandemlift.core.errors import FlightWarning, InputError
    from tandemlift.core.plugs import plug
    from tandemlift.flight.record import Flight
    from tandemlift.missions import Mission, load_mission, load_plugin
    from tandemlift.parts.controllers.user_controller import load_controller
    from tandemlift.parts.mechanics.vehicle import Vehicle
    from tandemlift.pictures.figures.registry import plot
    from tandemlift.simulation.fly import fly_many
    from tandemlift.simulation.known_flights import fly
    from tandemlift.simulation.pilot_api import Pilot
    from tandemlift.simulation.simulation import Simulation

_HOMES = {  # loaded when first used, so that `import tandemlift` is quick
    "Block": "analysis.learning.block",
    "Flight": "flight.record",
    "FlightWarning": "core.errors",
    "InputError": "core.errors",
    "LinearModel": "analysis.linearization.linear_model",
    "Mission": "missions",
    "Pilot": "simulation.pilot_api",
    "Simulation": "simulation.simulation",
    "Study": "analysis.studies.table",
    "Vehicle": "parts.mechanics.vehicle",
    "certify": "analysis.certification.certify",
    "check": "analysis.certification.mission_check",
    "compile_mission": "codegen.mission_module",
    "excite": "analysis.identification.excitation_design",
    "feel": "analysis.studies.feel",
    "fly": "simulation.known_flights",
    "fly_many": "simulation.fly",
    "grade": "apps.teaching.grading",
    "identify": "analysis.identification.identify",
    "jax_step": "analysis.differentiable.differentiable_step",
    "linearize": "analysis.linearization.linearize",
    "load_controller": "parts.controllers.user_controller",
    "load_mission": "missions",
    "load_plugin": "missions",
    "load_study": "analysis.studies.table",
    "page": "apps.live.notebook_page",
    "plot": "pictures.figures.registry",
    "plug": "core.plugs",
    "read_log": "apps.export.logs",
    "register_environments": "analysis.learning.registration",
    "shadow": "analysis.identification.shadow",
    "study": "analysis.studies.study",
    "torch_step": "analysis.differentiable.differentiable_step",
    "train": "analysis.studies.tuning.tune",
    "tune": "analysis.studies.tuning.tune",
}

__all__ = [
    "Block",
    "Flight",
    "FlightWarning",
    "InputError",
    "LinearModel",
    "Mission",
    "Pilot",
    "Simulation",
    "Study",
    "Vehicle",
    "certify",
    "check",
    "compile_mission",
    "excite",
    "feel",
    "fly",
    "fly_many",
    "grade",
    "identify",
    "jax_step",
    "linearize",
    "load_controller",
    "load_mission",
    "load_plugin",
    "load_study",
    "page",
    "plot",
    "plug",
    "read_log",
    "register_environments",
    "shadow",
    "study",
    "torch_step",
    "train",
    "tune",
]


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(importlib.import_module(f"tandemlift.{_HOMES[name]}"), name)
    raise AttributeError(f"module 'tandemlift' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])
