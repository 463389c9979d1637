"""The structure of a vehicle in the loops of its pilot: the damping of each mode of the closed linear model."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tandemlift.analysis.linearization.linear_model import Mode, modes_of
from tandemlift.analysis.linearization.linearize import linearize
from tandemlift.analysis.linearization.loop_margins import LIFT, NO_KINK, SETTLED, calm_mission
from tandemlift.core.errors import CheckResult, judged
from tandemlift.missions import Mission

SHAPE = re.compile(r"shape\.(?:coordinates|rates)\.n(\d+)")
BEFORE_TARE = 1.0 + LIFT + 0.5 * SETTLED  # s: the hover of `calm_mission` before its tare
LEAST_DAMPING = 0.003  # damping ratio: a mode with less is close to growing


def closed_structure(mission: Mission) -> dict[int, Mode]:
    """The modes of the hovering flight in which each mode of the structure has its largest part, by its number.

    A pilot that tares ignores pushes before; so both hovers count, and of each mode that with the least damping.

    Raises:
        InputError: the mission cannot be flown to a hover, even with damped modes.
    """
    calm, at = calm_mission(mission, slow=1.0)
    worst = dict[int, Mode]()
    for t in {at, min(at, BEFORE_TARE)}:
        found = dict[int, tuple[bool, float, Mode]]()
        for mode in modes_of(linearize(calm, t, kink_tolerance=NO_KINK).connected()).modes:
            for name, share in mode.states:
                if (part := SHAPE.fullmatch(name)) and mode.frequency > 0.0:
                    one, i = (mode.damping < 0.0, share, mode), int(part[1])
                    found[i] = max(found.get(i, one), one, key=lambda each: each[:2])
        for i, (_, _, mode) in found.items():
            worst[i] = min(worst.get(i, mode), mode, key=lambda each: each.damping)
    return dict(sorted(worst.items()))


def structure_in_loop_checks(mission: Mission) -> Iterator[CheckResult]:
    """Check that no loop of the pilot drives a mode of the structure."""
    modes = mission.structure_modes
    for i, mode in closed_structure(mission).items():
        words = modes[i].shape
        subject = f"{words}: {modes[i].hertz:.3g} Hz alone, {mode.frequency:.3g} Hz in flight"
        text = (
            f"the {words}, at {mode.frequency:.3g} Hz, which grows by a factor of e in {-mode.time_constant:.2g} s "
            "because the pilot drives it: add a notch there ([[allocation.notches]]), stiffen the beam or its mounts, "
            "or lower the gains of [controller]"
        )
        damping = mode.damping
        result = judged("structure", -damping, 0.0, "1", text, subject=subject)
        yield result if damping < 0.0 or damping >= LEAST_DAMPING else result._replace(verdict="close")
