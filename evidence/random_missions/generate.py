"""Random missions, over all keys of the schema: short valid flights, for a judge of their outcomes.

A family is a built-in mission, shortened, with some choices flipped and some entries added to its lists. Its members
share these, and so mostly the compiled loop, and differ in numbers. Everything is drawn from a seed.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping
from typing import Any, Literal, NamedTuple, get_args, get_origin

import numpy as np

from random_missions.values import varied
from tandemlift.core.errors import FlightWarning, InputError
from tandemlift.missions import Mission, load_mission, tables_of
from tandemlift.missions.key_descriptions import Key, is_of_the_package, plain, sections
from tandemlift.missions.loading import built_in
from tandemlift.parts.controllers import CONTROLLERS

Changes = dict[str, Any]

MOST_KEYS, MOST_FLIPS = 12, 3
UNPUSHED = 1000  # from this number on, a family has no pushes
TRIES = 40  # of keys for one mission; many changes do not load
OTHER_BODIES = "shape", "size", "mesh", "density", "corners", "bodies"  # of a payload that is no beam
FIXED = (
    *(
        "mission.name",
        "mission.fma",
        "mission.precision",
        "mission.log_interval",
        "person.recording",
        "changes",
        "admittance.feel",
    ),
    "allocation.notches",  # need the modes of a structure
    "excitation",  # needs lines that suit the vehicle
    *("plant.center_of_mass_offset", *(f"vehicle.payload.{key}" for key in OTHER_BODIES)),  # the judge has none of them
)
NEEDS: Mapping[tuple[str, Any], Changes] = {  # keys that a choice needs, or excludes
    ("actuators.model", "ideal"): {"ground.effect": False, "faults": []},
    ("ground.model", "none"): {
        **{"ground.effect": False, "walls": [], "corridor.centreline": [], "phases.rotors": "always"},
        "actuators.start": "hover",
    },
    ("ground.effect", True): {"ground.model": "floor", "actuators.model": "rotors"},
    ("phases.rotors", "flight"): {"ground.model": "floor"},
    ("sensors.model", "none"): {
        **{"pilot.state": "truth", "pilot.push": "truth", "sensor_faults": [], "sensors.additional": []},
    },
    ("pilot.guidance", "scheduled"): {"supervision.model": "none", "requests": [], "estimator.tare": "at-time"},
    ("supervision.model", "on"): {"pilot.guidance": "interactive"},
    ("estimator.tare", "hover"): {"pilot.guidance": "interactive"},
    ("estimator.identify_mass", True): {"estimator.tare_start": 3.2},
    ("observer.model", "extended-state"): {"allocation.method": "constrained"},
    ("observer.model", "super-twisting"): {"allocation.method": "constrained"},
    ("detection.model", "residual"): {"allocation.method": "constrained"},
    ("allocation.method", "pseudo-inverse"): {"observer.model": "none", "detection.model": "none"},
    **{
        ("pilot." + what, how): {"sensors.model": "simulated"}
        for what in ("state", "push")
        for how in ("measurement", "estimate")
    },
    **{
        ("person.model", how): {
            "pilot.guidance": "interactive",
            "person.path": [{"point": [1.0, 0.5]}, {"point": [3.0, 0.5]}],
        }
        for how in ("pull", "steer", "two-hands", "hold")
    },
}
LISTS = ("pushes", "faults", "walls", "requests", "sensor_faults", "wind.gusts", "sensors.additional", "changes")
LIST_NEEDS: Mapping[str, Changes] = {
    "faults": {"actuators.model": "rotors"},
    "walls": {"ground.model": "floor"},
    "requests": {"pilot.guidance": "interactive"},
    "sensor_faults": {"sensors.model": "simulated"},
    "sensors.additional": {"sensors.model": "simulated"},
    "wind.gusts": {"wind.model": "air"},
}
WEIGHTS = {  # of keys by their first words; a key that none fits has the weight 1
    **dict.fromkeys(("admittance", "controller", "faults", "ground", "mission", "phases", "vehicle", "wind"), 5.0),
    **dict.fromkeys(("actuators.delay", "plant.mass_scale", "wind.velocity", "mission.step"), 60.0),
    **dict.fromkeys(("controller.gains", "disturbance", "initial", "phases.height", "pushes"), 25.0),
}
TIMED = {**dict.fromkeys(("pushes", "faults", "requests", "sensor_faults", "changes"), "time"), "wind.gusts": "start"}
SAFE: Mapping[str, Mapping[str, tuple[str, ...]]] = {  # entries of lists, if their example shows little
    "changes": {"key": ("admittance.damping", "admittance.threshold", "wind.velocity", "compliance.max_speed")},
    "requests": {"action": ("disable", "enable", "land", "lift", "stop")},
    "sensor_faults": {"kind": ("frozen", "nan", "bias")},
}


class RandomMission(NamedTuple):
    """A mission drawn at random: its family and number there, the built-in mission, the changes, and the warnings."""

    family: int
    member: int
    base: str
    changes: Changes
    mission: Mission
    warnings: tuple[str, ...]


def random_missions(seed: int, families: int, members: int) -> Iterator[RandomMission]:
    """Draw missions that load, family by family.

    Args:
        seed: of all draws.
        families: their number.
        members: how many each has.
    """
    for family in range(families):
        yield from random_family(seed, family, members)


def random_family(seed: int, family: int, members: int) -> Iterator[RandomMission]:
    """The members of one family; families from number `UNPUSHED` on have no pushes."""
    if family >= UNPUSHED:
        yield from _unpushed_family(seed, family, members)
        return
    rng = np.random.default_rng([seed, family])
    base = str(rng.choice(sorted(built_in())))
    common = shortened(base)
    flips = _changed(base, common, int(rng.integers(0, MOST_FLIPS + 1)), rng, flips=True)
    for member in range(members):
        rng = np.random.default_rng([seed, family, member])
        count = int(rng.integers(1, MOST_KEYS + 1 - MOST_FLIPS))
        changes = _changed(base, {**common, **flips}, count, rng, flips=False)
        mission, said = _loaded(base, {**common, **flips, **changes})
        yield RandomMission(family, member, base, {**common, **flips, **changes}, mission, said)


def _unpushed_family(seed: int, family: int, members: int) -> Iterator[RandomMission]:
    """Missions without a push, each with an error that looks like one: of a sensor, a drift, or gusts."""
    base = ("iris", "heavy-payload", "off-centre-push")[family % 3]
    for member in range(members):
        rng = np.random.default_rng([seed, family, member])
        changes = {**shortened(base, 22.0), "mission.seed": int(rng.integers(1000)), "pushes": [], **_false_push(rng)}
        mission, said = _loaded(base, changes)
        yield RandomMission(family, member, base, changes, mission, said)


def _false_push(rng: np.random.Generator) -> Changes:
    """A bias or drift of the joints or the accelerometer, or one to three gusts, from 5 s on."""
    sensor = ("joints", "accelerometer")[int(rng.integers(2))]
    kind, sign = ("bias", "drift", "gusts")[int(rng.integers(3))], float(rng.choice([-1.0, 1.0]))
    if kind == "bias":
        size = sign * float(rng.uniform(0.2, 1.5) if sensor == "joints" else rng.uniform(0.5, 3.0))
        fault = {"sensor": sensor, "kind": "bias", "time": float(rng.uniform(5.0, 13.0)), "size": [size] * 3}
        return {"sensor_faults": [fault]}
    if kind == "drift":
        key = "sensors.joints.force_drift" if sensor == "joints" else "sensors.accelerometer.drift"
        return {key: float(rng.uniform(0.01, 0.2))}
    gusts = []
    for _ in range(int(rng.integers(1, 4))):
        speed, angle = float(rng.uniform(0.5, 4.0)), float(rng.uniform(0.0, 2.0 * np.pi))
        velocity = [speed * np.cos(angle), speed * np.sin(angle), float(rng.uniform(-1.0, 1.0))]
        gust = {"velocity": velocity, "start": float(rng.uniform(2.0, 13.0)), "rise": float(rng.uniform(0.1, 2.0))}
        gusts.append(gust if rng.random() < 0.5 else {**gust, "hold": float(rng.uniform(0.5, 6.0))})
    return {"wind.model": "air", "wind.gusts": gusts}


def shortened(base: str, duration: float = 14.0) -> Changes:
    """The changes that fit a built-in mission into `duration` [s]: lifted from 0.5 to 3 s, tared, pushed, landed."""
    mission = load_mission(base)
    p, e = mission.phases, mission.estimator
    lands = p.land_start is not None and p.land_start < mission.mission.duration
    changes: Changes = {
        "mission.duration": duration,
        "phases.lift_start": 0.5,
        "phases.lift_duration": min(p.lift_duration, 2.5),
        "phases.land_start": duration - 6.5 if lands else 1e6,
        "phases.land_duration": min(p.land_duration, 3.5),
    }
    if e.tare_start is not None:
        changes |= {"estimator.tare_start": 3.2, "estimator.tare_duration": 1.0}
    if mission.person.model not in ("none", "virtual-hand"):
        changes["person.start_time"] = min(mission.person.start_time, 4.4)
        changes["person.path"] = [{"point": [1.5, mission.person.grip]}]
    pushes = [q.model_dump(mode="json") for q in mission.pushes[-3:]]
    changes["pushes"] = [{**q, "time": 5.5 + 1.5 * i, "sigma": min(q["sigma"], 0.4)} for i, q in enumerate(pushes)]
    changes |= {f"wind.gusts.{i}.start": 5.0 + 2.0 * i for i in range(len(mission.wind.gusts))}
    changes |= {f"faults.{i}.time": 6.0 + i for i in range(len(mission.faults))}
    return changes


def _loaded(base: str, changes: Changes) -> tuple[Mission, tuple[str, ...]]:
    """The mission, and the warnings of its loading."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", FlightWarning)
        mission = load_mission(base, changes)
    return mission, tuple(str(w.message) for w in said if issubclass(w.category, FlightWarning))


