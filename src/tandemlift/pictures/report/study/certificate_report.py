"""`tl.certify`, and a certificate as files: a page, JSON, a PDF, and the missions that fly beyond each limit."""

from __future__ import annotations

import json
import math
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tandemlift.analysis.certification.certificate import Certificate
from tandemlift.analysis.certification.flown import with_limits
from tandemlift.analysis.certification.linear import linear_tier
from tandemlift.analysis.certification.person import ArmBox, person_tier
from tandemlift.analysis.certification.statistics import FLIGHTS, statistics_tier
from tandemlift.analysis.linearization.claims import Claim, Tier
from tandemlift.analysis.robustness.nonlinear import nonlinear_tier
from tandemlift.analysis.robustness.structured import DEFAULT_BOX, structured_tier
from tandemlift.core.errors import InputError, extra, unknown
from tandemlift.core.files import DATA, __version__, atomic_write
from tandemlift.core.progress import progress_or_own
from tandemlift.core.types import Progress
from tandemlift.missions import MissionLike, format_toml, mission_of, tables_of
from tandemlift.pictures.drawing.style import save
from tandemlift.pictures.report.page import shown_figures, write_page
from tandemlift.pictures.report.paper_report import check_typesetting, typeset
from tandemlift.pictures.report.study.certificate_figures import certificate_captions, certificate_figures
from tandemlift.pictures.report.study.words import command

PAGE, JSON, PDF, SOURCE = "certificate.html", "certificate.json", "certificate.pdf", "report.typ"
MISSION = "mission.toml"
NONE, MINUS = "none", "−"
TIERS = ("linear", "structured", "person", "nonlinear", "statistics")
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
        for done, name in enumerate(chosen):
            if shown:
                shown(done, len(chosen))
            found.append(with_limits(forms[name](), mission, fly))
        if shown:
            shown(len(chosen), len(chosen))
    return Certificate(mission.mission.name, tuple(found), _versions(), tables_of(mission))


def _versions() -> dict[str, str]:
    found = {"tandemlift": __version__}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def write_certificate(certificate: Certificate, folder: Path) -> list[Path]:
    """Write a certificate into a folder, which is made, with its mission; the PDF needs the extra "paper".

    Returns:
        The files: page, JSON, and PDF if there is one.
    """
    folder.mkdir(parents=True, exist_ok=True)
    mission = format_toml(certificate.tables)
    files = {MISSION: mission} | {n: t for tier in certificate.tiers for n, t in tier.files.items()}
    for name, text in files.items():
        _write(folder / name, text)
    certificate = _placed(certificate, {f"tandemlift run {name}": command("run", folder / name) for name in files})
    certificate.save(folder / JSON)
    figures, captions = certificate_figures(certificate), certificate_captions(certificate)
    tiers = [
        {"title": t.title, "assumptions": t.assumptions, "reason": t.reason, "rows": [_row(c) for c in t.claims]}
        for t in certificate.tiers
    ]
    verdict, versions = _verdict(certificate), ", ".join(f"{n} {v}" for n, v in certificate.versions.items())
    page = write_page(
        folder / PAGE,
        "certificate",
        name=certificate.mission,
        missed=[_name(claim) for claim in certificate.missed],
        verdict=None,
        tiers=tiers,
        mission=mission,
        repeat=command("certify", folder / MISSION, "--tiers", ",".join(t.name for t in certificate.tiers)),
        figures=shown_figures(figures, captions),
        versions=f"Computed with {versions}.",
    )
    written = [page, folder / JSON]
    try:
        check_typesetting()
    except InputError:
        return written
    shown = [{"file": f"{n}.pdf", "title": captions[n].title, "text": captions[n].text} for n in figures]
    data = {"mission": certificate.mission, "verdict": verdict, "tiers": tiers, "figures": shown, "versions": versions}
    with TemporaryDirectory() as aside:
        parts = Path(aside)
        for name, figure in figures.items():
            save(figure, parts / f"{name}.pdf")
        _write(parts / "report.json", json.dumps(data, ensure_ascii=False, allow_nan=False))
        _write(parts / SOURCE, (DATA / "report" / "certificate.typ").read_text("utf-8"))
        typeset(parts, folder / PDF)
    return [*written, folder / PDF]


def _placed(certificate: Certificate, commands: Mapping[str, str]) -> Certificate:
    """A certificate with other commands, by those that it has."""
    tiers = [
        replace(tier, claims=tuple(c._replace(command=commands.get(c.command, c.command)) for c in tier.claims))
        for tier in certificate.tiers
    ]
    return replace(certificate, tiers=tuple(tiers))


def _write(path: Path, text: str) -> None:
    with atomic_write(path) as partial:
        partial.write_text(text, "utf-8")


def _verdict(certificate: Certificate) -> str:
    missed = [_name(claim) for claim in certificate.missed]
    return f"Below the bar: {'; '.join(missed)}." if missed else "No number is below its bar."


def _name(claim: Claim) -> str:
    return f"{claim.quantity}, {claim.subject}" if claim.subject else claim.quantity


def _row(claim: Claim) -> dict[str, Any]:
    """A claim as texts."""
    flown = ""
    if claim.flown is not None:
        scale = claim.value / claim.limit if claim.value and claim.limit else 1.0
        flown = f"{shown(scale * claim.flown.above)} ({claim.flown.ended})" if claim.flown.ended else "not reached"
    bar = "" if claim.bar is None else shown(claim.bar)
    return {
        "name": _name(claim),
        "value": shown(claim.value),
        "unit": "" if claim.unit == "1" else claim.unit,
        "bar": bar,
        "verdict": claim.verdict,
        "flown": flown,
        "text": claim.text,
        "command": claim.command,
    }


def shown(value: float | None) -> str:
    """A number with three digits; "none" for one without a limit."""
    if value is None or math.isnan(value):
        return "–"
    return NONE if math.isinf(value) else f"{value:.3g}".replace("-", MINUS)


def certificate_lines(certificate: Certificate) -> Iterator[str]:
    """A certificate in words: its tiers, their assumptions and their numbers."""
    for tier in certificate.tiers:
        yield tier.title
        yield from (f"  assumed: {text}" for text in tier.assumptions)
        if tier.reason:
            yield f"  not formed: {tier.reason}"
        rows = [_row(claim) for claim in tier.claims]
        wide = max((len(row["name"]) for row in rows), default=0)
        for row in rows:
            beside = " ".join(
                text
                for text in (
                    f"bar {row['bar']}" if row["bar"] else "",
                    row["verdict"],
                    row["flown"] and f"flown {row['flown']}",
                )
                if text
            )
            yield f"  {row['name']:{wide}}  {row['value']:>8} {row['unit']:4} {beside:24} {row['text']}".rstrip()
    yield _verdict(certificate)
