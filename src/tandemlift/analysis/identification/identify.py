"""`tl.identify`: the numbers of a vehicle from its logs, by output error over windows."""

from __future__ import annotations

import re
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tandemlift.analysis.identification.equations import Equations, NormalEquations
from tandemlift.analysis.identification.fit import VehicleSearch
from tandemlift.analysis.identification.identification import Identification, Row, rows_of, with_values
from tandemlift.analysis.identification.judgement import (
    Covariance,
    Whiteness,
    assumptions_of,
    correlations_of,
    covariance_of,
    data_information,
    misfit_by_window,
    remarks_on,
    whiteness,
)
from tandemlift.analysis.identification.prediction import Predictor
from tandemlift.analysis.identification.sensor_errors import at_place, sensor_priors
from tandemlift.analysis.identification.vehicle_unknowns import (
    AXES,
    DEFAULT,
    INERTIAS,
    Unknowns,
    driven_numbers,
    unknowns_of,
)
from tandemlift.analysis.identification.windows import FEWEST, LENGTH, FlightWindows, windows_of
from tandemlift.analysis.logs.log import IMU, Log, log_of
from tandemlift.core.errors import InputError, without_flight_warnings
from tandemlift.core.progress import progress_or_own
from tandemlift.core.types import Array, Progress, flat
from tandemlift.engines.driven_vehicle import whole_vehicle
from tandemlift.flight.record import Flight
from tandemlift.missions import Mission, MissionLike, VehicleTable, mission_of

HELD_BACK = 0.15  # of the windows
SHOWN = 100  # blocks of the example
OF_BODIES = tuple(f"vehicle.payload.{name}" for name in ("mass", "center_of_mass", "inertia", "products"))
IMPOSSIBLE = 10.0  # times the white noise of samples: residuals that are refused


def identify(
    logs: Log | Flight | Iterable[Log | Flight],
    mission: MissionLike,
    *,
    parameters: Sequence[str] | None = None,
    weighed: Mapping[str, float] | None = None,
    window: float = LENGTH,
    held_back: float = HELD_BACK,
    predict: Log | Flight | None = None,
    progress: Progress | None = None,
) -> Identification:
    """Identify a vehicle from logs of its flights.

    Body, rotors and sensors of the mission are driven by the logged commands, in windows whose starts are unknown, too.
    No pilot is simulated. Pushes that a force gauge logged count as known; windows under others, and in contact, are
    left out. Noise levels follow from the residuals.

    Args:
        logs: one or several, from `read_log`, or flights with sensors.
        mission: of about such a vehicle: from `load_mission`, or its name or path.
        parameters: keys to estimate, of `vehicle_unknowns.KINDS` beside this module; all by default, of areas only
            where the mission's wind is "air" and none is 0.
        weighed: masses [kg] from a scale, right within 0.1 %, by key. Without joint sensors of known scale, or such a
            mass, only ratios of masses to thrust constants can be told.
        window: length of a window [s].
        held_back: part of the windows, the last ones, that is not used but predicted.
        predict: a log of another flight, which the identified mission predicts, window by window.
        progress: called with (steps done, steps in all).

    Returns:
        The estimates with intervals of 95 %, and what the logs could not tell.

    Raises:
        InputError: a log lacks a stream, is too short or not of such a vehicle; or a key cannot be estimated.
    """
    began, mission = time.perf_counter(), mission_of(mission)
    if mission.is_elastic:
        raise InputError(
            f"{mission.mission.name}: vehicle.payload must be rigid here, as every mount (no material, no "
            "bending_stiffness, no joint_stiffness): the body that predicts a log does not bend"
        )
    given = [logs] if isinstance(logs, (Log, Flight)) else list(logs)
    if not given:
        raise InputError("logs: must be one or more")
    if not (0.2 <= window <= 10.0 and 0.0 <= held_back <= 0.5):
        raise InputError(f"window = {window:g} s, held_back = {held_back:g}: must be 0.2 to 10 s, and 0 to 0.5")
    keys = _keys(mission, parameters)
    cut, other = (
        [windows_of(log_of(one) if isinstance(one, Flight) else one, mission, window) for one in logs]
        for logs in (given, [predict] if predict else [])
    )
    unknowns = unknowns_of(mission.vehicle, mission.actuators.delay, keys, weighed)
    _check_starts(unknowns, mission.mission.name)
    parts = [_split(w, held_back) for w in cut]
    streams = frozenset(name for w in cut for name in w.samples)
    place = next((w.place for w in cut if w.place is not None), None)
    priors = sensor_priors(mission.sensors, len(mission.vehicle.quadrotors), streams, place)
    search = VehicleSearch([Predictor(fitted, unknowns, mission) for fitted, _ in parts], unknowns, priors)
    found = _searched(search, [last for _, last in parts if last is not None], other, progress)
    return replace(found, details=_finite({**found.details, "seconds": time.perf_counter() - began}))


