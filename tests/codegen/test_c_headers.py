"""The headers of a mission in C: one source includes them all, in C99 and in C++."""

import re
import subprocess
from typing import Any, NamedTuple

import pytest
from c_flights import STRICT
from repository import ROOT

import tandemlift as tl
from tandemlift.codegen.c.names import Names
from tandemlift.codegen.c.types import Structs
from tandemlift.codegen.c_package import code_texts, written
from tools import need

USE = """#include "{p}_flight_prepare.h"
#include "{p}_pilot_prepare.h"
#include "{p}_pilot.h"
int main(void)
{{
    static {p}_PilotData pilot;
    static {p}_Prepared flight;
    {p}_PilotInput input = {p}_PilotInput();
    {p}_State *state = &input.state; /* one type in both headers */
    {p}_State *flown = &flight.model.flight_state.state;
    *state = *flown;
    return {p}_pilot_prepare(&{p}_pilot_numbers, &pilot) || {p}_flight_prepare(&{p}_flight_numbers, &flight);
}}
"""


def test_a_program_in_c_or_in_cpp_includes_all_headers_and_prepares_both_parts(tmp_path):
    need("gcc", "g++")
    name = "hover"
    files = written(code_texts(tl.load_mission(name)), tmp_path)
    sources, objects = [f for f in files if f.suffix == ".c"], []
    for source in sources:
        objects.append(source.with_suffix(".o"))
        subprocess.run(["gcc", *STRICT, "-O0", "-c", source, "-o", objects[-1]], check=True)
    text = USE.format(p=name)
    for compiler, standard, ending in (("gcc", "c99", "c"), ("g++", "c++11", "cpp")):
        use, program = tmp_path / f"use.{ending}", tmp_path / f"use-{ending}"
        use.write_text(text.replace(f" = {name}_PilotInput()", " = {0}") if ending == "c" else text)
        options = [f"-std={standard}", *STRICT[1:], "-O0"]
        subprocess.run([compiler, *options, use, *objects, "-o", program, "-lm"], check=True)
        subprocess.run([program], check=True)


class Pair(NamedTuple):
    """Of two numbers, or of anything else."""

    a: Any
    b: Any


def test_a_type_of_another_layout_has_a_name_that_the_other_header_does_not_have():
    first, second = Structs(Names()), Structs(Names())
    inner = first.of(Pair(1.0, 2.0))
    outer = first.of(Pair(1.0, Pair(1.0, 2.0)))
    second.agree(first.all.values())
    assert second.of(Pair(Pair(3.0, 4.0), 1.0)).name == "Pair_3"
    assert second.of(Pair(3.0, Pair(1.0, 4.0))) == outer
    assert second.of(Pair(5.0, 6.0)) == inner
    assert (inner.name, outer.name) == ("Pair", "Pair_2")


LAWS = "sample evaluate time_of sum_pushes advance_flight asinh copysign erfc strlen main solve elementary_exp cosf"
CLASSES = "Flight Inputs Prepared PilotNumbers FlightNumbers START Sample State PilotMemory PUSHES"
FIELDS = "NAN asm alignas nullptr constexpr M_PI position"


def controller_with_names_of_c(path):
    """A controller whose laws, classes and fields have names that the C around them has, too."""
    text = (ROOT / "docs" / "reference" / "listings" / "my_pd.py").read_text("utf-8")
    laws = "\n\n".join(f"@law\ndef {name}(x):\n    return x * 2.0" for name in LAWS.split())
    fields = "\n".join(f"    {field}: Number" for field in FIELDS.split())
    classes = "\n\n".join(f"class {name}(NamedTuple):\n{fields}" for name in CLASSES.split())
    text = text.replace("class Gains(", f"{laws}\n\n\n{classes}\n\n\nclass Gains(")
    members = "\n".join(f"    own_{name.lower()}: {name}" for name in CLASSES.split())
    text = text.replace("    mass: Number  # kg\n", f"    mass: Number  # kg\n{members}\n")
    chain = "(".join(LAWS.split()) + "(k.own_state.NAN" + ")" * len(LAWS.split())
    text = text.replace("    force = (", f"    force = UP * {chain} + (")
    values = ", ".join("0.0" for _ in FIELDS.split())
    given = "".join(f"        own_{name.lower()}={name}({values}),\n" for name in CLASSES.split())
    path.write_text(text.replace("        mass=vehicle.mass,\n", f"        mass=vehicle.mass,\n{given}"), "utf-8")
    return tl.load_controller(path)


@pytest.mark.thorough
def test_another_law_with_the_same_keys_has_another_hash(tmp_path):
    found, path = [], tmp_path / "my_pd.py"
    text = (ROOT / "docs" / "reference" / "listings" / "my_pd.py").read_text("utf-8")
    for factor in ("k.damping", "k.damping * 0.5"):
        path.write_text(text.replace("de * k.damping", f"de * {factor}"), "utf-8")
        texts = code_texts(tl.load_mission("hover", controller=tl.load_controller(path)))
        found.append(re.search(r"the hash ([0-9a-f]{16});", texts["hover_pilot.h"])[1])
        assert all(found[-1] in texts[name] for name in texts if name.endswith("t.h") or name == "README.md")
    assert found[0] != found[1]


@pytest.mark.parametrize("single", [False, True])
def test_names_of_a_controller_are_never_those_of_the_code_around_it(single, tmp_path):
    need("gcc", "g++")
    mission = tl.load_mission("hover", controller=controller_with_names_of_c(tmp_path / "own_pd.py"))
    texts = code_texts(mission, single)
    for source in [f for f in written(texts, tmp_path / "c") if f.suffix == ".c"]:
        subprocess.run(["gcc", *STRICT, "-fsyntax-only", source], check=True)
    include = "#include <cmath>\n#include <cstdio>\n" + USE.format(p="hover")
    command = ["g++", "-std=c++20", *STRICT[1:], "-fsyntax-only", f"-I{tmp_path / 'c'}", "-x", "c++", "-"]
    subprocess.run(command, input=include, text=True, check=True)
    bodies = {name: body for body, name in re.findall(r"struct \{\n([^}]+)\} (\w+);", texts["hover_flight.h"])}
    assert "world: position of the centre of mass" in bodies["hover_State"]
    own = re.findall(r"^ +\w+ (\w+);$", bodies["hover_State_2"], re.MULTILINE)  # without comments of other classes
    assert own == ["NAN_", "asm_", "alignas_", "nullptr_", "constexpr_", "M_PI_", "position"]
    assert "hover_Vec3 position;" in bodies["hover_Sample"]
