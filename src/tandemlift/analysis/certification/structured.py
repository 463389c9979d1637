"""The structured tier of a certificate: how far all parameters at once may be off, by µ-analysis.

The upper bound of µ proves a factor of the box within which no parameters make the hover oscillate. A search over the
box finds parameters that do: the factor at which they do bounds the true one from the other side. They are linearized
again, and written as a mission that flies to oscillation.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.certification.certificate import Claim, Tier
from tandemlift.analysis.certification.structured_singular_value import TINY, Bound, upper_bound
from tandemlift.analysis.certification.uncertain_loop import Deviations, family_of, uncertain_loop
from tandemlift.analysis.certification.uncertainty import (
    DEFAULT_BOX,
    INERTIAS,
    LARGEST,
    LONGEST,
    UNITS,
    Values,
    box_at,
    calm_model,
    largest_factor,
    parameters_of,
    uncertain_tables,
    weakens,
)
from tandemlift.analysis.linearization.loop_margins import LOWEST, ON_CIRCLE, POINTS, calm_mission, is_calm
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.missions import Mission, built_in, format_toml, load_mission, tables_of
from tandemlift.parts.mechanics.vehicle import Vehicle

NAME, TITLE = "structured", "Structured: all parameters at once"
EVERY = 3  # of the frequencies of a loop, at which µ is bounded
SMALLER = 0.99  # of a factor that is not proven
STARTS, SEED = 6, 1  # of the search
BETTER = 0.999  # of a factor, which is worth a change
FARTHEST = 4.0  # the largest deviation of a parameter alone, relative
ACCURACY = 0.01  # relative, of the factor at which the mission oscillates
CONFIRMED = 1.1  # times a limit and by it, where the mission is linearized again
NEARER = 0.85  # of the factor that is found: the search of the linearized mission begins there
BEYOND = 1.1  # times the factor at which the model oscillates, of the mission that is flown
FLOWN = 20.0  # s, of its hover


class Worst(NamedTuple):
    """Parameters that make the hover oscillate.

    Attributes:
        factor: of the box that they lie on.
        values: deviations by name.
        frequency: of the growing mode [rad/s].
    """

    factor: float
    values: Values
    frequency: float


def structured_tier(mission: Mission, box: Mapping[str, float] = DEFAULT_BOX) -> Tier:
    """The factors of a box of parameters: proven, and found to oscillate.

    Args:
        mission: the nominal one.
        box: half width of each parameter, as `DEFAULT_BOX`.

    Raises:
        InputError: a parameter is unknown or its width not allowed, there are too many, or scipy is not installed.
    """
    widths = parameters_of(mission, box)
    said = assumptions(mission, box, widths)
    share = mission.hover.share
    if share >= 1.0:
        reason = f"the hover saturates: its most loaded rotor needs {100.0 * share:.3g} % of its largest thrust"
        return Tier(NAME, TITLE, said, reason=reason)
    try:
        family = family_of(mission, widths)
    except InputError as error:
        return Tier(NAME, TITLE, said, reason=f"there is no linear model: {error}")
    if growing(mission, {})[0] > ON_CIRCLE:
        return Tier(NAME, TITLE, said, reason="the hover is not stable with all parameters as they are")
    deviations = Deviations(family, widths)
    proven, w, bounds = proven_factor(deviations)
    worst = worst_of(mission, deviations, largest_factor(widths))
    curves = {"frequency": w, "upper_bound": bounds, "widths": widths}
    files = {}
    if worst is not None:
        beyond = within_steps({name: BEYOND * p for name, p in worst.values.items()}, mission.mission.step)
        files[f"{mission.mission.name}-worst.toml"] = worst_mission(mission, beyond, worst)
        curves |= {"worst": worst.values, "flown": beyond}
    return Tier(NAME, TITLE, said, tuple(claims_of(mission, deviations, proven, worst)), curves, files)


def proven_factor(deviations: Deviations) -> tuple[float, Array, Array]:
    """(the largest factor whose box has µ ≤ 1 at all frequencies, these [rad/s], bounds of µ of the box itself).

    The frequencies are some of the family's, and all of them about the peak.
    """
    family, widths, bounds = deviations.family, deviations.widths, dict[int, Bound]()
    loop = uncertain_loop(family, box_at(widths, 1.0))

    def bound_at(frequencies: Iterable[int]) -> None:
        last = None
        for k in frequencies:
            bounds[k] = last = upper_bound(loop.M[k], loop.blocks, last)

    bound_at([*range(0, len(family.w), EVERY), len(family.w) - 1])
    peak = max(bounds, key=lambda k: bounds[k].value)
    bound_at(k for k in range(max(peak - EVERY, 0), min(peak + EVERY + 1, len(family.w))) if k not in bounds)
    order = sorted(bounds, key=lambda k: -bounds[k].value)

    def proves(factor: float) -> bool:
        box = box_at(widths, factor)
        larger = uncertain_loop(family, box)
        return deviations.stable({name: p.middle for name, p in box.items()}) and all(
            upper_bound(larger.M[k], larger.blocks, bounds[k], enough=1.0).value <= 1.0 for k in order
        )

    factor = min(1.0 / max(bounds[order[0]].value, TINY), largest_factor(widths))
    while not proves(factor):
        factor *= SMALLER
    at = sorted(bounds)
    return factor, family.w[at], np.array([bounds[k].value for k in at])


def found_factor(deviations: Deviations, most: float, *, flyable: bool) -> tuple[float, Values]:
    """(the smallest factor of the box at which a search loses stability, in which direction), infinite up to `most`.

    From each start, one parameter after the other changes its sign while that makes the factor smaller; at the end,
    those that do not matter are 0. `flyable`: without rotors that are stronger than the pilot assumes.
    """
    rng, best, found = np.random.default_rng(SEED), math.inf, dict[str, float]()
    choices = {
        name: (0.0, 1.0) if name == "delay" else (-1.0, 0.0) if flyable and weakens(name) else (-1.0, 0.0, 1.0)
        for name in deviations.widths
    }
    for _ in range(STARTS):
        signs = {name: 1.0 if name == "lag" else float(rng.choice(choices[name])) for name in choices}
        factor, improved = min(deviations.limit(signs, most), most), True
        while improved:
            improved = False
            for name, sign in [(str(n), sign) for n in rng.permutation(list(choices)) for sign in choices[str(n)]]:
                other = {**signs, name: sign}
                smaller = deviations.limit(other, min(factor, best)) if other != signs else math.inf
                if smaller < BETTER * factor:
                    signs, factor, improved = other, smaller, True
        if factor < min(best, most):
            best, found = factor, signs
    for name in found:
        if not deviations.stable(deviations.along({**found, name: 0.0}, best / BETTER)):
            found[name] = 0.0
    return best, found


def worst_of(mission: Mission, deviations: Deviations, most: float) -> Worst | None:
    """The parameters that can be flown in the smallest box at which the mission, linearized there, oscillates.

    None if there are none up to a factor `most`.
    """
    factor, signs = found_factor(deviations, most, flyable=True)
    if math.isinf(factor):
        return None
    step = mission.mission.step

    def there(factor: float) -> Worst:
        values = within_steps(deviations.along(signs, factor), step)
        growth, frequency = growing(mission, values)
        return Worst(factor if growth > ON_CIRCLE else math.inf, values, frequency or deviations.frequency(values))

    low, worst = NEARER * factor, there(factor)
    while math.isinf(worst.factor):
        low, factor = factor, CONFIRMED * factor
        if factor > most:
            return None
        worst = there(factor)
    while worst.factor - low > ACCURACY * low:
        middle = there(0.5 * (low + worst.factor))
        low, worst = (0.5 * (low + worst.factor), worst) if math.isinf(middle.factor) else (low, middle)
    return worst


def within_steps(values: Values, step: float) -> dict[str, float]:
    """Deviations with a delay of whole steps [s], as it is flown, and not beyond the box."""
    return {name: math.floor(p / step + 1e-9) * step if name == "delay" else p for name, p in values.items()}


def growing(mission: Mission, values: Values) -> tuple[float, float]:
    """(|z| − 1, frequency [rad/s]) of the fastest mode of a mission whose vehicle deviates; infinite if it is lost."""
    try:
        model = calm_model(mission, values, real=True)
    except InputError:
        return math.inf, 0.0
    z = np.linalg.eigvals(model.connected().A)
    fastest = z[np.abs(z).argmax()]
    return float(abs(fastest) - 1.0) if is_calm(model) else math.inf, float(abs(np.angle(fastest)) / model.step)


def worst_mission(mission: Mission, values: Values, worst: Worst) -> str:
    """A mission file that hovers with deviations of the vehicle, without pushes, person and landing."""
    name, whole = mission.mission.name, tables_of(mission)
    end = calm_mission(mission)[1] + FLOWN
    rest: dict[str, Any] = {"pushes": [], "requests": [], "changes": [], "person": {"model": "none"}}
    rest |= {"detection": {"model": "none"}, "phases": {**whole["phases"], "land_start": 2.0 * end}}
    rest["mission"] = {**whole["mission"], "name": f"{name}-worst", "duration": end}
    keys = uncertain_tables(whole, values) | rest
    if name in built_in() and load_mission(name) == mission:
        keys = {"extends": name} | {key: value for key, value in keys.items() if value != whole.get(key)}
    return (
        f"# {name} with parameters {BEYOND:g} times those at which its linear model begins to oscillate, at "
        f"{worst.frequency:.3g} rad/s.\n\n{format_toml(keys)}"
    )


def claims_of(mission: Mission, deviations: Deviations, proven: float, worst: Worst | None) -> Iterator[Claim]:
    """The numbers of the tier."""
    most, reach = largest_factor(deviations.widths), ", the largest that is tried"
    text = f"no parameters within it make the hover oscillate{reach if proven >= most else ''}"
    yield Claim("guaranteed factor", "box", proven, "box", 1.0, text)
    factor, signs = found_factor(deviations, most, flyable=False)
    values = deviations.along(signs, factor)
    text = f"none was found up to {most:.3g}{reach}" if not signs else f"with {words(values)} the model oscillates"
    yield Claim("factor found", "box", factor, "box", None, text, deviations.frequency(values) if signs else math.nan)
    if signs:
        text = "the factor found over the guaranteed one: between them nothing is known"
        yield Claim("gap", "box", factor / proven, "1", None, text)
    if worst is not None:
        text = f"the mission linearized with {words(worst.values)} oscillates"
        command = f"tandemlift run {mission.mission.name}-worst.toml"
        yield Claim("factor that can be flown", "box", worst.factor, "box", None, text, worst.frequency, command)
    for name in deviations.widths:
        if name in UNITS:
            yield alone(mission, deviations, name)


def alone(mission: Mission, deviations: Deviations, name: str) -> Claim:
    """The nearest deviation of one parameter at which the loop oscillates, as the mission linearized there confirms."""
    unit, width = UNITS[name], deviations.widths[name]
    ends = {1.0: LONGEST / width} if name == "delay" else {1.0: FARTHEST / width, -1.0: LARGEST / width}
    ends = {sign: end for sign, end in ends.items() if sign < 0.0 or not weakens(name)}
    factors = {sign: deviations.limit({name: sign}, end) for sign, end in ends.items()}
    sign = min(factors, key=lambda sign: factors[sign])
    if math.isinf(factors[sign]):
        reach = " and ".join(words({name: sign * end * width}) for sign, end in ends.items())
        return Claim("limit alone", name, math.inf, unit, None, f"no limit up to {reach}")
    values = deviations.along({name: sign}, factors[sign])
    frequency = deviations.frequency(values)
    text = f"with {words(values)} alone, the model oscillates at {frequency:.3g} rad/s"
    sides = [growing(mission, {name: side * values[name]})[0] > ON_CIRCLE for side in (1.0 / CONFIRMED, CONFIRMED)]
    if sides == [False, True]:
        return Claim("limit alone", name, values[name], unit, None, text, frequency)
    return Claim("limit alone", name, None, unit, None, f"{text}; the mission linearized about there does not agree")


def words(values: Values) -> str:
    """Deviations other than 0 in words."""
    return ", ".join(
        f"{name} {1e3 * p:+.3g} ms" if UNITS.get(name) == "s" else f"{name} {100.0 * p:+.3g} %"
        for name, p in values.items()
        if p != 0.0
    )


def assumptions(mission: Mission, box: Mapping[str, float], widths: Mapping[str, float]) -> tuple[str, ...]:
    """What the tier takes for granted, a sentence each."""
    said = [
        "The loop is the linear model of a calm hover, sampled, without noise, wind, ground effect and thrust limits.",
        f"Parameters are real and constant, in a box about the mission: {words(box).replace('+', '±')}; a delay only "
        "grows, and the lag is the mean of up and down.",
        "The pilot keeps its own model of the vehicle, except for what it identifies in flight.",
        f"The bound holds at {POINTS // EVERY} frequencies from {LOWEST:g} rad/s to half of the sample rate; it is not "
        "proven between them and below.",
    ]
    if {"mass", "thrust"} & set(widths):
        said.append(
            "What mass and thrust change by another hover comes from models at three values of each; what they change "
            "together, beyond either alone, is left out."
        )
    if any(map(weakens, widths)):
        said.append(
            "No key changes the thrust constant of the vehicle without that of its pilot: weaker rotors are flown as "
            "faults that the pilot does not know; stronger ones are in the guarantee, but cannot be flown."
        )
    J = Vehicle.from_settings(mission.vehicle).real_inertia(mission.plant)
    if np.abs(J - np.diag(np.diag(J))).max() > 1e-6 * J.max() and set(INERTIAS) & set(widths):
        said.append("Products of inertia stay as they are, while an inertia deviates.")
    if mission.actuators.model != "rotors":
        said.append('actuators.model = "ideal": there are no lag, delay and rotors that could deviate.')
    return tuple(said)
