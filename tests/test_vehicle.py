"""The vehicle's mass, centre of mass, inertia and matrices, against the paper's table and against point masses."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from law_values import BEAM, HEIGHT, paper_vehicle, quadrotor, random_vehicle, seeds

import tandemlift as tl
from tandemlift.core.errors import InputError
from tandemlift.parts.mechanics.vehicle import Vehicle, mixer, mixer_inverse

counts = st.integers(1, 4)
IRIS = ((0.13, -0.22), (-0.13, 0.20), (0.13, 0.22), (-0.13, -0.20))  # m: Gazebo's rotors 0 to 3
IRIS_SPINS = (-1, -1, 1, 1)  # counter-clockwise rotors, 0 and 1, push the body clockwise


def point_masses(mass: float, moments, center) -> tuple[np.ndarray, np.ndarray]:
    """Six point masses with this mass, centre and principal moments: (6,), (6 × 3)."""
    x, y, z = moments
    squares = 1.5 / mass * np.array([y + z - x, x + z - y, x + y - z])
    arms = np.diag(np.sqrt(np.maximum(squares, 0.0)))
    return np.full(6, mass / 6.0), np.asarray(center, dtype=float) + np.vstack([arms, -arms])


def as_points(vehicle: Vehicle) -> tuple[np.ndarray, np.ndarray]:
    """The whole vehicle as point masses, from the payload's centre of mass."""
    parts = [point_masses(vehicle.payload.mass, vehicle.payload.moments, np.zeros(3))]
    parts += [point_masses(q.mass, q.inertia, q.position) for q in vehicle.quadrotors]
    masses, places = zip(*parts, strict=True)
    return np.concatenate(masses), np.vstack(places)


def test_the_papers_table_is_the_sum_of_its_parts_to_every_printed_digit():
    v = paper_vehicle()
    assert f"{v.mass:.1f}" == "3.5"
    assert [f"{J:.6f}" for J in np.diag(v.inertia)] == ["3.227327", "0.061286", "3.277117"]
    assert [f"{100 * J:.4f}" for J in (BEAM.moments[0], BEAM.moments[2])] == ["16.6667", "16.6667"]
    assert f"{BEAM.moments[1]:.2e}" == "6.25e-04"
    assert np.abs(v.inertia - np.diag(np.diag(v.inertia))).max() < 1e-15


def test_the_papers_table_needs_the_quadrotors_above_the_beam():
    """At h = 0 the table's J_tx and J_ty would be 0.0024 kg m² smaller than printed."""
    flat = Vehicle(BEAM, [quadrotor((0.0, y, 0.0)) for y in (1.0, -1.0)])
    missing = np.diag(paper_vehicle().inertia - flat.inertia)
    assert missing == pytest.approx([0.00241071, 0.00241071, 0.0], abs=1e-8)


def test_the_papers_center_of_mass_is_between_beam_and_quadrotors():
    v = paper_vehicle()
    assert v.center_of_mass == pytest.approx([0.0, 0.0, 0.0642857], abs=1e-7)
    assert v.lever_arms[0] == pytest.approx([0.0, 1.0, 0.0107143], abs=1e-7)


@given(counts, seeds)
def test_mass_center_and_inertia_are_those_of_the_equivalent_point_masses(count, seed):
    v = random_vehicle(np.random.default_rng(seed), count)
    masses, places = as_points(v)
    center = masses @ places / masses.sum()
    arms = places - center
    J = sum(m * (r @ r * np.eye(3) - np.outer(r, r)) for m, r in zip(masses, arms, strict=True))
    assert v.mass == pytest.approx(masses.sum(), rel=1e-14)
    assert v.center_of_mass == pytest.approx(center, abs=1e-14)
    assert v.inertia == pytest.approx(J, abs=1e-13)
    assert v.lever_arms == pytest.approx(np.array([q.position for q in v.quadrotors]) - center, abs=1e-14)


