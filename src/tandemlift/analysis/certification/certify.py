"""`tl.certify`: the certificate of a mission, tier by tier, and the flights that confirm it."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from tandemlift.analysis.certification.flown import Trial, flown_limit, trial_of
from tandemlift.analysis.certification.linear import linear_tier
from tandemlift.analysis.certification.parameters import PARAMETERS
from tandemlift.analysis.certification.person import ArmBox, flown_map, person_tier
from tandemlift.analysis.certification.statistics import FLIGHTS, statistics_tier
from tandemlift.analysis.robustness.certificate import Certificate, Claim, Tier
from tandemlift.analysis.robustness.nonlinear import nonlinear_tier
from tandemlift.analysis.robustness.structured import DEFAULT_BOX, structured_tier
from tandemlift.core.errors import InputError, unknown
from tandemlift.core.progress import progress_or_own
from tandemlift.core.types import Progress
from tandemlift.missions import Mission, MissionLike, format_toml, mission_of, tables_of

TIERS = ("linear", "structured", "person", "nonlinear", "statistics")
PACKAGES = ("tandemlift", "numpy", "scipy", "slycot", "cvxpy", "clarabel")
PAST = 1.05  # of a limit: the mission beside it flies beyond, where the oscillation grows


def certify(
    mission: MissionLike,
    tiers: Sequence[str] = TIERS,
    *,
    fly: bool = False,
    arm: tuple[float, float, float] | None = None,
    box: Mapping[str, float] | None = None,
    flights: int = FLIGHTS,
    folder: str | Path | None = None,
    progress: Progress | None = None,
) -> Certificate:
    """How far a mission is from instability, with which parameters and person, and how often it fails.

    Args:
        mission: from `load_mission`, or its name or path.
        tiers: those to be formed, by name.
        fly: whether to fly each predicted limit of a parameter, by bisection without a linear model.
        arm: largest stiffness [N/m], damping [N s/m] and hand mass [kg] of the arms that may hold the vehicle.
        box: half widths of uncertain parameters, by name, of the structured tier.
        flights: number of random flights of the tier of statistics.
        folder: of that tier's study, which goes on where it stopped; by default a temporary one.
        progress: called with (tiers done, tiers in all).

    Returns:
        The certificate; a tier that cannot be formed for this mission has the reason.

    Raises:
        InputError: the mission cannot be loaded, a tier is unknown, a box is empty or too large, or an optional package
            is missing (extra: certify).
    """
    mission = mission_of(mission)
    for name in tiers:
        if name not in TIERS:
            raise unknown("tier", name, TIERS)
    chosen, found = [name for name in TIERS if name in tiers], list[Tier]()
    arms = ArmBox() if arm is None else ArmBox(*arm).checked()
    with progress_or_own(f"{mission.mission.name}, certified", progress, "tiers") as shown:
        for done, name in enumerate(chosen, 1):
            found.append(_with_limits(_tier(name, mission, arms, box, flights, folder, fly), mission, fly))
            if shown:
                shown(done, len(chosen))
    return Certificate(mission.mission.name, tuple(found), _versions())


def _tier(
    name: str,
    mission: Mission,
    arms: ArmBox,
    box: Mapping[str, float] | None,
    flights: int,
    folder: str | Path | None,
    fly: bool,
) -> Tier:
    """One tier of a mission."""
    if name == "linear":
        return linear_tier(mission)
    if name == "structured":
        return structured_tier(mission, box or DEFAULT_BOX)
    if name == "person":
        return person_tier(mission, arms)
    if name == "nonlinear":
        return nonlinear_tier(mission, fly=fly)
    if folder is not None:
        return statistics_tier(mission, Path(folder), flights)
    with tempfile.TemporaryDirectory() as aside:
        return statistics_tier(mission, Path(aside) / "study", flights)


def _with_limits(tier: Tier, mission: Mission, fly: bool) -> Tier:
    """A tier with a mission that flies beyond each limit of a parameter, and the flown limits if asked for."""
    files, claims = dict(tier.files), list[Claim]()
    for claim in tier.claims:
        if claim.limit is not None:
            trial, name = trial_of(mission, claim.parameter), f"limits/{claim.slug}.toml"
            files[name] = format_toml(tables_of(_mission_beyond(trial, claim.limit)))
            flown = flown_limit(trial, claim.limit) if fly else None
            claim = claim._replace(command=f"tandemlift run {name}", nominal=_nominal(mission, claim), flown=flown)
        claims.append(claim)
    curves = dict(tier.curves)
    if fly and "map" in curves:
        curves["map"] = flown_map(mission, curves["map"])
    return replace(tier, claims=tuple(claims), files=files, curves=curves)


def _nominal(mission: Mission, claim: Claim) -> float:
    return PARAMETERS[claim.parameter].nominal(mission)


def _mission_beyond(trial: Trial, limit: float) -> Mission:
    """The mission that flies beyond a limit, or just within it if missions beyond are refused."""
    beyond = PAST if limit >= trial.nominal else 1.0 / PAST
    try:
        return trial.mission(limit * beyond)
    except InputError:
        return trial.mission(limit / beyond)


def _versions() -> dict[str, str]:
    found = dict[str, str]()
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found
