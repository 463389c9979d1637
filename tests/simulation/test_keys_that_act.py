"""A census of all keys: one that changes nothing in a flight cannot act, and one that cannot act changes nothing.

Each key of a mission takes other values. What it changes is read from the numbers of the assembled flight that a step
reads, by the graph of the step; from the layout of the flight, and from its plan. No flight is compiled.
"""

from typing import Literal, get_args, get_origin

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.core.types import layout_and_numbers
from tandemlift.missions import changed, idle_keys, load_mission, tables_of
from tandemlift.missions.changes import MISSING, place_of, value_at
from tandemlift.missions.key_descriptions import plain, sections
from tandemlift.simulation.loop.sources import leaf_offset
from tandemlift.simulation.preparation.assemble import assemble
from tandemlift.simulation.preparation.templates import templates_from
from tandemlift.simulation.preparation.traced_step import TracedStep

SHIFTS = (
    (1.1, 0.0),
    (0.9, 0.0),
    (1.0, 0.001),
    (1.0, 0.01),
    (1.0, -0.01),
    (1.0, 0.3),
    (1.0, 3.0),
    (1.001, 0.0),
    (0.999, 0.0),
)
RESULTS = ("metrics", "ended", "impulse", "detectors")  # of a flight's state, read after it
AFTER = ("mission.name", "outcome.", "promise.", "findings.", "changes.")  # read after a flight, or by its plan
ENOUGH = 2  # values of a key that cannot act
TIMES_ZERO = ("person.max_couple", "person.path.0.heading")  # read by every step of a person, who may have no couple


def live(assembled):
    """The numbers of a flight on which its results depend: those that a step reads, now or by the memory later."""
    step = TracedStep(templates_from(assembled.model, assembled.given), rolls=False)
    graph, model = step.graph, step.templates.model
    state, size = leaf_offset(model, "flight_state")
    now = [*step.sample, *step.body.acting, *step.body.push, *step.body_in_contact, *step.may_touch_walls, *step.gust]
    now += [*step.body_on_feet, *step.body_in_free_air, *step.may_touch_hull]
    if step.limits is not None:
        now += step.limits.symbols
    if step.templates.has_floor:
        now.append(step.may_touch_floor)
    if step.templates.has_walls:
        due, _, found = step.wall_search
        now += [due, *found]
    places = [leaf_offset(model.flight_state, name) for name in RESULTS]
    roots = [x.node for x in now] + [step.next_state[i].node for at, n in places for i in range(at, at + n)]
    used = set()
    while True:
        inputs = [graph.args[node] for node in graph.needed(roots) if graph.ops[node] == "in"]
        more = {index for kind, index in inputs if kind == "fly"} - used
        if not more:
            return used
        used |= more
        roots += [step.next_state[i - state].node for i in more if state <= i < state + size]


class Traced:
    """What a mission's flight is made of."""

    def __init__(self, mission):
        made, m = assemble(mission), mission.mission
        self.layout, numbers = layout_and_numbers(made.model)
        self.numbers = np.array([float(x) for x in numbers])
        self.rest = [np.asarray(x, float).tolist() for x in (*made.tables, made.delays, made.seeds)]
        self.rest += [layout_and_numbers(made.given)[0], m.steps, m.log_every, m.step, m.fma, m.precision]

    def differs(self, other, used):
        """Whether another flight may have other results."""
        if self.layout != other.layout or self.rest != other.rest:
            return True
        differ = (self.numbers != other.numbers) & ~(np.isnan(self.numbers) & np.isnan(other.numbers))
        return not used.isdisjoint(np.flatnonzero(differ).tolist())


def others(key, value):
    """Other values to try."""
    kind = plain(key.field.annotation)
    if isinstance(value, bool):
        return [not value]
    if get_origin(kind) is Literal:
        return [choice for choice in get_args(kind) if choice != value]
    if isinstance(value, int):
        return [value + 1, value - 1, value + 2]
    if isinstance(value, float):
        return [value * factor + shift for factor, shift in SHIFTS]
    if isinstance(value, list) and value and all(isinstance(x, float) for x in value):
        return [[x * factor + shift for x in value] for factor, shift in SHIFTS]
    example = key.facts.example
    if example is None:
        return []
    moved = (np.multiply(example, 1.1) + 0.01).tolist() if isinstance(example, (float, list)) else example
    return [example, moved]


def changes_of(mission, key, idle, before, used):
    """Whether other values of a key change a flight; None if no value could be tried."""
    value, tried = value_at(tables_of(mission), place_of(key.name)), 0
    for other in [x for x in others(key, None if value is MISSING else value) if x != value]:
        try:
            after = Traced(changed(mission, key.name, other))
        except tl.InputError:
            continue
        tried += 1
        if before.differs(after, used):
            return True
        if idle and tried == ENOUGH:
            break
    return False if tried else None


ON = {
    **{"supervision.model": "on", "detection.model": "residual", "compliance.tank.model": "tank"},
    **{"compliance.yaw.model": "compliant", "contact.model": "on", "observer.model": "super-twisting"},
}
AIR = {"wind.model": "air", "wind.turbulence": 3.0}
MISSIONS = {
    "paper": {},
    "flight-ready": {"controller.switching": "sign", "sensors.model": "simulated", "sensors.gyroscope.noise": 0.01},
    "iris": ON | AIR | {"estimator.wind_compensation": "quadrotors", "wind.velocity": [1.0, 0.0, 0.0]},
    "zigzag": {},
    "narrow": {"estimator.wrench": "fused"},
    "gusts": {"estimator.wrench": "unscented", "sensors.joints.model": "none"},
    "hover": {},
    "rotor-loss": {"estimator.wrench": "kalman"},
}


@pytest.mark.thorough
@pytest.mark.parametrize("name", sorted(MISSIONS))
def test_a_key_that_changes_nothing_cannot_act_and_one_that_cannot_act_changes_nothing(name):
    mission = load_mission(name, MISSIONS[name])
    before, used, wrong = Traced(mission), live(assemble(mission)), []
    tables = tables_of(mission)
    for key in [k for s in sections() if s.controller in ("", mission.controller.name) for k in s.keys]:
        if key.name.startswith(AFTER) or value_at(tables, place_of(key.name)[:-1]) is MISSING:
            continue
        idle = list(idle_keys(mission, [place_of(key.name)]))
        changes = changes_of(mission, key, bool(idle), before, used)
        if changes is not None and changes == bool(idle) and key.name not in TIMES_ZERO:
            wrong.append(f"{key.name}: {f'changes the flight without {idle[0].condition}' if idle else 'no effect'}")
    assert wrong == [], "\n".join(wrong)


@pytest.mark.thorough
def test_what_a_step_reads_in_vain_changes_no_bit_of_a_flight():
    start = {"mission.duration": 20.0, "mission.log_interval": 0.1}
    mission = load_mission("narrow", start)
    assert [one.key for one in idle_keys(mission, map(place_of, TIMES_ZERO))] == list(TIMES_ZERO)
    others = [changed(mission, key, value) for key, value in zip(TIMES_ZERO, (0.1, 1.0), strict=True)]
    flown, *changed_ones = tl.fly_many([mission, *others])
    assert np.any(flown["push_force"]), "the person pushes within this time"
    for one in changed_ones:
        assert all(
            np.array_equal(one[name], flown[name]) for name in ("position", "velocity", "rotor_thrusts", "push_force")
        )
