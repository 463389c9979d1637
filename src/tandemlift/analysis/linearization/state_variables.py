"""Names and units of the numbers of a flight's state, as states of a linear model."""

from __future__ import annotations

import re
from fnmatch import fnmatchcase
from typing import NamedTuple

OWN = ("state.", "memory.")  # prefixes without information: the body's state, the pilot's memory
COMPONENT = re.compile(r"(\.([wxyz]|r\d+))+$")
PER_SET = re.compile(r"\.r\d+$")
RADIANS, RATE, ANGULAR = "rad", "rad/s", "rad/s^2"
UNITS = (  # of a state whose name, without its components, matches first
    ("estimator.push.sums.specific_force", "m/s^2"),  # of sums over samples
    ("estimator.push.sums.force", "N"),
    ("estimator.push.sums.moment", "N m"),
    ("estimator.push.moment.value", "N m"),
    ("estimator.push.moment.rate", "N m/s"),
    ("estimator.push.sums.*", ""),
    ("estimator.push.angular", ANGULAR),
    ("estimator.push.wind.filtered.value", "N"),
    ("estimator.push.wind.filtered.rate", "N/s"),
    ("estimator.push.*.value", "N"),
    ("estimator.push.*.rate", "N/s"),
    ("estimator.confirmation.speeds", RATE),
    ("estimator.confirmation.turning.value", "N m"),
    ("estimator.confirmation.turning.rate", "N m/s"),
    ("estimator.confirmation.turning_zero.square", "N^2 m^2"),
    ("estimator.confirmation.turning_zero.*.rate", "N m/s"),
    ("estimator.confirmation.turning_zero.*", "N m"),
    ("estimator.confirmation.force_zero.square", "N^2"),
    ("estimator.confirmation.*.rate", "N/s"),
    ("estimator.confirmation.*", "N"),
    ("estimator.contact.contact.point", "m"),
    ("estimator.contact.contact.normal", "1"),
    ("estimator.contact.contact.force", "N"),
    ("estimator.contact.contact.along", "m"),
    ("estimator.contact.contact.rise", "s"),
    ("estimator.contact.*.rate", "N/s"),
    ("estimator.contact.evidence.steepest", "N^2/s^2"),
    ("estimator.contact.evidence.doubt", "s"),
    ("estimator.contact.evidence.*", "N"),
    ("estimator.contact.*_time", "s"),
    ("estimator.*.gyroscope_bias", RATE),
    ("estimator.*.accelerometer_bias", "m/s^2"),
    ("estimator.*.measured_rates", RATE),
    ("observer.thrust.value", "N"),
    ("observer.thrust.rate", "N/s"),
    ("observer.moment.value", "N m"),
    ("observer.moment.rate", "N m/s"),
    ("observer.turning", ANGULAR),
    ("observer.turning_residual", ANGULAR),
    ("observer.residual", "m/s^2"),
    ("guidance.heading.angle", RADIANS),
    ("guidance.heading.rate", RATE),
    ("guidance.heading.acceleration", ANGULAR),
    ("guidance.heading.*.value", "N m"),
    ("guidance.heading.*.rate", "N m/s"),
    ("guidance.heading.band.*", "N m"),
    ("guidance.moment.value", "N m"),
    ("guidance.moment.rate", "N m/s"),
    ("guidance.compliance.alternation.rises", "N/s"),
    ("guidance.compliance.alternation.falls", "N/s"),
    ("guidance.compliance.*.value", "N"),
    ("guidance.compliance.*.rate", "N/s"),
    ("guidance.compliance.band.*", "N"),
    ("guidance.phase.since", "s"),
    ("guidance.phase.ground", "m"),
    ("guidance.phase.land_rate", "1/s"),
    ("guidance.phase.lift_fraction", "1"),
    ("guidance.following.reason", "1"),
    ("guidance.following.most_urgent", "1"),
    ("guidance.following.*", "s"),
    ("guidance.contact.normal", "1"),
    ("guidance.contact.level", "m"),
    ("guidance.contact.lever", "m/rad"),
    ("guidance.contact.*_time", "s"),
    ("guidance.contact.push.force", "N"),
    ("guidance.contact.push.moment", "N m"),
    ("guidance.tank.energy", "J"),
    ("controller.angles", RADIANS),
    ("controller.filter.angles", RADIANS),
    ("controller.smooth.value", RADIANS),
    ("controller.smooth.rate", RATE),
    ("lead.thrust.value", "N"),
    ("lead.thrust.rate", "N/s"),
    ("lead.moment.value", "N m"),
    ("lead.moment.rate", "N m/s"),
    ("allocation.thrusts", "N"),
    ("rotors.speed", RATE),
    ("rotors.arriving", "N"),
    ("person.place.value", "m"),
    ("person.place.rate", "m/s"),
    ("person.couple.value", "N m"),
    ("person.couple.rate", "N m/s"),
    ("person.grasp.value", "1"),
    ("person.grasp.rate", "1/s"),
    ("person.trim", "N"),
    ("person.view.grip", "m"),
    ("person.view.grip_velocity", "m/s"),
    ("person.view.yaw", RADIANS),
    ("person.view.yaw_rate", RATE),
    ("person.tremor.*", "N"),
    ("shape.coordinates.*", "m kg^1/2"),
    ("shape.rates.*", "m kg^1/2/s"),
    ("grip.*.normal", "N"),
    ("grip.*.x", "m"),
    ("grip.*.y", "m"),
    ("wind*", "1"),
    ("*.anchor", "m"),
    ("*position", "m"),
    ("*velocity", "m/s"),
    ("*acceleration", "m/s^2"),
    ("*specific_force", "m/s^2"),
    ("*attitude", "1"),
    ("*.frame", "1"),
    ("*rates", RATE),
    ("*joint_force", "N"),
    ("*joint_torque", "N m"),
)


class Variable(NamedTuple):
    """A state, an input or an output: its name, and its unit; "" where the unit is not known."""

    name: str
    unit: str


def state_variable(path: str, steps_ago: int = 0) -> Variable:
    """The state of a dotted number of a flight's state; `steps_ago`: when a value under way was written."""
    name = path
    for prefix in OWN:
        name = name.removeprefix(prefix)
    field = (PER_SET if name.startswith("grip.") else COMPONENT).sub("", name)
    unit = next((unit for pattern, unit in UNITS if fnmatchcase(field, pattern)), "")
    return Variable(f"{name}[-{steps_ago}]" if steps_ago else name, unit)