@given(counts, seeds)
def test_B_sums_thrusts_moments_and_lever_arms(count, seed):
    rng = np.random.default_rng(seed)
    v = random_vehicle(rng, count)
    inputs = rng.standard_normal((count, 4))
    force, moment = np.zeros(3), np.zeros(3)
    for d, u in zip(v.lever_arms, inputs, strict=True):
        thrust = np.array([0.0, 0.0, u[0]])
        force += thrust
        moment += np.cross(d, thrust) + u[1:]
    assert v.B.shape == (4, 4 * count)
    assert v.B @ inputs.ravel() == pytest.approx(np.append(force[2], moment), abs=1e-13)


@given(counts, seeds)
def test_the_effect_of_the_rotors_is_the_sum_over_all_of_them(count, seed):
    rng = np.random.default_rng(seed)
    v = random_vehicle(rng, count)
    thrusts = rng.uniform(0.0, 7.0, (count, 4))
    force, moment = 0.0, np.zeros(3)
    for d, q, own in zip(v.lever_arms, v.quadrotors, thrusts, strict=True):
        for j, f in enumerate(own):
            angle = j * np.pi / 2 + (np.pi / 4 if q.layout == "x" else 0.0)
            place = d + q.arm * np.array([np.cos(angle), np.sin(angle), 0.0])
            spin = 1.0 if j % 2 == 0 else -1.0
            force += f
            moment += np.cross(place, [0.0, 0.0, f])
            moment[2] += spin * q.torque_per_thrust * f
    assert v.effect @ thrusts.ravel() == pytest.approx(np.append(force, moment), abs=1e-12)


def placed(positions=IRIS, spins=IRIS_SPINS, **changes):
    return quadrotor(layout="x", arm=None, rotor_positions=positions, spins=spins, **changes)


def made_by(q, thrusts) -> np.ndarray:
    """Thrust and moments about a quadrotor's centre of mass, rotor by rotor."""
    force, moment = 0.0, np.zeros(3)
    for (x, y), spin, f in zip(q.rotor_positions, q.spins, thrusts, strict=True):
        force += f
        moment += np.cross([x, y, 0.0], [0.0, 0.0, f])
        moment[2] += spin * q.torque_per_thrust * f
    return np.append(force, moment)


@given(seeds)
def test_the_real_iris_makes_any_thrust_and_moments_by_its_mixers_inverse(seed):
    q, wanted = placed(), np.random.default_rng(seed).standard_normal(4)
    thrusts = mixer_inverse(q) @ wanted
    assert made_by(q, thrusts) == pytest.approx(wanted, abs=1e-13)
    assert mixer(q) @ thrusts == pytest.approx(wanted, abs=1e-13)


def test_the_real_iris_hovers_on_equal_thrusts_and_yaws_by_unequal_ones():
    """Its front rotors are further out: they turn it about z by less, so that it does not roll."""
    inverse = mixer_inverse(placed())
    assert inverse[:, 0] == pytest.approx([0.25] * 4, abs=1e-15)
    front, back = inverse[0, 3], inverse[1, 3]
    assert front / back == pytest.approx(0.20 / 0.22)
    rolling = inverse[:, 1]
    assert np.abs(rolling) == pytest.approx([1.0 / 0.84] * 4)  # 0.22 + 0.20 + 0.22 + 0.20 m


@given(seeds)
def test_rotors_at_any_places_have_an_inverse_or_are_refused(seed):
    rng = np.random.default_rng(seed)
    places = tuple(map(tuple, rng.uniform(-0.3, 0.3, (4, 2)).tolist()))
    q = placed(places, tuple(int(s) for s in rng.choice([-1, 1], 4)))
    wanted = rng.standard_normal(4)
    try:
        thrusts = mixer_inverse(q) @ wanted
    except InputError:
        assert np.linalg.matrix_rank(np.array([made_by(q, f) for f in np.eye(4)]), tol=1e-9) < 4
        return
    assert made_by(q, thrusts) == pytest.approx(wanted, abs=1e-9 * (1.0 + np.abs(thrusts).max()))


def test_rotors_placed_as_a_layout_has_them_are_that_layout():
    for layout, angles in (("+", np.arange(4) * 90.0), ("x", np.arange(4) * 90.0 + 45.0)):
        corners = 0.25 * np.column_stack([np.cos(np.radians(angles)), np.sin(np.radians(angles))])
        by_place = placed(tuple(map(tuple, corners.tolist())), (1, -1, 1, -1))
        by_layout = quadrotor(layout=layout, arm=0.25)
        assert np.array(by_layout.rotors) == pytest.approx(corners, abs=1e-16)
        assert mixer_inverse(by_place) == pytest.approx(mixer_inverse(by_layout), abs=1e-12)


