"""The tables of frames, topics, requests and parameters, of bags and of ROS."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from reference_tables.markdown import codes, table
from tandemlift.apps.export.coordinate_frames import FRAMES
from tandemlift.apps.export.recipes import Recipe
from tandemlift.apps.export.topics import NOT_SAMPLES, ROOT, OtherTopic, all_recipes
from tandemlift.apps.live.session.parameters import CHOICES, TUNABLE
from tandemlift.apps.ros.parameters import RATIO, SPRING
from tandemlift.apps.ros.pushes import REQUESTS
from tandemlift.apps.ros.ros2 import ONLY_ROS2
from tandemlift.apps.ros.topics import ONLY_LIVE
from tandemlift.flight.channels import CHANNELS
from tandemlift.missions import load_mission
from tandemlift.parts.mechanics.vehicle import Vehicle

HEAD = ("topic", "type, and frame", "what")
SEVERAL = 4  # channels that a cell names


def frames() -> str:
    """Every frame."""
    rows = [(f"`{f.name}`", codes(filter(None, [f.parent])), f.origin, f.axes) for f in FRAMES]
    return table(("frame", "parent", "origin", "axes"), rows)


def topics_of_every_flight() -> str:
    """The topics with a message for each sample that every flight has."""
    return _samples(_names(()))


def topics_of_some_flights() -> str:
    """The topics with a message for each sample of flights that have their channels."""
    return _samples(_names(CHANNELS) - _names(()))


def _recipes(channels: Iterable[str]) -> Iterator[Recipe]:
    """The recipes of the topics of a flight with these channels; of its joints, those of the first."""
    vehicle = Vehicle.from_settings(load_mission("hover").vehicle)
    return (recipe for recipe in all_recipes(tuple(channels), vehicle) if "joint_2" not in recipe.name)


def _names(channels: Iterable[str]) -> set[str]:
    return {recipe.name for recipe in _recipes(channels)}


def _samples(names: set[str]) -> str:
    return table(HEAD, [_sample(recipe) for recipe in _recipes(CHANNELS) if recipe.name in names])


def _sample(recipe: Recipe) -> tuple[str, ...]:
    channels = codes(recipe.needs[:SEVERAL]) + (", …" if len(recipe.needs) > SEVERAL else "")
    cells = [f"`{recipe.name}`", codes(filter(None, [recipe.kind, recipe.frame])), f"{recipe.meaning}: {channels}"]
    return tuple(cell.replace("joint_1", "joint_N") for cell in cells)


def other_topics() -> str:
    """The topics of bags and nodes whose messages are no samples."""
    return _others(NOT_SAMPLES)


def topics_of_nodes() -> str:
    """The topics that only a node has."""
    return _others(ONLY_LIVE)


def topics_of_ros_2() -> str:
    """The topics that stand for services and parameters in ROS 2."""
    return _others(ONLY_ROS2)


def _others(topics: Iterable[OtherTopic]) -> str:
    return table(HEAD, [(f"`{t.name}`", codes([t.kind, *t.frames]), t.meaning) for t in topics])


def requests() -> str:
    """The requests."""
    return table(("request", "what"), [(f"`{ROOT}/{name}`", meaning) for name, meaning in REQUESTS.items()])


def parameters() -> str:
    """The parameters of a node."""
    rows = [(f"`{p.key}`", p.unit, f"{p.low:g} to {p.high:g}", p.label) for p in TUNABLE if p.key not in SPRING]
    rows.append((f"`{RATIO}`", "1", "≥ 0", "D/(2 √(M K)) of axes with stiffness, else 0"))
    rows += [(f"`{key}`", "", "", "one of its choices") for key in CHOICES]
    return table(("parameter", "unit", "range", "what"), sorted(rows))
