"""What happens before the first step: a mission becomes numbers (`assemble`), and the loop over its steps machine code.

Loops are compiled for one flight, for a block of flights, and for the parts of a step around Python.

A flight is a flat array of the numbers of a `FlightModel`; a block holds LANES of them interleaved, so that the same
instruction serves all of them. The laws are the same, and so is every bit of the result.
"""

from tandemlift.engines.registry import machine_of
from tandemlift.simulation.loop.external_inputs import GAUSSIAN, GUST, LANES, SPAN, InputTables
from tandemlift.simulation.loop.sources import LeafSpan, delayed_spans, leaf_offset
from tandemlift.simulation.preparation.compiled_flight import LoopCode
from tandemlift.simulation.preparation.memory import COUNTS, POINTERS, WORDS, FlightMemory, FlightStart, TimeGrid
from tandemlift.simulation.preparation.templates import COMMAND, GIVEN, PythonController
