"""The C sources of the three FMUs of a mission: its code (`c_package`), and the functions of FMI on top of it."""

from __future__ import annotations

import re
from typing import Any, NamedTuple

from tandemlift.codegen import fmu_variables
from tandemlift.codegen.c.expressions import number
from tandemlift.codegen.c.source import SourceFile
from tandemlift.codegen.c_flight import FlightFile
from tandemlift.codegen.c_package import source_file, with_hash
from tandemlift.codegen.c_pilot import PilotFile
from tandemlift.codegen.number_facts import facts_of
from tandemlift.codegen.prepare import PrepareFile, prepared_numbers
from tandemlift.compiler.tracer import symbols
from tandemlift.core.types import flat, leaves
from tandemlift.missions import Mission
from tandemlift.simulation.graphs import TracedAssembly, VehicleStep, is_of_vehicle, trace_assembly, with_values
from tandemlift.simulation.pilot_api import INPUT, pilot_at_start
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.results import channel_columns

PARTS = {
    "pilot": "the pilot: state and push in, thrusts out",
    "vehicle": "the vehicle without pilot: thrusts and push in; readings, state, joint wrenches out",
    "flight": "the whole flight: pilot, rotors, sensors and body",
}


PREFIX = """
/* A program with the sources of several FMUs compiles those of each with its own FMI2_FUNCTION_PREFIX, or
 * FMI3_FUNCTION_PREFIX, as in the headers of the standards: it stands before all names that other files see. */
#if defined(FMI3_FUNCTION_PREFIX) && !defined(FMI2_FUNCTION_PREFIX)
#define FMI2_FUNCTION_PREFIX FMI3_FUNCTION_PREFIX
#endif
#if defined(FMI2_FUNCTION_PREFIX) && !defined(FMU_NAME)
#define FMU_PASTE(a, b) a##b
#define FMU_JOIN(a, b) FMU_PASTE(a, b)
#define FMU_NAME(name) FMU_JOIN(FMI2_FUNCTION_PREFIX, name)
{}
#endif
"""


class FmuPart(NamedTuple):
    """An FMU before it is compiled.

    Attributes:
        identifier: of the model, in C.
        meaning: in words.
        variables: parameters, inputs and outputs.
        texts: of its sources by name; the mark `/*@TOKEN@*/` is left in `…_fmu.h`.
        step: [s].
        duration: of the mission [s].
    """

    identifier: str
    meaning: str
    variables: list[fmu_variables.FmuVariable]
    texts: dict[str, str]
    step: float
    duration: float


def pilot_part(mission: Mission) -> FmuPart:
    """The pilot of a mission, which is portable."""
    file, traced = source_file(mission), trace_assembly(mission, pilot_at_start)
    pilot, facts = PilotFile(file, with_values(traced.assembled, traced.graph)), facts_of(mission, traced.keys)
    prepare = PrepareFile(file.anew(), traced, "pilot")
    effective = _effective(traced, [*symbols(traced.graph, traced.assembled), *_conditions(traced)])
    count, start = len(traced.keys), [float(x) for x in flat(INPUT)]
    tunable = _effective(traced, symbols(traced.graph, traced.assembled.parameters))
    found = [*fmu_variables.parameters(traced, facts, effective, tunable), *fmu_variables.pilot_inputs(count, start)]
    found.append(fmu_variables.thrust_output(count + len(start), len(pilot.thrusts)))
    code = {"pilot.c": pilot.source(), "pilot.h": pilot.header()}
    code |= {"pilot_prepare.c": prepare.source(), "pilot_prepare.h": prepare.header(facts)}
    words = {"STARTS": _numbers(start), "ENDS": "", "PLACES": "", "COPIES": ""}
    return _part(file, mission, "pilot", traced, found, code, words)


def flight_part(mission: Mission, part: str) -> FmuPart:
    """The whole flight of a mission, which is portable, or its vehicle: `part` is "flight" or "vehicle"."""
    is_whole, plan, traced = part == "flight", FlightPlan(mission, interactive=True), trace_assembly(mission)
    step: Any = {} if is_whole else {"step": VehicleStep}
    file, facts = source_file(mission), facts_of(mission, traced.keys)
    flight, prepare = FlightFile(file, plan, **step), PrepareFile(file.anew(), traced, "flight")
    found, spans = prepared_numbers(traced)
    tunable = _tunable(traced, found)
    if is_whole:
        found += _conditions(traced)
    else:
        used, model = VehicleStep(flight.templates, fuses=False, rolls=False).used(), spans["flight"].columns
        found = [x for i, x in enumerate(found) if i >= model or i in used]
    count, external = len(traced.keys), plan.given.external
    names = [name for name in channel_columns(plan.sample) if is_whole or is_of_vehicle(name)]
    shown, places = fmu_variables.outputs(flight.templates.sample, count + leaves(external), names)
    variables = [*fmu_variables.parameters(traced, facts, _effective(traced, found), tunable)]
    variables += [*fmu_variables.caller_inputs(external, count, has_pilot=is_whole), *shown]
    code = {"flight.c": flight.source(), "flight.h": flight.header()}
    code["flight_prepare.c"] = prepare.source(flight.traced_tables)
    code["flight_prepare.h"] = prepare.header(facts, flight.traced_tables)
    upper = file.prefix.upper()
    words = {
        "STARTS": _numbers([0.0] * leaves(external)),
        "PLACES": ", ".join(map(str, places)),
        "COPIES": "\n".join(f"    prepared->inputs.{name} = prepared->{name};" for name, *_ in flight.traced_tables),
        "ENDS": f" || flight->k == {upper}FLIGHT_STEPS" if is_whole else "",
    }
    return _part(file, mission, part, traced, variables, code, words)


