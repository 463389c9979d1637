"""Numbers of a certificate from models whose answers are known: free bodies, integrators, limits that are set."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.analysis.certification import admittance_map as maps
from tandemlift.analysis.certification import felt_admittance, flown
from tandemlift.analysis.certification.admittance_map import acceleration_per_force, admittance_family, family_limit
from tandemlift.analysis.certification.claims import Claim, Tier
from tandemlift.analysis.certification.felt_admittance import (
    CEILING,
    ArmImpedance,
    FeltAdmittance,
    is_coupled_stable,
    stiffness_limit,
)
from tandemlift.analysis.certification.flown import LimitTrial, flown_limit
from tandemlift.analysis.certification.parameters import ARM
from tandemlift.analysis.certification.person import ArmBox, leading_impedance
from tandemlift.core.errors import InputError
from tandemlift.missions import load_mission

W = np.geomspace(0.05, 300.0, 900)
S = 1j * W


def hover():
    return load_mission("hover")


# arms


def test_an_arm_has_the_impedance_of_its_spring_its_damper_and_its_mass():
    Z = ArmImpedance(40.0, 3.0, 0.5).impedance(np.array([2.0]))
    assert Z[0] == pytest.approx(3.0 + 1j * (0.5 * 2.0 - 40.0 / 2.0))


@pytest.mark.parametrize("name", ["stiffness", "damping", "mass"])
@pytest.mark.parametrize("value", [0.0, -1.0, math.inf, math.nan])
def test_a_box_of_arms_has_a_size_along_each_side(name, value):
    assert ArmBox().checked() == ArmBox()
    with pytest.raises(InputError, match=f"arm {name} = "):
        ArmBox()._replace(**{name: value}).checked()


@pytest.mark.parametrize("size", [1, 3])
def test_a_mass_in_a_springs_hand_is_stable_with_damping_and_one_behind_a_delay_is_not(size):
    """The same along one axis as along three."""
    eye = np.eye(size)
    mass = FeltAdmittance(W, (1.0 / (2.0 * S + 0.1))[:, None, None] * eye)
    late = FeltAdmittance(W, (np.exp(-0.2 * S) / (2.0 * S + 0.1))[:, None, None] * eye)
    spring = ArmImpedance(50.0, 0.5).impedance(W)
    assert is_coupled_stable(mass, spring)
    assert not is_coupled_stable(late, spring)


def test_a_person_who_leads_pushes_by_their_gain_times_the_missing_speed_whatever_they_do_late():
    """At low frequency Z → gain; without delay and lag it is (k/s + b) gain s/k = gain (1 + b s/k) at all."""
    person = load_mission("zigzag").person
    for gain, delay, lag in ((2.0, 0.0, 0.0), (5.0, 0.2, 0.05), (1.0, 0.1, 0.1)):
        one = person.model_copy(update={"gain": gain, "lag": lag})
        assert leading_impedance(one, np.array([1e-4]), delay)[0] == pytest.approx(gain, rel=1e-3)
        if lag == 0.0:
            expected = gain * (1.0 + one.damping * S / one.stiffness)
            assert leading_impedance(one, W, 0.0) == pytest.approx(expected)


# the admittance at the hand of a free body


@pytest.mark.parametrize("yaw", [0.0, 0.9])
def test_the_admittance_at_the_hand_of_a_free_body_is_that_of_its_mass_and_its_inertia_about_the_grip(yaw, monkeypatch):
    """v = F/(m s) and J ω̇ = r × F at the centre of mass; the velocity of the grip is v + ω × r."""
    mission = load_mission("iris", {"initial.euler": [0.0, 0.0, yaw], "person.grip": 0.4})
    mass, J, seen = 3.0, np.diag([0.4, 0.1, 0.45]), {}

    def linearize(hover, at, **_):
        seen.update(hover=hover, at=at)
        return SimpleNamespace(connected=lambda: SimpleNamespace(A=np.zeros((1, 1)), step=hover.mission.step))

    def response(model, hertz):
        s = 2j * math.pi * hertz
        found = np.zeros((len(s), 6, 6), complex)
        found[:, :3, :3] = np.eye(3) / (mass * s[:, None, None])
        found[:, 3:, 3:] = np.linalg.inv(J) / s[:, None, None]
        return found

    monkeypatch.setattr(felt_admittance, "linearize", linearize)
    monkeypatch.setattr(felt_admittance, "frequency_response", response)
    felt = felt_admittance.felt_admittance(mission, {"admittance.damping": [4.0] * 3})
    assert seen["hover"].admittance.damping == (4.0,) * 3
    _, calm = flown.hover_as_flown(mission)
    (push,) = seen["hover"].pushes
    assert seen["at"] == push.time == pytest.approx(calm + 5.0)  # in the middle of a push that begins in calm
    assert push.force == pytest.approx([x + 0.2 for x in mission.admittance.threshold])
    assert seen["hover"].mission.duration > push.time
    r = mission.hover.vehicle.origin + np.array([0.0, mission.person.grip, 0.0])
    cross = np.array([[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]])
    R = np.array([[math.cos(yaw), -math.sin(yaw), 0.0], [math.sin(yaw), math.cos(yaw), 0.0], [0.0, 0.0, 1.0]])
    inverse = np.eye(3) / mass - R @ cross @ np.linalg.inv(J) @ cross @ R.T  # (1/m − [r] J⁻¹ [r]) F
    assert felt.Y * (1j * felt.w)[:, None, None] == pytest.approx(np.broadcast_to(inverse, felt.Y.shape))


# the map of arms

MIX = [(0.02 + 0.01j, 0.9, 0.3 - 0.2j), (0.0, 1.1, 0.1), (0.01, 0.8, 0.2j)]  # α, β, γ of each axis


def fractional(step):
    """Y of any virtual mass and damping: (α + β e^(−0.1 s) A)/(1 + γ A) along each axis."""

    def felt(mission, changes):
        m, c = changes["admittance.mass"][0], changes["admittance.damping"][0]
        A = 1.0 / (m + c * step / np.expm1(S * step))
        x = A * np.exp(-0.1 * S)  # late, so that arms have a limit
        return FeltAdmittance(
            W, np.stack([(a + b * x) / (1.0 + g * A) for a, b, g in MIX], axis=-1)[:, :, None] * np.eye(3)
        )

    return felt


def test_a_family_of_admittances_is_met_at_any_mass_and_damping(monkeypatch):
    mission = hover()
    monkeypatch.setattr(maps, "felt_admittance", fractional(mission.mission.step))
    family = admittance_family(mission)
    for m, c in ((0.7, 2.0), (5.0, 0.3)):
        changes = {"admittance.mass": [m] * 3, "admittance.damping": [c] * 3}
        expected = fractional(mission.mission.step)(mission, changes)
        assert family.at(m, c) == pytest.approx(np.diagonal(expected.Y, axis1=1, axis2=2))
        axes = [FeltAdmittance(W, expected.Y[:, i : i + 1, i : i + 1]) for i in range(3)]
        limit = min(CEILING, *(stiffness_limit(axis, 1.0) for axis in axes))
        assert family_limit(family, m, c, 1.0) == pytest.approx(limit, rel=1e-6)
        assert limit < CEILING


def test_a_slow_push_accelerates_a_mass_and_a_steady_one_is_held_by_the_damping():
    """A of v⁺ = v + T a, M a = F − C v: between samples v = T a/(z − 1)."""
    z = np.exp(S * 0.01)
    assert acceleration_per_force(W, 0.01, 2.0, 3.0) == pytest.approx(1.0 / (2.0 + 3.0 * 0.01 / (z - 1.0)))


@pytest.mark.parametrize("fly", [False, True])
@pytest.mark.parametrize("limit", [40.0, CEILING])
def test_a_map_of_arms_is_around_the_mission_and_flies_where_there_is_a_limit(fly, limit, monkeypatch):
    mission, asked = load_mission("iris"), []
    monkeypatch.setattr(maps, "admittance_family", lambda mission: "family")
    monkeypatch.setattr(maps, "family_limit", lambda family, m, c, arm: limit if c > 1e-3 else math.nan)
    monkeypatch.setattr(maps, "fly_many", lambda missions: asked.extend(missions) or missions)
    heavy = 1.5 * max(mission.admittance.mass)
    monkeypatch.setattr(
        maps, "stability_in_hand", lambda flight: "oscillation" if flight.admittance.mass[0] > heavy else ""
    )
    data = maps.admittance_map(mission, fly=fly)
    for key, own in (("mass", mission.admittance.mass), ("damping", mission.admittance.damping)):
        assert (data[key][0], data[key][-1]) == pytest.approx((0.2 * max(own), 5.0 * max(own)))
    assert data["mission"] == [max(mission.admittance.mass), max(mission.admittance.damping)]
    assert data["arm_stiffness"] == limit
    assert np.shape(data["stiffness"]) == (len(data["mass"]), len(data["damping"]))
    assert ("flown" in data) == bool(asked) == (fly and limit < CEILING)
    for (mass, damping, calm), flight in zip(data.get("flown", ()), asked, strict=True):
        assert calm == (mass <= heavy)
        assert (flight.admittance.mass, flight.admittance.damping) == ((mass,) * 3, (damping,) * 3)
        assert (flight.person.model, flight.person.stiffness) == ("hold", limit)


# limits that flights find


def trial(limit, nominal, refused=math.inf):
    """A vehicle that oscillates beyond a limit, on either side of its nominal value."""

    def mission(value):
        if abs(math.log(value / nominal)) > abs(math.log(refused / nominal)):
            raise InputError("not allowed")
        return value

    beyond = (lambda value: value > limit) if limit > nominal else (lambda value: value < limit)
    return LimitTrial(mission, lambda value: "oscillation" if beyond(value) else "", nominal)


@pytest.fixture
def _flown_at_once(monkeypatch):
    monkeypatch.setattr(flown, "fly_many", lambda missions, threads: missions)
    monkeypatch.setattr(flown, "frequency_of", lambda value: 2.0 * value)


@pytest.mark.usefixtures("_flown_at_once")
@pytest.mark.parametrize("limit", [0.55, 0.8, 1.0, 1.3, 1.59])
def test_flights_find_a_limit_near_the_predicted_one_on_either_side(limit):
    """Values from half to 1.6 times the predicted one are tried, 16 and then 12, so that they are 0.7 % apart."""
    for predicted, nominal in ((10.0, 1.0), (0.1, 1.0)):
        true = predicted * limit if predicted > nominal else predicted / limit
        found = flown_limit(trial(true, nominal), predicted)
        assert found.ended == "oscillation"
        assert abs(math.log(found.above / found.below)) < 0.01
        assert min(found.below, found.above) <= true <= max(found.below, found.above)
        assert found.frequency == pytest.approx(2.0 * found.above)


@pytest.mark.usefixtures("_flown_at_once")
def test_flights_that_find_no_limit_or_a_nearer_one_say_so():
    for predicted, endless in ((10.0, math.inf), (0.1, 0.0)):
        none = flown_limit(LimitTrial(lambda value: value, lambda value: "", 1.0), predicted)
        assert (none.above, none.ended) == (endless, "")
        assert none.below == pytest.approx(predicted * (1.6 if predicted > 1.0 else 1.0 / 1.6))
    first = flown_limit(LimitTrial(lambda value: value, lambda value: "lost", 1.0), 10.0)
    assert (first.below, first.above, first.ended) == (1.0, pytest.approx(5.0), "lost")
    assert math.isnan(first.frequency)
    refused = flown_limit(trial(30.0, 1.0, refused=9.0), 10.0)
    assert (refused.above, refused.ended) == (pytest.approx(9.0, rel=0.01), "refused")


def recorded(rates, climb=lambda t: 0.0 * t, outcome="flying"):
    """A flight of 30 s at 200 Hz; `rates`: of roll, pitch and yaw, over the time."""
    t = np.arange(0.0, 30.0, 0.005)
    channels = {
        "rates": np.column_stack([np.broadcast_to(rate(t), t.shape) for rate in rates]),
        "velocity": np.column_stack([0.7 + 0.0 * t, -0.4 + 0.0 * t, climb(t)]),
    }
    one = SimpleNamespace(time=t, outcome=outcome, failure="")
    return type("Recorded", (), {"__getitem__": lambda self, name: channels[name]} | vars(one))()


def still(t):
    return 0.0 * t


def swinging(size, frequency=5.0, rate=0.0):
    return lambda t: size * np.exp(rate * t) * np.sin(frequency * t)


@pytest.mark.parametrize("axis", [0, 1, 2, 3])
def test_a_motion_that_stays_is_an_oscillation_with_its_frequency_and_one_that_decays_is_none(axis):
    def flight(motion):
        rates = [still] * 3
        if axis < 3:
            rates[axis] = motion
        return recorded(rates, motion if axis == 3 else still)

    for judge in (flown.stability, flown.stability_in_hand):
        assert judge(flight(swinging(0.1))) == "oscillation"
        assert judge(flight(swinging(0.01, rate=0.05))) == "oscillation"
        assert judge(flight(swinging(0.1, rate=-0.2))) == ""
        assert judge(recorded([still] * 3, outcome="crashed")) == "lost"
    assert flown.frequency_of(flight(swinging(0.1))) == pytest.approx(5.0, rel=0.01)
    late = flight(lambda t: np.where(t < 22.0, 0.1 * np.sin(9.0 * t), 0.1 * np.sin(3.0 * t)))
    assert flown.frequency_of(late) == pytest.approx(3.0, rel=0.02)  # of the last 8 s


def test_an_arm_keeps_an_oscillation_from_growing_so_that_its_size_at_any_time_counts():
    """A swing that once was large and decays: without an arm it is over, in an arm's hand it was none of the pull."""
    once = recorded([lambda t: 0.5 * np.exp(-0.4 * np.abs(t - 12.0)) * np.sin(5.0 * t), still, still])
    assert flown.stability(once) == ""
    assert flown.stability_in_hand(once) == "oscillation"
    large = recorded([swinging(0.9, rate=-0.02), still, still])
    assert flown.stability(large) == "oscillation"  # 0.5 rad/s are left, too much for its push


