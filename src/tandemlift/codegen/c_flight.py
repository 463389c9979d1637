"""The whole flight of a mission as C: header and source. The loop around the laws is a text of `data/c`."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from tandemlift.codegen import c_limits
from tandemlift.codegen.c_expressions import number
from tandemlift.codegen.c_source import SourceFile, Unit
from tandemlift.codegen.c_statements import law_function
from tandemlift.codegen.c_step import FlightStep
from tandemlift.compiler.tracer.structured import TracedLaw
from tandemlift.core.types import leaves, rebuilt
from tandemlift.core.vector import ZERO
from tandemlift.parts.contact.wall_geometry import WALL
from tandemlift.parts.person.person import PATH_LEG
from tandemlift.simulation.assembly.assemble import AssembledFlight
from tandemlift.simulation.loop_code.external_inputs import GAUSSIAN, GUST, InputTables
from tandemlift.simulation.loop_code.offsets import delayed_spans
from tandemlift.simulation.loop_code.step_output import COMMAND_LINE
from tandemlift.simulation.loop_code.templates import templates_from
from tandemlift.simulation.loop_code.traced_step import TracedStep

ROWS = InputTables(GAUSSIAN, GUST, WALL, PATH_LEG)


class FlightFile:
    """The header and the source of a flight.

    Args:
        file: the names of the mission, and its precision.
        assembled: the flight at its first step.
        steps: of the flight.
        every: steps from one logged sample to the next.
    """

    def __init__(self, file: SourceFile, assembled: AssembledFlight, steps: int, every: int) -> None:
        self.file, self.assembled, self.steps, self.every, unit = file, assembled, steps, every, file.unit
        self.model = assembled.model
        self.templates = templates_from(assembled.model, assembled.given)
        for value in (ZERO, *ROWS, self.model, assembled.given, self.templates.sample):  # these get the plain names
            unit.structs.of(value)
        with unit.laws.recording():
            self.traced = TracedStep(self.templates, fuses=False, rolls=False)
        self.step = FlightStep(file, self.traced)
        self.delayed = delayed_spans(self.model)
        rows = [row for row, has in zip(ROWS, self._has_tables, strict=True) if has]
        values = [self.model, self.templates.sample, assembled.given.hand.start, *rows]
        self.public = [unit.structs.of(value) for value in values]

    @property
    def _has_tables(self) -> tuple[bool, ...]:
        return True, self.step.has_gusts, self.templates.has_walls, self.templates.has_person

    @cached_property
    def has(self) -> set[str]:
        """The blocks of the texts that this flight needs."""
        x = self.templates
        found = {"gusts": self.step.has_gusts, "walls": x.has_walls, "person": x.has_person, "floor": x.has_floor}
        found |= {"draws": leaves(x.given.noise) > 0, "delays": x.has_delays and self.ring_rows > 1}
        return {name for name, is_there in found.items() if is_there} | (
            {"surroundings"} if x.has_floor or x.has_person else set()
        )

    @property
    def traced_tables(self) -> tuple[tuple[str, str, int], ...]:
        """Name, type and rows of each table that the mission has."""
        names, kinds = ("pushes", "gusts", "walls", "legs"), (self.file.unit.structs.of(row).name for row in ROWS)
        rows = zip(names, kinds, map(len, self.assembled.tables), self._has_tables, strict=True)
        return tuple((name, kind, count) for name, kind, count, has in rows if has and count)

    @property
    def ring_rows(self) -> int:
        """Rows of the delay lines."""
        delays = self.assembled.delays
        return 1 << int(delays.max()).bit_length() if delays.any() else 1

    def header(self) -> str:
        """The text of the header."""
        words = {
            "STEPS": str(self.steps),
            "EVERY": str(self.every),
            "RING_ROWS": str(self.ring_rows),
            "RING_WIDTH": str(max(self.delayed.size, 1)),
            "DELAYS": str(max(len(self.delayed), 1)),
            "TYPES": self.file.typedefs(self.public),
            "PUSH": self.file.unit.structs.of(self.assembled.given.hand.start).name,
        }
        return self.file.filled("flight.h", self.has, **words)

    def source(self) -> str:
        """The text of the source."""
        done: list[int] = []
        texts = self.step.functions(done)
        words, outer = self._outside(done)
        parts = [f"{{{s.at}, {s.size}, {int(j == COMMAND_LINE)}}}" for j, s in enumerate(self.delayed)]
        words |= {
            "DOUBLE_STEP": number(self.file.step, "double"),
            "PARTS": ", ".join(parts),
            "PLACES": ", ".join(f"{{{s.at}, {s.size}}}" for s in self.delayed),
            "ARGUMENTS": "".join(f"{name}, " for name in self.step.arguments),
        }
        words["TABLES"] = self._tables()
        functions = "\n".join([*texts, *outer])
        used = functions + words["TABLES"]
        return self.file.source("flight.c", self.public, functions, self.has, used=used, **words)

    def _outside(self, done: list[int]) -> tuple[dict[str, str], list[str]]:
        """(Calls in the text, the functions that they call)."""
        m, hand = self.model, self.assembled.given.hand.start
        unit, words, texts = self.file.unit, dict[str, str](), list[str]()

        def add(function: Any, arguments: dict[str, Any], given: dict[str, str]) -> None:
            law = unit.laws.trace(function, arguments)
            texts.extend(new_functions(unit, law, done))
            words[function.__name__.upper()] = call_text(unit, law, given)

        span = {"opens": 0.0, "closes": 0.0}
        add(c_limits.push_is_active, {"row": GAUSSIAN, **span}, {"row": "*row", "opens": "opens", "closes": "closes"})
        given = {"hand": "flight->hands[j]", "row": "*row", "when": "when"}
        add(c_limits.with_push, {"hand": hand, "row": GAUSSIAN, "when": 0.0}, given)
        if "gusts" in self.has:
            given = {"sum": "sum", "row": "flight->inputs.gusts[i]", "t": "t"}
            add(c_limits.with_gust, {"sum": ZERO, "row": GUST, "t": 0.0}, given)
        moving = {"model": "*model", "dt": f"{self.file.prefix.upper()}FLIGHT_STEP"}
        if "floor" in self.has:
            add(c_limits.floor_is_near, {"model": m, "dt": 0.0}, moving)
        if "walls" in self.has:
            add(c_limits.walls_are_due, {"model": m, "dt": 0.0}, moving)
            add(
                c_limits.nearest_walls, {"model": m, "row": WALL}, {"model": "*model", "row": "flight->inputs.walls[i]"}
            )
        if "draws" in self.has:
            texts += self._draws(words, done)
        return words, texts

    def _draws(self, words: dict[str, str], done: list[int]) -> list[str]:
        """The functions that draw random numbers: in doubles, whose bits they use."""
        unit = Unit("double", "drawn_", self.file.unit.names) if self.file.real == "float" else self.file.unit
        law = unit.laws.trace(c_limits.draw_normals, {"number": 0, "draw": 0, "key0": 0.0, "key1": 0.0})
        given = {"number": "k", "draw": "i", "key0": "keys[0]", "key1": "keys[1]"}
        words["DRAW_NORMALS"] = call_text(unit, law, given)
        words["DRAWS"] = str(-(-leaves(self.templates.given.noise) // 4))
        words["NORMALS"] = unit.structs.of(law.result).name
        texts = new_functions(unit, law, done if unit is self.file.unit else [])
        if unit is self.file.unit:
            return texts
        own = [struct.definition("", "double") for struct in unit.structs.all.values()]
        return ["\n".join([*own, ""]), *texts]

    def _tables(self) -> str:
        """The constants of the mission: numbers at the start, and tables."""
        texts = [self.file.constant(self.model, "START")]
        names, members = ("pushes", "gusts", "walls", "legs"), list[str]()
        counts = ("push_count", "gust_count", "wall_count", "leg_count")
        for name, count, like, rows, has in zip(
            names, counts, ROWS, self.assembled.tables, self._has_tables, strict=True
        ):
            if not has:
                continue
            members += [f"    .{name} = {name.upper() if len(rows) else 0},", f"    .{count} = {len(rows)},"]
            if len(rows):
                kind = self.file.unit.structs.of(like).name
                lines = [f"    {self.file.initialiser(rebuilt(iter(map(float, row)), like))}," for row in rows]
                texts.append("\n".join([f"static const {kind} {name.upper()}[] = {{", *lines, "};", ""]))
        if "delays" in self.has:
            members.append(f"    .delays = {{{', '.join(str(int(d)) for d in self.assembled.delays)}}},")
        members.append(f"    .keys = {{{', '.join(number(float(x), 'double') for x in self.assembled.seeds)}}},")
        kind = f"{self.file.prefix}Inputs"
        texts.append("\n".join([f"static const {kind} INPUTS = {{", *members, "};", ""]))
        if "walls" in self.has:
            texts.append(self.file.constant(self.templates.nowhere, "NOWHERE"))
        return "\n".join(texts)


def new_functions(unit: Unit, law: TracedLaw, done: list[int]) -> list[str]:
    """The functions of a law and of those that it calls, without those that are done."""
    texts = []
    for one in [*unit.reached(law.graph, [s.node for s in law.ends]), law.number]:
        if one not in done:
            done.append(one)
            texts.append(law_function(unit, one))
    return texts


def call_text(unit: Unit, law: TracedLaw, given: dict[str, str]) -> str:
    """A call of a law's function; `given`: a value in C for each argument."""
    signature, names = unit.signature(law.number), list(law.arguments)
    texts, starts = [], dict[int, str]()
    first = 0
    for name in names:
        starts[first] = name
        first += count_of(law.arguments[name])
    for p in signature.parameters:
        value = given[starts[p.first]]
        texts.append((value[1:] if value.startswith("*") else f"&{value}") if p.pointer else value)
    return f"{signature.name}({', '.join(texts)})"


def count_of(value: Any) -> int:
    """Numbers of an argument."""
    return leaves(value) if hasattr(value, "_fields") else 1
