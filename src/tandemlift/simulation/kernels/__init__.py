"""The compiled loops over steps: one flight, a block of flights, and the parts of a step around Python.

A flight is a flat array of the numbers of a `FlightModel`; a block holds LANES of them interleaved, so that the same
instruction serves all of them. The laws are the same, and so is every bit of the result.
"""

from tandemlift.simulation.kernels.compiled_flight import Kernels
from tandemlift.simulation.kernels.external_inputs import GAUSSIAN, GUST, HALVES, LANES, SPAN, InputTables
from tandemlift.simulation.kernels.memory import FlightMemory, FlightStart, TimeGrid
from tandemlift.simulation.kernels.offsets import leaf_offset
from tandemlift.simulation.kernels.templates import COMMAND, GIVEN, PythonController, Templates

__all__ = [
    "COMMAND",
    "GAUSSIAN",
    "GIVEN",
    "GUST",
    "HALVES",
    "LANES",
    "SPAN",
    "FlightMemory",
    "FlightStart",
    "InputTables",
    "Kernels",
    "PythonController",
    "Templates",
    "TimeGrid",
    "leaf_offset",
]
