"""Checks of exercise 4. A failed assertion says what to look at."""

import numpy as np

import tandemlift as tl

ONE = np.array([[0.2, -0.2], [-0.2, 0.2], [0.2, 0.2], [-0.2, -0.2]])  # m
SPINS = np.array([-1.0, -1.0, 1.0, 1.0])
SIDE = np.array([0.0, 1.0])
TWO = np.vstack([ONE + SIDE, ONE - SIDE])
WRENCH = np.array([40.0, 0.5, -0.3, 0.1])  # N, N m


def _effectiveness(arms, spins):
    return np.array([np.ones(len(arms)), arms[:, 1], -arms[:, 0], 0.06 * spins])


E4, E8 = _effectiveness(ONE, SPINS), _effectiveness(TWO, np.tile(SPINS, 2))


def check_thrust_and_roll(effectiveness, points=1):
    """The rows of thrust and roll."""
    e = np.asarray(effectiveness(ONE, SPINS, 0.06))
    assert e.shape == (4, 4), f"One row each for thrust, roll, pitch and yaw, one column for each rotor: not {e.shape}."
    assert np.allclose(e[0], 1.0), "Each rotor adds its own thrust: the first row is ones."
    assert np.allclose(e[1], ONE[:, 1]), "A thrust up at y > 0 rolls about +x: r × f has y·f in x."


def check_pitch_and_yaw(effectiveness, points=1):
    """The rows of pitch and yaw."""
    e = np.asarray(effectiveness(ONE, SPINS, 0.06))
    assert np.allclose(e[2], -ONE[:, 0]), "A thrust up at x > 0 pitches about -y: r × f has -x·f in y."
    assert np.allclose(e[3], 0.06 * SPINS), "Yaw is the reaction torque: spin times torque per thrust times thrust."


def check_vehicle(effectiveness, points=1):
    """The rotors of mission one-push make the moments that your matrix says."""
    flight = tl.fly("one-push")
    vehicle = tl.Vehicle.from_settings(flight.vehicle)
    places = [
        np.asarray(hubs) + body.position for hubs, body in zip(vehicle.rotor_hubs, vehicle.quadrotors, strict=True)
    ]
    arms, spins = np.vstack(places)[:, :2], np.concatenate([body.spins for body in vehicle.quadrotors])
    e = np.asarray(effectiveness(arms, spins, 0.06))
    made = flight["rotor_thrusts"] @ e.T
    off = np.abs(made - np.column_stack([flight["thrust"], flight["moment"]])).max(axis=0)
    assert off.max() < 1e-6, (
        f"In flight, thrust, roll, pitch and yaw differ from E f by up to {np.round(off, 3).tolist()} N and N m."
    )


def check_allocate(allocate, points=2):
    """The thrusts make the wrench that is asked for."""
    for e in (E4, E8):
        f = np.asarray(allocate(e, WRENCH))
        assert f.shape == (e.shape[1],), f"One thrust for each of {e.shape[1]} rotors: not {f.shape}."
        assert np.allclose(e @ f, WRENCH), f"Your thrusts make {np.round(e @ f, 2).tolist()}, not {WRENCH.tolist()}."


def check_least_effort(allocate, points=1):
    """Of all such thrusts, those with the least sum of squares."""
    f = np.asarray(allocate(E8, WRENCH))
    least = np.linalg.lstsq(E8, WRENCH, rcond=None)[0]
    assert np.allclose(f, least), (
        f"The sum of squares is {f @ f:.1f} N², and {least @ least:.1f} N² would do: eight rotors for four numbers "
        "leave a choice; the pseudo-inverse makes it."
    )


def check_lost_rotor(allocate_without, points=2):
    """A lost rotor makes nothing, and the others make up for it."""
    for rotor in (0, 5):
        f = np.asarray(allocate_without(E8, WRENCH, rotor))
        assert f.shape == (8,), "Keep eight thrusts: that of the lost rotor is zero."
        assert abs(f[rotor]) < 1e-12, f"Rotor {rotor} is lost, but makes {f[rotor]:.2f} N."
        assert np.allclose(E8 @ f, WRENCH), "Without it the others must still make the wrench."
        others = np.delete(f, rotor)
        least = np.linalg.lstsq(np.delete(E8, rotor, axis=1), WRENCH, rcond=None)[0]
        assert np.allclose(others, least), "Allocate anew over the others; do not spread what is missing evenly."


def check_hover(can_hover, points=2):
    """Which losses the vehicle survives."""
    weight = np.array([30.0, 0.0, 0.0, 0.0])
    assert not any(can_hover(E4, weight, 20.0, rotor) for rotor in range(4)), (
        "A quadrotor cannot hover on three rotors: a thrust below zero is none that a rotor makes."
    )
    assert all(can_hover(E8, weight, 20.0, rotor) for rotor in range(8)), "Two quadrotors can, with any rotor lost."
    assert not any(can_hover(E8, weight, 4.0, rotor) for rotor in range(8)), (
        "Eight rotors of 4 N carry 30 N, seven do not: each thrust must be within the largest."
    )
    assert not can_hover(E8, np.array([30.0, 40.0, 0.0, 0.0]), 20.0, 0), "This moment would need thrusts below zero."
