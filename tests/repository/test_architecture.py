"""architecture.md describes what stands: each name in it exists, and a push walks as it says."""

import importlib
import re

import pytest
from for_all import for_all
from repository import ROOT

import tandemlift as tl

TEXT = (ROOT / "docs" / "explanation" / "architecture.md").read_text("utf-8")
PACKAGE = ROOT / "src" / "tandemlift"
ROOMS = sorted(p.stem for p in PACKAGE.iterdir() if p.is_dir() or p.suffix == ".py")
DOTTED = sorted(set(re.findall(rf"`((?:{'|'.join(ROOMS)})(?:\.\w+)+)`", TEXT)))
PATHS = sorted(set(re.findall(r"`(\w+/(?:\w+/)*\w+\.py)`", TEXT)))
JOINED = re.sub(r"\n {3,}", " ", TEXT)  # an item of a list in one line
WALK = re.findall(r"^\d+\. .*: (`.*) → (.*)$", JOINED, flags=re.M)


def found(name):
    """What a dotted name below `tandemlift` names."""
    *modules, last = ["tandemlift", *name.split(".")]
    try:
        return importlib.import_module(".".join([*modules, last]))
    except ModuleNotFoundError:
        return getattr(importlib.import_module(".".join(modules)), last)


@for_all(DOTTED)
def test_each_dotted_name_exists(name):
    assert found(name) is not None


@for_all(PATHS)
def test_each_file_exists(path):
    assert (PACKAGE / path).is_file()


def test_the_walk_of_a_push_names_a_function_and_a_type_at_each_station():
    assert WALK
    for function, handed_on in WALK:
        names = re.findall(r"`([\w.]+)`", function)
        assert names
        assert all(callable(found(name)) for name in names), function
        types = re.findall(r"`([\w.]+)`", handed_on)
        assert all(isinstance(found(name), type) for name in types), handed_on


def test_a_push_walks_from_the_mission_to_the_rotors_and_into_the_flight():
    changes = {"mission.duration": 1.0, "phases.lift_start": 20.0, "pushes": []}
    push = {"force": [2.0, 0.0, 0.0], "time": 0.5, "sigma": 0.1}
    still, pushed = (tl.fly(tl.load_mission("hover", {**changes, "pushes": pushes})) for pushes in ([], [push]))
    assert abs(pushed["push_force"] - still["push_force"]).max() == pytest.approx(2.0, rel=1e-3)
    for station in ("admittance_position", "reference_position", "moment", "rotor_thrusts", "position"):
        assert abs(pushed[station] - still[station]).max() > 1e-6, station
