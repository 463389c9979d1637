"""The person tier: the admittance as felt at the hand, an arm that holds the vehicle, and contact with a person.

Y(jω) (3 × 3) is the velocity of the grip over the force on it, of the closed linear model while a push acts. An arm
with impedance Z = m s + b + k/s, massless or with the mass of a hand, is coupled to it: the loops are stable if
det(I + Y Z) turns about 0 only as far as its ends ask.

Sources: Colgate and Hogan, Robust control of dynamically interacting systems, 1988; Keemink, van der Kooij and Stienen,
Admittance control for physical human-robot interaction, 2018.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tandemlift.analysis.certification.contact_limits import HAND, contact_claims
from tandemlift.analysis.certification.flown import held, hover_as_flown, stability_in_hand
from tandemlift.analysis.certification.linear import nearest_to_oscillation
from tandemlift.analysis.certification.parameters import ARM, with_keys
from tandemlift.analysis.linearization.frequency_response import frequency_response
from tandemlift.analysis.linearization.linearize import linearize
from tandemlift.analysis.linearization.loop_margins import NO_KINK
from tandemlift.analysis.robustness.certificate import Claim, Tier
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.missions import Mission
from tandemlift.simulation.fly import fly_many
from tandemlift.simulation.simulation import Simulation

TITLE = "Person: an arm that holds the vehicle, and contact"
ASSUMPTIONS = (
    "The vehicle hovers calmly; a push along all axes is beyond its threshold, so that the admittance responds.",
    "The model is linear: no limit of speed, acceleration, tilt or thrust, dead band or energy tank acts.",
    "An arm is a spring and a damper between a fixed place and the grip, with the mass of a hand at the grip.",
    "A person who leads sees the vehicle late, as in [person]; the limits are those of small motions.",
    "Contact: two bodies collide once at the largest speed of the admittance; forces and masses of body regions are "
    "those of ISO/TS 15066. Open rotors injure at any speed and are not judged.",
)
SLOWEST, FASTEST, POINTS = 0.03, 300.0, 240  # rad/s
BEYOND, PUSHED = 0.2, 2.5  # N beyond the threshold, and s, of the push in which the model is formed
LARGEST = 1e5  # N/m, kg, s: more is not tried
ACCURACY = 5e-3  # relative
GROWS = 1e-6  # beyond 1, of an eigenvalue that grows
AROUND, MAP = (0.2, 5.0), 16  # factors of the mission's mass and damping in the map, and points along each
FLOWN, FLOWN_MASS = 3, 1  # every third damping and every mass of the map is flown
SPREAD = 3.0  # between the masses and dampings of a family's models
LEAST_DAMPING = 0.1  # N s/m, in the map of a mission without damping


class FeltAdmittance(NamedTuple):
    """The admittance at the hand.

    Attributes:
        w: frequencies [rad/s] (F,).
        Y: velocity of the grip over the force on it [m/(s N)], world axes (F, 3, 3); or of one axis (F, 1, 1).
    """

    w: Array
    Y: NDArray[np.complexfloating]


class ArmImpedance(NamedTuple):
    """An arm between a fixed place and the grip: stiffness [N/m], damping [N s/m], and mass of the hand [kg]."""

    stiffness: float
    damping: float
    mass: float = 0.0

    def impedance(self, w: Array) -> NDArray[np.complexfloating]:
        """Z (F,): force over velocity [N s/m]."""
        s = 1j * w
        return self.mass * s + self.damping + self.stiffness / s


def felt_admittance(mission: Mission, changes: dict[str, Any] | None = None) -> FeltAdmittance:
    """The admittance at the hand of a mission, hovering, while a push along all axes is beyond its threshold.

    Args:
        mission: whose person's grip is the hand's place.
        changes: further changes by dotted key.

    Raises:
        InputError: the controller is plain Python, a change is invalid, or the flight is lost.
    """
    hover, at = hover_as_flown(mission)
    hover = with_keys(hover, {"mission.duration": at + 2.0 * PUSHED, **(changes or {})})
    sim = Simulation(hover)
    sim.step(steps=round(at / sim.dt))
    sim.step([x + BEYOND for x in hover.admittance.threshold], steps=round(PUSHED / sim.dt))
    groups = ["push_force", "push_moment"], ["velocity", "rates"]
    model = linearize(sim, inputs=groups[0], outputs=groups[1], kink_tolerance=NO_KINK).connected()
    if np.abs(np.linalg.eigvals(model.A)).max() > 1.0 + GROWS:
        raise InputError(f"{mission.mission.name}: a push beyond the threshold makes the hover unstable")
    T, h = hover.mission.step, model.step
    w = np.geomspace(SLOWEST, min(FASTEST, 0.9 * math.pi / h), POINTS)
    s = 1j * w
    held = (np.expm1(-s * T) * h) / (np.expm1(-s * h) * T)  # the model holds a force for a sample, an arm for a step
    x, y, z = np.add(mission.hover.vehicle.origin, (0.0, mission.person.grip, 0.0))  # the grip
    lever = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])  # v = v_c + ω × r
    at_grip = np.hstack([np.eye(3), lever])
    return FeltAdmittance(w, at_grip @ frequency_response(model, w / (2.0 * math.pi)) @ at_grip.T * held[:, None, None])


def is_coupled_stable(felt: FeltAdmittance, Z: NDArray[np.complexfloating]) -> bool:
    """Whether a stable vehicle stays stable once an impedance Z (F,), the same along each axis, holds its grip."""
    eye = np.eye(felt.Y.shape[-1])
    det = np.linalg.det(eye + felt.Y * Z[:, None, None]) if len(eye) > 1 else 1.0 + felt.Y[:, 0, 0] * Z
    ends = np.angle(np.linalg.eigvals(eye + felt.Y[[0, -1]] * Z[[0, -1], None, None])).sum(axis=1)
    turned = np.unwrap(np.angle(det))
    return bool(abs(turned[-1] - turned[0] - (ends[1] - ends[0])) < math.pi)


def largest_stable(stable: Callable[[float], bool], start: float, most: float = LARGEST) -> float:
    """The smallest number above 0 at which stability is lost, by bisection; infinite beyond `most`."""
    low, high = 0.0, start
    while stable(high):
        low, high = high, 1.5 * high
        if high > most:
            return math.inf
    while high - low > ACCURACY * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if stable(middle) else (low, middle)
    return 0.5 * (low + high)


def stiffness_limit(felt: FeltAdmittance, damping: float, mass: float = 0.0) -> float:
    """The stiffness of an arm [N/m] from which on the vehicle in its hand oscillates."""
    return largest_stable(lambda k: is_coupled_stable(felt, ArmImpedance(k, damping, mass).impedance(felt.w)), 1.0)


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


def leading_impedance(mission: Mission, w: Array, delay: float) -> NDArray[np.complexfloating]:
    """Z (F,) of a person with model "pull" who leads the grip and sees it with a delay [s]: `parts.interaction.person`.

    The hand moves, through the muscles, to the seen grip, predicted over the delay and the muscles' lag, and ahead of
    it by the force for the missing speed over the stiffness.
    """
    p, s = mission.person, 1j * w
    seen = np.exp(-s * delay) / (1.0 + p.lag * s) ** 2
    arm = p.stiffness / s + p.damping
    return arm * (1.0 - seen * (1.0 + s * (delay + 2.0 * p.lag) - s * p.gain / p.stiffness))


def person_tier(mission: Mission, box: ArmBox) -> Tier:
    """The person tier of a mission; without claims, and with the reason, where its loop has no linear model.

    Args:
        mission: whose person's grip is held.
        box: of arms.
    """
    try:
        felt = felt_admittance(mission)
    except InputError as error:
        return Tier("person", TITLE, ASSUMPTIONS, reason=f"there is no linear model: {error}")
    claims = (*_passivity(felt), *_arms(mission, felt, box), *contact_claims(mission))
    curves = {
        "frequency": felt.w.tolist(),
        **{axis: felt.Y[:, i, i].real.tolist() for i, axis in enumerate("xyz")},
        **_map(mission),
    }
    return Tier("person", TITLE, ASSUMPTIONS, claims, curves)


def _passivity(felt: FeltAdmittance) -> Iterator[Claim]:
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


def _arms(mission: Mission, felt: FeltAdmittance, box: ArmBox) -> Iterator[Claim]:
    """Limits of arms that hold the vehicle, and of the delay of a person who leads it."""
    p, w = mission.person, felt.w
    at = stiffness_limit(felt, p.damping)
    text = f"massless, with the damping of [person], {p.damping:g} N s/m; [person] has {p.stiffness:g} N/m"
    frequency = math.nan
    if at < math.inf:
        frequency = coupled_frequency(felt, ArmImpedance(at, p.damping).impedance(w))
        text += f"; it oscillates at {frequency:.3g} rad/s"
    yield Claim("arm stiffness limit", "", at, "N/m", p.stiffness, text, frequency, parameter=ARM, limit=at)
    worst = min((stiffness_limit(felt, b, m), b, m) for b in np.linspace(0.0, box.damping, 4) for m in (0.0, box.mass))
    text = (
        f"damping up to {box.damping:g} N s/m, hands up to {box.mass:g} kg at the grip: the worst of them has "
        f"{worst[1]:.3g} N s/m and {worst[2]:g} kg"
    )
    yield Claim("arm stiffness limit, box", "", worst[0], "N/m", box.stiffness, text)
    heavy = largest_stable(lambda m: is_coupled_stable(felt, ArmImpedance(0.0, p.damping, m).impedance(w)), 0.01)
    text = f"rigidly at the grip, with {p.damping:g} N s/m; a hand has about {HAND:g} kg, mostly behind soft tissue"
    yield Claim("hand mass limit", "", heavy, "kg", None, text)
    late = largest_stable(lambda T: is_coupled_stable(felt, leading_impedance(mission, w, T)), 0.01, 10.0)
    text = f"of a person who leads the vehicle, with the other keys of [person]; theirs is {p.delay:g} s"
    yield Claim("reaction delay limit", "", late, "s", p.delay, text)


def coupled_frequency(felt: FeltAdmittance, Z: NDArray[np.complexfloating]) -> float:
    """The frequency [rad/s] at which the vehicle in an arm's hand is nearest to an oscillation."""
    return min(
        (nearest_to_oscillation(felt.w, y * Z) for y in np.linalg.eigvals(felt.Y).T), key=lambda found: found[1]
    )[0]


