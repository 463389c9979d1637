"""A certificate as files: a page, JSON, a PDF, and the missions that fly beyond each limit."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tandemlift.analysis.certification.certificate import Certificate
from tandemlift.analysis.certification.claims import Claim, Tier
from tandemlift.core.errors import InputError
from tandemlift.core.files import DATA, atomic_write
from tandemlift.missions import format_toml
from tandemlift.pictures.drawing.style import save
from tandemlift.pictures.report.page import Verdict, shown_figures, write_page
from tandemlift.pictures.report.paper_report import check_typesetting, typeset
from tandemlift.pictures.report.study.certificate_figures import certificate_captions, certificate_figures
from tandemlift.pictures.report.study.words import command

PAGE, JSON, PDF, SOURCE = "certificate.html", "certificate.json", "certificate.pdf", "report.typ"
MISSION = "mission.toml"
NONE, MINUS = "none", "−"


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
    tiers = [_shown_tier(tier) for tier in certificate.tiers]
    versions = ", ".join(f"{n} {v}" for n, v in certificate.versions.items())
    about, flown = [certificate.scope, _identity(certificate)], ["--fly"] * certificate.flown
    names, (head, colon, rest) = ",".join(t.name for t in certificate.tiers), certificate.verdict.partition(":")
    page = write_page(
        folder / PAGE,
        "certificate",
        name=certificate.mission,
        about=" ".join(about),
        verdict=Verdict(head, colon + rest, "missed" if certificate.missed or certificate.not_formed else ""),
        tiers=tiers,
        mission=mission,
        repeat=command("certify", folder / MISSION, "--tiers", names, *flown),
        figures=shown_figures(figures, captions),
        versions=f"Computed with {versions}.",
    )
    written = [page, folder / JSON]
    try:
        check_typesetting()
    except InputError:
        return written
    shown = [{"file": f"{n}.pdf", "title": captions[n].title, "text": captions[n].text} for n in figures]
    data = {"mission": certificate.mission, "about": about, "verdict": certificate.verdict, "tiers": tiers}
    data |= {"figures": shown, "versions": versions}
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


def _identity(certificate: Certificate) -> str:
    by = f"tandemlift {certificate.versions.get('tandemlift', '')}"
    return f"Mission {certificate.mission}, SHA-256 {certificate.mission_sha256[:16]}…; {by}; {certificate.made}."


def _shown_tier(tier: Tier) -> dict[str, Any]:
    """A tier as texts; columns without a text are left out."""
    rows = [_row(claim) for claim in tier.claims]
    columns = [name for name in ("bar", "flown") if any(row[name] for row in rows)]
    about = {"title": tier.title, "assumptions": tier.assumptions, "reason": tier.reason}
    return {**about, "rows": rows, "columns": columns}


def _row(claim: Claim) -> dict[str, Any]:
    """A claim as texts."""
    flown = ""
    if claim.flown is not None:
        scale = claim.value / claim.limit if claim.value and claim.limit else 1.0
        flown = f"{shown(scale * claim.flown.above)} ({claim.flown.ended})" if claim.flown.ended else "not reached"
    bar = "" if claim.bar is None else shown(claim.bar)
    return {
        "name": claim.name,
        "value": f"≥ {shown(claim.tried)}" if claim.is_least else shown(claim.value),
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
    """A certificate in words: what it covers and its verdict, then its tiers, their assumptions and their numbers."""
    yield from (certificate.scope, certificate.verdict, _identity(certificate))
    for tier in certificate.tiers:
        yield tier.title
        yield from (f"  assumed: {text}" for text in tier.assumptions)
        if tier.reason:
            yield f"  not formed: {tier.reason}"
        rows = []
        for row in map(_row, tier.claims):
            said = (row["bar"] and f"bar {row['bar']}", row["verdict"], row["flown"] and f"flown {row['flown']}")
            rows.append((row["name"], f"{row['value']:>8} {row['unit']:4}", " ".join(filter(None, said)), row["text"]))
        wide, _, beside, _ = [max(map(len, column)) for column in zip(*rows, strict=True)] if rows else (0, 0, 0, 0)
        for name, value, words, text in rows:
            yield f"  {name:{wide}}  {value} {words:{beside}}{' ' * bool(beside)}{text}".rstrip()
    yield f"{certificate.scope} {certificate.verdict}"
