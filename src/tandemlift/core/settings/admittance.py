"""`[admittance]`: how a push moves the reference, by mass and damping or by what it feels like."""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from tandemlift.core.settings.key_description import key
from tandemlift.core.settings.value_types import NonNegative3, Positive3, Table, is_number

LN_20 = 2.995732273553991  # time constants until 95 %


class Feel(NamedTuple):
    """The response to a push of `force` [N]: `speed` [m/s] that it leads to, `time` [s] until 95 % of it."""

    force: float
    speed: float
    time: float


FEELS = {  # their damping keeps mean forces near 2 N; less mass than about 1 kg oscillates with a person who sees late
    "light": Feel(1.0, 0.5, 2.5),  # its acceleration begins with ln 20 · speed/time, 0.6 m/s²
    "firm": Feel(2.0, 0.6, 1.5),  # 1.2 m/s²
    "slow": Feel(1.0, 0.2, 1.5),  # 0.4 m/s²
}
TRIED = (
    "chosen: accelerations up to 1.2 m/s², of 2.5 that the tilt of mission iris gives; in `zigzag`, none "
    "of 400 random persons touches a wall with any of them"
)


class FeelTable(Table):
    """`[admittance.feel]`: the response to a push, in place of mass and damping: a force, a speed and a time.

    M v' + C v = F beyond the threshold: mass M and damping C follow, along each axis. A soft gate passes what exceeds
    the threshold; guidance by hand always has one.
    """

    preset: Literal["light", "firm", "slow"] = key(
        "light",
        None,
        "numbers by name; those that are given beside it count instead",
        choices={name: f"{f.force:g} N gives {f.speed:g} m/s in {f.time:g} s" for name, f in FEELS.items()},
        source=TRIED,
    )
    force: Positive3 | None = key(
        None, "N", "a push of this force", rule="above the threshold", unset="that of the preset", example=1.0
    )
    speed: Positive3 | None = key(None, "m/s", "speed that the push leads to", unset="that of the preset", example=0.6)
    time: Positive3 | None = key(
        None, "s", "time in which 95 % of that speed is reached", unset="that of the preset", example=1.5
    )

    @property
    def axes(self) -> tuple[Feel, Feel, Feel]:
        """The numbers along x, y and z: those given, else the preset's."""
        given = (getattr(self, name) or (number,) * 3 for name, number in FEELS[self.preset]._asdict().items())
        x, y, z = (Feel(*numbers) for numbers in zip(*given, strict=True))
        return x, y, z


class AdmittanceTable(Table):
    """`[admittance]`: virtual mass, damping and stiffness that a push moves, along each world axis."""

    feel: FeelTable | None = None

    mass: Positive3 = key(..., "kg", "virtual mass M", example=1.0)
    damping: NonNegative3 = key(
        ...,
        "N s/m",
        "virtual damping C; a push of impulse I moves the vehicle by about I/C",
        rule="from stiffness · step / 2 to 2 · mass / step",
        example=1.6,
    )
    stiffness: NonNegative3 = key(
        (0.0, 0.0, 0.0), "N/m", "virtual stiffness K; with 0 the vehicle stays where it was pushed"
    )
    threshold: NonNegative3 = key(..., "N", "forces up to this are ignored", example=0.3)
    gate: Literal["hard", "soft"] = key(
        "hard",
        None,
        "how much of a force beyond the threshold acts",
        choices={"hard": "the whole force", "soft": "only what exceeds the threshold"},
    )
    hold_after_release: bool = key(
        False, None, "with stiffness: true makes the vehicle stay where its motion has died, instead of springing back"
    )


def with_feel(tables: dict[str, Any]) -> dict[str, Any]:
    """A mission's tables with mass and damping by `[admittance.feel]`: v(t) = v (1 − exp(−C t/M)).

    They are unchanged without a feel, and where something is wrong that the keys' own rules explain. The dead band of
    guidance by hand is a soft gate.

    Raises:
        PydanticCustomError: a force is not above the threshold.
    """
    admittance, pilot = tables.get("admittance"), tables.get("pilot")
    try:
        feel, threshold = FeelTable(**admittance["feel"]), admittance["threshold"]  # type: ignore[index]
        thresholds = [float(x) for x in ([threshold] * 3 if is_number(threshold) else threshold)]
        pairs = list(zip(feel.axes, thresholds, strict=True))
    except (ValidationError, KeyError, TypeError, ValueError):
        return tables
    for axis, (given, least) in zip("xyz", pairs, strict=True):
        if given.force <= least:
            force = f"admittance.feel.force = {given.force:g}"
            words = f"{force}: must be above admittance.threshold = {least:g} along {axis}"
            raise PydanticCustomError("feel", "{words}", {"words": words})
    by_hand = isinstance(pilot, dict) and pilot.get("guidance") == "interactive"
    soft = by_hand or admittance.get("gate") == "soft"  # type: ignore[union-attr]
    damping = tuple((given.force - (least if soft else 0.0)) / given.speed for given, least in pairs)
    mass = tuple(c * given.time / LN_20 for c, given in zip(damping, feel.axes, strict=True))
    return {**tables, "admittance": {**admittance, "damping": damping, "mass": mass}}  # type: ignore[dict-item]
