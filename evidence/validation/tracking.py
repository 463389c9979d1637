"""Rows about tracking of the reference."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tandemlift.flight.record import LATE, Flight
from validation.rows import Row, below, errors, rms, triple, true_yielding
from validation.scenarios import SLOW, WINDY, Bench, Changes, drawn, mission

HEAVIER = 0.3  # kg
ASIDE = 0.1  # m, of the payload's centre of mass


def nominal(bench: Bench) -> Iterator[Row]:
    """Rows about calm air, wind, model errors, slow rotors."""
    calm, real, wind, slow, heavy, aside = bench.fly(
        [
            mission(),
            mission({"pilot.state": "estimate"}, base={}),
            mission(WINDY),
            mission(SLOW),
            mission({"plant.mass_scale": 1.0 + HEAVIER / 3.5}),
            mission({"disturbance.moment": [0.5 * 9.81 * ASIDE, 0.0, 0.0]}),
        ]
    )
    yield below("calm: RMSE x / y / z against the pilot's reference", rms(errors(calm)), (4.0, 4.0, 1.0), "mm", 2)
    yield below(
        "calm: x / y against the unfiltered admittance of the true push", admittance_error(calm), (28.0, 25.0), "mm"
    )
    yield real_row(real)
    yield below("3 + 3 N of wind, gusts of 1 N rms: RMSE x / y / z", rms(errors(wind)), (18.0, 18.0, 2.0), "mm", 2)
    yield below("the same: mean offset", np.abs(errors(wind).mean(axis=0)), (3.0, 3.0, 3.0), "mm", 2)
    yield below("rotor lag 50 ms, delay 20 ms: RMSE x / y / z", rms(errors(slow)), (5.0, 5.0, 1.0), "mm", 2)
    yield from model_error(heavy, f"payload {HEAVIER} kg heavier than assumed")
    mass = heavy["payload_mass_estimate"][-1]
    yield below("the same: error of the estimated mass", abs(mass / (0.5 + HEAVIER) - 1.0) * 100.0, 2.0, "%", 2)
    yield from model_error(aside, f"payload's centre of mass off by {ASIDE} m")
    yield from saturated(real, calm, wind)


def admittance_error(flight: Flight) -> np.ndarray:
    """RMS distance [mm] from an unfiltered admittance under the true push, x and y."""
    part = flight.time > LATE
    return 1000.0 * rms((true_yielding(flight) - flight["position"])[part])[:2]


def real_row(flight: Flight) -> Row:
    """Mission iris unchanged: biases, drift, misalignment, its own state estimate, from the floor and back."""
    lifted, landing = flight.mission["phases"]["lift_start"], flight.mission["phases"]["land_start"]
    values = rms(errors(flight, max(LATE, lifted), landing))
    return below(
        "`iris` unchanged: from the floor, with sensor biases and its own state estimate",
        values,
        (4.0, 4.0, 1.0),
        "mm",
        2,
    )


def model_error(flight: Flight, what: str) -> Iterator[Row]:
    """The error of the height from five seconds after the lift on."""
    p = flight.mission["phases"]
    off = np.abs(errors(flight, p["lift_start"] + p["lift_duration"] + 5.0, p["land_start"])[:, 2])
    yield below(f"{what}: largest z error from 5 s after the lift", off.max(), 3.0, "mm", 2)


def saturated(real: Flight, calm: Flight, wind: Flight) -> Iterator[Row]:
    """Rows about steps with a rotor at its limit."""
    names = ("`iris` unchanged", "calm, from the tilted start", "wind, from the tilted start")
    for flight, name, limit in zip((real, calm, wind), names, (0.1, 0.1, 2.0), strict=True):
        share = 100.0 * flight.metrics()["rotor_saturated_share"]
        yield below(f"steps with a saturated rotor, {name}", share, limit, "%", 3)


def observers(bench: Bench) -> Iterator[Row]:
    """Rows that compare the observers: RMSE x / y / z, all else equal."""
    kinds = ("none", "extended-state", "super-twisting")
    places: tuple[tuple[str, Changes], ...] = (("calm", {}), ("wind", WINDY), ("slow rotors", SLOW))
    missions = [mission({**changes, "observer.model": kind}) for kind in kinds for _, changes in places]
    flights = iter(bench.fly(missions))
    for kind in kinds:
        said = [f"{triple(rms(errors(next(flights))))} ({where})" for where, _ in places]
        yield Row(f"observer `{kind}`: RMSE x / y / z [mm]", "", "; ".join(said), None)


def draws(bench: Bench) -> Iterator[Row]:
    """Rows about random missions with all deviations together."""
    rng = np.random.default_rng(4)
    flights = bench.fly([drawn(rng, number) for number in range(bench.draws)])
    failed = sum(flight.ending is not None for flight in flights)
    values = np.array([rms(errors(flight)) for flight in flights if flight.ending is None])
    what = f"{bench.draws} random draws of all deviations together: failures"
    yield Row(what, "0", str(failed), failed == 0)
    yield below("the same: worst RMSE x / y / z", values.max(axis=0), (25.0, 25.0, 3.0), "mm")
    yield Row(
        "the same: median RMSE x / y / z", "", f"{' / '.join(f'{v:.1f}' for v in np.median(values, axis=0))} mm", None
    )
