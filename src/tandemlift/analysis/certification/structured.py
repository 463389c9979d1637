"""The structured tier of a certificate: how far all parameters at once may be off, by µ-analysis.

The upper bound of µ proves a factor of the box within which no parameters make the hover oscillate. A search over the
box finds parameters that do: the factor at which they do bounds the true one from the other side. They are linearized
again, and written as a mission that flies to oscillation.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from tandemlift.analysis.certification.claims import Claim, Tier
from tandemlift.analysis.certification.uncertain_loop import DETAIL, STRIDE, DeviatingLoop, found_factor, proven_factor
from tandemlift.analysis.certification.uncertainty import (
    DEFAULT_BOX,
    INERTIAS,
    MAX_DELAY,
    MAX_SHARE,
    UNITS,
    Values,
    calm_model,
    family_at,
    hovers_of,
    largest_factor,
    parameters_of,
    uncertain_tables,
)
from tandemlift.analysis.linearization.loop_margins import LOW_END, ON_CIRCLE, POINTS, calm_mission, is_calm
from tandemlift.core.errors import InputError
from tandemlift.missions import HoverFacts, Mission, built_in, check, format_toml, load_mission, tables_of

NAME, TITLE = "structured", "Structured: all parameters at once"
SPAN = 4.0  # the largest deviation of a parameter alone, relative
ACCURACY = 0.01  # relative, of the factor at which the mission oscillates
CHECK_FACTOR = 1.1  # times a limit and by it, where the mission is linearized again
START_RATIO = 0.85  # of the factor that is found: the search of the linearized mission begins there
EXCESS = 1.1  # times the factor at which the model oscillates, of the mission that is flown
HOVER_TIME = 20.0  # s, of its hover

Growth = Callable[[Values], tuple[float, float]]
"""`growing` of a mission."""


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
    hover, step, growth = mission.hover, mission.mission.step, partial(growing, mission)
    widths = parameters_of(hover, box)
    said, share = assumptions(hover, box, widths), hover.share
    if share >= 1.0:
        reason = f"the hover saturates: its most loaded rotor needs {100.0 * share:.3g} % of its largest thrust"
        return Tier(NAME, TITLE, said, reason=reason)
    if not widths:
        return Tier(NAME, TITLE, said, reason="no parameter of the box has an effect on this mission")
    try:
        hovers = hovers_of(mission, widths)
        deviations = DeviatingLoop(family_at(hovers, hovers.w), widths)
    except InputError as error:
        return Tier(NAME, TITLE, said, reason=f"there is no linear model: {error}")
    if growth({})[0] > ON_CIRCLE:
        return Tier(NAME, TITLE, said, reason="the hover is not stable with all parameters as they are")
    most = largest_factor(widths)
    factor, signs = found_factor(deviations, most)
    found = deviations.along(signs, factor)
    frequency = deviations.frequency(found) if found else math.nan
    proven, w, bounds = proven_factor(hovers, deviations, frequency)
    worst = worst_of(growth, step, deviations, (factor, signs), most)
    curves, files = {"frequency": w, "upper_bound": bounds, "widths": widths}, dict[str, str]()
    claims = [*factors_of(proven, Worst(factor, found, frequency), most)]
    if worst is not None:
        beyond = within_steps({name: EXCESS * p for name, p in worst.values.items()}, step)
        text, command = f"the mission linearized with {words(worst.values)} oscillates", ""
        try:
            files[f"{mission.mission.name}-worst.toml"] = worst_mission(mission, beyond, worst)
            command = f"tandemlift run {mission.mission.name}-worst.toml"
        except InputError as error:
            text = f"{text}, but cannot be flown: {error}"
        claims.append(Claim("factor to fly", "box", worst.factor, "box", None, text, worst.frequency, command))
        curves |= {"worst": worst.values, "flown": beyond}
    claims += [alone(growth, deviations, name) for name in widths if name in UNITS]
    return Tier(NAME, TITLE, said, tuple(claims), curves, files)


def worst_of(
    growth: Growth, step: float, deviations: DeviatingLoop, found: tuple[float, Values], most: float
) -> Worst | None:
    """The parameters in the smallest box at which the mission, linearized there, oscillates.

    `found`: the factor at which the model does, and the direction. None if there are none up to a factor `most`.
    """
    factor, signs = found
    if math.isinf(factor):
        return None

    def there(factor: float) -> Worst:
        values = within_steps(deviations.along(signs, factor), step)
        rate, frequency = growth(values)
        return Worst(factor if rate > ON_CIRCLE else math.inf, values, frequency or deviations.frequency(values))

    low, worst = START_RATIO * factor, there(factor)
    while math.isinf(worst.factor):
        low, factor = factor, CHECK_FACTOR * factor
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
    """A mission file that hovers with deviations of the vehicle, without pushes, person and landing.

    Raises:
        InputError: such a mission is refused.
    """
    name, whole = mission.mission.name, tables_of(mission)
    end = calm_mission(mission)[1] + HOVER_TIME
    rest: dict[str, Any] = {"pushes": [], "requests": [], "changes": [], "person": {"model": "none"}}
    rest |= {key: {"model": "none"} for key in ("detection", "excitation")}
    rest |= {"phases": {**whole["phases"], "land_start": 2.0 * end}}
    rest["mission"] = {**whole["mission"], "name": f"{name}-worst", "duration": end}
    keys = uncertain_tables(whole, values) | rest
    check(keys, f"{name}-worst", quiet=True)
    if name in built_in() and load_mission(name) == mission:
        keys = {"extends": name} | {key: value for key, value in keys.items() if value != whole.get(key)}
    return (
        f"# {name} with parameters {EXCESS:g} times those at which its linear model begins to oscillate, at "
        f"{worst.frequency:.3g} rad/s.\n\n{format_toml(keys)}"
    )


def factors_of(proven: float, found: Worst, most: float) -> Iterator[Claim]:
    """The factor that is proven, the one that was found up to `most`, and the gap between them."""
    reach = ", the largest that is tried"
    text = f"no parameters within it make the hover oscillate{reach if proven >= most else ''}"
    yield Claim("guaranteed factor", "box", proven, "box", 1.0, text, tried=most)
    text = f"with {words(found.values)} the model oscillates" if found.values else f"none up to {most:.3g}{reach}"
    yield Claim("factor found", "box", found.factor, "box", None, text, found.frequency)
    if found.values:
        text = "the factor found over the guaranteed one: between them nothing is known"
        yield Claim("gap", "box", found.factor / proven, "1", None, text)


def alone(growth: Growth, deviations: DeviatingLoop, name: str) -> Claim:
    """The nearest deviation of one parameter at which the loop oscillates, as the mission linearized there confirms."""
    unit, width = UNITS[name], deviations.widths[name]
    ends = {1.0: (MAX_DELAY if name == "delay" else SPAN) / width}
    ends |= {} if name in ("lag", "delay") else {-1.0: MAX_SHARE / width}
    factors = {sign: deviations.limit({name: sign}, end) for sign, end in ends.items()}
    sign = min(factors, key=lambda sign: factors[sign])
    if math.isinf(factors[sign]):
        reach = " and ".join(words({name: sign * end * width}) for sign, end in ends.items())
        return Claim("limit alone", name, math.inf, unit, None, f"no limit up to {reach}")
    values = deviations.along({name: sign}, factors[sign])
    frequency = deviations.frequency(values)
    text = f"with {words(values)} alone, the model oscillates at {frequency:.3g} rad/s"
    sides = [growth({name: side * values[name]})[0] > ON_CIRCLE for side in (1.0 / CHECK_FACTOR, CHECK_FACTOR)]
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


def assumptions(hover: HoverFacts, box: Mapping[str, float], widths: Mapping[str, float]) -> tuple[str, ...]:
    """The assumptions of the tier, a sentence each."""
    said = [
        "The loop is the linear model of a calm hover, sampled, without noise, wind, ground effect and thrust limits.",
        f"Parameters are real and constant, in a box about the mission: {words(box).replace('+', '±')}; a delay only "
        "grows, and the lag is the mean of up and down.",
        "The pilot keeps its own model of the vehicle, except for what it identifies in flight.",
        f"The bound holds at some {POINTS // STRIDE} frequencies from {LOW_END:g} rad/s to half of the sample rate, a "
        f"quarter with slower sensors, and {DETAIL} about each peak; it is not proven between them and below.",
    ]
    if {"mass", "thrust"} & set(widths):
        said.append(
            "What mass and thrust change by another hover comes from models at three values of each, and both together "
            "from either alone."
        )
    J = hover.vehicle.real_inertia(hover.plant)
    if np.abs(J - np.diag(np.diag(J))).max() > 1e-6 * J.max() and set(INERTIAS) & set(widths):
        said.append("Products of inertia stay as they are, while an inertia deviates.")
    if hover.actuators.model != "rotors":
        said.append('actuators.model = "ideal": there are no lag, delay and rotors that could deviate.')
    return tuple(said)