def _searched(
    search: VehicleSearch, held_back: list[FlightWindows], other: list[FlightWindows], progress: Progress | None
) -> Identification:
    """The end of a search, judged by the windows that were held back and those of another flight.

    Raises:
        InputError: no such vehicle explains the log.
    """
    predictor = search.parts[0].predictor
    mission, source = predictor.mission, predictor.windows.source
    try:
        with progress_or_own(f"{mission.mission.name}, identified", progress, "steps") as shown:
            equations, normal = search.run(shown)
        _check_structure(search, source)
        found = _judged(search, equations, normal, held_back, mission)
        vehicle = Unknowns(driven_numbers(found.mission.vehicle, found.mission.actuators.delay), ())
        found.details.update(predicted=_predicted(other, vehicle, search, None))
    except (np.linalg.LinAlgError, ArithmeticError):
        raise _no_such_vehicle(search, source, "the search leaves all numbers that a vehicle can have") from None
    if not all(np.isfinite([row.value, row.low, row.high]).all() for row in (*found.rows, *found.whole)):
        raise _no_such_vehicle(search, source, "some numbers of the vehicle are not finite")
    return found


def _keys(mission: Mission, parameters: Sequence[str] | None) -> list[str]:
    """The keys to estimate: those that are asked for, or all whose value the mission can have."""
    air = mission.wind.model == "air" and min(mission.vehicle.payload.areas) > 0.0
    keys = [key for key in DEFAULT if air or "area" not in key]
    keys = keys if parameters is None else list(parameters)
    if mission.vehicle.payload.shape == "bodies" and (own := [key for key in keys if key in OF_BODIES]):
        raise InputError(
            f'mission {mission.mission.name}: vehicle.payload.shape = "bodies" gives {", ".join(own)}, so that '
            'identified ones have no place: give inertia and products, with shape "beam", or "mesh" and its corners'
        )
    return keys


def _check_starts(unknowns: Unknowns, name: str) -> None:
    """Refuse a number that is estimated by its logarithm and starts from 0."""
    shared = [u for u in unknowns.unknowns if not u.weights]
    zero = [u.name for u in shared if u.positive and u.start == 0.0 and u.kind.field not in INERTIAS]
    if zero:
        raise InputError(
            f"mission {name}: {', '.join(zero)} = 0: must start above 0 to be estimated; set about what it may be, as "
            "0.02 s for a lag, or leave it out of parameters"
        )


def _judged(
    search: VehicleSearch,
    equations: list[Equations],
    normal: NormalEquations,
    held_back: list[FlightWindows],
    mission: Mission,
) -> Identification:
    """The estimate of a search, with what the data say of it."""
    unknowns, rows = search.unknowns, [one.rows for one in equations]
    streams = {
        name: np.concatenate([r[name][part.used] for part, r in zip(search.parts, rows, strict=True) if name in r])
        for name in search.estimate.noise
    }
    white = {name: whiteness(r) for name, r in streams.items()}
    covariance = covariance_of(search, equations, normal, {name: w.factor for name, w in white.items()})
    information = data_information(normal, len(unknowns))
    found, whole, values = _results(search, covariance, mission.vehicle)
    with without_flight_warnings():
        identified, refused = with_values(mission, values)
    keys = _with_derivatives(lambda x: _values(unknowns, x), search.estimate.q)
    correlations = correlations_of(keys, covariance.covariance)
    remarks = [f"{key} = {values[key]} is left as it was: {why}" for key, why in refused.items()]
    remarks += remarks_on(unknowns, correlations, information, white, found, search)
    vehicle = Unknowns(unknowns.numbers(search.estimate.q), ())
    held = _predicted(held_back, vehicle, search, search.estimate.fixed)
    details = _details(search, correlations, covariance, white, misfit_by_window(search, rows), held)
    written = reference_rows(identified)
    details |= {"example": _example(search), "refused": [*refused]}
    details |= {"written": {row.key: written.get(row.key, row.value) for row in found}}
    return Identification(identified, tuple(found), tuple(whole), tuple(remarks), details)


