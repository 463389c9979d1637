"""The uncertain loop against its equations written out, and its limits against Routh's of a loop of third order.

A beam that rolls: J ω̇ = M + m and M = −G J ω̇ with G = k/(s (τ s + 1)), behind rotors with the lag l. With an inertia
off by p and a lag by q, s (τ s + 1)(1 + l (1 + q) s)(1 + p) + k has roots on the right where
k > (1 + p)(1/τ + 1/(l (1 + q))).
"""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq

from tandemlift.analysis.certification import uncertain_loop as loops
from tandemlift.analysis.certification import uncertainty
from tandemlift.analysis.certification.structured import Worst, alone, within_steps, worst_mission, worst_of
from tandemlift.analysis.certification.uncertain_loop import DeviatingLoop, found_factor, proven_factor, uncertain_loop
from tandemlift.analysis.certification.uncertainty import (
    Family,
    Hovers,
    Trim,
    box_at,
    family_at,
    largest_factor,
    unit_gain,
)
from tandemlift.analysis.linearization.loop_margins import calm_mission
from tandemlift.missions import load_mission, mission_from_text

N = 8
RNG = np.random.default_rng(5)
TAU, LAG, K = 0.1, 0.05, 12.0
ROLL, WRENCH, MOMENT = 1, 1, 4 + N  # rows and columns of H
WIDTHS = {"inertia_x": 0.3, "lag": 0.5}


def mixed(*shape):
    return 0.2 * (RNG.normal(size=shape) + 1j * RNG.normal(size=shape))


# the uncertain loop

FAMILY_W = np.array([0.3, 2.0, 25.0])
LAGS = np.repeat([0.02, 0.035], 4)
MIXED = Family(FAMILY_W, mixed(3, 7, 4 + N + 3), {}, RNG.normal(size=(N, 4)), RNG.normal(size=(4, N)), LAGS, 0.01)
TRIM = Trim(mixed(3, 7, 2), mixed(3, 2, 4 + N + 3), mixed(3, 2, 2))
BOX = {"inertia_x": 0.2, "inertia_z": 0.3, "thrust": 0.1, "lag": 0.4, "delay": 0.02, "rotor.2": 0.3, "rotor.8": 0.2}


def written_out(family, k, p, wide):
    """(det(I − H K) at a frequency, with all deviations, times what lag, delay and hover are divided by)."""
    s, H = 1j * family.w[k], family.H[k]
    whole = 1.0
    for name, trim in family.trims.items():
        inner = np.eye(trim.V.shape[1]) - p.get(name, 0.0) * trim.V[k]
        H = H + p.get(name, 0.0) * trim.U[k] @ np.linalg.inv(inner) @ trim.W[k]
        whole *= np.linalg.det(inner)
    slower = 1.0 + s * family.lags * (1.0 + p.get("lag", 0.0))
    g = np.diag((1.0 + p.get("thrust", 0.0)) * np.exp(-s * (family.delay + p.get("delay", 0.0))) / slower)
    gains = np.diag([p.get(f"rotor.{i + 1}", 0.0) for i in range(N)])
    inertia = np.diag([p.get(f"inertia_{axis}", 0.0) for axis in "xyz"])
    by_command = np.vstack([family.effect @ g @ family.spread - np.eye(4), gains @ g @ family.spread, np.zeros((3, 4))])
    by_turning = np.vstack([np.zeros((4 + N, 3)), -inertia])
    whole *= np.linalg.det(np.eye(7) - H @ np.hstack([by_command, by_turning])) * np.prod(np.unique(slower)) ** 4
    if wide:  # e^(−jωp) is a fraction: 1 + j tan(ω half/2) δ below
        tangent = math.tan(0.5 * family.w[k] * (p["delay"] - wide))
        whole *= (1.0 + 1j * tangent) ** 4
    return whole


def deviations(box, delta, w):
    """The parameters of δ in a box; of the delay, δ is that of a tangent."""
    found = {name: span.middle + delta[name] * span.half for name, span in box.items()}
    if "delay" in box:
        middle, half = box["delay"]
        found["delay"] = middle + 2.0 / w * math.atan(delta["delay"] * math.tan(0.5 * w * half))
    return found


@pytest.mark.parametrize("trims", [{}, {"mass": TRIM}, {"thrust": TRIM}], ids=["none", "mass", "thrust"])
@pytest.mark.parametrize("without", [(), ("delay",), ("thrust",), ("lag",), ("inertia_x", "rotor.2")])
def test_the_determinant_of_a_box_is_that_of_the_loop_with_its_deviations_written_out(trims, without):
    family = MIXED._replace(trims=trims)
    widths = {name: width for name, width in {**BOX, **dict.fromkeys(trims, 0.15)}.items() if name not in without}
    box = box_at(widths, 1.3)
    M, blocks = uncertain_loop(family, box)
    middle = {name: span.middle for name, span in box.items()}
    at = middle.get("delay", 0.0)
    for k, w in enumerate(family.w):
        for _ in range(3):
            delta = {name: RNG.uniform(-1.0, 1.0) for name in box}
            D = np.diag(np.repeat(list(delta.values()), [block.size for block in blocks]))
            ratio = written_out(family, k, deviations(box, delta, w), at) / written_out(family, k, middle, at)
            assert np.linalg.det(np.eye(len(D)) - M[k] @ D) == pytest.approx(ratio, rel=1e-9)
    assert all(block.real for block in blocks)


