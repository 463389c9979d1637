"""The whole flight of a mission as C: header and source. The loop around the laws is a text of `data/c`.

The laws of a step are functions, and so are a step, `advance_flight`, and the laws of its external inputs, which the
text calls.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any

from tandemlift.codegen.c.expressions import UNARY, number
from tandemlift.codegen.c.laws import write_call, write_functions
from tandemlift.codegen.c.source import SourceFile
from tandemlift.codegen.c.statements import Statements
from tandemlift.codegen.c.text import FunctionHead, function
from tandemlift.codegen.c_pilot import write_limits, write_solver
from tandemlift.codegen.number_facts import described
from tandemlift.compiler.tracer import Symbol
from tandemlift.core.types import leaves, rebuilt
from tandemlift.core.vector import ZERO
from tandemlift.simulation import graphs
from tandemlift.simulation.graphs import COMMAND_LINE, ROWS, TracedStep, draw_count, templates_from
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import COUNTS

STEP = """/* One step of a flight from time t [s] by dt [s]: its state after it, and the sample at its start
 * (tandemlift.simulation.preparation.traced_step). */
"""


class FlightFile:
    """The header and the source of a flight.

    Args:
        file: the names of the mission, and its precision.
        plan: of the flight, interactive: a caller has inputs.
        step: traces the step; by default, the whole of it.
    """

    def __init__(self, file: SourceFile, plan: FlightPlan, step: Callable[..., TracedStep] = TracedStep) -> None:
        self.file, self.plan, unit = file, plan, file.unit
        self.templates, self.delayed = templates_from(plan.model, plan.given), plan.loop_code.delayed
        unit.structs.keep((plan.model, plan.given, self.templates.sample))
        for value in (ZERO, *ROWS, plan.model, plan.given, self.templates.sample):  # these get the plain names
            unit.structs.of(value)
        unit.structs.agree(())  # all types of the header have their names
        with unit.laws.recording():
            x = self.traced = step(self.templates, fuses=False, rolls=False)
        symbols = [*x.next_state, *x.sample, *x.body_in_contact, *x.body_on_feet, *x.body_in_free_air]
        symbols += [*x.may_touch_walls, *x.may_touch_hull, *(x.limits.symbols if x.limits else [])]
        self.roots = [s.node for s in symbols]
        self.has_noise = leaves(self.templates.given.noise) > 0
        self.has_gusts = any(x.graph.args[n][0] == "gust" for n in x.graph.needed(self.roots) if x.graph.ops[n] == "in")
        values = [plan.model, self.templates.sample, plan.given.hand.start, plan.given.external]
        values += [row for _, row, _ in self._tables]
        self.public = [unit.structs.of(value) for value in values]

    @property
    def _tables(self) -> Iterator[tuple[str, Any, Any]]:
        """Name, layout of a row, and rows of each table that the mission may have."""
        has = True, self.has_gusts, self.templates.has_walls, self.templates.has_person
        for name, row, rows, is_there in zip(ROWS._fields, ROWS, self.plan.tables, has, strict=True):
            if is_there:
                yield name, row, rows

    @property
    def traced_tables(self) -> tuple[tuple[str, str, int], ...]:
        """Name, type and rows of each table that the mission has."""
        return tuple((name, self.file.unit.type_of(row), len(rows)) for name, row, rows in self._tables if len(rows))

    @cached_property
    def has(self) -> set[str]:
        """The blocks of the texts that this flight needs."""
        x = self.templates
        found = {"gusts": self.has_gusts, "walls": x.has_walls, "person": x.has_person, "floor": x.has_floor}
        found |= {"draws": self.has_noise, "delays": x.has_delays and self.ring_rows > 1}
        found["surroundings"] = x.has_floor or x.has_person
        found["ends"] = type(self.traced) is TracedStep  # a vehicle goes on beyond the mission's duration
        return {name for name, is_there in found.items() if is_there}

    @property
    def ring_rows(self) -> int:
        """Rows of the delay lines."""
        return len(self.plan.start().ring)

    def header(self) -> str:
        """The text of the header."""
        words = {
            "STEPS": str(self.plan.steps),
            "EVERY": str(self.plan.every),
            "RING_ROWS": str(self.ring_rows),
            "RING_WIDTH": str(max(self.delayed.size, 1)),
            "DELAYS": str(max(len(self.delayed), 1)),
            "TYPES": self.file.typedefs(self.public, described),
            "PUSH": self.file.unit.type_of(self.plan.given.hand.start),
        }
        return self.file.filled("flight.h", self.has, **words)

    def source(self) -> str:
        """The text of the source."""
        unit, x = self.file.unit, self.traced
        write_functions(unit, unit.reached(x.graph, self.roots))
        if x.limits:
            write_solver(unit, x.limits.solver)
        self._write_step()
        arguments = ["gust"] * self.has_gusts + ["&noise"] * self.has_noise
        arguments += ["flight->low"] * bool(x.body_in_free_air)
        words = self._calls() | {
            "DOUBLE_STEP": number(self.file.step, "double"),
            "PARTS": ", ".join(f"{{{s.at}, {s.size}, {int(j == COMMAND_LINE)}}}" for j, s in enumerate(self.delayed)),
            "PLACES": ", ".join(f"{{{s.at}, {s.size}}}" for s in self.delayed),
            "ARGUMENTS": "".join(f"{name}, " for name in arguments),
            "TABLES": self._constants(),
        }
        return self.file.source("flight.c", self.public, self.has, used=words["TABLES"], **words)

    def _write_step(self) -> None:
        x, unit, templates = self.traced, self.file.unit, self.templates
        body = Statements(unit, x.graph, self.roots)
        for name in ("model", "hand", "external", "gust", "noise", "low", "t", "dt", "sample"):
            body.taken.new(name)
        given = [
            body.argument("model", x.model, pointer=True),
            body.argument("hand", x.input_of("hand", templates.given.hand), pointer=True),
            body.argument("external", x.graph.inputs("external", templates.given.external), pointer=True),
        ]
        if self.has_gusts:
            given.append(body.argument("gust", x.input_of("gust", ZERO)))
        if self.has_noise:
            given.append(body.argument("noise", x.input_of("noise", templates.given.noise), pointer=True))
        given += ["bool low"] * bool(x.body_in_free_air)
        given += [body.argument("t", x.t), body.argument("dt", x.dt), f"{unit.type_of(templates.sample)} *sample"]
        if x.limits:
            write_limits(body, x.limits)
        self._move_body(body)
        body.compute([s.node for s in [*x.sample, *x.next_state]])
        state = templates.model.flight_state
        last = [] if x.t.node in x.graph.needed(self.roots) else ["(void)t;"]  # a vehicle may not know the time
        last.append(f"*sample = {body.value(rebuilt(iter(x.sample), templates.sample))};")
        last.append(f"return {body.value(rebuilt(iter(x.next_state), state))};")
        head = FunctionHead(STEP, unit.type_of(state), "advance_flight", given)
        unit.texts.append(function(head, body.made, "\n".join(last)))

    def _move_body(self, body: Statements) -> None:
        """The body's part of the step: near walls or with all parts near the floor, on its feet, or in free air."""
        x, like = self.traced, self.templates.moved
        moved = body.variable(x.input_of("moved", like), "moved")

        def move(numbers: list[Symbol]) -> None:
            value: Any = rebuilt(iter(numbers), like)
            body.compute([s.node for s in numbers])
            body.line(f"{moved} = {body.value(value)};")

        if not x.body_in_free_air:
            move(x.body_in_contact)
            return
        body.compute([s.node for s in [*x.may_touch_walls, *x.may_touch_hull]])
        walls, hull = ([body.number(s.node).within(UNARY) for s in t] for t in (x.may_touch_walls, x.may_touch_hull))
        with body.branch(f"if ({' || '.join([*walls, *[f'(low && {test})' for test in hull]])}) {{", last=False):
            move(x.body_in_contact)
        with body.branch("} else if (low) {", last=False):
            move(x.body_on_feet)
        with body.branch("} else {", last=True):
            move(x.body_in_free_air)

    def _calls(self) -> dict[str, str]:
        """Calls, in the text, of the laws of external inputs."""
        words = dict[str, str]()

        def add(law: Callable[..., Any], **arguments: tuple[Any, str]) -> None:
            words[law.__name__.upper()] = write_call(self.file.unit, law, arguments)[1]

        row, hand = (ROWS.pushes, "*row"), (self.plan.given.hand.start, "flight->hands[j]")
        model, dt = (self.plan.model, "*model"), (0.0, f"{self.file.prefix.upper()}FLIGHT_STEP")
        add(graphs.push_is_active, row=row, opens=(0.0, "opens"), closes=(0.0, "closes"))
        add(graphs.with_push, hand=hand, row=row, when=(0.0, "when"))
        if "gusts" in self.has:
            row = ROWS.gusts, "flight->inputs.gusts[i]"
            add(graphs.with_gust, sum=(ZERO, "sum"), row=row, t=(0.0, "t"))
        if "floor" in self.has:
            add(graphs.floor_is_near, model=model, dt=dt)
        if "walls" in self.has:
            add(graphs.walls_are_due, model=model, dt=dt)
            add(graphs.nearest_walls, model=model, row=(ROWS.walls, "flight->inputs.walls[i]"))
        return words | (self._draws() if "draws" in self.has else {})

    def _draws(self) -> dict[str, str]:
        """The call that draws random numbers: in doubles, whose bits its law uses."""
        unit = self.file.unit.in_double("drawn_")
        given = {"number": (0, "k"), "draw": (0, "i"), "key0": (0.0, "keys[0]"), "key1": (0.0, "keys[1]")}
        law, call = write_call(unit, graphs.draw_normals, given)
        self.file.unit.take(unit)
        draws = str(draw_count(self.templates.given.noise))
        return {"DRAW_NORMALS": call, "DRAWS": draws, "NORMALS": unit.type_of(law.result)}

    def _constants(self) -> str:
        """The constants of the mission: numbers at the start, and tables."""
        texts, members = [self.file.constant(self.plan.model, "START")], list[str]()
        counts = dict(zip(ROWS._fields, COUNTS, strict=True))
        for name, row, rows in self._tables:
            members += [f"    .{name} = {name.upper() if len(rows) else 0},", f"    .{counts[name]} = {len(rows)},"]
            if len(rows):
                lines = [f"    {self.file.initialiser(rebuilt(iter(map(float, numbers)), row))}," for numbers in rows]
                opening = f"static const {self.file.unit.type_of(row)} {name.upper()}[] = {{"
                texts.append("\n".join([opening, *lines, "};", ""]))
        if "delays" in self.has:
            members.append(f"    .delays = {{{', '.join(str(int(d)) for d in self.plan.delays)}}},")
        members.append(f"    .keys = {{{', '.join(number(float(x), 'double') for x in self.plan.seeds)}}},")
        texts.append("\n".join([f"static const {self.file.prefix}Inputs INPUTS = {{", *members, "};", ""]))
        if "walls" in self.has:
            texts.append(self.file.constant(self.templates.nowhere, "NOWHERE"))
        return "\n".join(texts)
