"""What the keys of a mission feel like: its axes under the standard push, the effort in a corridor, and the checks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from tandemlift.common.progress import progress_or_own
from tandemlift.common.types import Progress
from tandemlift.missions import Mission
from tandemlift.missions.flight_checks.result import FAILS, CheckResult
from tandemlift.studies.feel.closed_form import YAW, AxisFeel
from tandemlift.studies.feel.effort import CORRIDOR, Effort, effort_in_corridor
from tandemlift.studies.feel.feel_checks import feel_checks, flown_checks
from tandemlift.studies.feel.standard_push import Answer, PushedAxis, pushed_axes

HEADS = ("push", "moves from", "final speed", "95 % after", "overshoot", "lag", "stops within", "apart")
STEPS = 2  # of the progress: the pushes, the corridor


class FeelStudy(NamedTuple):
    """What a mission's admittance feels like.

    Attributes:
        mission: that was asked about.
        pushed: each axis under the standard push, by closed form and flown.
        effort: of the person in mission `zigzag` with this admittance.
        checks: each with its number, its limit, and what to do.
    """

    mission: Mission
    pushed: tuple[PushedAxis, ...]
    effort: Effort
    checks: tuple[CheckResult, ...]

    @property
    def fails(self) -> bool:
        """Whether a check fails."""
        return any(check.verdict == FAILS for check in self.checks)

    def summary(self) -> dict[str, Any]:
        """All numbers in SI units; in yaw, those of lengths are angles, and those of forces are moments."""
        a = self.mission.admittance
        return {
            "mission": self.mission.mission.name,
            "feel": None if a.feel is None else [f._asdict() for f in a.feel.axes],
            "axes": [_axis(p) for p in self.pushed],
            "corridor": {"mission": CORRIDOR, **self.effort._asdict()},
            "checks": [{**check._asdict(), "margin": check.margin} for check in self.checks],
        }


def study_feel(mission: Mission, progress: Progress | None = None) -> FeelStudy:
    """Fly the standard push and the corridor with a mission's admittance, and check it.

    Args:
        mission: from `load_mission`.
        progress: called with (parts done, parts in all); by default, a notebook shows a bar.

    Raises:
        InputError: the mission cannot be flown without its surroundings, or `zigzag` not with its admittance.
    """
    with progress_or_own("Feel", progress, "parts") as shown:
        pushed = pushed_axes(mission)
        if shown:
            shown(1, STEPS)
        effort = effort_in_corridor(mission)
        if shown:
            shown(STEPS, STEPS)
    checks = (*feel_checks(mission, [p.feel for p in pushed]), *flown_checks(pushed, effort))
    return FeelStudy(mission, pushed, effort, checks)


def _axis(p: PushedAxis) -> dict[str, Any]:
    k = p.feel
    return {
        **k._asdict(),
        "time_constant": k.time_constant if k.damping > 0.0 else None,
        "acceleration": k.acceleration,
        "closed_form": p.ideal._asdict(),
        "flown": p.real._asdict(),
        "difference": p.difference,
        "findings": sorted({finding.kind for finding in p.flight.findings}),
        "failure": p.flight.failure,
    }


def table_of(study: FeelStudy) -> list[tuple[str, ...]]:
    """A row for each axis, with cells of `HEADS` after its name; where two values differ, "closed form → flown"."""
    return [(p.feel.axis, *_cells(p)) for p in study.pushed]


def _cells(p: PushedAxis) -> Iterator[str]:
    k, length, force = p.feel, "rad" if p.feel.axis == YAW else "m", "N m" if p.feel.axis == YAW else "N"
    yield f"{k.push:g} {force}"
    yield f"{k.threshold:g} {force}"
    units = (f"{length}/s", "s", "%", "s", length)
    for name, unit in zip(Answer._fields, units, strict=True):
        yield _both(getattr(p.ideal, name), getattr(p.real, name), unit)
    yield "–" if p.difference is None else f"{p.difference:.2f} {length}/s"


def _both(ideal: float | None, real: float | None, unit: str) -> str:
    scale, digits = (100.0, 0) if unit == "%" else (1.0, 2)
    texts = ["–" if value is None else f"{scale * value:.{digits}f}" for value in (ideal, real)]
    return f"{' → '.join(dict.fromkeys(texts))} {unit}".removeprefix("– → ")


def gate_text(k: AxisFeel, release: float | None, dwell: float) -> str:
    """What the least force does, in words.

    Args:
        k: the axis.
        release: below which a push ends [N]; None without a dead band.
        dwell: for which it must last before [s].
    """
    acts = "only what exceeds it acts" if k.soft else "beyond it the whole force acts"
    if release is None:
        return f"A push must exceed {k.threshold:g} N; {acts}."
    lasting = f"for {1e3 * dwell:g} ms; {acts}, until the push falls below {release:.2g} N"
    return f"A push must exceed {k.threshold:g} N {lasting}."


def sentences_of(study: FeelStudy) -> list[str]:
    """What the least force does, and the effort in the corridor, in a sentence each."""
    m, by_hand = study.mission, study.mission.pilot.guidance == "hand"
    first = study.pushed[0].feel
    release = first.threshold * m.compliance.release_fraction if by_hand else None
    e = study.effort
    if e.force is None or e.work is None or e.time is None or e.jerk is None:
        effort = f"In `{CORRIDOR}` nobody could lead the vehicle: {e.outcome}."
    else:
        ended = "it lands at the end" if e.arrived else f"it does not arrive ({e.outcome})"
        clearance = "" if e.clearance is None else f", {e.clearance:.2f} m from the walls at least"
        work = f"{e.work:.2f}".replace("-", "−")
        effort = (
            f"In `{CORRIDOR}` a person leads it with {e.force:.2f} N and {work} J/m for {e.time:.1f} s, with "
            f"{e.jerk:.2f} m/s³ of jerk (rms); {ended}{clearance}."
        )
    return [gate_text(first, release, m.compliance.dwell), effort]