class AdmittanceFamily(NamedTuple):
    """The admittance at the hand for any virtual mass and damping, along each axis.

    Virtual mass M and damping C act through the acceleration over the force, A = 1/(M + C T/(z − 1)), alone, so that
    Y = (α + β A)/(1 + γ A) at each frequency.

    Attributes:
        w: frequencies [rad/s] (F,).
        coefficients: α, β and γ (F, 3 axes, 3).
        step: T, of the mission [s].
    """

    w: Array
    coefficients: NDArray[np.complexfloating]
    step: float

    def at(self, mass: float, damping: float) -> NDArray[np.complexfloating]:
        """Y (F, 3 axes) with a virtual mass [kg] and damping [N s/m]."""
        alpha, beta, gamma = np.moveaxis(self.coefficients, -1, 0)
        A = acceleration_per_force(self.w, self.step, mass, damping)[:, None]
        return (alpha + beta * A) / (1.0 + gamma * A)


def acceleration_per_force(w: Array, step: float, mass: float, damping: float) -> NDArray[np.complexfloating]:
    """A (F,) [1/kg] of the admittance, sampled every `step` [s]."""
    return 1.0 / (mass + damping * step / np.expm1(1j * w * step))


def admittance_family(mission: Mission) -> AdmittanceFamily:
    """The family of a mission, from its linear models with three pairs of virtual mass and damping.

    Raises:
        InputError: as by `felt_admittance`.
    """
    mass, damping = max(mission.admittance.mass), max(max(mission.admittance.damping), LEAST_DAMPING)
    pairs = [(mass, damping), (SPREAD * mass, damping), (mass, SPREAD * damping)]
    felt = [felt_admittance(mission, {"admittance.mass": [m] * 3, "admittance.damping": [c] * 3}) for m, c in pairs]
    w, step = felt[0].w, mission.mission.step
    A = np.stack([acceleration_per_force(w, step, m, c) for m, c in pairs], axis=-1)[:, None]  # (F, 1, 3 models)
    Y = np.stack([np.diagonal(f.Y, axis1=1, axis2=2) for f in felt], axis=-1)  # (F, 3 axes, 3 models)
    A = np.broadcast_to(A, Y.shape)
    return AdmittanceFamily(
        w, np.linalg.solve(np.stack([np.ones_like(Y), A, -A * Y], axis=-1), Y[..., None])[..., 0], step
    )


