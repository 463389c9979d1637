"""A rotor is lost at any moment, found, and landed with: `python benchmarks/rotor_loss.py [--json FILE] [--flights N]`.

The paper's pushes on IRIS rotors, guided by hand, from a start tilted in the air. Any of the eight rotors stops at a
random moment, in calm air and in a wind of 3 N along x and y with gusts of 1 N rms, which acts on the quadrotors and is
no push. Then flights in which none stops, in that wind, 0.3 kg too heavy, with rotors that lag by 50 ms, a delay of
20 ms, and an inertia of 0.8 or 1.2 times what is believed: nothing is to be found. All of it is one compiled loop.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from typing import Any

import numpy as np
from machine import describe, heading, number, save, table

import tandemlift as tl

FLOOR, DROP = -0.5, 0.36  # m: low enough for a start that is tilted; how far below the start the landing ends
TRIAL: dict[str, Any] = {
    "mission.log_interval": 0.004,
    "initial": {"position": [0.3, -0.3, 0.0], "euler": [0.15, -0.15, 0.2]},
    "ground": {"height": FLOOR, "effect": False},
    "actuators.start": "hover",
    "phases.rotors": "always",
    "sensors.joints": {"force_bias": 0.0, "force_drift": 0.0, "torque_bias": 0.0, "misalignment": 0.0},
    "sensors.accelerometer": {"bias": 0.0, "drift": 0.0},
    "sensors.gyroscope": {"noise": 0.01, "bias": 0.0, "drift": 0.0},
    "sensors.motion.interval": 0.0,
    "pilot": {"guidance": "hand", "state": "measurement", "push": "measurement"},
    "controller.max_tilt": 0.5,
    "compliance.press": DROP,
    "observer.model": "super-twisting",
    "detection.model": "residual",
    "vehicle.payload.drag_area": [0.0, 0.0, 0.0],
    "vehicle.quadrotors.0.drag_area": [0.1, 0.1, 0.05],
    "vehicle.quadrotors.1.drag_area": [0.1, 0.1, 0.05],
}
WINDS = {
    "calm": {"wind.model": "air", "wind.turbulence": 1e-6},
    "wind": {"wind.model": "air", "wind.velocity": [4.16, 4.16, 0.0], "wind.turbulence": 4.0},
}
SLOW = {f"vehicle.quadrotors.{i}.lag_{way}": 0.05 for i in (0, 1) for way in ("up", "down")}
UNKNOWN = {**SLOW, "actuators.delay": 0.02, "plant.mass_scale": 3.8 / 3.5}
NEVER = 1e6  # s
FIRST, LAST = 3.0, 70.0  # s, when a rotor may be lost: before, the tilted start makes the residual unusable
AFTER = 20.0  # s, from the loss to the end


def fault(rotor: int, time: float) -> dict[str, Any]:
    return {"faults": [{"quadrotor": rotor // 4 + 1, "rotor": rotor % 4 + 1, "time": time}]}


def losses(wind: str, count: int) -> Iterator[tuple[int, float, tl.Mission]]:
    """(Rotor from 0, time [s], mission) of flights in which a rotor is lost, each rotor as often as the others."""
    chance = np.random.default_rng(0)
    for i in range(count):
        time = round(float(chance.uniform(FIRST, LAST)), 3)
        changes = {**TRIAL, **WINDS[wind], **fault(i % 8, time), "mission.seed": i}
        yield i % 8, time, tl.load_mission("iris", changes)


def sound(count: int) -> Iterator[tl.Mission]:
    """Flights in which no rotor is lost, of a vehicle that is not as believed."""
    for i in range(count):
        wrong = {**UNKNOWN, "plant.inertia_scale": (0.8, 1.2)[i % 2]}
        changes = {**TRIAL, **WINDS["wind"], **fault(0, NEVER), **wrong, "mission.seed": 1000 + i}
        yield tl.load_mission("iris", changes)


def landed(flight: tl.Flight, rotor: int, time: float) -> dict[str, Any]:
    """What became of a flight in which a rotor was lost at a time [s]."""
    m = flight.metrics()
    after = np.flatnonzero(flight.time >= time)
    touched = after[np.abs(flight["contact_force"][after, 2]) > 0.0]
    found = flight["rotor_lost"][-1] == rotor + 1
    row = {
        "found_s": m["rotor_loss_found_after_s"] if found else None,
        "named": m["rotors_taken_for_lost"],
        "landed": bool(flight.divergence is None and len(touched) and flight["phase"][-1] == 0.0),
    }
    if not row["landed"]:
        return row
    way = slice(after[0], touched[0] + 1)
    away = np.hypot(*(flight["position"][way, :2] - flight["position"][after[0], :2]).T)
    tilt = np.hypot(*flight["euler"][touched[0] - 1, :2])
    yaw = np.unwrap(flight["euler"][way, 2])
    return row | {
        "sink_m_s": float(-flight["velocity"][touched[0] - 1, 2]),
        "tilt_deg": float(np.degrees(tilt)),
        "away_m": float(away.max()),
        "turned_deg": float(np.degrees(np.abs(yaw - yaw[0]).max())),
    }


def flown(missions: list[Any], size: int = 8) -> Iterator[Any]:
    for i in range(0, len(missions), size):
        yield from tl.fly_many(missions[i : i + size])


def lost(wind: str, count: int) -> list[dict[str, Any]]:
    drawn = list(losses(wind, count))
    flights = flown([mission for *_, mission in drawn])
    return [
        landed(f, rotor, time) | {"rotor": rotor + 1, "time": time}
        for f, (rotor, time, _) in zip(flights, drawn, strict=True)
    ]


def summary(rows: list[dict[str, Any]]) -> list[str]:
    """A line of the table: found, rightly at once, when; landed; worst of sink, tilt, way."""
    found = [r["found_s"] for r in rows if r["found_s"] is not None]
    down = [r for r in rows if r["landed"]]
    worst = [number(max(r[key] for r in down)) for key in ("sink_m_s", "tilt_deg", "away_m", "turned_deg")]
    once = sum(r["named"] == 1.0 for r in rows if r["found_s"] is not None)
    times = [number(1e3 * v) for v in (np.median(found), np.quantile(found, 0.95), max(found))]
    return [f"{len(found)} of {len(rows)}", str(once), *times, str(len(down)), *worst]


HEADER = ["air", "found", "named once", "ms, median", "95 %", "most", "landed", "m/s", "tilt °", "away m", "turned °"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", metavar="FILE", help="write the results to this file too")
    parser.add_argument("--flights", type=int, default=200, help="flights with a loss, in each wind")
    parser.add_argument("--sound", type=int, default=100, help="flights without")
    options = parser.parse_args()
    about = describe(("tandemlift", "numba", "numpy"))
    rows = {wind: lost(wind, options.flights) for wind in WINDS}
    alarms = [m["rotors_taken_for_lost"] for m in tl.fly_many(sound(options.sound), keep="metrics")]
    print(heading(about), "\n")
    print(table(HEADER, [[wind, *summary(r)] for wind, r in rows.items()]))
    print(f"\nNo rotor lost: one was named in {sum(a > 0.0 for a in alarms)} of {len(alarms)} flights.")
    save(options.json, {"machine": about, "lost": rows, "alarms": alarms})


if __name__ == "__main__":
    main()
