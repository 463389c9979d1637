"""What contradicts in a log, and the one change of its map with which nothing does.

A contradiction between two streams does not say which of them is wrong. So every single mistake that a map can have is
undone in turn (a sign, a unit, exchanged columns, turned axes, quadrotors or rotors in another order, another frame,
late stamps), and all tests are made again. The cause is the change after which all agree, the best if there are more.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from tandemlift.analysis.logs.checks import check_log
from tandemlift.analysis.logs.columns import turned_by
from tandemlift.analysis.logs.corrections import NONE, MapCorrection, corrected, in_words, width_of
from tandemlift.analysis.logs.grid import thinned
from tandemlift.analysis.logs.log import COMMANDS, IMU, JOINTS, MOTION, SPEED_COMMANDS, Log, rotated, stream_channel
from tandemlift.analysis.logs.maps import ROTATION_VECTOR, TIME_UNITS, UNITS, factor_of
from tandemlift.analysis.logs.stream_tests import KINDS, OF_EACH, SURE, Fit, VehicleLaws, streams_of
from tandemlift.core.errors import InputError
from tandemlift.core.types import Array
from tandemlift.missions import VehicleTable

POSITION, VELOCITY, ATTITUDE = MOTION
FORCE, RATES = IMU
LEANS = 10.0  # deg that the mean specific force may be off the vertical
NOTHING, ALIKE = 0.3, 0.6  # correlation below which two streams have nothing in common; from which a lag is told
OF_ROTORS = ("rpm", "1")  # units in which programs have the speeds of rotors
EXACT = 0.03  # that a scale may be off after a correction, where the law is exact
STILL_TOLD = 0.5  # standard deviation of a scale, up to which a law tells something
AWAY = 0.15  # m from the payload's origin that an accelerometer may be, which the centre of mass may be off, too
LIKELIER = 12.0  # units of log-likelihood
FAR = 0.3  # of what a law leaves, for a scale that is e times what the mission says
RARE = 0.3  # of what a law leaves, for a unit that is near another and seldom met
WORST = 1.5  # part of a square that a law leaves, at most: more is no worse
MOST_ORDERS = 24  # of quadrotors that are tried
NEARLY = 0.15  # relative: a scale so near that of a unit is it
MEANINGS = {
    "turn": "the turn of the attitude against the gyroscope",
    "path": "the change of the position against the velocity",
    "speed": "the change of the velocity against the accelerometer in world axes",
    "load": "the sum of the joints' forces against the payload's mass times the accelerometer",
    "lever": "the moment of the joints about the payload against its inertia times the angular acceleration",
    "lift": "the accelerometer against the commanded thrusts over the mass",
    "twist": "the angular acceleration against that of the commanded thrusts",
    "side": "the joint's force across against the quadrotor's mass times its acceleration",
    "thrust": "the joint's force and the quadrotor's mass times its acceleration against its commanded thrusts",
    "arm": "the joint's torque against the moment of its force about the quadrotor",
    "torque": "the joint's torque and the quadrotor's inertia times its turn against the moments of its thrusts",
}


class StreamTest(NamedTuple):
    """A line of the table of tests: what was found of streams, beside what is expected."""

    stream: str
    test: str
    found: str
    expected: str
    verdict: str


class Cause(NamedTuple):
    """A mistake of a map: what it is, and what undoes it."""

    words: str
    corrections: tuple[MapCorrection, ...]


def findings_of(laws: VehicleLaws, log: Log, first: Sequence[str] = ()) -> Iterator[StreamTest]:
    """The table of all tests of a log, those of some laws first."""
    for names in (first, [name for name in laws.names if name not in first]):
        for name, fit in laws.fits(log, names):
            yield from _of_law(name, ", ".join(streams_of(name.split()[0], log)), fit)
        if names is first:
            yield from _of_means(laws, log)


def _of_means(laws: VehicleLaws, log: Log) -> Iterator[StreamTest]:
    """What gravity tells of means."""
    constants = laws.constants(log)
    if "up" in constants:
        up, size = constants["up"], float(np.linalg.norm(constants["up"]))
        angle, axis = math.degrees(math.acos(min(max(up[2] / size, -1.0), 1.0))), int(np.argmax(np.abs(up)))
        good = angle < LEANS and 0.85 < size < 1.15
        found = f"{up[axis]:+.2f} g along {'xyz'[axis]} of the world, {angle:.0f}° off z"
        found = f"{size:.2f} g: it seems to be without gravity" if size < 0.05 else found
        yield _tried(f"{FORCE}, {ATTITUDE}", "gravity", found, "+1 g along z", good)
    if "load" in constants:
        whole = constants["load"].sum(axis=0)
        flat = float(np.linalg.norm(whole[:2]))
        good = -0.5 < float(whole[2]) < 2.5 and flat < 0.8
        found = f"{whole[2]:+.2f} of the payload's weight along z, {flat:.2f} across"
        yield _tried(JOINTS[0], "weight", found, "1, or 0 after a tare; 0 across", good)
    for way, better in laws.frames(log).items():
        found = f"along {way} axes it suits the position better by {better:+.0f}"
        yield _tried(VELOCITY, f"frame of the velocity, if {way}", found, f"below {LIKELIER:g}", better < LIKELIER)
    if "lift" in constants and np.isfinite(constants["lift"]).all():
        ratio = float(constants["lift"][0])
        yield _tried(log.commands, "hover", f"{ratio:.3g} of the weight", "0.5 to 2", 0.5 < ratio < 2.0)


def _tried(stream: str, test: str, found: str, expected: str, good: bool) -> StreamTest:
    return StreamTest(stream, test, found, expected, "agrees" if good else "contradicts")


def _of_law(name: str, streams: str, fit: Fit | None) -> Iterator[StreamTest]:
    law, *number = name.split()
    kind, test = KINDS[law], f"{MEANINGS[law]}{f', quadrotor {number[0]}' if number else ''}"
    low, high = kind.scales
    exact = law in ("turn", "path")
    if fit is not None and fit.better > LIKELIER:
        found = f"others suit better by {fit.better:.0f}"
        yield _tried(streams, f"order and signs of axes of {test}", found, f"at most by {LIKELIER:g}", False)
    if fit is None or not fit.told.any():
        if fit is not None and exact and np.any(fit.moves & (fit.left > 0.7)):
            yield StreamTest(streams, test, "nothing in common", "equal", "contradicts")
        else:
            yield StreamTest(streams, test, "hardly moved", "", "not told")
        return
    off, apart = np.flatnonzero(fit.told & fit.off), np.flatnonzero(exact & fit.moves & (fit.left > 0.8))
    shown = ", ".join(f"{'xyz'[i]} {fit.scale[i]:.2f}" for i in range(3) if fit.told[i] or i in apart)
    yield _tried(streams, test, f"scale {shown}", f"{low:g} to {high:g}", not len(off) + len(apart))
    least, most = kind.lags
    if fit.alike > ALIKE and not len(off):
        good = least - SURE * fit.lag_sd < fit.lag < most + SURE * fit.lag_sd
        found = f"late by {round(1e3 * fit.lag)} ms"
        yield _tried(streams, f"lag of {test}", found, f"{1e3 * least:.0f} to {1e3 * most:.0f} ms", good)
    known = np.degrees(fit.turn_sd) < 0.6 * kind.turn
    if kind.turn < math.inf and known.any():
        turn = fit.turn * known
        angle = float(np.linalg.norm(turn))
        sd = float(np.linalg.norm(turn[known] * fit.turn_sd[known])) / max(angle, 1e-12)
        good = math.degrees(angle - SURE * sd) < kind.turn
        yield _tried(streams, f"axes of {test}", axis_and_angle(turn), f"within {kind.turn:g}°", good)


def away(laws: VehicleLaws, log: Log) -> Array | None:
    """Where the accelerometer is, from the payload's origin [m], if it is elsewhere; None if it may be there."""
    found = laws.place(log)
    if found is None or found[1].max() > AWAY:
        return None
    return found[0] if np.linalg.norm(found[0]) > AWAY + SURE * float(found[1].max()) else None


