"""What each figure shows, in words: a title, a caption, and a description for those who cannot see it."""

from __future__ import annotations

from typing import NamedTuple


class Caption(NamedTuple):
    """Title and text printed with a figure, and `alt`, which stands in for it."""

    title: str
    text: str
    alt: str


CAPTIONS: dict[str, Caption] = {
    "reference": Caption(
        "Reference trajectories",
        "What the admittance makes of the person’s push, per world axis: the push over its largest absolute value on "
        "that axis, and the reference position and velocity that it brings about.",
        "Nine panels over time, three columns for x, y and z: normalised push, reference position, reference velocity.",
    ),
    "path": Caption(
        "Path",
        "The path of the centre of mass, with arrows where the person pushed: each starts where the push acted at its "
        "peak and is as long, over the longest one, as it was strong. The vehicle is drawn to scale at a few instants, "
        "black at the start and at the end; dotted lines lead from the pushes straight down to the floor.",
        "Three-dimensional view of the flown path with an arrow for each push and the vehicle at a few instants.",
    ),
    "tracking": Caption(
        "Tracking",
        "Desired and actual orientation, position and velocity. Bottom row: the errors, desired minus actual, each "
        "over its largest absolute value, which the legend gives.",
        "Twelve panels over time, three columns for orientation, position and velocity: desired and actual value of "
        "each component, and their normalised errors.",
    ),
    "inputs": Caption(
        "Inputs",
        "Commanded thrust U₁ and moments U₂, U₃, U₄ about the body axes. Where a disturbed start asks for far more "
        "than the rest of the flight, the first second stands in a column of its own.",
        "Panels over time of the commanded thrust and of the three commanded moments.",
    ),
    "interaction": Caption(
        "Interaction",
        "The person’s push and the thresholds of the admittance (left axis) with the reference that it yields (right "
        "axis), per world axis. Grey: the push is beyond the threshold and moves the reference; white: the position is "
        "held.",
        "Three panels over time, for x, y and z: push, thresholds and reference position, shaded where the admittance "
        "is active.",
    ),
}
