"""The descriptions of an FMU: modelDescription.xml of FMI 2.0 and 3.0, and buildDescription.xml."""

from __future__ import annotations

import re
from collections.abc import Iterator
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from tandemlift.codegen.fmu_sources import FmuPart
from tandemlift.codegen.fmu_variables import FmuVariable
from tandemlift.core.files import __version__

FLAGS = "-std=c99 -O2 -ffp-contract=off"  # no fused multiply-add: each operation is rounded by itself
BASE = {  # units by the exponents of SI's
    "kg": {"kg": 1},
    "m": {"m": 1},
    "s": {"s": 1},
    "rad": {"rad": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2},
    "Hz": {"s": -1},
    "1": {},
}
RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
FACTOR = re.compile(r"([A-Za-z]+|1)(?:\^?(-?\d+))?")


def base_unit(unit: str) -> dict[str, int] | None:
    """The exponents of SI's base units in a unit such as "N s/m"; None for one with other powers or two meanings."""
    plain = unit.replace("²", "^2").replace("³", "^3").replace("·", " ").translate(RAISED)
    plain = re.sub(r"\(([^()]+)\)", lambda m: m[1].replace("/", "~"), plain)  # N/(rad/s)²: handled below
    if "~" in plain:
        inside = re.fullmatch(r"(\w+)/(\w+)~(\w+)\^(\d)", plain)
        plain = f"{inside[1]} {inside[3]}^{inside[4]}/{inside[2]}^{inside[4]}" if inside else "?"
    found = dict[str, int]()
    for i, side in enumerate(plain.split("/")):
        for factor in side.split():
            match = FACTOR.fullmatch(factor)
            if match is None or match[1] not in BASE:
                return None
            for name, power in BASE[match[1]].items():
                found[name] = found.get(name, 0) + power * int(match[2] or 1) * (-1 if i else 1)
    return {name: power for name, power in found.items() if power}


def model_description(part: FmuPart, fmi: int, token: str) -> bytes:
    """modelDescription.xml of a part for a version of FMI."""
    root = Element("fmiModelDescription", fmiVersion=f"{fmi}.0", modelName=part.identifier)
    root.set("guid" if fmi == 2 else "instantiationToken", token)
    root.set("description", f"{part.meaning}; outputs are at the current time, from the inputs of the last step")
    root.set("generationTool", f"tandemlift {__version__}")
    root.set("variableNamingConvention", "flat")
    simulation = SubElement(root, "CoSimulation", modelIdentifier=part.identifier)
    simulation.set("canHandleVariableCommunicationStepSize", "false")
    state = "FMUstate" if fmi == 2 else "FMUState"
    for ability in (f"canGetAndSet{state}", f"canSerialize{state}"):
        simulation.set(ability, "true")
    if fmi == 2:
        simulation.set("canNotUseMemoryManagementFunctions", "true")
        files = SubElement(simulation, "SourceFiles")
        for name in sources(part):
            SubElement(files, "File", name=name)
    else:
        simulation.set("fixedInternalStepSize", repr(part.step))
    _add_units(SubElement(root, "UnitDefinitions"), part)
    categories = SubElement(root, "LogCategories")
    for name in ("logStatusError", "logStatusDiscard", "logStatusWarning"):
        SubElement(categories, "Category", name=name)
    SubElement(root, "DefaultExperiment", startTime="0", stopTime=repr(part.duration), stepSize=repr(part.step))
    (_add_scalars if fmi == 2 else _add_arrays)(root, part.variables)
    return _written(root)


def sources(part: FmuPart) -> list[str]:
    """The names of the files of C that are compiled."""
    return [name for name in part.texts if name.endswith(".c")]


def build_description(part: FmuPart) -> bytes:
    """buildDescription.xml of FMI 3.0."""
    root = Element("fmiBuildDescription", fmiVersion="3.0")
    build = SubElement(root, "BuildConfiguration", modelIdentifier=part.identifier)
    files = SubElement(build, "SourceFileSet", language="C99", compilerOptions=FLAGS)
    for name in sources(part):
        SubElement(files, "SourceFile", name=name)
    return _written(root)


