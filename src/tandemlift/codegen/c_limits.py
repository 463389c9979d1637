"""The solver of thrust limits in C: called under a branch, and the loop of its search."""

from __future__ import annotations

import operator
from typing import Any

from tandemlift.codegen.c_source import Unit
from tandemlift.codegen.c_statements import Statements, law_function
from tandemlift.core.types import Condition, Number, is_value, leaves, rebuilt
from tandemlift.core.vector import Vec3
from tandemlift.parts.contact.clearance import is_fast
from tandemlift.parts.contact.feet import may_touch
from tandemlift.parts.contact.wall_geometry import Wall
from tandemlift.parts.contact.walls import NearWalls, nearest_with
from tandemlift.parts.mechanics.push import GaussianPush, Push, push_at
from tandemlift.parts.mechanics.wind import Gust, gust_velocity
from tandemlift.parts.rotors.allocation import AllocationState, ConstrainedAllocation
from tandemlift.parts.rotors.thrust_limit_solver import BoundedProblem, Search, search_step, start_search
from tandemlift.simulation.loop.random_numbers import Normals, normals
from tandemlift.simulation.loop.step import FlightModel
from tandemlift.simulation.loop_code.external_inputs import SPAN, is_active
from tandemlift.simulation.loop_code.traced_step import LimitProblem

SOLVE = """/* The thrusts within limits that come closest to the desired wrench
 * (tandemlift.parts.rotors.thrust_limit_solver.limited_thrusts); it ends after {most} steps at the latest. */
static {state} {name}(const {problem} *problem, const {state} *held)
{{
    {search} search = {start}(&problem->limits, held);
    for (int step = 1; step <= {most}; step++) {{
        search = {step}(problem, &search);
        if (!(search.ended == 0.0)) {{
            break;
        }}
    }}
    return search.found;
}}
"""
WIDENED = """/* The same in single precision. The search is in doubles: where part of a wrench is out of reach,
 * its sums cancel all digits of a float. */
static AllocationState solve(const BoundedProblem *problem, const AllocationState *held)
{{
    float given[{size}], before[{held}];
    double numbers[{size}], start[{held}];
    {problem} exact;
    {state} found;
    AllocationState result;
    memcpy(given, problem, sizeof given);
    memcpy(before, held, sizeof before);
    for (int i = 0; i < {size}; i++) {{
        numbers[i] = (double)given[i];
    }}
    for (int i = 0; i < {held}; i++) {{
        start[i] = (double)before[i];
    }}
    memcpy(&exact, numbers, sizeof exact);
    memcpy(&found, start, sizeof found);
    found = {name}(&exact, &found);
    memcpy(start, &found, sizeof start);
    for (int i = 0; i < {held}; i++) {{
        before[i] = (float)start[i];
    }}
    memcpy(&result, before, sizeof result);
    return result;
}}
"""


def problem_like(allocation: ConstrainedAllocation) -> BoundedProblem:
    """The layout of the solver's problem."""
    return BoundedProblem(allocation.rows, allocation.weights, allocation.weights, allocation.limits, allocation.limits)


def write_limits(body: Statements, needs: LimitProblem, allocation: ConstrainedAllocation) -> None:
    """The thrusts within limits, from the solver where a thrust exceeds its limits."""
    limits = allocation.limits
    like = AllocationState(limits, limits)
    plain, start = rebuilt(iter(needs.plain), like), rebuilt(iter(needs.search), Search(like, 0.0, 0.0, 0.0))
    problem = rebuilt(iter(needs.problem), problem_like(allocation))
    solved = body.variable(body.graph.inputs("solved", like), "limited")
    body.compute([needs.beyond.node])
    with body.branch(f"if ({body.number(needs.beyond.node).text}) {{", last=False):
        body.compute([s.node for s in [*needs.problem, *needs.search]])
        body.line(f"{solved} = solve({body.address(problem)}, {body.address(start.found)});")
    with body.branch("} else {", last=True):
        body.compute([s.node for s in needs.plain])
        body.line(f"{solved} = {body.value(plain)};")


class Solver:
    """The functions of the solver in a file: in double precision always.

    Args:
        unit: of the file.
        allocation: of the mission.
    """

    def __init__(self, unit: Unit, allocation: ConstrainedAllocation) -> None:
        limits = allocation.limits
        self.held, self.problem, self.most = AllocationState(limits, limits), problem_like(allocation), 8 * len(limits)
        unit.structs.of(self.problem)
        self.file_unit, self.widens = unit, unit.real == "float"
        self.unit = Unit("double", "exact_", unit.names) if self.widens else unit
        self.search = Search(self.held, 0.0, 0.0, 0.0)
        self.start = self.unit.laws.trace(start_search, {"limits": limits, "held": self.held})
        self.step = self.unit.laws.trace(search_step, {"p": self.problem, "s": self.search})

    def functions(self, done: list[int]) -> list[str]:
        """The text of the functions that are not done yet."""
        texts, ready = list[str](), [] if self.widens else done
        for law in (self.start, self.step):
            for number in [*self.unit.reached(law.graph, [s.node for s in law.ends]), law.number]:
                if number not in ready:
                    ready.append(number)
                    texts.append(law_function(self.unit, number))
        kinds = {"state": self.held, "problem": self.problem, "search": self.search}
        words = {word: self.unit.structs.of(value).name for word, value in kinds.items()}
        words["start"], words["step"] = (self.unit.signature(x.number).name for x in (self.start, self.step))
        words |= {"most": str(self.most), "name": "exact_solve" if self.widens else "solve"}
        texts.append(SOLVE.format(**words))
        if self.widens:
            own = [struct.definition("", "double") for struct in self.unit.structs.all.values()]
            sizes = {"size": str(leaves(self.problem)), "held": str(leaves(self.held))}
            texts = ["\n".join([*own, ""]), *texts, WIDENED.format(**words, **sizes)]
        return texts


def push_is_active(row: GaussianPush, opens: Number, closes: Number) -> Condition:
    """Whether a push is other than zero somewhere between two times [s]."""
    return is_active(row, opens, closes)


def with_push(hand: Push, row: GaussianPush, when: Number) -> Push:
    """A push at a time [s] added to others."""
    return _added(hand, push_at(hand, row, when))


def _added(a: Any, b: Any) -> Any:
    return type(a)(*map(_added, a, b)) if is_value(a) else operator.add(a, b)


def with_gust(sum: Vec3, row: Gust, t: Number) -> Vec3:
    """The velocity of a gust at time t [s] added to that of others."""
    return _added(sum, gust_velocity(row, t))


def floor_is_near(model: FlightModel, dt: Number) -> Condition:
    """Whether a foot may touch the floor within a span of steps."""
    return may_touch(model.plant.floor, model.flight_state.state, dt * float(SPAN))


def walls_are_due(model: FlightModel, dt: Number) -> Condition:
    """Whether the nearest walls are found anew in a step within a span, too."""
    return is_fast(model.plant.walls, model.flight_state.state, dt * float(SPAN))


def nearest_walls(model: FlightModel, row: Wall) -> NearWalls:
    """The nearest walls once a row of the table of walls was looked at."""
    before = model.flight_state
    near: Any = before.near  # never `Absent`: this is called where there are walls
    return nearest_with(model.plant.walls, row, near, model.plant.frame, before.state)


def draw_normals(number: Number, draw: Number, key0: Number, key1: Number) -> Normals:
    """Four standard normals of a step."""
    return normals(number, draw, key0, key1)