def _changed(base: str, before: Changes, count: int, rng: np.random.Generator, *, flips: bool) -> Changes:
    """Valid changes of up to `count` keys, with those that they need, on top of earlier ones."""
    made = Changes()
    mission, keys = load_quietly(base, before), list[tuple[Key, Any]]()
    for _ in range(TRIES if count else 0):
        keys = keys or list(_keys_of(mission, flips=flips))
        key, value = keys[_drawn_place([key.name for key, _ in keys], rng)]
        new = _flipped(key, value, mission, rng) if flips else {key.name: varied(key, value, rng)}
        if not new or new == {key.name: value}:
            continue
        try:
            mission = load_quietly(base, {**before, **made, **new})
        except InputError:
            continue
        made, count, keys = {**made, **new}, count - 1, []
        if not count:
            break
    return made


def drawable_keys(base: str) -> set[str]:
    """The dotted names of all keys of a built-in mission that may be drawn, numbers and choices."""
    mission = load_quietly(base, {})
    return {key.name for flips in (False, True) for key, _ in _keys_of(mission, flips=flips)}


def _drawn_place(names: list[str], rng: np.random.Generator) -> int:
    weights = np.array(
        [max((w for start, w in WEIGHTS.items() if name.startswith(start)), default=1.0) for name in names]
    )
    return int(rng.choice(len(names), p=weights / weights.sum()))