def axis_and_angle(turn: Array) -> str:
    """A rotation vector [rad] in words."""
    angle = float(np.linalg.norm(turn))
    axis = turn / max(angle, 1e-12)
    near = int(np.argmax(np.abs(axis)))
    if abs(axis[near]) > 0.95:
        return f"turned by {math.copysign(math.degrees(angle), axis[near]):.0f}° about {'xyz'[near]}"
    return f"turned by {math.degrees(angle):.0f}° about {np.round(axis, 2).tolist()}"


class Streams(NamedTuple):
    """What the tests of a log found: their table, and where the accelerometer is if not at the payload's origin [m]."""

    table: tuple[StreamTest, ...]
    place: Array | None


def check_streams(log: Log, table: VehicleTable) -> Streams:
    """Test the streams of a log against each other; one that contradicts itself is refused with the likely cause.

    Args:
        log: of about such a vehicle.
        table: of the vehicle.

    Raises:
        InputError: tests contradict; the message names what, and what to write into the map.
    """
    _check_spans(log)
    check_log(log)
    laws, log = VehicleLaws(table), thinned(log)
    found, place = tuple(findings_of(laws, log)), away(laws, log)
    if place is not None:
        laws.at = place
        there = tuple(findings_of(laws, log))
        if any(one.verdict == "contradicts" for one in there):
            laws.at = 0.0 * place  # it is something else
        else:
            found = there
    wrong = [one for one in found if one.verdict == "contradicts"]
    if not wrong:
        if place is not None:
            at = f"{np.round(place, 2).tolist()} m from the payload's origin"
            found += (StreamTest(FORCE, "place of the accelerometer", at, f"within {AWAY:g} m", "estimated"),)
        return Streams(found, place)
    first = wrong[0]
    said = f"{log.source}: stream {first.stream}: {first.test}: {first.found}; expected: {first.expected}"
    causes = causes_of(log, laws, wrong)
    if not causes:
        others = "".join(f"; {one.test}: {one.found}" for one in wrong[1:3])
        why = "it has several mistakes, or is no log of about such a vehicle"
        raise InputError(f"{said}{others}. No single change of the map makes it agree: {why}")
    cause = causes[0]
    raise InputError(f"{said}. It seems to be {cause.words}: {in_words(cause.corrections, log)}")


