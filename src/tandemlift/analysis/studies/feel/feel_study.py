"""What the keys of a mission feel like: its axes under the standard push, and the checks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from tandemlift.analysis.studies.feel.closed_form import YAW
from tandemlift.analysis.studies.feel.feel_checks import feel_checks, flown_checks
from tandemlift.analysis.studies.feel.standard_push import Answer, PushedAxis, pushed_axes
from tandemlift.core.checks import FAILS, CheckResult
from tandemlift.core.progress import progress_or_own
from tandemlift.core.types import Progress
from tandemlift.missions import Mission

HEADS = ("push", "moves from", "final speed", "95 % after", "overshoot", "lag", "stops within", "apart")


class FeelStudy(NamedTuple):
    """What a mission's admittance feels like.

    Attributes:
        mission: that was asked about.
        pushed: each axis under the standard push, by closed form and flown.
        checks: each with its number, its limit, and what to do.
    """

    mission: Mission
    pushed: tuple[PushedAxis, ...]
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
            "checks": [{**check._asdict(), "margin": check.margin} for check in self.checks],
        }


def study_feel(mission: Mission, progress: Progress | None = None) -> FeelStudy:
    """Fly the standard push along each axis of a mission's admittance, and check it.

    Args:
        mission: from `load_mission`.
        progress: called with (axes flown, axes in all); by default, a notebook shows a bar.

    Raises:
        InputError: the mission cannot be flown without its surroundings.
    """
    with progress_or_own("Feel", progress, "axes") as shown:
        pushed = pushed_axes(mission, shown)
    flown = (check for p in pushed for check in flown_checks(p))
    return FeelStudy(mission, pushed, (*feel_checks(mission, [p.feel for p in pushed]), *flown))


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


def gate_text(study: FeelStudy) -> str:
    """What the smallest force that moves the vehicle does, along x, in a sentence."""
    k, m = study.pushed[0].feel, study.mission
    acts = "only what exceeds it acts" if k.subtracts_threshold else "beyond it the whole force acts"
    if m.pilot.guidance != "interactive":
        return f"A push must exceed {k.threshold:g} N; {acts}."
    release, dwell = k.threshold * m.compliance.release_fraction, 1e3 * m.compliance.dwell
    lasting = f"for {dwell:g} ms; {acts}, until the push falls below {release:.2g} N"
    return f"A push must exceed {k.threshold:g} N {lasting}."
