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
        "black at the start and at the end; dotted lines lead from the pushes straight down to the floor, which is "
        "filled if it is there to stand on. Walls are seen through.",
        "Three-dimensional view of the flown path with an arrow for each push, the vehicle at a few instants, and the "
        "floor and walls if there are any.",
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
    "push": Caption(
        "Push as felt",
        "The person’s push, what the last readings of the joint sensors say of it, and the estimate made of them, per "
        "world axis, with the thresholds of the admittance. Then: where on the beam it acts, along body y from the "
        "payload’s centre and as wide as the beam, while it is large enough to tell; the payload’s mass; and by how "
        "much the sensors disagree, with the limit beyond which they are not trusted. Grey: the estimate may not be "
        "used. Blue: the tare, in which the sensors’ bias is found.",
        "Six panels over time: true, measured and estimated push along x, y and z with thresholds; place along the "
        "beam; mass of the payload; disagreement of the sensors. Shaded where the estimate may not be used.",
    ),
    "disturbance": Caption(
        "Disturbance",
        "What the observer finds to act on the vehicle besides rotors, weight and person: force in world axes, moment "
        "in body axes. Bottom, with a sliding mode: what is left of the disturbance over λ₂, the largest of the three "
        "axes of position and of attitude; the law’s guarantee needs it below 1. Grey: a person steers.",
        "Panels over time: disturbing force and moment, components x, y and z; what is left of them over λ₂.",
    ),
    "joints": Caption(
        "Joints",
        "Force and torque of each quadrotor on the payload at its joint, in body axes. Where sensors are simulated, "
        "what they measured stands behind. Where a disturbed start asks for far more than the rest of the flight, the "
        "scale is that of what follows the first second.",
        "A row of two panels over time for each quadrotor: force and torque on the payload, components x, y and z.",
    ),
    "rotors": Caption(
        "Rotors",
        "Thrust of each rotor and what was commanded of it, between its limits; commands far beyond them are cut off. "
        "A rotor that fails is marked, and its upper limit falls to what is left. Near the floor a rotor can give more "
        "than its limit. Bottom: the share of the wanted thrust and moments that the commands, held within the limits, "
        "give; it is 0 while the rotors are stopped.",
        "A row of four panels over time for each quadrotor: thrust, command and limits of each rotor. Below, the share "
        "of the wanted thrust and moments that they give.",
    ),
    "surroundings": Caption(
        "Surroundings",
        "What there is of these: velocity of the air and its force on all parts together, force of floor and walls on "
        "the vehicle with its weight, in world axes, and height of the lowest sole over the floor. Grey: floor or "
        "walls touch the vehicle.",
        "Panels over time of the wind’s velocity and force, the contact force and the height over the floor, as far as "
        "there are wind and floor; shaded in contact.",
    ),
    "corridor": Caption(
        "Among walls",
        "Top: walls, the way of the centre of mass and the path that the person was to follow, from above; the vehicle "
        "to scale at even steps of the way, black at the start and at the end: its beam, and the guards about its "
        "quadrotors; arrows where the person held on then, as long as the horizontal push was strong. Bottom: how far "
        "guards and beam were from the nearest wall, over the way flown, with the least of it; below zero they press.",
        "Two panels: view from above of walls, path, vehicle and pushes; clearance of guards and beam over the way.",
    ),
    "views": Caption(
        "Photographs",
        "The flight as cameras saw it that stand in its world.",
        "Photographs of the vehicle in its surroundings, each with its letter, what it shows, and the time.",
    ),
}
