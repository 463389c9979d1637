"""Arms that hold a vehicle, against the roots of the same loop's polynomial; bounds on failures against SciPy."""

import math
import shlex

import numpy as np
import pytest
from scipy.stats import beta

from tandemlift.analysis.certification.felt_admittance import FeltAdmittance
from tandemlift.analysis.certification.person import ArmBox, _arms, passivity
from tandemlift.analysis.certification.statistics import SHOWN_ROWS, _claims
from tandemlift.analysis.studies.execution.random_flights import RandomFlight
from tandemlift.core.phases import FAILURES
from tandemlift.missions import load_mission

W = np.geomspace(0.03, 300.0, 2000)
M, C, LAG = 2.0, 3.0, 0.1  # kg, N s/m, s: an admittance behind two lags, Y = 1/((M s + C)(τ s + 1)²)
LATE = np.polymul([M, C], np.polymul([LAG, 1.0], [LAG, 1.0]))
ENDS = sorted(FAILURES)
BOX = ArmBox(100.0, 5.0, 0.6)
CORNERS = [(b, m) for b in np.linspace(0.0, BOX.damping, 4) for m in (0.0, BOX.mass)]


def felt():
    """The vehicle, heavier along y and z: the loop along x oscillates first."""
    Y = 1.0 / np.polyval(LATE, 1j * W)
    return FeltAdmittance(W, Y[:, None, None] * np.diag([1.0, 0.5, 0.25]))


def roots(stiffness, damping, mass):
    """Of s (M s + C)(τ s + 1)² + m s² + b s + k."""
    return np.roots(np.polyadd(np.polymul(LATE, [1.0, 0.0]), [mass, damping, stiffness]))


def edge(is_stable, low, high):
    """Between a stable number and another."""
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_stable(middle) else (low, middle)
    return low


def stiffest(damping, mass=0.0):
    return edge(lambda k: roots(k, damping, mass).real.max() < 0.0, 0.0, 1e4)


def claims():
    return {claim.quantity: claim for claim in _arms(load_mission("hover").person, felt(), BOX)}


def test_the_box_of_arms_is_as_good_as_its_worst_arm_by_the_roots_of_each():
    every = {corner: stiffest(*corner) for corner in CORNERS}
    worst = min(every, key=lambda corner: every[corner])
    assert max(every.values()) > 1.5 * every[worst]
    claim = claims()["arm stiffness limit, box"]
    assert claim.value == pytest.approx(every[worst], rel=0.01)
    assert (claim.unit, claim.bar) == ("N/m", BOX.stiffness)
    assert f"the worst of them has {worst[0]:.3g} N s/m and {worst[1]:g} kg" in claim.text


def test_the_stiffest_arm_of_the_person_and_its_oscillation_are_those_of_the_roots():
    person, claim = load_mission("hover").person, claims()["arm stiffness limit"]
    limit = stiffest(person.damping)
    found = roots(limit, person.damping, 0.0)
    assert claim.value == claim.limit == pytest.approx(limit, rel=0.01)
    assert claim.frequency == pytest.approx(abs(found[np.argmax(found.real)].imag), rel=0.01)
    assert (claim.bar, claim.unit, claim.parameter) == (person.stiffness, "N/m", "arm stiffness")


def test_the_heaviest_hand_without_a_spring_is_that_of_the_roots():
    """With k = 0 one root is 0, the place of the hand, which nothing holds; little damping bears any mass."""
    person = load_mission("hover").person
    for damping in (person.damping, 12.0):
        heavy = edge(lambda m, b=damping: np.roots(np.polyadd(LATE, [m, b])).real.max() < 0.0, 0.0, 2e5)
        found = {c.quantity: c for c in _arms(person.model_copy(update={"damping": damping}), felt(), BOX)}
        expected = math.inf if heavy > 1.9e5 else pytest.approx(heavy, rel=0.01)
        assert found["hand mass limit"].value == expected
        assert found["hand mass limit"].unit == "kg"


def test_a_vehicle_that_is_passive_up_to_a_frequency_by_its_closed_form_is_so_in_the_claim():
    """Two lags τ behind M s + C: Re Y changes its sign where C = ω² τ (2 M + C τ), as Re ((M s + C)(τ s + 1)²) does."""
    edge_of = math.sqrt(C / (LAG * (2.0 * M + C * LAG))) / (2.0 * math.pi)
    x, y, z = passivity(felt())
    assert [claim.subject for claim in (x, y, z)] == ["x", "y", "z"]
    for claim in (x, y, z):
        assert claim.value == pytest.approx(edge_of, rel=0.01)
        assert claim.unit == "Hz"
    worst = -np.real(1.0 / np.polyval(LATE, 1j * W))
    assert f"most at {W[np.argmax(worst)] / (2.0 * math.pi):.2g} Hz: Re Y = {-worst.max():.2g} m" in x.text
    assert f"Re Y = {-0.25 * worst.max():.2g} m" in z.text


def rows(failed, landed, flown):
    """Flights, those that failed last, each with one finding, and landed ones with two."""
    found = [RandomFlight("flying", ())] * flown + [RandomFlight("landed", ("contact", "late"))] * landed
    return [*found, *(RandomFlight(end, ("contact",)) for end in failed)]


@pytest.mark.parametrize("failed", [(), ENDS[:1], (*ENDS, "refused"), ENDS[:1] * 2 * SHOWN_ROWS])
def test_the_bounds_on_failures_and_findings_are_clopper_and_pearsons(failed, tmp_path):
    every = rows(failed, 7, 53)
    total, bad = len(every), [60 + i for i in range(len(failed))]
    failure, *findings = _claims(every, tmp_path)
    assert failure.value == pytest.approx(beta.ppf(0.95, len(failed) + 1, total - len(failed)))
    assert failure.quantity == "probability of a failure, at most"
    assert f"{len(failed)} of {total} flights failed" in failure.text
    if bad:
        assert f"rows {', '.join(map(str, bad[:SHOWN_ROWS]))}{' …' if len(bad) > SHOWN_ROWS else ''};" in failure.text
        assert shlex.split(failure.command)[-2:] == ["--row", "60"]
    else:
        assert shlex.split(failure.command) == ["tandemlift", "report", str(tmp_path)]
    counts = {"contact": 7 + len(failed), "late": 7}
    assert {claim.subject for claim in findings} == set(counts)
    for claim in findings:
        k = counts[claim.subject]
        assert claim.value == pytest.approx(beta.ppf(0.95, k + 1, total - k))
        assert claim.text == f"{k} of {total} flights"
