"""A certificate of a mission: its tiers, as plain data and as a file."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tandemlift.analysis.certification.claims import MET, MISSED, Claim, Tier
from tandemlift.core.errors import InputError
from tandemlift.core.files import write_file
from tandemlift.missions import format_toml

TIERS = ("linear", "structured", "person", "nonlinear", "statistics")
SECONDS = {  # of a tier of `iris` on two cores, without flights that look for its limits and with them; of a flight
    "linear": (20.0, 60.0),
    "structured": (20.0, 20.0),
    "person": (40.0, 90.0),
    "nonlinear": (40.0, 60.0),
    "statistics": (0.03, 0.03),
}


@dataclass(frozen=True)
class Certificate:
    """The certificate of a mission.

    Attributes:
        mission: its name.
        tiers: in the order of their strength, from the linear model to flights.
        versions: of the packages that computed it.
        tables: of the mission, with every key.
        flown: whether flights looked for the predicted limits.
        made: the day on which it was computed, as in 2026-01-31.
        stopped: whether it was stopped before all tiers that were asked for.
    """

    mission: str
    tiers: tuple[Tier, ...]
    versions: Mapping[str, str]
    tables: Mapping[str, Any] = field(default_factory=dict)
    flown: bool = False
    made: str = ""
    stopped: bool = False

    def tier(self, name: str) -> Tier:
        """A tier by its name.

        Raises:
            InputError: the certificate has none of this name.
        """
        found = [tier for tier in self.tiers if tier.name == name]
        if not found:
            raise InputError(
                f"tier {name!r} is not in this certificate; it has {', '.join(tier.name for tier in self.tiers)}"
            )
        return found[0]

    @property
    def missed(self) -> tuple[Claim, ...]:
        """The claims below their bar."""
        return tuple(claim for tier in self.tiers for claim in tier.claims if claim.verdict == MISSED)

    @property
    def left_out(self) -> tuple[str, ...]:
        """The tiers, by name, that are not in it."""
        return tuple(name for name in TIERS if name not in [tier.name for tier in self.tiers])

    @property
    def not_formed(self) -> tuple[str, ...]:
        """The tiers, by name, that were asked for and have no numbers."""
        return tuple(tier.name for tier in self.tiers if not tier.claims)

    @property
    def scope(self) -> str:
        """What the certificate covers, in a sentence: its tiers, those that were left out, and whether limits flew."""
        names = [tier.name for tier in self.tiers]
        parts = ["Stopped before its end"] * self.stopped
        parts += [f"{len(names)} of {len(TIERS)} tiers: {', '.join(names) or 'none'}"]
        parts += [f"left out: {', '.join(self.left_out)}"] * bool(self.left_out)
        parts += [f"not formed: {', '.join(self.not_formed)}"] * bool(self.not_formed)
        limits = any(claim.limit is not None for tier in self.tiers for claim in tier.claims)
        parts += ["no limits" if not limits else "limits flown" if self.flown else "limits predicted, not flown"]
        return f"{'; '.join(parts)}."

    @property
    def mission_sha256(self) -> str:
        """The SHA-256 of the mission with every key, as `mission.toml` beside the certificate."""
        return hashlib.sha256(format_toml(self.tables).encode()).hexdigest()

    @property
    def verdict(self) -> str:
        """The numbers below their bar, or how many have one, in a sentence."""
        if missed := self.missed:
            return f"Below the bar: {'; '.join(claim.name for claim in missed)}."
        judged = sum(claim.verdict == MET for tier in self.tiers for claim in tier.claims)
        return f"No number is below its bar, of {judged} that have one." if judged else "No number has a bar."

    def to_dict(self) -> dict[str, Any]:
        """The certificate as plain data; a number without a limit is the text "unlimited", one that is unknown None."""
        return {
            "scope": self.scope,
            "verdict": self.verdict,
            "mission": self.mission,
            "mission_sha256": self.mission_sha256,
            "made": self.made,
            "flown": self.flown,
            "stopped": self.stopped,
            "left_out": list(self.left_out),
            "tables": _finite(self.tables),
            "versions": dict(self.versions),
            "tiers": [
                {
                    "name": tier.name,
                    "title": tier.title,
                    "assumptions": list(tier.assumptions),
                    "reason": tier.reason,
                    "claims": [_plain(claim) for claim in tier.claims],
                    "curves": _finite(tier.curves),
                }
                for tier in self.tiers
            ],
        }

    def save(self, path: str | Path) -> None:
        """Write it as JSON, atomically."""
        write_file(Path(path), json.dumps(self.to_dict(), ensure_ascii=False, indent=1, allow_nan=False))


def _plain(claim: Claim) -> dict[str, Any]:
    flown = claim.flown._asdict() if claim.flown is not None else None
    value = claim.tried if claim.is_least else claim.value
    more = {"value": value, "at_least": claim.is_least, "flown": flown, "verdict": claim.verdict}
    return _finite({**claim._asdict(), **more})


def _finite(value: Any) -> Any:
    """Plain data without infinities and NaN, which JSON has no numbers for."""
    if isinstance(value, Mapping):
        return {key: _finite(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(one) for one in value]
    if hasattr(value, "tolist"):
        return _finite(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else "unlimited"
    return value


def time_left(tiers: Sequence[str], done: int, elapsed: float, *, fly: bool, flights: int) -> float:
    """The time that is left [s] after `done` tiers in `elapsed` [s]: by `SECONDS` at first, then by their pace."""
    work = [SECONDS[name][fly] * (flights if name == "statistics" else 1) for name in tiers]
    return sum(work[done:]) * (elapsed / sum(work[:done]) if done else 1.0)