def _check_structure(search: VehicleSearch, source: str) -> None:
    """Refuse a mission with which no numbers explain how the vehicle turns."""
    times = search.estimate.noise["measured_rates"] / search.white["measured_rates"]
    if search.lost or times > IMPOSSIBLE:
        why = f"measured_rates differ from those of any such vehicle by more than {IMPOSSIBLE:g} times their noise"
        raise _no_such_vehicle(search, source, why)


def _no_such_vehicle(search: VehicleSearch, source: str, why: str) -> InputError:
    name = search.parts[0].predictor.mission.mission.name
    said = "it cannot be this vehicle; compare place, order and spin of rotors with the commands"
    return InputError(f"{source}: mission {name}: {why}: {said}")


def _finite(value: Any) -> Any:
    """Plain values in which what is no finite number is None, as JSON has no such numbers."""
    if isinstance(value, dict):
        return {key: _finite(own) for key, own in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(own) for own in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value


def _split(w: FlightWindows, held_back: float) -> tuple[FlightWindows, FlightWindows | None]:
    """(The windows that are used, those that are held back)."""
    count = len(w.first)
    last = min(round(held_back * count), count - FEWEST)
    if last <= 0:
        return w, None
    used = np.arange(count) < count - last
    return w.chosen(used), w.chosen(~used)


def _values(unknowns: Unknowns, q: Array) -> dict[str, tuple[Array, str]]:
    """The values of every key, with their unit."""
    n, found = unknowns.numbers(q), dict[str, tuple[Array, str]]()
    every = {**n.vehicle._asdict(), **n._asdict()}
    for u in unknowns.unknowns:
        value = every[u.kind.field]
        table = np.array(flat(value) if hasattr(value, "_fields") else value, float).reshape(u.kind.axes or 1, -1)
        for i in u.quadrotors or (0,):
            found[u.key.replace("*", str(i))] = table[:, i], u.kind.unit
    return found


def _with_derivatives(function: Any, q: Array) -> dict[str, tuple[Array, Array, str, Array]]:
    """Values of a function of coordinates by key: values, derivatives, unit, values at 0."""
    here, start, columns = function(q), function(np.zeros_like(q)), dict[str, list[Array]]()
    for i in range(len(q)):
        h = np.zeros_like(q)
        h[i] = 1e-5
        ahead, behind = function(q + h), function(q - h)
        for key in here:
            columns.setdefault(key, []).append((ahead[key][0] - behind[key][0]) / 2e-5)
    return {
        key: (value, np.array(columns[key]).T.reshape(len(value), -1), unit, start[key][0])
        for key, (value, unit) in here.items()
    }


def _results(
    search: VehicleSearch, covariance: Covariance, table: VehicleTable
) -> tuple[list[Row], list[Row], dict[str, list[float]]]:
    """(Rows of keys, rows of the whole vehicle, the values by key of each quadrotor)."""
    unknowns, q = search.unknowns, search.estimate.q
    matrices = covariance.covariance, covariance.bound, np.diag(unknowns.unweighed**2)

    def whole(x: Array) -> dict[str, tuple[Array, str]]:
        return whole_vehicle(table, unknowns.numbers(x).vehicle)

    off = {"actuators.delay": max(part.windows.stamp_offset for part in search.parts)}
    found = list(rows_of(_with_derivatives(lambda x: _values(unknowns, x), q), *matrices, off))
    changes = dict[str, list[float]]()
    for key, (values, _) in _values(unknowns, q).items():
        kept = np.maximum(values, 0.0) if "drag" in key or "delay" in key else values
        changes[key] = [float(f"{x:.7g}") for x in kept]
    return found, list(rows_of(_with_derivatives(whole, q), *matrices)), changes


def _predicted(
    windows: list[FlightWindows], vehicle: Unknowns, search: VehicleSearch, fixed: Array | None
) -> dict[str, Any]:
    """The errors of a vehicle's predictions of windows that were not used, by stream: root mean squares over the noise.

    Starts of the windows and biases are found; errors of sensors that stay, too, where `fixed` does not have them.
    """
    if not windows:
        return {}
    mission = search.parts[0].predictor.mission
    again = VehicleSearch([Predictor(w, vehicle, mission) for w in windows], vehicle, search.priors, fixed)
    again.estimate.noise = dict(search.estimate.noise)
    equations, _ = again.run(None, follow=False)
    by_window = misfit_by_window(again, [one.rows for one in equations])
    ratios = {name: float(np.sqrt(np.nanmean(np.square([size for _, size in own])))) for name, own in by_window.items()}
    return {"ratio": ratios, "windows": by_window}


def _details(
    search: VehicleSearch,
    correlations: Array,
    covariance: Covariance,
    white: Mapping[str, Whiteness],
    misfit: Mapping[str, Any],
    held: Mapping[str, Any],
) -> dict[str, Any]:
    e = search.estimate
    return {
        "logs": [part.windows.source for part in search.parts],
        "windows": {"used": int(sum(p.used.sum() for p in search.parts)), "left_out": search.left_out},
        "steps": search.steps,
        "noise": dict(e.noise),
        "whiteness": {name: {**w._asdict(), "white": w.white} for name, w in white.items()},
        "misfit": dict(misfit),
        "held_back": dict(held),
        "correlation": correlations.round(4).tolist(),
        "efficiency": float(np.median(covariance.efficiency)),
        "motion_point": e.point.tolist(),
        "accelerometer_place": e.place.tolist(),
        "assumptions": assumptions_of(search),
        "streams": [one._asdict() for part in search.parts for one in part.windows.tests],
        "joint_turns": e.turns.tolist(),
        "biases": {name: e.biases[:, place].mean(axis=0).tolist() for name, place in search.priors.places.items()},
        "clocks": {name: float(e.biases[:, place].mean()) for name, place in search.priors.clocks.items()},
    }


def _example(search: VehicleSearch) -> dict[str, Any]:
    """Measured and predicted readings in the last window that was used."""
    part = search.parts[0]
    w, n = part.windows, search.unknowns.numbers(search.estimate.q)
    predicted = part.predictor.predicted(part.starts, n, part.predictor.squares(n, False)[0], search.estimate.point)
    force, rates = (predicted[name] for name in IMU)
    predicted[IMU[0]] = at_place(force, rates, search.estimate.place, w.step)
    last, shown = int(np.flatnonzero(part.used)[-1]), dict[str, Any]()
    for name in ("measured_specific_force", "measured_rates", "measured_joint_force", "measured_position"):
        s = w.samples.get(name)
        if s is not None and (own := s.window == last).any():
            thin = max(1, int(own.sum()) // SHOWN)
            place = search.priors.places.get(name)
            bias = search.estimate.biases[part.groups[last], place] if place else 0.0
            step = s.step[own][::thin]
            shown[name] = {
                "time": (w.times()[last] + step * w.step).tolist(),
                "measured": s.values[own][::thin].tolist(),
                "predicted": (predicted[name][last, step] + bias).tolist(),
            }
    return shown


def reference_rows(mission: MissionLike) -> dict[str, float]:
    """The numbers of a mission by the keys of `Identification` rows, to compare estimates with.

    A key with an asterisk has the mean of all quadrotors, as `Identification` has it.
    """
    mission = mission_of(mission)
    unknowns = unknowns_of(mission.vehicle, mission.actuators.delay)
    at = np.zeros(len(unknowns))
    every = _values(unknowns, at) | whole_vehicle(mission.vehicle, unknowns.start.vehicle)
    found = {
        f"{key}.{AXES[i]}" if len(values) > 1 else key: float(x)
        for key, (values, _) in every.items()
        for i, x in enumerate(values)
    }
    of_all = dict[str, list[float]]()
    for key, x in found.items():
        of_all.setdefault(re.sub(r"quadrotors\.\d+", "quadrotors.*", key), []).append(x)
    return found | {key: float(np.mean(xs)) for key, xs in of_all.items() if key not in found}
