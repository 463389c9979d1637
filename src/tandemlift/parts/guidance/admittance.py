"""The admittance controller: a person's push becomes a reference trajectory T_r.

M (T̈_r − T̈_d) + C (Ṫ_r − Ṫ_d) + K (T_r − T_d) = F_ext, per world axis, with T_d at rest and F_ext the gated force of
the person on the vehicle. Erratum: the paper prints T_d − T_r, which would move the vehicle against the push.
T̈_r is computed at the sample and held over the step.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import ValidationError
from pydantic_core import PydanticCustomError

from tandemlift.core.algebra import absolute, clip, where
from tandemlift.core.caching import cached
from tandemlift.core.errors import CheckResult, refused
from tandemlift.core.keys import NonNegative3, Positive3, Table, is_number, key
from tandemlift.core.law import choice, elementwise, law
from tandemlift.core.plugs import PLUGS, Chosen, plug
from tandemlift.core.trajectories import Trajectory
from tandemlift.core.types import LN_20, Number
from tandemlift.core.vector import Vec3, vec3


class Feel(NamedTuple):
    """The response to a push of `force` [N]: its final `speed` [m/s], and the `time` [s] until 95 % of it."""

    force: float
    speed: float
    time: float


FEELS = {  # their damping keeps mean forces near 2 N; less mass than about 1 kg oscillates with a person who sees late
    "light": Feel(1.0, 0.5, 2.5),  # the initial acceleration is ln 20 · speed/time, 0.6 m/s²
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
    the threshold; interactive guidance always has one.
    """

    preset: Literal["light", "firm", "slow"] = key(
        "light",
        None,
        "preset of the numbers; numbers that are given beside it take precedence",
        choices={name: f"{f.force:g} N gives {f.speed:g} m/s in {f.time:g} s" for name, f in FEELS.items()},
        source=TRIED,
    )
    force: Positive3 | None = key(
        None, "N", "a push of this force", rule="above the threshold", unset="that of the preset", example=1.0
    )
    speed: Positive3 | None = key(None, "m/s", "final speed of the push", unset="that of the preset", example=0.6)
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
    """`[admittance]`: virtual mass, damping and stiffness on which a push acts, along each world axis."""

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
    gate: Annotated[Literal["hard", "soft"], Chosen("gate")] | None = key(
        None,
        None,
        "part of a force above the threshold that acts",
        rule='"soft" or left out where pilot.guidance is "interactive"',
        unset="hard scheduled, soft interactive",
        example="soft",
        choices={"hard": "the whole force", "soft": "only the excess over the threshold"},
    )
    hold_after_release: bool = key(
        False, None, "with stiffness: true makes the vehicle stay where its motion ends, instead of springing back"
    )


