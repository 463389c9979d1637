"""Checks of exercise 2. A failed assertion says what to look at."""

import numpy as np

W = np.geomspace(1e-2, 1e3, 4001)  # rad/s
S = 1j * W
INTEGRATOR = 4.0 / S
PLANT = 10.0 / (S * (S + 1.0) * (0.05 * S + 1.0))
RESONANT = 0.25 / (S * (10.0 * S + 1.0)) + 15.0 * S / (S**2 + 0.4 * S + 100.0)  # crosses 1 three times


def check_one_crossover(crossovers, points=1):
    """The crossover of an integrator."""
    found = np.atleast_1d(crossovers(W, INTEGRATOR))
    assert len(found) == 1, f"|4/s| is 1 at one frequency only; you found {len(found)}."
    assert abs(found[0] - 4.0) < 0.02, (
        f"|4/s| is 1 at 4 rad/s, you found {found[0]:.3f}. Is it in rad/s, and where |L| is 1 (not 0.7, not 1 dB)?"
    )


def check_all_crossovers(crossovers, points=2):
    """All crossovers of a loop with a resonance."""
    found = np.sort(np.atleast_1d(crossovers(W, RESONANT)))
    true = W[np.flatnonzero(np.diff(np.sign(np.abs(RESONANT) - 1.0)))]
    assert len(found) == len(true), (
        f"This loop crosses 1 at {len(true)} frequencies, downwards and upwards; you found {len(found)}."
    )
    assert np.allclose(found, true, rtol=0.01), (
        f"They are near {np.round(true, 2).tolist()} rad/s, not {found.tolist()}."
    )


def check_phase_margin(phase_margin, points=2):
    """The phase margin of loops whose margin is known."""
    margin = phase_margin(W, INTEGRATOR)
    assert abs(margin - 90.0) < 0.1, (
        f"An integrator has 90°, you found {margin:.2f}. Is it in degrees, and from -180°, where the loop turns over?"
    )
    crossing = np.interp(0.0, -np.log(np.abs(PLANT)), W)
    true = 180.0 - 90.0 - np.degrees(np.arctan(crossing)) - np.degrees(np.arctan(0.05 * crossing))
    assert abs(phase_margin(W, PLANT) - true) < 0.3, (
        f"10/(s (s + 1)(0.05 s + 1)) has {true:.1f}°, you found {phase_margin(W, PLANT):.1f}°."
    )


def check_wrapped_phase(phase_margin, with_delay, points=1):
    """A loop beyond its limit has a negative margin."""
    margin = phase_margin(W, with_delay(W, INTEGRATOR, 0.5))
    assert abs(margin - (90.0 - np.degrees(2.0))) < 0.3, (
        f"4/s with 0.5 s of delay has {90.0 - np.degrees(2.0):.1f}°, you found {margin:.1f}°. An angle beyond -180° "
        "comes back as +179°: bring the margin into -180° to 180°."
    )


def check_delay_is_no_gain(with_delay, points=1):
    """A delay turns the response, and leaves its magnitude."""
    late = with_delay(W, INTEGRATOR, 0.1)
    assert np.allclose(np.abs(late), np.abs(INTEGRATOR)), "|exp(-jωT)| is 1: a delay changes no magnitude."
    turned = np.angle(late / INTEGRATOR)[np.searchsorted(W, 4.0)]
    assert abs(turned + 0.4) < 0.01, f"At 4 rad/s, 0.1 s turn the response by -0.4 rad; yours by {turned:.2f}."


def check_longest_delay(longest_delay, points=2):
    """The longest delay is the smallest over all crossovers."""
    found = longest_delay(W, INTEGRATOR)
    assert abs(found - np.pi / 8.0) < 0.003, (
        f"4/s bears π/8 = 0.393 s, you found {found:.4f}. The margin in rad over the crossover in rad/s is in s."
    )
    cross = W[np.flatnonzero(np.diff(np.sign(np.abs(RESONANT) - 1.0)))]
    phases = np.interp(cross, W, np.unwrap(np.angle(RESONANT)))
    true = np.min(((np.pi + phases) % (2.0 * np.pi)) / cross)
    assert abs(longest_delay(W, RESONANT) - true) < 0.03 * true, (
        f"The loop with the resonance bears {true:.3f} s, not {longest_delay(W, RESONANT):.3f}: its fastest crossover "
        "has the larger margin, but turns by more with each second."
    )


def check_flown(longest_delay, points=1):
    """The loop oscillates beyond your limit, and settles within it."""
    limit = float(longest_delay(W, PLANT))
    assert 0.0 < limit < 1.0, f"{limit:.3f} s is no delay that 10/(s (s + 1)(0.05 s + 1)) could bear."
    early, late = (_swing(share * limit) for share in (0.9, 1.1))
    assert early < 0.5, f"With {0.9 * limit:.4f} s, nine tenths of your limit, the loop already oscillates."
    assert late > 2.0, f"With {1.1 * limit:.4f} s, beyond your limit, the loop still settles."


def _swing(delay):
    """The largest error in the last fifth of 60 s over that in the first, of PLANT in closed loop with a delay."""
    dt, x, error = 1e-3, np.zeros(3), []
    late = [0.0] * max(round(delay / dt), 1)
    for i in range(60_000):
        late.append((1.0 if i < 100 else 0.0) - x[0])
        x += dt * np.array([x[1], x[2] - x[1], (10.0 * late[i] - x[2]) / 0.05])
        error.append(abs(x[0]))
        if error[-1] > 1e3:
            return np.inf
    return max(error[-12_000:]) / max(error[:12_000])