def _check_spans(log: Log) -> None:
    """Refuse a stream whose stamps last a thousand times as long as those of others, or that lies apart from them."""
    spans = {name: float(stream.time[-1] - stream.time[0]) for name, stream in log.items() if len(stream.time) > 1}
    if not spans:
        return
    usual = float(np.median([*spans.values()]))
    for name, span in spans.items():
        given = log.ways.get(name, {}).get("time_unit", "s")
        for unit in TIME_UNITS:
            ratio = factor_of(unit) / factor_of(given) * span / max(usual, 1e-12)
            if unit != given and 0.5 < ratio < 2.0 and not 0.05 < span / usual < 20.0:
                raise InputError(
                    f"{log.source}: stream {name}: its stamps last {span:.4g} s, those of others {usual:.4g} s. "
                    f'It seems to be stamped in {unit}: [{name}] time_unit = "{unit}"'
                )
    middle = {name: float(np.mean(log[name].time[[0, -1]])) for name in spans}
    center = float(np.median([*middle.values()]))
    name = max(middle, key=lambda name: abs(middle[name] - center))
    if log.duration < 0.3 * min(usual, *spans.values()):
        time = log[name].time
        raise InputError(
            f"{log.source}: stream {name}: its stamps are from {time[0]:.6g} to {time[-1]:.6g} s, of others about "
            f"{center:.6g} s: they seem to be of another clock: give delay = {middle[name] - center:.4g}, and align"
        )