def with_feel(tables: dict[str, Any]) -> dict[str, Any]:
    """A mission's tables with mass and damping by `[admittance.feel]`: v(t) = v (1 − exp(−C t/M)).

    They are unchanged without a feel, and with an error that the keys' own rules explain. The dead band of
    interactive guidance is a soft gate.

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
    is_soft = by_hand or admittance.get("gate") == "soft"  # type: ignore[union-attr]
    damping = tuple((given.force - (least if is_soft else 0.0)) / given.speed for given, least in pairs)
    mass = tuple(c * given.time / LN_20 for c, given in zip(damping, feel.axes, strict=True))
    return {**tables, "admittance": {**admittance, "damping": damping, "mass": mass}}  # type: ignore[dict-item]


# m/s; far below any motion. A velocity that decays ends near 1e-114, and never in slow denormal numbers.
REST = Vec3(1e-100, 1e-100, 1e-100)


class HardGate(NamedTuple):
    """Passes a force unchanged where it exceeds the threshold [N]."""

    threshold: Vec3


class SoftGate(NamedTuple):
    """Passes the part of a force that exceeds the threshold [N]: continuous, but smaller by the threshold."""

    threshold: Vec3


class Admittance(NamedTuple):
    """1/M [1/kg], C [N·s/m], K [N/m] per world axis.

    `hold_after_release`: 1 if T_d moves to T_r after a push, else 0.
    """

    inverse_mass: Vec3
    damping: Vec3
    stiffness: Vec3
    hold_after_release: Number


class AdmittanceState(NamedTuple):
    """Memory of the admittance: T_r [m], Ṫ_r [m/s] and T_d [m], world axes."""

    position: Vec3
    velocity: Vec3
    anchor: Vec3


@choice
def gate(kind: HardGate | SoftGate, F: Vec3) -> Vec3:
    """The part of a measured force [N, world axes] that the admittance responds to, per axis."""


@elementwise
def hard_threshold(F: Number, threshold: Number) -> Number:
    """F where |F| > threshold, else 0."""
    return where(absolute(F) > threshold, F, 0.0)


@elementwise
def soft_threshold(F: Number, threshold: Number) -> Number:
    """F − threshold sgn F where |F| > threshold, else 0."""
    return F - clip(F, -threshold, threshold)


@gate.register(HardGate)
def _hard_gate(kind: HardGate, F: Vec3) -> Vec3:
    return hard_threshold(F, kind.threshold)


@gate.register(SoftGate)
def _soft_gate(kind: SoftGate, F: Vec3) -> Vec3:
    return soft_threshold(F, kind.threshold)


@elementwise
def anchored(anchor: Number, position: Number, velocity: Number, force: Number, hold_after_release: Number) -> Number:
    """T_d of one axis, moved to T_r once the gate passes no force and the motion away from T_d has ended.

    From then on the spring is unloaded: T_r comes to rest under its damping, and stays.
    """
    ended = where(velocity * (position - anchor) > 0.0, anchor, position)
    return where(absolute(force) * hold_after_release + (1.0 - hold_after_release) > 0.0, anchor, ended)


@law
def admittance_response(a: Admittance, m: AdmittanceState, F: Vec3) -> Trajectory:
    """T_r, Ṫ_r and T̈_r under the gated force F [N, world axes]."""
    # paper: equ4
    acceleration = (F - a.damping * m.velocity - a.stiffness * (m.position - m.anchor)) * a.inverse_mass
    return Trajectory(m.position, m.velocity, acceleration)


@law
def admittance_step(a: Admittance, m: AdmittanceState, F: Vec3, now: Trajectory, dt: Number) -> AdmittanceState:
    """The memory after a step of `dt` [s] with T̈_r held."""
    position = m.position + m.velocity * dt + now.acceleration * (0.5 * dt * dt)
    velocity = (m.velocity + now.acceleration * dt + REST) - REST
    return AdmittanceState(position, velocity, anchored(m.anchor, position, velocity, F, a.hold_after_release))


@cached
def admittance_from(a: AdmittanceTable) -> Admittance:
    """M, C and K of a mission."""
    inverse_mass = vec3(1.0 / m for m in a.mass)
    return Admittance(inverse_mass, vec3(a.damping), vec3(a.stiffness), float(a.hold_after_release))


@cached
def gate_from(a: AdmittanceTable) -> Any:
    """The gate of scheduled guidance, by whose type `gate` finds its law; interactive guidance has the dead band of its
    compliance instead."""
    return PLUGS["gate"][a.gate or "hard"].start(a)


@plug("gate", "hard")
def _hard(a: AdmittanceTable) -> HardGate:
    return HardGate(vec3(a.threshold))


@plug("gate", "soft")
def _soft(a: AdmittanceTable) -> SoftGate:
    return SoftGate(vec3(a.threshold))


def gate_checks(a: AdmittanceTable, guidance: str) -> Iterator[CheckResult]:
    """A hard gate with interactive guidance, whose dead band is a soft one; `guidance`: `pilot.guidance`."""
    if a.gate not in (None, "soft") and guidance == "interactive":
        yield refused(f'admittance.gate = "{a.gate}": must be "soft" or left out where pilot.guidance is "interactive"')


def admittance_checks(a: AdmittanceTable, step: float) -> Iterator[CheckResult]:
    """Check for a sampled admittance that is unstable: an eigenvalue outside the unit circle."""
    for axis, M, C, K in zip("xyz", a.mass, a.damping, a.stiffness, strict=True):
        # z² − (2 − c − k/2) z + 1 − c + k/2 with c = Ch/M, k = Kh²/M; Jury's conditions come to k/2 ≤ c ≤ 2
        least, most = K * step / 2.0, 2.0 * M / step
        if not least * (1.0 - 1e-12) <= C <= most * (1.0 + 1e-12):
            yield refused(
                f"admittance.damping = {C} along {axis}: must be from stiffness*step/2 = {least:.6g} to "
                f"2*mass/step = {most:.6g} N s/m with mass {M:g} kg, stiffness {K:g} N/m and step {step:g} s, "
                "or the admittance is unstable"
            )
