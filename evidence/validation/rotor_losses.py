"""Rows about rotor-loss detection and emergency landing.

The flights have the paper's pushes and a tilted start in the air above a floor. One of the eight rotors stops at a
random time, in calm air and in wind. In further flights no rotor stops, and none may be reported: in wind, 0.3 kg too
heavy, with a rotor lag of 50 ms, a delay of 20 ms, and an inertia of 0.8 or 1.2 times the assumed one.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tandemlift.flight.record import Flight
from tandemlift.missions import Mission
from validation.rows import Row, below
from validation.scenarios import STEADY, TURBULENCE, Bench, Changes, mission, wind

FLOOR, DROP = -0.5, 0.36  # m, height of the floor, and of the landing below the start
TRIAL: Changes = {
    "mission.log_interval": 0.004,
    "initial.position": [0.3, -0.3, 0.0],
    "initial.euler": [0.15, -0.15, 0.2],
    "ground.model": "floor",
    "ground.height": FLOOR,
    "compliance.touchdown_depth": DROP,
    "detection.model": "residual",
}
CALM, WIND = "calm", "wind"
NEVER = 1e6  # s
FIRST, LAST = 3.0, 70.0  # s, range of the time of a loss; before, the tilted start makes the residual unusable
TARGETS = {CALM: (0.5, 8.0, 1.5), WIND: (1.0, 15.0, 1.5)}  # m/s, °, m
SLOW: Changes = {"lag_up": 0.05, "lag_down": 0.05}


def air(kind: str, fleet: Changes | None = None) -> Changes:
    """Calm air, or 3 N along x and y with gusts of 1 N rms, on the quadrotors."""
    return wind([STEADY, STEADY, 0.0], TURBULENCE, fleet) if kind == WIND else wind([0.0] * 3, 1e-6, fleet)


def fault(rotor: int, time: float) -> Changes:
    """The fault of a rotor, numbered from 0, that stops at a time [s]."""
    return {"faults": [{"quadrotor": rotor // 4 + 1, "rotor": rotor % 4 + 1, "time": time}]}


def lost(kind: str, count: int) -> Iterator[tuple[int, float, Mission]]:
    """(Rotor from 0, time [s], mission) of flights with a rotor loss, each rotor equally often."""
    chance = np.random.default_rng(0)
    for i in range(count):
        time = round(float(chance.uniform(FIRST, LAST)), 3)
        yield i % 8, time, mission({**TRIAL, **air(kind), **fault(i % 8, time), "mission.seed": i})


def intact(count: int) -> Iterator[Mission]:
    """Flights without a rotor loss, of a vehicle that differs from the pilot's model."""
    for i in range(count):
        wrong = {"actuators.delay": 0.02, "plant.mass_scale": 3.8 / 3.5, "plant.inertia_scale": (0.8, 1.2)[i % 2]}
        yield mission({**TRIAL, **air(WIND, SLOW), **fault(0, NEVER), **wrong, "mission.seed": 1000 + i})


def outcome_of(flight: Flight, rotor: int, time: float) -> dict[str, Any]:
    """The outcome of a flight with a rotor loss at a time [s]."""
    m = flight.metrics()
    after = np.flatnonzero(flight.time >= time)
    touched = after[np.abs(flight["contact_force"][after, 2]) > 0.0]
    found = flight["failed_rotor"][-1] == rotor + 1
    row = {
        "found": m["rotor_failure_detection_delay_s"] if found else None,
        "landed": bool(flight.ending is None and len(touched) and flight["phase"][-1] == 0.0),
    }
    if not row["landed"]:
        return row
    way = slice(after[0], touched[0] + 1)
    away = np.hypot(*(flight["position"][way, :2] - flight["position"][after[0], :2]).T)
    tilt = np.hypot(*flight["euler"][touched[0] - 1, :2])
    worst = [-flight["velocity"][touched[0] - 1, 2], np.degrees(tilt), away.max()]
    return row | {"worst": [float(w) for w in worst]}


def rows_of(kind: str, outcomes: list[dict[str, Any]]) -> Iterator[Row]:
    """The rows of one kind of air."""
    down = [o["worst"] for o in outcomes if o["landed"]]
    found = [o["found"] for o in outcomes if o["found"] is not None]
    count = len(outcomes)
    yield Row(f"rotor lost, {kind}: landed", f"{count} of {count}", f"{len(down)} of {count}", len(down) == count)
    worst = np.array(down).max(axis=0)
    limits = TARGETS[kind]
    said = "{:.2f} m/s, {:.1f}°, {:.2f} m"
    within = bool(np.all(worst <= np.array(limits)))
    yield Row(
        "the same: largest touch-down speed, tilt, distance",
        "≤ {:g} m/s, {:g}°, {:g} m".format(*limits),
        said.format(*worst),
        within,
    )
    yield Row(
        "the same: correct rotor identified", f"{count} of {count}", f"{len(found)} of {count}", len(found) == count
    )
    times = 1e3 * np.array(found)
    yield below(
        "the same: detection time, median / 95 % / max", np.quantile(times, [0.5, 0.95, 1.0]), [100.0] * 3, "ms", 0
    )


def losses(bench: Bench) -> Iterator[Row]:
    """Rows about flights with a rotor loss, and without."""
    for kind in (CALM, WIND):
        drawn = list(lost(kind, bench.draws))
        flights = bench.fly(m for *_, m in drawn)
        yield from rows_of(kind, [outcome_of(f, r, t) for f, (r, t, _) in zip(flights, drawn, strict=True)])
    count = max(1, bench.draws // 2)
    alarms = sum(m["rotor_failure_detections"] > 0.0 for m in bench.metrics(intact(count)))
    yield Row(f"no rotor lost, {count} flights: false alarms", "0", str(alarms), alarms == 0)
