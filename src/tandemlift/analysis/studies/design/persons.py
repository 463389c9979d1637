"""Random persons, whose numbers are drawn about those of the mission.

Gains, arm, speed and lag are those of the mission times independent factors of 0.7 to 1.3. The visual delay is 0.1 s to
0.3 s (in steps of 20 ms, so that blocks fill), the tremor up to 0.1 N, the grip anywhere on the beam. A wind of up to
1 N, unknown to the pilot, comes from a random direction. The mission lasts longer, because some persons are slow.
"""

from __future__ import annotations

from typing import Any

from tandemlift.analysis.studies.design.distributions import Horizontal, Uniform
from tandemlift.analysis.studies.design.draws import Drawn
from tandemlift.core.errors import InputError

SCALED = (
    *("stiffness", "damping", "lag", "gain", "speed"),
    *("look_ahead", "approach_gain", "trim_rate", "yaw_gain", "yaw_damping"),
)
GRIP = "person.grip"
LONGER = 1.6  # times the mission's duration


def random_person() -> Drawn:
    """The distributions of a random person."""
    return {
        **{f"person.{key}": Uniform(distribution="uniform", low=0.7, high=1.3, relative=True) for key in SCALED},
        "person.delay": Uniform(distribution="uniform", low=0.1, high=0.3, step=0.02),
        "person.tremor": Uniform(distribution="uniform", low=0.0, high=0.1),
        GRIP: Uniform(distribution="uniform", low=-1.0, high=1.0),
        "disturbance.force": Horizontal(distribution="horizontal", low=0.0, high=1.0),
    }


def check_has_person(model: str, name: str) -> None:
    """Check that a mission has a person: `model` is that of `[person]`, `name` the mission's.

    Raises:
        InputError: it has none.
    """
    if model == "none":
        raise InputError(f"study.persons = 'random': mission {name!r} has no person; person.model must not be 'none'")


def person_changes(model: str, duration: float, drawn: dict[str, Any]) -> dict[str, Any]:
    """The changes of a mission with this `person.model` and duration [s] for a drawn person."""
    changes = {key: value for key, value in drawn.items() if key != GRIP or model == "steer"}
    return {"mission.duration": LONGER * duration, **changes}
