"""Fly `iris` on beams that bend, and print what each mode does to its thrusts: docs/how-to/beam-that-bends.md.

Each beam is 2 m long and has the mass of its material.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

import tandemlift as tl
from tandemlift.core.errors import FlightWarning
from tandemlift.flight import Flight
from tandemlift.missions import Mission

BEAMS: dict[str, dict[str, Any]] = {
    "rigid, 0.5 kg": {},
    "CFRP tube 30 × 1 mm": {"material": "cfrp", "section": "tube", "radius": 0.015, "wall": 0.001},
    "aluminium tube 25 × 1 mm": {"material": "aluminium", "section": "tube", "radius": 0.0125, "wall": 0.001},
    "CFRP tube 16 × 1 mm": {"material": "cfrp", "section": "tube", "radius": 0.008, "wall": 0.001},
    "pine rod 22 mm": {"material": "pine", "radius": 0.011},
    "PVC tube 32 × 1.8 mm": {"material": "pvc", "section": "tube", "radius": 0.016, "wall": 0.0018},
}
HOVER = {"pushes": [], "mission.duration": 30.0, "phases.land_start": None}
CALM = 12.0  # s, from which it hovers


def mission_of(beam: dict[str, Any]) -> Mission:
    """`iris`, hovering, with a beam."""
    payload = {f"vehicle.payload.{name}": value for name, value in beam.items()}
    return tl.load_mission("iris", {**HOVER, **({"vehicle.payload.mass": None, **payload} if beam else {})})


def row(name: str, mission: Mission) -> str:
    """A row of the table."""
    flight: Flight = tl.fly(mission)
    hovers = flight.time > CALM
    swing = float(flight["rotor_thrusts"][hovers].std(axis=0).mean())
    off = 1e3 * float(np.sqrt(np.mean(np.square(flight["position_error"][hovers, 2]))))
    found = ", ".join(dict.fromkeys(f.kind for f in flight.findings)) or "none"
    bends = [mode.frequency for mode in mission.structure_modes if "up and down" in mode.shape]
    driven = [r.subject.partition(":")[0] for r in tl.check(mission) if r.check == "structure" and r.verdict == "fails"]
    lowest = f"{bends[0]:.3g}" if bends else "–"
    return f"| {name} | {lowest} | {'; '.join(driven) or '–'} | {swing:.2f} | {off:.3g} | {found} |"


def main() -> None:
    """Print the table."""
    warnings.simplefilter("ignore", FlightWarning)
    print(
        "| beam | bends up and down, rad/s | `check`: driven | thrust, standard deviation, N | z, RMS, mm | findings |"
    )
    print("|---|---:|---|---:|---:|---|")
    for name, beam in BEAMS.items():
        print(row(name, mission_of(beam)), flush=True)


if __name__ == "__main__":
    main()