# limits of the beam that rolls


def beam(w):
    s = 1j * w
    G = K / (s * (TAU * s + 1.0))
    H = np.zeros((len(w), 7, 4 + N + 3), complex)
    for column in (WRENCH, MOMENT):
        H[:, ROLL, column], H[:, 4, column] = -G / (1.0 + G), 1.0 / (1.0 + G)
    H[:, 5, MOMENT + 1] = H[:, 6, MOMENT + 2] = 1.0  # about the other axes it turns freely
    return Family(w, H, {}, np.vstack([0.5 * np.eye(4)] * 2), np.hstack([np.eye(4)] * 2), np.full(N, LAG), 0.0)


def rolls(widths=WIDTHS):
    return DeviatingLoop(beam(np.geomspace(0.1, 1000.0, 200)), widths)


def routh(factor, widths=WIDTHS):
    """Above 0 while the worst of a box is stable: the lightest, with the slowest rotors."""
    return (1.0 - factor * widths["inertia_x"]) * (1.0 / TAU + 1.0 / (LAG * (1.0 + factor * widths["lag"]))) - K


WORST = brentq(routh, 0.0, 1.8)
AT = 1.0 / math.sqrt(TAU * LAG * (1.0 + WORST * WIDTHS["lag"]))  # rad/s, of the roots on the axis


def growth(p):
    """(growth, frequency) of the fastest mode, without delay."""
    late = [LAG * (1.0 + p.get("lag", 0.0)), 1.0]
    whole = (1.0 + p.get("inertia_x", 0.0)) * np.polymul(np.polymul([TAU, 1.0], late), [1.0, 0.0])
    roots = np.roots(np.polyadd(whole, [K]))
    fastest = roots[np.argmax(roots.real)]
    return float(fastest.real), float(abs(fastest.imag))


def test_the_search_finds_the_lightest_beam_with_the_slowest_rotors():
    factor, signs = found_factor(rolls(), largest_factor(WIDTHS))
    assert factor == pytest.approx(WORST, rel=2e-3)
    assert signs == {"inertia_x": -1.0, "lag": 1.0}
    assert rolls().frequency(rolls().along(signs, factor)) == pytest.approx(AT, rel=0.01)


def test_a_parameter_that_does_not_matter_is_left_at_zero_and_a_beam_without_a_limit_has_none():
    widths = {**WIDTHS, "inertia_z": 0.3}
    factor, signs = found_factor(rolls(widths), 1.8)
    assert factor == pytest.approx(WORST, rel=2e-3)
    assert signs["inertia_z"] == 0.0
    assert found_factor(rolls(), 0.9 * WORST) == (math.inf, {})


@pytest.mark.parametrize(("low", "high"), [(1.0, 60.0), (0.999 * AT, 60.0), (1.0, 1.001 * AT)])
def test_a_factor_is_proven_up_to_near_the_limit_wherever_the_peak_is(low, high, monkeypatch):
    """The bound of µ with real parameters is one: above the peak's frequency it proves less than is so."""
    monkeypatch.setattr(loops, "family_at", lambda hovers, w: beam(w))
    hovers = SimpleNamespace(w=np.geomspace(low, high, 13))
    factor, w, bounds = proven_factor(hovers, rolls(), AT)
    assert 0.65 * WORST < factor < 1.003 * WORST
    assert len(w) == len(bounds)
    assert (w[0], w[-1]) == pytest.approx((low, high))
    assert factor == pytest.approx(1.0 / bounds.max(), rel=0.05)
    assert w[bounds.argmax()] == pytest.approx(AT, rel=0.25)


def test_no_factor_is_proven_beyond_the_largest_deviation(monkeypatch):
    monkeypatch.setattr(loops, "family_at", lambda hovers, w: beam(w))
    widths = {"inertia_z": 0.3}
    factor, _, _ = proven_factor(SimpleNamespace(w=np.geomspace(0.1, 300.0, 21)), rolls(widths), math.nan)
    assert factor == pytest.approx(3.0)


@pytest.mark.parametrize(
    ("widths", "factor"), [({"delay": 0.05}, 4.0), ({"mass": 0.3}, 3.0), ({"lag": 0.1, "mass": 0.3}, 3.0)]
)
def test_the_largest_factor_is_that_at_which_a_parameter_reaches_its_end(widths, factor):
    assert largest_factor(widths) == pytest.approx(factor)


