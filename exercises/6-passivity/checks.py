"""Checks of exercise 6. A failed assertion says what to look at."""

import numpy as np

import tandemlift as tl

W = np.geomspace(0.05, 200.0, 2000)  # rad/s
M, D = 1.0, 1.6  # kg, N s/m


def check_energy(energy, points=1):
    """The energy that a hand puts in."""
    t = np.linspace(0.0, 2.0, 2001)
    force = np.column_stack([np.full_like(t, 3.0), 0.0 * t, 0.0 * t])
    velocity = np.column_stack([0.5 * t, t, 0.0 * t])
    found = energy(force, velocity, t[1])
    assert np.ndim(found) == 0, "The energy is one number: sum over the axes, and over time."
    assert abs(found - 3.0) < 0.01, f"3 N along 1 m are 3 J, not {found:.3f}: integrate the power F·v over time."
    assert energy(-force, velocity, t[1]) < 0.0, "A hand that brakes takes energy out: the sign counts."


def check_felt(felt, points=2):
    """The admittance that the hand feels."""
    now = felt(W, M, D, 0.0)
    assert np.allclose(now, 1.0 / (M * 1j * W + D)), "Without delay it is 1/(M jω + D), velocity over force."
    late = felt(W, M, D, 0.05)
    assert np.allclose(np.abs(late), np.abs(now)), "A delay changes no magnitude."
    at = np.searchsorted(W, 10.0)
    assert np.angle(late[at] / now[at]) < 0.0, "A delay turns the response backwards."
    assert np.allclose(late, now * np.exp(-0.05j * W)), "A delay of T is the factor exp(-jωT)."


def check_passive(is_passive, points=2):
    """Whether an admittance is passive."""
    now = 1.0 / (M * 1j * W + D)
    assert is_passive(W, now), "A mass with a damper takes energy only: Re Y ≥ 0 at every frequency."
    assert not is_passive(W, now * np.exp(-0.05j * W)), (
        "Behind 50 ms it is not passive: Re Y is negative at some frequency, even if |Y| is small there."
    )
    assert is_passive(W, 2.0 + 0.0 * now), "A damper alone is passive."
    assert not is_passive(W, -now), "With the sign turned it drives the hand."


def check_stiffest_without_mass(stiffest_arm, points=1):
    """The stiffest arm on a damper alone, in closed form."""
    found = stiffest_arm(1e-9, 1.6, 0.1)
    true = 1.6 * np.pi / (2.0 * 0.1)
    assert abs(found - true) < 0.02 * true, (
        f"A damper of 1.6 N s/m behind 0.1 s bears D π/(2T) = {true:.1f} N/m, you found {found:.1f}."
    )


def _swing(stiffness, delay):
    """An arm on the admittance behind a delay: the largest motion in the last fifth of 60 s over that in the first."""
    dt, x, v, moved = 1e-3, 0.0, 0.0, []
    late = [0.0] * max(round(delay / dt), 1)
    for i in range(60_000):
        late.append(-stiffness * x + (1.0 if i < 200 else 0.0))
        v += dt * (late[i] - D * v) / M
        x += dt * v
        moved.append(abs(x))
        if moved[-1] > 1e6:
            return np.inf
    return max(moved[-12_000:]) / max(moved[:12_000])


def check_stiffest(stiffest_arm, points=2):
    """Beyond the stiffest arm the coupled system swings, below it settles."""
    for delay in (0.05, 0.2):
        k = float(stiffest_arm(M, D, delay))
        assert 0.0 < k < 1e4, f"{k:.3g} N/m is no arm's stiffness."
        assert _swing(0.9 * k, delay) < 0.7, f"With {delay:g} s and nine tenths of your {k:.1f} N/m it already swings."
        assert _swing(1.1 * k, delay) > 1.5, f"With {delay:g} s and more than your {k:.1f} N/m it still settles."


def check_damping(least_damping, points=1):
    """The least damping for a stiff arm."""
    for k in (5.0, 40.0):
        d = float(least_damping(M, 0.1, k))
        w = np.sqrt((np.sqrt(d**4 + 4.0 * M**2 * k**2) - d**2) / (2.0 * M**2))  # where k/|s(Ms + D)| is 1
        left = np.pi / 2 - np.arctan(w * M / d) - 0.1 * w
        assert abs(left) < 0.02, (
            f"For an arm of {k:g} N/m your {d:.2f} N s/m leave {np.degrees(left):.0f}° of phase; at the limit it is 0°."
        )


def check_flight(energy, points=1):
    """The work of the person of mission one-push, from its log."""
    flight = tl.fly("one-push")
    mine = energy(flight["push_force"], flight["velocity"], flight.time[1] - flight.time[0])
    theirs = flight.metrics()["human_work_j"]
    assert abs(mine - theirs) < 0.02 * theirs, f"The flight's own metric says {theirs:.2f} J, your sum {mine:.2f} J."