CANNOT = {
    "spins that are alike": (IRIS, (1, 1, 1, 1)),
    "four in a line": (((0.3, 0.0), (0.1, 0.0), (-0.1, 0.0), (-0.3, 0.0)), (1, -1, 1, -1)),
    "two at one place that turn alike": (((0.2, 0.0), (0.2, 0.0), (-0.2, 0.1), (-0.2, -0.1)), (1, 1, -1, -1)),
    "spins that go with the side": (((0.2, -0.2), (-0.2, 0.2), (0.2, 0.2), (-0.2, -0.2)), (-1, 1, 1, -1)),
}


@pytest.mark.parametrize(("positions", "spins"), CANNOT.values(), ids=CANNOT)
def test_rotors_that_cannot_make_every_moment_are_refused(positions, spins):
    q = placed(positions, spins)
    with pytest.raises(InputError, match="cannot produce every thrust and moment"):
        mixer_inverse(q)


def test_B_of_two_quadrotors_stands_side_by_side():
    """Erratum b_matrix_equ: the printed sum is 4 × 4 and has lost which quadrotor is which."""
    v = paper_vehicle()
    blocks = np.split(v.B, 2, axis=1)
    printed = blocks[0] + blocks[1]
    assert v.B.shape == (4, 8)
    roll_by_thrust = np.array([1.0, 0, 0, 0, -1.0, 0, 0, 0])  # more on quadrotor 1, at +y, less on 2
    assert v.B @ roll_by_thrust == pytest.approx([0.0, 2.0, 0.0, 0.0])
    assert printed == pytest.approx(np.diag([2.0, 2.0, 2.0, 2.0]))  # no roll from any thrust


@given(seeds)
def test_heights_do_not_enter_the_allocation(seed):
    rng = np.random.default_rng(seed)
    v = random_vehicle(rng, 3)
    lifted = [q.model_copy(update={"position": (*q.position[:2], q.position[2] + rng.normal())}) for q in v.quadrotors]
    assert Vehicle(v.payload, lifted).effect == pytest.approx(v.effect, abs=1e-14)


def test_a_vehicle_needs_a_quadrotor():
    with pytest.raises(InputError, match="at least one"):
        Vehicle(BEAM, [])


def test_the_iris_lifts_1_65_times_the_papers_weight():
    v = paper_vehicle()
    assert v.max_thrust / v.weight == pytest.approx(1.65, abs=0.005)
    assert v.weight / v.rotor_count == pytest.approx(4.292, abs=5e-4)
    assert mixer(v.quadrotors[0]).sum(axis=1) == pytest.approx([4.0, 0.0, 0.0, 0.0], abs=1e-15)
    assert v.lever_arms[0][2] == pytest.approx(HEIGHT - v.center_of_mass[2])


ROTOR = {"thrust_constant": 1.2e-5, "max_speed": 1000.0, "max_thrust": 12.0}


@pytest.mark.parametrize(
    "left_out", [("max_thrust",), ("max_speed",), ("thrust_constant",), ("thrust_constant", "max_speed")]
)
def test_a_largest_thrust_says_what_is_left_out_of_constant_and_speed(left_out):
    iris = tl.load_mission("iris").vehicle.quadrotors[0]
    given = {name: value for name, value in (iris.model_dump() | ROTOR).items() if name not in left_out}
    rotor = type(iris).model_validate(given)
    assert rotor.thrust_limit == pytest.approx(12.0)
    assert rotor.thrust_constant * rotor.max_speed**2 == pytest.approx(12.0)


def test_a_largest_thrust_that_contradicts_constant_and_speed_is_refused_with_the_speed_that_suits():
    with pytest.raises(tl.InputError, match=r"here 7\.066 N and not 5 N: .* set max_speed = 925\.29"):
        tl.load_mission("iris", {"vehicle.quadrotors.0.max_thrust": 5.0})
