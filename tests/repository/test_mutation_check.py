"""`make mutation-check` makes mistakes where they can be made, laws included, and knows why it leaves some out."""

import ast
import importlib
import json
import os
import shutil
import sys
import tomllib

import mutation_check
import pytest
from house import PACKAGE
from mutants.operators import mutants
from patience import completed
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


@pytest.mark.parametrize(
    "mistake",
    [
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
    ],
)
def test_each_kind_of_mistake_is_made_in_laws_and_their_variants(mistake):
    found = {m.name: m for m in mutants("a.py", LAW)}
    mutant = found[f"a.py: {mistake}"]
    assert mutant.is_law
    wanted = mistake.partition(": ")[2].partition(" -> ")
    assert ast.unparse(ast.parse(mutant.made_in(LAW))) == ast.unparse(
        ast.parse(LAW.replace(wanted[0].encode(), f"({wanted[2]})".encode(), 1))
    )
    assert not [name for name in found if "Text" in name or "1e-12 ->" in name]


def test_at_least_300_mistakes_are_drawn_more_than_half_in_laws_each_can_be_compiled_and_no_two_are_one():
    every = [m for room in mutation_check.ROOMS for m in mutation_check.drawn(room, 320, 25)]
    assert len(every) >= 300
    assert sum(m.is_law for m in every) > len(every) / 2
    assert len({m.name for m in every}) == len(every)
    sources = {file: (mutation_check.PACKAGE / file).read_bytes() for file in {m.file for m in every}}
    trees = {file: ast.dump(ast.parse(source)) for file, source in sources.items()}
    assert [m.name for m in every if ast.dump(ast.parse(m.made_in(sources[m.file]))) == trees[m.file]] == []


def test_a_mistake_that_no_test_can_notice_has_a_reason_in_a_line():
    reasons = tomllib.loads(mutation_check.REASONS.read_text("utf-8"))["equivalent"]
    assert [name for name, why in reasons.items() if len(why) < 20 or "\n" in why] == []


def test_what_a_process_forgets_between_mutants_is_where_the_list_says():
    source = (ROOT / "tools" / "mutants" / "trials.py").read_text("utf-8")
    (remembered,) = (
        ast.literal_eval(node.value)
        for node in ast.parse(source).body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "REMEMBERED"
    )
    for module, (name, forget) in remembered.items():
        assert callable(getattr(getattr(importlib.import_module(f"tandemlift.{module}"), name), forget))


FLYING = """
import sys
from pathlib import Path
import pytest
from mutants.touched import Touched
package, folder = map(Path, sys.argv[1:])
(folder / "traced").mkdir()
touched = Touched(package, ["parts"], folder / "traced", folder / "calls.json")
sys.exit(pytest.main([str(folder / "test_flight.py"), "-q", "-p", "no:cacheprovider"], plugins=[touched]))
"""


def test_whoever_flies_has_called_the_laws_that_are_compiled_for_the_flight(tmp_path):
    fly = 'tl.fly(tl.load_mission("hover", {"mission.duration": 0.1}))'
    (tmp_path / "test_flight.py").write_text(f"import tandemlift as tl\n\ndef test_flight():\n    {fly}\n")
    paths = os.pathsep.join(map(str, (ROOT / "tools", PACKAGE.parent)))
    command = [sys.executable, "-c", FLYING, str(PACKAGE), str(tmp_path)]
    for _ in range(2):  # compiled, and read from disk
        shutil.rmtree(tmp_path / "traced", ignore_errors=True)
        completed(command, env={**os.environ, "PYTHONPATH": paths}, capture_output=True, check=True)
        ((_, called),) = json.loads((tmp_path / "calls.json").read_text()).values()
        assert "parts/mechanics/rigid_body.py: rigid_body_motion" in called
