"""Checks for pushes that are too weak to be followed, or act beside the vehicle."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tandemlift.core.errors import FAILS, CheckResult, judged
from tandemlift.missions.tables.mission import Mission
from tandemlift.parts.mechanics.vehicle import Vehicle

BESIDE = 0.05  # m, from the box of all parts


def point_checks(m: Mission) -> Iterator[CheckResult]:
    """Check for pushes outside the box around all parts."""
    for i, push in enumerate(m.pushes):
        off = Vehicle.from_settings(m.vehicle).beside(push.point)
        text = f"pushes.{i}.point = {list(push.point)} is {off:.2g} m beside the vehicle, where nobody can push"
        yield judged("push point", off, BESIDE, "m", text, subject=f"pushes.{i}", near=0.0)


def push_checks(m: Mission) -> Iterator[CheckResult]:
    """Check for pushes that exceed no axis' threshold, alone or with simultaneous pushes, and so are ignored."""
    a = m.admittance
    windy = m.wind.model == "air" and m.pilot.push != "truth"  # wind on the payload counts as a push
    if windy or m.person.model != "none" or any(change.key.startswith("admittance") for change in m.changes):
        return
    turns = m.pilot.guidance == "interactive" and m.compliance.yaw.model == "compliant"
    for i, push in enumerate(m.pushes):
        if not any(push.force) or (turns and any(push.point[:2])):
            continue
        near = [(q, math.exp(-0.5 * ((push.time - q.time) / q.sigma) ** 2)) for q in m.pushes]
        most = [sum(share * abs(q.force[axis]) for q, share in near) for axis in range(3)]
        if all(force <= threshold for force, threshold in zip(most, a.threshold, strict=True)):
            axis = max(range(3), key=lambda j: abs(push.force[j]))
            text = (
                f"pushes.{i} has {abs(push.force[axis]):g} N along {'xyz'[axis]}, and admittance.threshold is "
                f"{a.threshold[axis]:g} N there: it is ignored; raise pushes.{i}.force, or lower the threshold"
            )
            yield CheckResult("push", f"pushes.{i}", a.threshold[axis], most[axis], "N", FAILS, text)