def test_a_kick_and_its_watching_fit_into_the_flight():
    """4 s after the push, then two windows of 8 s, 8 s apart."""
    mission = load_mission("iris")
    keys = flown.kick_keys(mission.hover, 12.0, 2.0)
    (push,) = keys["pushes"]
    assert keys["mission.duration"] == pytest.approx(12.0 + 4.0 + 8.0 + 8.0)
    assert push["force"] == [0.5] * 3
    assert push["time"] - 2.0 * push["sigma"] > 12.0
    assert push["time"] + 3.0 * push["sigma"] < keys["mission.duration"] - 16.0
    arm = flown.arm_keys(mission.person, mission, 12.0, 40.0)
    assert arm["mission.duration"] == keys["mission.duration"]
    hand = np.array(arm["person"]["path"][0]["point"])
    x, y, _ = mission.initial.position
    assert 40.0 * (hand - (x, y + mission.person.grip)) == pytest.approx([0.02, 0.02])  # N, the pull


@pytest.mark.thorough
def test_an_arm_begins_with_its_pull_alone_where_the_centre_of_mass_is_not_the_payloads():
    """0.02 N along x and y on the grip, wherever the payload's centre is, and whichever way the vehicle heads."""
    odd = {"vehicle.payload.center_of_mass": [0.05, 0.2, 0.0], "initial.euler": [0.0, 0.0, 0.7]}
    flight = tl.fly(flown.trial_of(load_mission("iris", odd), ARM).mission(10.0))
    assert 0.02 < np.linalg.norm(flight["push_force"], axis=1).max() < 0.05


def test_each_limit_has_a_mission_just_beyond_it():
    mission = load_mission("iris")
    limit = Claim("lag limit", "", 40.0, "ms", parameter="lag", limit=0.04)
    tier = flown.with_limits(
        Tier("linear", "Linear", (), (limit, Claim("gain margin", "roll", 9.0, "dB"))), mission, False
    )
    claim, other = tier.claims
    assert (claim.flown, other.command) == (None, "")
    assert claim.nominal == pytest.approx(
        0.5 * (mission.vehicle.quadrotors[0].lag_up + mission.vehicle.quadrotors[0].lag_down)
    )
    assert claim.command == "tandemlift run limits/lag-limit.toml"
    assert list(tier.files) == ["limits/lag-limit.toml"]
    assert f"lag_up = {0.04 * 1.05:g}" in tier.files["limits/lag-limit.toml"]
