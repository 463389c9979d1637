"""A certificate of a mission: its tiers, as plain data and as a file."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tandemlift.analysis.linearization.claims import MISSED, Claim, Tier
from tandemlift.core.errors import InputError
from tandemlift.core.files import write_file


@dataclass(frozen=True)
class Certificate:
    """The certificate of a mission.

    Attributes:
        mission: its name.
        tiers: in the order of their strength, from the linear model to flights.
        versions: of the packages that computed it.
        tables: of the mission, with every key.
    """

    mission: str
    tiers: tuple[Tier, ...]
    versions: Mapping[str, str]
    tables: Mapping[str, Any] = field(default_factory=dict)

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

    def to_dict(self) -> dict[str, Any]:
        """The certificate as plain data; a number without a limit is the text "unlimited", one that is unknown None."""
        return {
            "mission": self.mission,
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
    return _finite({**claim._asdict(), "flown": flown, "verdict": claim.verdict})


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
