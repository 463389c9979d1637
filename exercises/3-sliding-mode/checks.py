"""Checks of exercise 3. A failed assertion says what to look at."""

import numpy as np

DT = 1e-3  # s


def fly(command, boundary, gain=2.0, disturbance=0.0, lag=0.0, seconds=8.0):
    """A point of one axis that begins 1 m off, at rest; its position, speed and commanded acceleration at each step."""
    x, v, a, rows = 1.0, 0.0, 0.0, []
    for _ in range(round(seconds / DT)):
        wanted = float(command(x, v, 2.0, gain, boundary))
        a = wanted if lag == 0.0 else a + DT / lag * (wanted - a)
        v += DT * (a + disturbance)
        x += DT * v
        rows.append((x, v, wanted))
        if not abs(x) < 1e3:
            break
    return np.array(rows).T


def check_surface(surface, points=1):
    """The surface is a first-order decay of the error."""
    assert abs(surface(0.0, 0.0, 2.0)) < 1e-12, "Without error and speed the state is on the surface: s = 0."
    assert abs(surface(0.5, -1.0, 2.0)) < 1e-12, (
        "An error of 0.5 m that falls by 1 m/s decays with the slope 2/s: "
        f"s must be 0, not {surface(0.5, -1.0, 2.0):.2f}."
    )
    assert surface(0.5, 0.0, 2.0) > 0.0, "s must grow with the error."
    assert abs(surface(0.0, 1.0, 2.0) - 1.0) < 1e-12, "s is a speed: the error's rate enters with the factor 1."


def check_switching(switching, points=2):
    """The switching term is a sign with a boundary layer."""
    assert abs(switching(5.0, 0.1) - 1.0) < 1e-6 and abs(switching(-5.0, 0.1) + 1.0) < 1e-6, (
        "Far from the surface it is the sign of s, 1 or -1."
    )
    assert abs(switching(0.01, 0.1) - 0.1) < 0.01, (
        f"Within the layer it is near s/boundary: 0.1 at s = 0.01 with a layer of 0.1, not {switching(0.01, 0.1):.3f}."
    )
    assert abs(switching(0.3, 0.0) - 1.0) < 1e-9 and np.isfinite(switching(0.0, 0.0)), (
        "Without a layer it is the sign itself; do not divide by zero."
    )


def check_reaches(command, points=2):
    """The error vanishes."""
    x, v, _ = fly(command, 0.02)
    assert abs(x[-1]) < 1.0, "The error grows without end: the command must drive s towards zero from either side."
    assert abs(x[-1]) < 0.02, f"After 8 s the error is still {x[-1]:.2f} m."
    late = np.searchsorted(np.arange(len(x)) * DT, 3.0)
    assert np.max(np.abs(v[late:] + 2.0 * x[late:])) < 0.05, (
        "It arrives, but not along the surface: does the command also cancel the slope times the speed?"
    )


def check_reaching_time(command, points=1):
    """It reaches the surface within |s|/gain."""
    x, v, _ = fly(command, 1e-3, gain=2.0)
    first = np.flatnonzero(np.abs(v + 2.0 * x) < 0.01)
    reached = first[0] * DT if len(first) else np.inf
    assert abs(reached - 1.0) < 0.05, (
        f"s begins at 2 m/s and falls by the gain, 2 m/s²: the surface must be reached after 1 s, not {reached:.2f} s. "
        "Does the command cancel the slope times the speed, and nothing else?"
    )


def check_disturbance(command, points=1):
    """A disturbance below the gain leaves the error that the layer predicts."""
    x, _, _ = fly(command, 0.2, disturbance=0.8)
    assert abs(x[-1] - 0.04) < 0.004, (
        f"A steady 0.8 m/s² must be held off at s = 0.2 · 0.8/2, an error of 40 mm; yours is {1e3 * x[-1]:.0f} mm."
    )


def check_least_gain(least_gain, points=1):
    """The least gain that holds off a disturbance."""
    assert abs(least_gain(0.8, 0.0) - 0.8) < 1e-9, "Without a demand on time, the gain must equal the disturbance."
    assert abs(least_gain(0.8, 0.5) - 1.3) < 1e-9, (
        f"s must fall by 0.5 m/s² although 0.8 m/s² push against it: 1.3, not {least_gain(0.8, 0.5):.2f}."
    )


def check_chattering(changes_per_second, command, points=2):
    """Chattering is counted, and the layer ends it."""
    square = np.sign(np.sin(2.0 * np.pi * 5.0 * (np.arange(2000) + 0.5) * DT))
    counted = changes_per_second(square, DT)
    assert abs(counted - 10.0) < 0.6, f"A square wave of 5 Hz changes its sign 10 times a second, not {counted:.1f}."
    assert changes_per_second(np.ones(100), DT) == 0, "A constant does not change its sign."
    hard, soft = (changes_per_second(fly(command, layer, lag=0.02)[2][4000:], DT) for layer in (0.0, 0.4))
    assert hard > 5.0, (
        f"Without a layer, behind rotors of 20 ms, the command must chatter; {hard:.1f} changes a second."
    )
    assert soft < 1.0, f"With a layer of 0.4 m/s it must not; {soft:.1f} changes a second."