def _written(root: Element) -> bytes:
    indent(root, " ")
    text: bytes = tostring(root, "UTF-8", xml_declaration=True)
    return text + b"\n"


def _add_units(element: Element, part: FmuPart) -> None:
    for unit in sorted({"s"} | {v.channel.unit for v in part.variables if not v.is_truth} - {""}):
        base = base_unit(unit)
        own = SubElement(element, "Unit", name=unit)
        if base is not None:
            SubElement(own, "BaseUnit", {name: str(power) for name, power in base.items()})


def _facts(variable: FmuVariable, fmi: int) -> dict[str, str]:
    """The attributes of unit and bounds, which may be open in a mission; they are closed here."""
    facts = dict[str, str]()
    if variable.is_truth:
        return facts
    if variable.channel.unit:
        facts["unit"] = variable.channel.unit
    for name, keys in {"min": ("minimum", "exclusiveMinimum"), "max": ("maximum", "exclusiveMaximum")}.items():
        for key in keys:
            if key in variable.bounds:
                facts[name] = repr(float(variable.bounds[key]))
    return facts


def _number(x: float) -> str:
    """A number of XML Schema."""
    return {"inf": "INF", "-inf": "-INF"}.get(text := repr(float(x)), text)


def _common(variable: FmuVariable) -> dict[str, str]:
    """The attributes that a variable has in both versions."""
    found = {"causality": variable.causality}
    if variable.causality == "parameter":
        found |= {"variability": "tunable" if variable.is_tunable else "fixed"}
    elif variable.is_truth:
        found |= {"variability": "discrete"}
    return found


def _scalars(variables: list[FmuVariable]) -> Iterator[tuple[FmuVariable, int]]:
    return ((v, i) for v in variables for i in range(len(v.labels)))


def _add_scalars(root: Element, variables: list[FmuVariable]) -> None:
    """The variables of FMI 2.0, a scalar for each number, and the structure of the model."""
    table, shown = SubElement(root, "ModelVariables"), list[str]()
    for count, (variable, i) in enumerate(_scalars(variables), 1):
        about = {"name": variable.labels[i], "valueReference": str(variable.at + i + 1)}
        about |= {"description": variable.description} | _common(variable)
        scalar = SubElement(table, "ScalarVariable", about)
        kind = SubElement(scalar, "Boolean" if variable.is_truth else "Real", _facts(variable, 2))
        if variable.start:
            start = variable.start[i]
            kind.set("start", str(bool(start)).lower() if variable.is_truth else _number(start))
        if variable.causality == "output":
            shown.append(str(count))
    structure = SubElement(root, "ModelStructure")
    for name in ("Outputs", "InitialUnknowns"):
        unknowns = SubElement(structure, name)
        for index in shown:
            SubElement(unknowns, "Unknown", index=index)


def _add_arrays(root: Element, variables: list[FmuVariable]) -> None:
    """The variables of FMI 3.0, and the structure of the model."""
    table, structure = SubElement(root, "ModelVariables"), SubElement(root, "ModelStructure")
    time = {"name": "time", "valueReference": "0", "causality": "independent", "variability": "continuous"}
    SubElement(table, "Float64", time, description="time", unit="s")
    for variable in variables:
        about = {"name": variable.name, "valueReference": str(variable.at + 1), "description": variable.description}
        about |= _common(variable) | _facts(variable, 3)
        if variable.start:
            words = [str(bool(x)).lower() if variable.is_truth else _number(x) for x in variable.start]
            about["start"] = " ".join(words)
        own = SubElement(table, "Boolean" if variable.is_truth else "Float64", about)
        if variable.is_array:
            SubElement(own, "Dimension", start=str(len(variable.labels)))
    for name in ("Output", "InitialUnknown"):
        for variable in variables:
            if variable.causality == "output":
                SubElement(structure, name, valueReference=str(variable.at + 1))
