"""A flight as graphs, for what writes them in another language or differentiates them: assembly, step and pilot.

`trace_assembly` makes the numbers of a flight from those of its mission; a `TracedStep` takes one step from them, and a
`VehicleStep` one without the pilot; a `PilotSampler` is the pilot alone. Each has a `LimitProblem` if its thrusts are
limited together. The laws of external inputs make what a step is given.

What compiles or differentiates a flight imports this module, and nothing further in `preparation` and `loop`.
"""

from tandemlift.core.caching import LastUsed
from tandemlift.parts.mechanics.push import PointPush, PushSamples, push_at, push_moment
from tandemlift.parts.mechanics.wind import gust_velocity
from tandemlift.parts.rotors.normal_equations import GAMMA
from tandemlift.parts.rotors.rotor_lag import by_direction, lag
from tandemlift.simulation.caller_values import portable_mission
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
from tandemlift.simulation.preparation.module_text import ValuesFunction, write_flight_module
from tandemlift.simulation.preparation.pilot_sampling import PilotDataState, PilotSampler
from tandemlift.simulation.preparation.precompute import ScratchValues
from tandemlift.simulation.preparation.step_end import COMMAND_LINE
from tandemlift.simulation.preparation.templates import templates_from
from tandemlift.simulation.preparation.traced_assembly import TracedAssembly, trace_assembly, with_values
from tandemlift.simulation.preparation.traced_step import TracedStep
from tandemlift.simulation.preparation.vehicle_step import VehicleStep, is_of_vehicle