def _numbers(values: list[float]) -> str:
    return ", ".join(number(x, "double") for x in values)


def _conditions(traced: TracedAssembly) -> list[Any]:
    return [guard.condition for guard in traced.guards]


def _effective(traced: TracedAssembly, results: list[Any]) -> set[int]:
    """The inputs of an assembly that its results depend on."""
    graph = traced.graph
    return {graph.args[n][1] for n in graph.needed([s.node for s in results]) if graph.ops[n] == "in"}


def _tunable(traced: TracedAssembly, found: list[Any]) -> set[int]:
    """The inputs of an assembly on which parameters of a flight depend, and neither body nor delays nor tables."""
    changing, kept, at = list[Any](), list[Any](), 0
    for name, part in traced.assembled.model._asdict().items():
        own, at = found[at : at + leaves(part)], at + leaves(part)
        if name != "flight_state":  # which has begun
            (kept if name in ("plant", "delays") else changing).extend(own)
    return _effective(traced, changing) - _effective(traced, [*kept, *found[at:]])


def _part(
    file: SourceFile,
    mission: Mission,
    part: str,
    traced: TracedAssembly,
    variables: list[fmu_variables.FmuVariable],
    code: dict[str, str],
    words: dict[str, str],
) -> FmuPart:
    """The part with the sources of FMI beside its code."""
    kind = "pilot" if part == "pilot" else "flight"
    count, outs = len(traced.keys), [v for v in variables if v.causality == "output"]
    last = outs[-1]
    sizes = [0] * (last.at + len(last.labels))
    for variable in variables:
        sizes[variable.at] = len(variable.labels)
    guards = [f'    "{", ".join(traced.keys_of(guard))}",' for guard in traced.guards]
    words |= {
        "TOKEN": "/*@TOKEN@*/",
        "DOUBLE_STEP": number(file.step, "double"),
        "PARAMETERS": str(count),
        "INPUTS": str(outs[0].at - count),
        "OUTPUTS": str(len(sizes) - outs[0].at),
        "PART": kind,
        "NUMBERS": f"{file.prefix}{kind.capitalize()}Numbers",
        "SIZES": _lines(sizes),
        "BOUNDS": "\n".join(_bounds(traced, variables)),
        "GUARDS": "\n".join(guards),
        "NAMES": "\n".join(f'    "{name}",' for v in variables if v.causality == "input" for name in v.labels),
    }
    api = ["fmi2.c", "fmi3.c", "fmu.c", "fmu.h", "fmu_values.c"]  # a library speaks both versions
    texts = {f"{file.prefix}{name}": text for name, text in code.items()}
    texts |= {f"{file.prefix}{name}": file.filled(name, {kind}, **words) for name in ("checks.h", *api)}
    texts[f"{file.prefix}checks.h"] += _prefixed("\n".join(texts.values()), file.prefix)
    texts = with_hash(mission, texts)
    return FmuPart(f"{file.prefix}{part}", PARTS[part], variables, texts, file.step, mission.mission.duration)


def _prefixed(code: str, mission: str) -> str:
    """Macros for a program with the sources of several FMUs: a prefix before all names that other files see."""
    types = re.findall(r"^NO_SUCH_TYPE\((\w+)", code, re.MULTILINE)
    names = {f"fmi{version}{verb}{kind}" for version in "23" for verb in ("Get", "Set") for kind in types}
    names.update(re.findall(rf"\b(?:fmi[23][A-Z]|fmu_[a-z]|{mission}(?:pilot|flight)_[a-z])\w*", code))
    return PREFIX.format("\n".join(f"#define {name} FMU_NAME({name})" for name in sorted(names)))


def _lines(sizes: list[int]) -> str:
    return ",\n".join("    " + ", ".join(map(str, sizes[i : i + 32])) for i in range(0, len(sizes), 32))


def _bounds(traced: TracedAssembly, variables: list[fmu_variables.FmuVariable]) -> list[str]:
    """A row of key, bounds and whether it is tunable for each number of the mission; NaN is in no bounds."""
    of = {v.at + i: v for v in variables for i in range(len(v.labels)) if v.causality == "parameter"}
    rows = list[str]()
    for i, key in enumerate(traced.keys):
        own = of[i].bounds if i in of else {}
        can_change = str(i in of and of[i].is_tunable).lower()
        least = own.get("minimum", own.get("exclusiveMinimum", -float("inf")))
        most = own.get("maximum", own.get("exclusiveMaximum", float("inf")))
        ends = f"{number(float(least), 'double')}, {number(float(most), 'double')}"
        is_open = [str(f"exclusive{end}" in own).lower() for end in ("Minimum", "Maximum")]
        rows.append(f'    {{"{key}", {ends}, {", ".join([*is_open, can_change])}}},')
    return rows