def load_quietly(base: str, changes: Changes) -> Mission:
    """The mission, without its warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlightWarning)
        return load_mission(base, changes)


def _keys_of(mission: Mission, *, flips: bool) -> Iterator[tuple[Key, Any]]:
    """Each key of a mission that may be drawn, named by its place in it, with its value; or lists that may grow."""
    tables = tables_of(mission)
    for section in sections():
        if section.controller not in ("", mission.controller.name) or not is_of_the_package(section.controller):
            continue
        for key in section.keys:
            if key.name.startswith(FIXED) or _is_choice(key) != flips:
                continue
            for name, value in _places(tables, key.name.split("."), ()):
                yield key._replace(name=name), value
    if flips:
        any_key = next(section.keys[0] for section in sections() if section.keys)
        for name in LISTS:
            yield any_key._replace(name=name), None


def _places(at: Any, parts: list[str], above: tuple[str, ...]) -> Iterator[tuple[str, Any]]:
    """The places that a dotted name means, in which 0 stands for any entry of a list, with the value at each."""
    if not parts:
        yield ".".join(above), at
    elif isinstance(at, list) and parts[0] == "0":
        for i, entry in enumerate(at):
            yield from _places(entry, parts[1:], (*above, str(i)))
    elif isinstance(at, dict) and parts[0] in at:
        yield from _places(at[parts[0]], parts[1:], (*above, parts[0]))
    elif isinstance(at, dict) and len(parts) == 1:
        yield ".".join((*above, parts[0])), None  # not set


def _is_choice(key: Key) -> bool:
    kind = plain(key.field.annotation)
    return kind is bool or kind is str or get_origin(kind) is Literal


def _flipped(key: Key, value: Any, mission: Mission, rng: np.random.Generator) -> Changes:
    """Another choice with the keys that it needs, or one more entry of a list."""
    if key.name in LISTS:
        return _with_entry(key.name, mission, rng)
    if key.name == "controller.name":
        names = [name for name in CONTROLLERS if is_of_the_package(name) and name != value]
        return {"controller": {"name": str(rng.choice(sorted(names)))}}
    kind = plain(key.field.annotation)
    options = [True, False] if kind is bool else list(get_args(kind)) if get_origin(kind) is Literal else []
    others = [option for option in options if option != value]
    if not others:
        return Changes()
    other = others[int(rng.integers(len(others)))]
    return {**NEEDS.get((key.name, other), {}), key.name: other}


def _with_entry(name: str, mission: Mission, rng: np.random.Generator) -> Changes:
    """One more entry of a list, from the examples of its keys, at a time within the flight."""
    *above, last = name.split(".")
    at: Any = tables_of(mission)
    for part in above:
        at = at.get(part, {})
    keys = {key.name.rpartition(".")[2]: key for section in sections() if section.name == name for key in section.keys}
    entry = {inner: key.example for inner, key in keys.items() if key.field.is_required()}
    entry |= {inner: str(rng.choice(list(choices))) for inner, choices in SAFE.get(name, {}).items()}
    time = round(float(rng.uniform(1.0, mission.mission.duration)), 2)
    if name == "changes":
        entry["value"], time = round(float(rng.uniform(0.5, 4.0)), 2), max([time, *(c.time for c in mission.changes)])
    if name in TIMED:
        entry[TIMED[name]] = time
    return {**LIST_NEEDS.get(name, {}), name: [*at.get(last, []), entry]}