def causes_of(log: Log, laws: VehicleLaws, wrong: Sequence[StreamTest]) -> list[Cause]:
    """The changes with which no test contradicts, the best first."""
    concerned = {name for one in wrong for name in one.stream.split(", ")}
    first = [name for name in laws.names if any(MEANINGS[name.split()[0]] in one.test for one in wrong)]
    before = {name for name, fit in laws.fits(log) if fit is not None and fit.told.any()}
    found = list[tuple[float, int, Cause]]()
    for number, cause in enumerate(candidates(log, laws, concerned)):
        ways = [(one, log.ways.get(one.stream, {})) for one in cause.corrections]
        if not all(one.can_be_said(way, width_of(log, one.stream)) for one, way in ways):
            continue
        other = corrected(log, cause.corrections)
        if any(one.verdict == "contradicts" for one in findings_of(laws, other, first)):
            continue
        fits = dict(laws.fits(other))
        if (turn := fits.get("turn")) is not None and np.any(
            turn.told & (np.abs(turn.scale - 1.0) > EXACT + 2.0 * turn.scale_sd)
        ):
            continue  # the turn of the attitude is the gyroscope's, whatever the mission
        if all((fit := fits.get(name)) is not None and fit.scale_sd.min() < STILL_TOLD for name in before):
            rare = RARE * any(one.unit in ("lbf ft", "lbf in", "cm/s", "km/h") for one in cause.corrections)
            found.append((_unexplained(fits) + rare, number, cause))
    return [cause for *_, cause in sorted(found, key=lambda item: item[:2])]


def _unexplained(fits: Mapping[str, Fit | None]) -> float:
    """The parts of squares that the laws leave, and how far told scales are from 1 and lags from 0, summed."""
    total = 0.0
    for name, fit in fits.items():
        if fit is not None:
            least, most = KINDS[name.split()[0]].lags
            if least == -most and fit.told.any():
                total += FAR * min(abs(fit.lag) / most, 1.0)
            total += float(np.sum(np.minimum(fit.left, WORST)))
            total += FAR * float(np.sum(np.abs(np.log(np.maximum(fit.scale[fit.told], 1e-3)))))
    return total


SIGNS = tuple(itertools.product((1.0, -1.0), repeat=3))
ORDERS = tuple(itertools.permutations(range(3)))
SAME = ORDERS[0], SIGNS[0]
ROTATIONS = tuple(
    (order, signs)
    for order in ORDERS
    for signs in SIGNS
    if np.linalg.det(np.diag(signs) @ np.eye(3)[list(order)]) > 0.0 and (order, signs) != SAME
)
MISTAKES = (  # signs, columns in another order, both for other axes
    *((ORDERS[0], signs) for signs in SIGNS[1:]),
    *((order, SIGNS[0]) for order in ORDERS[1:]),
    *((order, signs) for order, signs in ROTATIONS if order != ORDERS[0] and signs != SIGNS[0]),
)


def _axes(order: Sequence[int], signs: Sequence[float]) -> str:
    """In words: signs and exchanged axes of a vector."""
    negative = [a for a, s in zip("xyz", signs, strict=True) if s < 0.0]
    if tuple(order) == (0, 1, 2):
        if negative == ["y", "z"]:
            return "of front, right, down"
        return f"of the other sign{'' if len(negative) == 3 else f' along {chr(32).join(negative)}'}"
    swapped = f"along other axes: columns in the order {', '.join('xyz'[i] for i in order)}"
    return swapped + (f", {' and '.join(negative)} negative" if negative else "")


