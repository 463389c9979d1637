"""`make mutation-check` makes mistakes where they can be made, laws included, and knows why it leaves some out."""

import ast
import importlib
import json
import os
import subprocess
import sys

import mutation_check
from for_all import for_all
from mutants.operators import mutants
from repository import ROOT

LAW = b"""@law
def pull(k, m, dt):
    \"\"\"Text + more.\"\"\"
    force = -k.stiffness * (m.x - 0.5)
    return where(force < k.limit, clip(force, 0.0, 1.0), minimum(force, dt))


@pull.register(Spring)
def _spring(k, m):
    return cross(k, m) if not k else ahead(m, k, 1e-12)
"""


MISTAKES = [
    "pull: -k.stiffness * (m.x - 0.5) -> -k.stiffness / (m.x - 0.5)",
    "pull: -k.stiffness -> k.stiffness",
    "pull: m.x - 0.5 -> m.x + 0.5",
    "pull: m.x - 0.5 -> m.x",
    "pull: m.x -> m.y",
    "pull: 0.5 -> 1.0",
    "pull: force < k.limit -> force <= k.limit",
    "pull: force < k.limit -> force > k.limit",
    "pull: clip(force, 0.0, 1.0) -> force",
    "pull: minimum(force, dt) -> maximum(force, dt)",
    "_spring: cross(k, m) -> cross(m, k)",
    "_spring: not k -> k",
]


@for_all(MISTAKES)
def test_each_kind_of_mistake_is_made_in_laws_and_their_variants(mistake):
    found = {m.name: m for m in mutants("a.py", LAW)}
    mutant = found[f"a.py: {mistake}"]
    assert mutant.is_law
    wanted = mistake.partition(": ")[2].partition(" -> ")
    assert ast.unparse(ast.parse(mutant.made_in(LAW))) == ast.unparse(
        ast.parse(LAW.replace(wanted[0].encode(), f"({wanted[2]})".encode(), 1))
    )
    assert not [name for name in found if "Text" in name or "1e-12 ->" in name]


OF_LAWS = ("parts", "parts/estimation/wrench")
FLOWN = ("parts", "simulation", "analysis/studies")  # the rooms of a flight and of studies; the others are beside them


def test_300_mistakes_are_drawn_in_flights_and_200_beside_each_can_be_compiled_and_no_two_are_one():
    drawn = {room: mutation_check.drawn(room, 25) for room in mutation_check.ROOMS}
    assert [len(many) for many in drawn.values()] == [count for count, _ in mutation_check.ROOMS.values()]
    every, flown = [m for many in drawn.values() for m in many], [m for room in FLOWN for m in drawn[room]]
    assert len(flown) >= 300
    of_laws = [m.is_law for room in OF_LAWS for m in drawn[room]]
    assert sum(of_laws) >= len(of_laws) / 2
    assert len(every) - len(flown) >= 200
    assert len({m.name for m in every}) == len(every)
    for m in every[::5]:
        source = (mutation_check.PACKAGE / m.file).read_bytes()
        assert ast.dump(ast.parse(m.made_in(source))) != ast.dump(ast.parse(source)), m.name


def test_who_flies_a_compiled_loop_has_called_the_laws_that_were_traced_for_it(tmp_path):
    """Also where the code comes from memory or disk: in a process of its own, as its plugin follows every call."""
    brief = "{'mission.duration': 0.01}"
    test = f"def test_it():\n    import tandemlift as tl\n    tl.fly(tl.load_mission('one-push', {brief}))\n"
    (tmp_path / "test_a.py").write_text(test + test.replace("test_it", "test_again"), "utf-8")
    (tmp_path / "traced").mkdir()
    run = (
        "import sys, pytest\nfrom pathlib import Path\nfrom mutants.touched import Touched\n"
        "package, here = map(Path, sys.argv[1:])\n"
        "plugin = Touched(package, ['parts/mechanics/'], here / 'traced', here / 'calls.json')\n"
        "sys.exit(pytest.main([str(here), '-q', '-p', 'no:cacheprovider', '-p', 'no:xdist'], plugins=[plugin]))\n"
    )
    command = [sys.executable, "-c", run, str(mutation_check.PACKAGE), str(tmp_path)]
    path = os.pathsep.join([str(ROOT / "src"), str(ROOT / "tools")])
    subprocess.run(command, cwd=tmp_path, env=os.environ | {"PYTHONPATH": path}, check=True)
    said = json.loads((tmp_path / "calls.json").read_text("utf-8"))
    assert len(said) == 2
    for _, called in said.values():
        assert any(name.startswith("parts/mechanics/rigid_body.py: ") for name in called)


def test_what_a_process_forgets_between_mutants_is_where_the_list_says():
    source = (ROOT / "tools" / "mutants" / "trials.py").read_text("utf-8")
    (remembered,) = (
        ast.literal_eval(node.value)
        for node in ast.parse(source).body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "REMEMBERED"
    )
    for module, (name, forget) in remembered.items():
        assert callable(getattr(getattr(importlib.import_module(f"tandemlift.{module}"), name), forget))
