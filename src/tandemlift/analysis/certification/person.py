"""The person tier: the vehicle in an arm's hand, a person who leads it late, and contact with a person."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.certification.admittance_map import admittance_map
from tandemlift.analysis.certification.claims import Claim, Tier
from tandemlift.analysis.certification.contact_limits import HAND, contact_claims
from tandemlift.analysis.certification.felt_admittance import (
    CEILING,
    ArmImpedance,
    FeltAdmittance,
    felt_admittance,
    is_coupled_stable,
    largest_stable,
    stiffness_limit,
)
from tandemlift.analysis.certification.linear import nearest_to_oscillation
from tandemlift.analysis.certification.parameters import ARM
from tandemlift.analysis.certification.shakes import shake_claims
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.missions import Mission, PersonTable

TITLE = "Person: an arm that holds the vehicle, and contact"
MAX_DELAY = 10.0  # s: a later person is not tried
ASSUMPTIONS = (
    "The vehicle hovers calmly; a push along all axes is beyond its threshold, so that the admittance responds.",
    "The model is linear: no limit of speed, acceleration, tilt or thrust, dead band or energy tank acts.",
    "An arm is a spring and a damper between a fixed place and the grip, with the mass of a hand at the grip.",
    "The largest shake is found by flights, with all limits and errors of sensors: a sine for 8 s.",
    "A person who leads sees the vehicle late, as in [person]; the limits are those of small motions.",
    "Contact: two bodies collide once at the largest speed of the admittance; forces and masses of body regions are "
    "those of ISO/TS 15066. Open rotors injure at any speed and are not judged.",
)


class ArmBox(NamedTuple):
    """The arms against which a vehicle is judged: the largest stiffness [N/m], damping [N s/m] and hand mass [kg]."""

    stiffness: float = 100.0
    damping: float = 5.0
    mass: float = HAND

    def checked(self) -> ArmBox:
        """The box.

        Raises:
            InputError: it is empty.
        """
        for name, value in self._asdict().items():
            if not 0.0 < value < math.inf:
                raise InputError(f"arm {name} = {value:g}: must be above 0 and finite, or the box of arms is empty")
        return self


def leading_impedance(p: PersonTable, w: Array, delay: float) -> NDArray[np.complexfloating]:
    """Z (F,) of a person with model "pull" who leads the grip and sees it with a delay [s]: `parts.person.person`.

    The hand moves, through the muscles, to the seen grip, predicted over the delay and the muscles' lag, and ahead of
    it by the force for the missing speed over the stiffness.
    """
    s = 1j * w
    seen = np.exp(-s * delay) / (1.0 + p.lag * s) ** 2
    arm = p.stiffness / s + p.damping
    return arm * (1.0 - seen * (1.0 + s * (delay + 2.0 * p.lag) - s * p.gain / p.stiffness))


def person_tier(mission: Mission, box: ArmBox, *, fly: bool = False) -> Tier:
    """The person tier of a mission; without claims, and with the reason, where its loop has no linear model.

    Args:
        mission: whose person's grip is held.
        box: of arms.
        fly: whether to fly the map.
    """
    try:
        felt = felt_admittance(mission)
    except InputError as error:
        return Tier("person", TITLE, ASSUMPTIONS, reason=f"there is no linear model: {error}")
    contact = contact_claims(mission.hover.mass, max(mission.compliance.max_speed))
    shakes, shaken, files = shake_claims(mission)
    claims = (*passivity(felt), *_arms(mission.person, felt, box), *shakes, *contact)
    curves = {
        "frequency": felt.w.tolist(),
        **{axis: felt.Y[:, i, i].real.tolist() for i, axis in enumerate("xyz")},
        "map": admittance_map(mission, fly=fly),
        "shakes": shaken,
    }
    return Tier("person", TITLE, ASSUMPTIONS, claims, curves, files)


def passivity(felt: FeltAdmittance) -> Iterator[Claim]:
    """Up to which frequency the vehicle is passive in the hand: Re Y ≥ 0."""
    for i, axis in enumerate("xyz"):
        real = felt.Y[:, i, i].real
        bad = np.flatnonzero(real < 0.0)
        upto = float(felt.w[bad[0]]) / (2.0 * math.pi) if len(bad) else math.inf
        worst = int(np.argmin(real))
        text = (
            "passive at all frequencies"
            if not len(bad)
            else (
                f"beyond it the vehicle can give energy to a hand, most at {felt.w[worst] / (2.0 * math.pi):.2g} Hz: "
                f"Re Y = {real[worst]:.2g} m/(s N)"
            )
        )
        yield Claim("passive up to", axis, upto, "Hz", None, text)


def _arms(p: PersonTable, felt: FeltAdmittance, box: ArmBox) -> Iterator[Claim]:
    """Limits of arms that hold the vehicle, and of the delay of a person who leads it."""
    w, at = felt.w, stiffness_limit(felt, p.damping)
    text = f"massless, with the damping of [person], {p.damping:g} N s/m; [person] has {p.stiffness:g} N/m"
    frequency = math.nan
    if at < math.inf:
        frequency = coupled_frequency(felt, ArmImpedance(at, p.damping).impedance(w))
        text += f"; it oscillates at {frequency:.3g} rad/s"
    yield Claim(
        "arm stiffness limit",
        "",
        at,
        "N/m",
        p.stiffness,
        text,
        frequency,
        parameter=ARM,
        limit=at if at < math.inf else None,
        tried=CEILING,
    )
    worst = min((stiffness_limit(felt, b, m), b, m) for b in np.linspace(0.0, box.damping, 4) for m in (0.0, box.mass))
    text = (
        f"damping up to {box.damping:g} N s/m, hands up to {box.mass:g} kg at the grip: the worst of them has "
        f"{worst[1]:.3g} N s/m and {worst[2]:g} kg"
    )
    yield Claim("arm stiffness limit, box", "", worst[0], "N/m", box.stiffness, text, tried=CEILING)
    heavy = largest_stable(lambda m: is_coupled_stable(felt, ArmImpedance(0.0, p.damping, m).impedance(w)), 0.01)
    text = f"rigidly at the grip, with {p.damping:g} N s/m; a hand has about {HAND:g} kg, mostly behind soft tissue"
    yield Claim("hand mass limit", "", heavy, "kg", None, text, tried=CEILING)
    late = largest_stable(lambda T: is_coupled_stable(felt, leading_impedance(p, w, T)), 0.01, MAX_DELAY)
    text = f"of a person who leads the vehicle, with the other keys of [person]; theirs is {p.delay:g} s"
    yield Claim("reaction delay limit", "", late, "s", p.delay, text, tried=MAX_DELAY)


def coupled_frequency(felt: FeltAdmittance, Z: NDArray[np.complexfloating]) -> float:
    """The frequency [rad/s] at which the vehicle in an arm's hand is nearest to an oscillation."""
    return min(
        (nearest_to_oscillation(felt.w, y * Z) for y in np.linalg.eigvals(felt.Y).T), key=lambda found: found[1]
    )[0]
