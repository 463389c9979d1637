"""`tl.certify`: the tiers of a certificate of a mission, one after the other."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from tandemlift.analysis.certification.certificate import TIERS, Certificate
from tandemlift.analysis.certification.claims import Tier
from tandemlift.analysis.certification.flown import with_limits
from tandemlift.analysis.certification.linear import linear_tier
from tandemlift.analysis.certification.nonlinear import nonlinear_tier
from tandemlift.analysis.certification.person import ArmBox, person_tier
from tandemlift.analysis.certification.statistics import FLIGHTS, statistics_tier
from tandemlift.analysis.certification.structured import DEFAULT_BOX, structured_tier
from tandemlift.core.errors import extra, unknown
from tandemlift.core.files import __version__
from tandemlift.core.progress import progress_or_own
from tandemlift.core.types import Progress
from tandemlift.missions import MissionLike, check_double, mission_of, tables_of

PACKAGES = ("numpy", "scipy", "slycot", "cvxpy")


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
        The certificate; a tier that cannot be formed for this mission has the reason. Ctrl-C after a tier ends it with
        the tiers so far, `stopped`.

    Raises:
        InputError: the mission cannot be loaded, a tier is unknown, a box is empty or too large, or an optional package
            is missing (extra: certify).
    """
    mission = mission_of(mission)
    check_double(mission, "a certificate is computed in doubles")
    for name in tiers:
        if name not in TIERS:
            raise unknown("tier", name, TIERS)
    chosen = [name for name in TIERS if name in tiers]
    arms = ArmBox() if arm is None else ArmBox(*arm).checked()
    with extra("certify", "a certificate"):
        from threadpoolctl import threadpool_limits
    # many small matrices: threads of BLAS would only wait for each other
    with (
        threadpool_limits(1),
        tempfile.TemporaryDirectory() as aside,
        progress_or_own(f"{mission.mission.name}, certified", progress, "tiers") as shown,
    ):
        study = Path(aside) / "study" if folder is None else Path(folder)
        forms: dict[str, Callable[[], Tier]] = {
            "linear": lambda: linear_tier(mission),
            "structured": lambda: structured_tier(mission, box or DEFAULT_BOX),
            "person": lambda: person_tier(mission, arms, fly=fly),
            "nonlinear": lambda: nonlinear_tier(mission, fly=fly),
            "statistics": lambda: statistics_tier(mission, study, flights),
        }
        found = _formed([forms[name] for name in chosen], lambda tier: with_limits(tier, mission, fly), shown)
    day, stopped = f"{datetime.now(UTC):%Y-%m-%d}", len(found) < len(chosen)
    return Certificate(mission.mission.name, tuple(found), _versions(), tables_of(mission), fly, day, stopped)


def _formed(
    forms: Sequence[Callable[[], Tier]], finish: Callable[[Tier], Tier], progress: Progress | None
) -> list[Tier]:
    """The tiers that are formed before Ctrl-C, if there is one."""
    found = list[Tier]()
    try:
        for form in forms:
            if progress:
                progress(len(found), len(forms))
            found.append(finish(form()))
        if progress:
            progress(len(forms), len(forms))
    except KeyboardInterrupt:
        if not found:
            raise
    return found


def _versions() -> dict[str, str]:
    found = {"tandemlift": __version__}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found
