"""The structured tier of a certificate: how far all parameters at once may be off, by µ-analysis.

The upper bound of µ proves a factor of the box within which no parameters make the hover oscillate. A search over the
box finds parameters that do: the factor at which they do bounds the true one from the other side. They are linearized
again, and written as a mission that flies to oscillation.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.certification.certificate import Claim, Tier
from tandemlift.analysis.certification.structured_singular_value import upper_bound
from tandemlift.analysis.certification.uncertain_loop import Deviations, uncertain_loop
from tandemlift.analysis.certification.uncertainty import (
    DEFAULT_BOX,
    INERTIAS,
    UNITS,
    Family,
    Values,
    box_at,
    calm_model,
    family_of,
    largest_factor,
    parameters_of,
    uncertain_tables,
)
from tandemlift.analysis.linearization.loop_margins import ON_CIRCLE, calm_mission, is_calm
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.missions import Mission, built_in, format_toml, load_mission, tables_of
from tandemlift.parts.mechanics.vehicle import Vehicle

NAME, TITLE = "structured", "Structured: all parameters at once"
EVERY = 3  # of the frequencies of a loop, at which µ is bounded
SMALLER = 0.97  # of a factor that is not proven
STARTS, SEED = 6, 1  # of the search
FINER = 12  # bisections
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
    said = assumptions(mission, widths)
    share = mission.hover.share
    if share >= 1.0:
        reason = f"the hover saturates: its most loaded rotor needs {100.0 * share:.3g} % of its largest thrust"
        return Tier(NAME, TITLE, said, reason=reason)
    try:
        family = family_of(mission, widths)
        growth, frequency = growing(mission, {})
    except InputError as error:
        return Tier(NAME, TITLE, said, reason=f"there is no linear model: {error}")
    if growth > ON_CIRCLE:
        reason = f"the hover is not stable with all parameters as they are: it oscillates at {frequency:.3g} rad/s"
        return Tier(NAME, TITLE, said, reason=reason)
    deviations = Deviations(family, widths)
    proven, w, bounds = proven_factor(family, widths)
    worst = worst_of(mission, deviations, largest_factor(widths))
    curves = {"frequency": w, "upper_bound": bounds, "widths": widths}
    files = {}
    if worst is not None:
        beyond = within_steps(mission, {name: BEYOND * p for name, p in worst.values.items()})
        files[f"{mission.mission.name}-worst.toml"] = worst_mission(mission, beyond, worst)
        curves |= {"worst": worst.values, "flown": beyond, "flown_frequency": growing(mission, beyond)[1]}
    return Tier(NAME, TITLE, said, claims(mission, deviations, proven, worst), curves, files)


def proven_factor(family: Family, widths: Mapping[str, float]) -> tuple[float, Array, Array]:
    """(the largest factor whose box has µ ≤ 1 at all frequencies, these [rad/s], bounds of µ of the box itself)."""
    w = family.w[::EVERY]
    few = Family(w, *[X[::EVERY] for X in family[1:5]], *family[5:])
    loop, bound, bounds = uncertain_loop(few, box_at(widths, 1.0)), None, []
    for M in loop.M:
        bound = upper_bound(M, loop.blocks, bound)
        bounds.append(bound)
    values = np.array([bound.value for bound in bounds])
    order = np.argsort(-values)

    def proves(factor: float) -> bool:
        loop = uncertain_loop(few, box_at(widths, factor))
        return all(upper_bound(loop.M[k], loop.blocks, bounds[k], enough=1.0).value <= 1.0 for k in order)

    factor = min(1.0 / max(values.max(), 1e-9), largest_factor(widths))
    while not proves(factor):
        factor *= SMALLER
    return factor, w, values


def worst_of(mission: Mission, deviations: Deviations, most: float) -> Worst | None:
    """The parameters in the smallest box that were found to make the hover oscillate; None if none are."""
    rng, best, found = np.random.default_rng(SEED), most, None
    names = list(deviations.widths)
    for start in range(STARTS):
        signs = {name: 1.0 if name in ("lag", "delay") else float(rng.choice((-1.0, 1.0))) for name in names}
        factor = smallest_factor(deviations, signs, most)
        improved = True
        while improved:
            improved = False
            for name in rng.permutation(names):
                for sign in (0.0, 1.0) if name == "delay" else (-1.0, 0.0, 1.0):
                    other = {**signs, str(name): sign}
                    smaller = smallest_factor(deviations, other, factor) if other != signs else math.inf
                    if smaller < 0.999 * factor:
                        signs, factor, improved = other, smaller, True
        if factor < best:
            best, found = factor, signs
    return None if found is None else confirmed(mission, deviations, found, best, most)


def smallest_factor(deviations: Deviations, signs: Values, below: float) -> float:
    """The factor below another at which parameters along a direction lose stability; infinite if they do not there."""
    if deviations.stable(along(deviations, signs, below)):
        return math.inf
    low, high = 0.0, below
    for _ in range(FINER):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if deviations.stable(along(deviations, signs, middle)) else (low, middle)
    return high


def along(deviations: Deviations, signs: Values, factor: float) -> dict[str, float]:
    """The deviations at a factor of the box, along a direction."""
    return {name: factor * sign * deviations.widths[name] for name, sign in signs.items()}


def confirmed(mission: Mission, deviations: Deviations, signs: Values, factor: float, most: float) -> Worst | None:
    """The smallest factor along a direction at which the mission, linearized there, oscillates."""

    def there(factor: float) -> Worst:
        values = within_steps(mission, along(deviations, signs, factor))
        return Worst(factor, values, growing(mission, values)[1])

    low, high = 0.85 * factor, factor
    while growing(mission, there(high).values)[0] <= ON_CIRCLE:
        low, high = high, 1.05 * high
        if high > most:
            return None
    while high - low > 0.01 * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if growing(mission, there(middle).values)[0] > ON_CIRCLE else (middle, high)
    return there(high)


def within_steps(mission: Mission, values: Values) -> dict[str, float]:
    """Deviations with the delay rounded to whole steps, as it is flown."""
    step = mission.mission.step
    return {name: round(p / step) * step if name == "delay" else p for name, p in values.items()}


def growing(mission: Mission, values: Values) -> tuple[float, float]:
    """(|z| − 1, frequency [rad/s]) of the fastest growing mode of a mission whose vehicle deviates.

    A hover that is lost before it can be linearized grows infinitely, at no frequency.
    """
    model = calm_model(mission, values, real=True)
    z = np.linalg.eigvals(model.connected().A)
    fastest = z[np.abs(z).argmax()]
    if not is_calm(model):
        return math.inf, float(abs(np.angle(fastest)) / model.step)
    return float(abs(fastest) - 1.0), float(abs(np.angle(fastest)) / model.step)