def _mapped(
    name: str, width: int, order: Sequence[int], signs: Sequence[float], only: Iterable[int] | None = None
) -> MapCorrection:
    """Axes of a stream in another order and with other signs; of joints, of some quadrotors."""
    columns, factors = list(range(width)), [1.0] * width
    for i in range(width // 3) if only is None else only:
        for axis in range(3):
            columns[3 * i + axis], factors[3 * i + axis] = 3 * i + order[axis], signs[axis]
    moved = tuple(columns) if columns != [*range(width)] else ()
    return MapCorrection(name, moved, tuple(factors) if min(factors) < 0.0 else ())


def candidates(log: Log, laws: VehicleLaws, concerned: Iterable[str]) -> Iterator[Cause]:
    """Single mistakes of a map that may be in some streams of a log."""
    concerned = [name for name in log if name in {*concerned}]
    yield from _units(log, concerned)
    yield from _late(log, laws, concerned)
    for name in (RATES, FORCE, POSITION, VELOCITY):
        if name in concerned:
            for order, signs in MISTAKES:
                yield Cause(_axes(order, signs), (_mapped(name, 3, order, signs),))
    if VELOCITY in concerned and ATTITUDE in log:
        other = "world" if log.ways.get(VELOCITY, {}).get("frame") else "body"
        yield Cause(f"along {other} axes", (MapCorrection(VELOCITY, frame=other),))
    if {*IMU} & {*concerned} and {*IMU} <= {*log}:
        for order, signs in ROTATIONS:
            yield Cause(f"of an IMU {_axes(order, signs)}", tuple(_mapped(name, 3, order, signs) for name in IMU))
    if {*MOTION} & {*concerned}:
        yield from _attitudes(log, laws)
    if {*JOINTS} & {*concerned}:
        yield from _joints(log, laws)
    for name in (COMMANDS, SPEED_COMMANDS):
        if name in concerned:
            yield from _commands(name, log[name].values.shape[1])


def _units(log: Log, concerned: Sequence[str]) -> Iterator[Cause]:
    """Other units of a stream."""
    for name in concerned:
        if name == ATTITUDE:
            continue
        own, way = stream_channel(name).unit, log.ways.get(name, {})
        given = way.get("unit", "1")
        for unit in ("1", *(unit for unit, (other, _) in UNITS.items() if other == own)):
            if unit not in (given, own) and not (name == SPEED_COMMANDS and unit not in OF_ROTORS):
                words = f"in {own} already" if unit == "1" else f"in {unit}"
                yield Cause(words, (MapCorrection(name, unit=unit),))
        if np.any(np.abs(way.get("scale", 1.0)) != 1.0):
            yield Cause(f"in {own if given == '1' else given} already", (MapCorrection(name, plain=True),))


def _late(log: Log, laws: VehicleLaws, concerned: Sequence[str]) -> Iterator[Cause]:
    """Late stamps of a stream, or of all of a source."""
    groups = [(name,) for name in concerned] + [
        tuple(name for name in group if name in log) for group in (MOTION, JOINTS, IMU) if {*group} & {*concerned}
    ]
    fits = dict(laws.fits(log))
    for group in groups:
        lags = set[float]()
        for name, fit in fits.items():
            streams = KINDS[name.split()[0]].streams
            if fit is None or name.split()[0] in OF_EACH:
                continue
            late = fit.lag - laws.lag * (COMMANDS in streams)
            if {*streams[:1]} & {*group} or (name == "lever" and {*JOINTS} & {*group}):
                lags.add(late)
            if {*streams[1:]} & {*group} or (COMMANDS in streams and SPEED_COMMANDS in group):
                lags.add(-late)
        for lag in lags:
            if abs(lag) > 0.008:
                words = f"stamped {1e3 * abs(lag):.0f} ms {'late' if lag > 0.0 else 'early'}"
                yield Cause(words, tuple(MapCorrection(name, delay=lag) for name in group))


def _attitudes(log: Log, laws: VehicleLaws) -> Iterator[Cause]:
    """Other quaternions, and other axes of the world and of what is tracked."""
    there = [name for name in MOTION if name in log]
    if ATTITUDE in log:
        yield from _angles(log) if log.ways.get(ATTITUDE, {}).get("angles") else _quaternions()
        for axis, angle in itertools.product(range(3), (90.0, -90.0, 180.0)):
            turn = tuple(angle * (i == axis) for i in range(3))
            words = f"of axes that are turned by {angle:.0f}° about {'xyz'[axis]}"
            yield Cause(words, (MapCorrection(ATTITUDE, turn=turn),))
        if any(log.ways.get(ATTITUDE, {}).get("turn", ())):
            back = tuple(-x for x in log.ways[ATTITUDE]["turn"])
            yield Cause("of the body's own axes", (MapCorrection(ATTITUDE, turn=back),))
        fit = dict(laws.fits(log)).get("turn")
        if fit is not None and fit.alike > ALIKE:
            turn = tuple(np.degrees(-fit.turn).tolist())
            words = f"of axes that are {axis_and_angle(-fit.turn)} against the gyroscope's"
            yield Cause(words, (MapCorrection(ATTITUDE, turn=turn),))
            words = f"a gyroscope's of axes that are {axis_and_angle(fit.turn)} against the attitude's"
            yield Cause(words, (MapCorrection(RATES, turn=tuple(np.degrees(fit.turn).tolist())),))
    in_world = [name for name in there if not log.ways.get(name, {}).get("frame")]
    for group in ([ATTITUDE], in_world, [name for name in in_world if name != ATTITUDE]):
        if not group or not all(name in log for name in group):
            continue
        ups = {log.ways.get(name, {}).get("up", "z") for name in group}
        for up in {"y", "z"} - (ups if len(ups) == 1 else set()):
            yield Cause(f"of a world with {up} up", tuple(MapCorrection(name, up=up) for name in group))
            if ATTITUDE in group:  # of the world alone, the axes of what is tracked stay
                own = turned_by(log.ways.get(ATTITUDE, {}).get("turn", (0.0, 0.0, 0.0)))
                angle = -90.0 if up == "y" else 90.0
                turn = tuple((angle * rotated(own[None], np.array([[1.0, 0.0, 0.0]]))[0]).tolist())
                words = f"of a world with {up} up, what is tracked with {'z' if up == 'y' else 'y'} up"
                yield Cause(
                    words,
                    tuple(MapCorrection(name, up=up, turn=turn if name == ATTITUDE else NONE) for name in group),
                )
        if ATTITUDE in group and log.ways.get(ATTITUDE, {}).get("angles"):
            continue
        for flip, (order, factors) in HALF_TURNS.items():
            signs = tuple(1.0 if a == flip else -1.0 for a in "xyz")
            words = "of a world with z down" if flip == "x" else f"of a world turned by 180° about {flip}"
            yield Cause(
                words,
                tuple(
                    MapCorrection(name, order, factors) if name == ATTITUDE else MapCorrection(name, (), signs)
                    for name in group
                ),
            )


HALF_TURNS = {  # of the world: columns of the quaternion, and their signs
    "x": ((1, 0, 3, 2), (-1.0, 1.0, -1.0, 1.0)),
    "y": ((2, 3, 0, 1), (-1.0, 1.0, 1.0, -1.0)),
    "z": ((3, 2, 1, 0), (-1.0, -1.0, 1.0, 1.0)),
}


def _quaternions() -> Iterator[Cause]:
    """Other orders, signs and axes of quaternions."""
    for order, words in (
        ((0, 1, 2, 3), ""),
        ((3, 0, 1, 2), "x, y, z, w: give the columns in the order w, x, y, z"),
        ((1, 2, 3, 0), "w, x, y, z already, and not x, y, z, w"),
    ):
        for axes, signs in (SAME, *MISTAKES):
            if (axes, signs) == SAME and not words:
                continue
            moved = (order[0], *(order[1 + i] for i in axes))
            named = {
                (ORDERS[0], SIGNS[-1]): "from world to body",
                (ORDERS[0], (1.0, -1.0, -1.0)): "of front, right, down in north, east, down",
                SAME: "",
            }.get((axes, signs), _axes(axes, signs))
            one = MapCorrection(
                ATTITUDE, moved if moved != (0, 1, 2, 3) else (), () if min(signs) > 0.0 else (1.0, *signs)
            )
            yield Cause(" and ".join(filter(None, (words, named))), (one,))


def _angles(log: Log) -> Iterator[Cause]:
    """Other units, orders, signs and axes of an attitude's angles."""
    way = log.ways[ATTITUDE]
    given, unit = way["angles"], way.get("unit", "1")
    other = "deg" if unit in ("1", "rad") else "rad"
    yield Cause(f"in {other}", (MapCorrection(ATTITUDE, unit=other),))
    back = "" if given == ROTATION_VECTOR else given.upper() if given.islower() else given.lower()
    yield Cause("from world to body", (MapCorrection(ATTITUDE, signs=SIGNS[-1], angles=back),))
    for order, signs in MISTAKES:
        yield Cause(_axes(order, signs), (_mapped(ATTITUDE, 3, order, signs),))
    for angles in ("xyz", "ZYX", "XYZ", "zyx", ROTATION_VECTOR):
        for order in ORDERS if angles != given else ():
            one = _mapped(ATTITUDE, 3, order, SIGNS[0])
            yield Cause(f'angles "{angles}"', (one._replace(angles=angles),))


def _joints(log: Log, laws: VehicleLaws) -> Iterator[Cause]:
    """Other signs, quadrotors and axes of the joints' sensors."""
    there = [name for name in JOINTS if name in log]
    sides = [fit for name, fit in laws.fits(log) if name.startswith("side") and fit is not None]
    if sides:
        turn = -min(sides, key=lambda fit: fit.turn_sd[2]).turn
        words = f"of axes that are {axis_and_angle(turn)} against the accelerometer's"
        given = tuple(np.degrees(turn).tolist())
        yield Cause(words, tuple(MapCorrection(name, turn=given) for name in there))
    count = log[there[0]].values.shape[1] // 3
    groups = [[name] for name in there] + ([there] if len(there) > 1 else [])
    for group in groups:
        for order in itertools.islice(itertools.permutations(range(count)), 1, MOST_ORDERS):
            columns = tuple(3 * i + axis for i in order for axis in range(3))
            words = f"of quadrotors in the order {', '.join(map(str, order))}"
            yield Cause(words, tuple(MapCorrection(name, columns) for name in group))
    quadrotors: list[list[int] | None] = [None, *([i] for i in range(count) if count > 1)]
    for group, only in itertools.product(groups, quadrotors):
        where = "" if only is None else f" at quadrotor {only[0]}"
        for order, signs in MISTAKES if len(group) == 1 else (*ROTATIONS, (ORDERS[0], SIGNS[-1])):
            yield Cause(
                f"{_axes(order, signs)}{where}", tuple(_mapped(name, 3 * count, order, signs, only) for name in group)
            )


def _commands(name: str, width: int) -> Iterator[Cause]:
    """Quadrotors and rotors in another order, other powers."""
    for order in itertools.islice(itertools.permutations(range(width // 4)), 1, MOST_ORDERS):
        columns = tuple(4 * i + rotor for i in order for rotor in range(4))
        yield Cause(f"of quadrotors in the order {', '.join(map(str, order))}", (MapCorrection(name, columns),))
    for only in [None, *(range(width // 4) if width > 4 else ())]:
        for order in itertools.islice(itertools.permutations(range(4)), 1, None):
            columns = tuple(
                4 * i + (order[rotor] if only in (None, i) else rotor) for i in range(width // 4) for rotor in range(4)
            )
            where = "" if only is None else f" of quadrotor {only}"
            yield Cause(f"of rotors{where} in the order {', '.join(map(str, order))}", (MapCorrection(name, columns),))
    yield Cause("of squares of what is expected", (MapCorrection(name, power=0.5),))
