"""A flight as graphs, for what writes them in another language or differentiates them: assembly, step and pilot.

`trace_assembly` makes the numbers of a flight from those of its mission; a `TracedStep` takes one step from them, and a
`VehicleStep` one without the pilot; a `PilotSampler` is the pilot alone. Each has a `LimitProblem` if its thrusts are
limited together. The laws of external inputs make what a step is given.

What compiles or differentiates a flight imports this module, and nothing further in `preparation` and `loop`.
"""

from tandemlift.parts.mechanics.push import PointPush, PushSamples, push_at, push_moment
from tandemlift.parts.mechanics.wind import gust_velocity
from tandemlift.parts.rotors.normal_equations import GAMMA
from tandemlift.parts.rotors.rotor_lag import by_direction, lag
from tandemlift.simulation.loop.external_inputs import (
    ROWS,
    draw_count,
    draw_normals,
    floor_is_near,
    nearest_walls,
    push_is_active,
    walls_are_due,
    with_gust,
    with_push,
)
from tandemlift.simulation.preparation.assemble import AssembledFlight, assemble
from tandemlift.simulation.preparation.limit_solver import LimitProblem, TracedSolver
from tandemlift.simulation.preparation.loops import write_limits, write_solver
from tandemlift.simulation.preparation.module_text import (
    ValuesFunction,
    write_flight_loop,
    write_ramp,
    write_values_function,
)
from tandemlift.simulation.preparation.pilot_sampling import PilotDataState, PilotSampler
from tandemlift.simulation.preparation.precompute import ScratchValues
from tandemlift.simulation.preparation.step_end import COMMAND_LINE
from tandemlift.simulation.preparation.templates import templates_from
from tandemlift.simulation.preparation.traced_assembly import TracedAssembly, trace_assembly, with_values
from tandemlift.simulation.preparation.traced_step import Symbols, TracedStep
from tandemlift.simulation.preparation.vehicle_step import VehicleStep, is_of_vehicle

__all__ = [
    "COMMAND_LINE",
    "GAMMA",
    "ROWS",
    "AssembledFlight",
    "LimitProblem",
    "PilotDataState",
    "PilotSampler",
    "PointPush",
    "PushSamples",
    "ScratchValues",
    "Symbols",
    "TracedAssembly",
    "TracedSolver",
    "TracedStep",
    "ValuesFunction",
    "VehicleStep",
    "assemble",
    "by_direction",
    "draw_count",
    "draw_normals",
    "floor_is_near",
    "gust_velocity",
    "is_of_vehicle",
    "lag",
    "nearest_walls",
    "push_at",
    "push_is_active",
    "push_moment",
    "templates_from",
    "trace_assembly",
    "walls_are_due",
    "with_gust",
    "with_push",
    "with_values",
    "write_flight_loop",
    "write_limits",
    "write_ramp",
    "write_solver",
    "write_values_function",
]