def test_each_parameter_alone_has_its_limit_by_routh_and_phase():
    inertia = alone(growth, rolls(), "inertia_x")
    assert inertia.value == pytest.approx(K / (1.0 / TAU + 1.0 / LAG) - 1.0, rel=5e-3)  # lighter
    assert inertia.frequency == pytest.approx(1.0 / math.sqrt(TAU * LAG), rel=0.01)
    slow = alone(growth, rolls(), "lag")  # 1/(l (1 + q)) = k − 1/τ: beyond what is tried
    assert (slow.value, slow.text) == (math.inf, "no limit up to lag +400 %")

    def response(w):
        return K / (1j * w * (1.0 + 1j * w * TAU) * (1.0 + 1j * w * LAG))

    crossing = brentq(lambda w: abs(response(w)) - 1.0, 1.0, 100.0)
    late = (np.angle(response(crossing)) + math.pi) / crossing
    delay = alone(lambda p: (p["delay"] - late, crossing), rolls({"delay": 0.005}), "delay")
    assert delay.value == pytest.approx(late, rel=5e-3)
    assert (delay.unit, delay.frequency) == ("s", pytest.approx(crossing, rel=0.01))


def test_a_limit_alone_that_the_mission_does_not_confirm_has_no_number():
    for wrong in (1.0, -1.0):
        claim = alone(lambda p, wrong=wrong: (wrong, 0.0), rolls(), "inertia_x")
        assert claim.value is None
        assert "does not agree" in claim.text


def test_the_worst_that_the_mission_confirms_is_on_its_own_limit():
    worst = worst_of(growth, 1e-3, rolls(), (0.96 * WORST, {"inertia_x": -1.0, "lag": 1.0}), 1.8)
    assert worst.factor == pytest.approx(WORST, rel=0.012)
    assert worst.frequency == pytest.approx(AT, rel=0.02)
    assert worst_of(growth, 1e-3, rolls(), (math.inf, {}), 1.8) is None
    assert worst_of(lambda p: (-1.0, 0.0), 1e-3, rolls(), (1.0, {"lag": 1.0}), 1.8) is None
    assert within_steps({"delay": 0.0047, "lag": 0.3}, 1e-3) == {"delay": pytest.approx(0.004), "lag": 0.3}


def test_the_worst_mission_hovers_for_twenty_seconds_and_does_not_land():
    mission = load_mission("iris")
    text = worst_mission(mission, {"lag": 0.5}, Worst(1.0, {"lag": 0.5}, 3.0))
    worst = mission_from_text("iris-worst.toml", text)
    assert worst.mission.duration == pytest.approx(calm_mission(mission)[1] + 20.0)
    assert worst.phases.land_start > worst.mission.duration
    assert (worst.pushes, worst.person.model) == ((), "none")


# hovers with other mass and thrust


def axis(loop, gain=1.0):
    """What rotors give of one axis: `gain` times the command c = −L (gain c + w), so −gain L/(1 + gain L)."""
    H = np.zeros((len(FAMILY_W), 7, 4 + N + 3), complex)
    H[:, 0, 0] = -gain * loop / (1.0 + gain * loop)
    return H


LOOPS = {name: mixed(3) + 0.4 for name in ("calm", "weak", "strong", "light", "heavy")}


def test_a_hover_with_stronger_rotors_is_closed_again_with_those_as_they_are():
    for gain in (0.8, 1.0, 1.3):
        assert unit_gain(axis(LOOPS["calm"], gain), gain) == pytest.approx(axis(LOOPS["calm"]))


def test_the_trims_of_a_family_pass_through_the_hovers_that_were_linearized(monkeypatch):
    models = {"calm": 1.0, "weak": 0.9, "strong": 1.1, "light": 1.0, "heavy": 1.0}
    monkeypatch.setattr(uncertainty, "port_response", lambda hover, step, model, w: axis(LOOPS[model], models[model]))
    off = {"thrust": ((-0.1, "weak"), (0.1, "strong")), "mass": ((-0.2, "light"), (0.3, "heavy"))}
    mission = load_mission("iris")
    family = family_at(Hovers(mission.hover, 1e-3, "calm", off), FAMILY_W)
    for name, pairs in off.items():
        U, W, V = family.trims[name]
        for p, model in pairs:
            added = p * U @ np.linalg.inv(np.eye(V.shape[1]) - p * V) @ W
            assert axis(LOOPS["calm"]) + added == pytest.approx(axis(LOOPS[model]), abs=1e-9)
    q = mission.vehicle.quadrotors[0]
    assert family.lags == pytest.approx(np.full(8, 0.5 * (q.lag_up + q.lag_down)))
    assert family.delay == mission.actuators.delay