def family_limit(family: AdmittanceFamily, mass: float, damping: float, arm: float) -> float:
    """The stiffness [N/m] of massless arms with a damping of `arm` [N s/m] from which on an axis oscillates."""
    Y = family.at(mass, damping)
    axes = (FeltAdmittance(family.w, Y[:, i, None, None]) for i in range(3))
    return min(stiffness_limit(axis, arm) for axis in axes)


def _map(mission: Mission) -> dict[str, Any]:
    """The stiffness limit of massless arms over virtual mass and damping, each around the mission's."""
    a, arm = mission.admittance, mission.person.damping
    masses, dampings = (np.geomspace(*AROUND, MAP) * max(max(x), LEAST_DAMPING) for x in (a.mass, a.damping))
    family = admittance_family(mission)
    rows = [[family_limit(family, m, c, arm) for c in dampings] for m in masses]
    grid = {"mass": masses.tolist(), "damping": dampings.tolist(), "stiffness": rows}
    here = [max(a.mass), max(max(a.damping), LEAST_DAMPING)]
    return {"map": {**grid, "mission": here, "arm_stiffness": family_limit(family, here[0], here[1], arm)}}


def flown_map(mission: Mission, data: Mapping[str, Any]) -> dict[str, Any]:
    """The data of a map with flights over it: virtual mass, damping, and whether an arm's hand stays calm."""
    places = [(m, c) for c in data["damping"][1::FLOWN] for m in data["mass"][::FLOWN_MASS]]
    keys = [{"admittance.mass": [m] * 3, "admittance.damping": [c] * 3} for m, c in places]
    flights = fly_many([held(mission, data["arm_stiffness"], changes) for changes in keys])
    calm = [not stability_in_hand(flight) for flight in flights]
    return {**data, "flown": [[*place, stable] for place, stable in zip(places, calm, strict=True)]}
