"""The compiled loops over steps: one flight, a block of flights, and the parts of a step around Python.

A flight is a flat array of the numbers of a `FlightModel`; a block holds LANES of them interleaved, so that the same
instruction serves all of them. The laws are the same, and so is every bit of the result.
"""

from tandemlift.simulation.loop_code.compiled_flight import LoopCode
from tandemlift.simulation.loop_code.external_inputs import GAUSSIAN, GUST, HALVES, LANES, SPAN, InputTables
from tandemlift.simulation.loop_code.memory import FlightMemory, FlightStart, TimeGrid
from tandemlift.simulation.loop_code.offsets import leaf_offset
from tandemlift.simulation.loop_code.templates import COMMAND, GIVEN, PythonController, Templates

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
    "LoopCode",
    "PythonController",
    "Templates",
    "TimeGrid",
    "leaf_offset",
]
