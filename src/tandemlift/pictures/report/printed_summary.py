"""A flight in a few lines."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tandemlift.core.types import Array
from tandemlift.flight.channels import FLOWN
from tandemlift.flight.record import Flight, counted_until

NOT_KNOWN = "   not known"


def summary_lines(flight: Flight) -> Iterator[str]:
    """The outcome of a flight, its main metrics and its events."""
    m = flight.metrics()
    late = "_after_10s" if m["position_rmse_after_10s_m"] else ""
    when = "after 10 s" if late else "whole flight" if counted_until(flight) is None else "until crash"
    rows = [
        ("final position", _list(m["final_position_m"], 3), "m"),
        ("final reference", _list(m["final_reference_m"], 3), "m"),
        (f"position RMSE, {when}", _list(m[f"position_rmse{late}_m"], 2, 1e3), "mm"),
        (f"largest position error, {when}", _list(m[f"position_max_error{late}_m"], 2, 1e3), "mm"),
        ("attitude RMSE", _list(m["attitude_rmse_rad"], 2, 57.29577951308232), "deg"),
        (
            "commanded thrust after 10 s",
            _list([m["thrust_min_after_10s_n"], m["thrust_max_after_10s_n"]], 2),
            "N (min, max)",
        ),
        ("largest thrust", _largest_thrust(flight), ""),
        ("human work", *((NOT_KNOWN, "") if m["human_work_j"] is None else (_list([m["human_work_j"]], 2), "J"))),
    ]
    yield f"{flight.name}: {flight.outcome}; {m['steps']} steps, flown in {m['wall_s'] * 1e3:.1f} ms"
    if FLOWN in flight:
        commands = flight["rotor_commands" if "rotor_commands" in flight else "rotor_thrusts"]
        if "push_estimate" in flight:
            rows.append(
                ("largest push felt", _list([float((flight["push_estimate"] ** 2).sum(axis=1).max() ** 0.5)], 2), "N")
            )
        rows.append(("commands beside the flown, RMS", _list([_rms(commands - flight[FLOWN])], 3), "N"))
    for label, value, unit in rows:
        if value:
            yield f"  {label:36}{value} {unit}".rstrip()
    for at, what in m["events"]:
        yield f"  {at:.2f} s: {what}"
    for note in notes(flight):
        yield f"  note: {note}"


def notes(flight: Flight) -> Iterator[str]:
    """What a reader should know of a flight that is no finding: thrusts of ideal actuators that no rotor gives."""
    thrusts, most = _thrusts_and_limits(flight, "ideal")
    beyond = ((thrusts < 0.0) | (thrusts > most)).any(axis=1)
    if beyond.any():
        ends = float(np.nanmin(thrusts)), float(np.nanmax(thrusts))
        low, high = ((f"{x:+,.0f}" if abs(x) > 100.0 else f"{x:+.3g}").replace("-", "−") for x in ends)
        give = " or ".join(f"{x:.3g}" for x in sorted(set(most.tolist())))
        yield (
            f"ideal actuators: beyond what these quadrotors give (0 to {give} N a rotor), from {low} to {high} N, "
            f"in {_percent(beyond.mean())} of the logged samples"
        )


def _thrusts_and_limits(flight: Flight, model: str) -> tuple[Array, Array]:
    """The logged thrusts (T, R) and largest ones (R) [N] of rotors of a model; no samples, if the flight has others."""
    if "rotor_thrusts" in flight and "vehicle" in flight.mission and flight.mission["actuators"]["model"] == model:
        thrusts, most = flight["rotor_thrusts"], np.repeat(list(_thrust_limits(flight)), 4)
        if thrusts.shape[-1] == len(most) and np.isfinite(thrusts).any():
            return thrusts, most
    return np.empty((0, 1)), np.ones(1)


def _thrust_limits(flight: Flight) -> Iterator[float]:
    """The largest thrust of a rotor of each quadrotor [N], as of its table in the mission."""
    tables = flight.mission["vehicle"].get("quadrotors", [{}])
    if all({"thrust_constant", "max_speed"} <= table.keys() for table in tables):  # resolved: needs no table's class
        yield from (table["thrust_constant"] * table["max_speed"] ** 2 for table in tables)
    else:
        yield from (q.thrust_limit for q in flight.vehicle.quadrotors)


def _largest_thrust(flight: Flight) -> str:
    """The largest thrust of a rotor beside its limit; "" of a flight without vehicle, or of ideal rotors."""
    thrusts, most = _thrusts_and_limits(flight, "rotors")
    if not len(thrusts):
        return ""
    largest = np.nanmax(thrusts, axis=0)
    k = int(np.argmax(largest / most))
    over = largest[k] > most[k] * 1.001 and flight.mission["ground"]["effect"]  # a limit is of thrust in free air
    why = " in free air; more by ground effect" if over else ""
    share = f"{largest[k]:8.2f} N of {most[k]:.2f} N{why} ({largest[k] / most[k]:.0%})"
    return f"{share}, rotor {k % 4 + 1} of quadrotor {k // 4 + 1}"


def _percent(share: float) -> str:
    return "less than 0.1 %" if share < 1e-3 else f"{100.0 * share:.3g} %"


def _rms(values: Array) -> float:
    return float((values**2).mean() ** 0.5)


def _list(values: list[float | None] | None, digits: int, scale: float = 1.0) -> str:
    """Numbers side by side; '' if there are none."""
    if not values or any(v is None for v in values):
        return ""
    return "  ".join(f"{round(v * scale, digits) + 0.0:8.{digits}f}" for v in values if v is not None)
