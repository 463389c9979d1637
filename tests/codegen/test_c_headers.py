"""The headers of a mission in C: one source includes them all, in C99 and in C++."""

import subprocess
from typing import Any, NamedTuple

from c_flights import STRICT

import tandemlift as tl
from tandemlift.codegen.c.types import Names, Structs
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
    second.adopt(first.all.values())
    assert second.of(Pair(Pair(3.0, 4.0), 1.0)).name == "Pair_3"
    assert second.of(Pair(3.0, Pair(1.0, 4.0))) == outer
    assert second.of(Pair(5.0, 6.0)) == inner
    assert (inner.name, outer.name) == ("Pair", "Pair_2")
