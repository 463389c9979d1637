"""Maps: where the streams of a log are in the tables of a file, with the unit, the signs and the stamps of columns."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError

from tandemlift.analysis.logs.log import MOTION, stream_channel
from tandemlift.core.errors import InputError, shown
from tandemlift.core.files import toml_tables
from tandemlift.core.keys import Table
from tandemlift.missions import problems_in

DEGREE, STANDARD_GRAVITY = math.pi / 180.0, 9.80665  # m/s² of the unit g, by definition
POUND, INCH, FOOT = 4.4482216152605, 0.0254, 0.3048  # N of the unit lbf, m
UNITS = {
    "deg": ("rad", DEGREE),
    "deg/s": ("rad/s", DEGREE),
    "rpm": ("rad/s", math.pi / 30.0),
    "krad/s": ("rad/s", 1e3),
    "mrad/s": ("rad/s", 1e-3),
    "g": ("m/s^2", STANDARD_GRAVITY),
    "mg": ("m/s^2", 1e-3 * STANDARD_GRAVITY),
    "m/s²": ("m/s^2", 1.0),
    "ft/s^2": ("m/s^2", FOOT),
    "mm/s^2": ("m/s^2", 1e-3),
    "kgf": ("N", STANDARD_GRAVITY),
    "gf": ("N", 1e-3 * STANDARD_GRAVITY),
    "lbf": ("N", POUND),
    "mN": ("N", 1e-3),
    "kgf m": ("N m", STANDARD_GRAVITY),
    "lbf ft": ("N m", POUND * FOOT),
    "lbf in": ("N m", POUND * INCH),
    "mN m": ("N m", 1e-3),
    "N mm": ("N m", 1e-3),
    "mm": ("m", 1e-3),
    "cm": ("m", 1e-2),
    "in": ("m", INCH),
    "ft": ("m", FOOT),
    "mm/s": ("m/s", 1e-3),
    "cm/s": ("m/s", 1e-2),
    "ft/s": ("m/s", FOOT),
    "km/h": ("m/s", 1.0 / 3.6),
    "ms": ("s", 1e-3),
    "us": ("s", 1e-6),
    "ns": ("s", 1e-9),
}
"""Units that columns may have beside those of streams: for which of these, and the factor."""
TIME_UNITS = ("s", *(unit for unit, (of, _) in UNITS.items() if of == "s"))
SPELT = {"°/s": "deg/s", "dps": "deg/s", "°": "deg", "degrees": "deg", "m/s/s": "m/s^2", "m/s2": "m/s^2", "µs": "us"}
"""Other spellings of units in tables."""

FORMATS = {
    name: f"{'ulog' if name == 'px4' else name}.toml"
    for name in ("optitrack", "vicon", "blackbox", "crazyflie", "px4", "ardupilot", "rosbag-csv")
}
"""The formats that have a map of ours, and its file in `data/logs`."""

Map = Mapping[str, Any]
TIME = "time"  # the column of stamps, if a map does not say it
OF_ALL, OFFSET = ("time", "time_unit", "up"), "stamp_offset"  # keys of all streams at once, and of the log
OF_TABLE = ("separator", "decimal", "names_line", "rigid_body")  # keys of `TableSettings`
ROTATION_VECTOR = "rotation vector"


class TableSettings(Table):
    """How the table of a text file is read: keys of a whole map.

    Attributes:
        separator: between cells; it is found if it is not given.
        decimal: the decimal sign; likewise.
        names_line: the line of names, from 1, or several, whose names are joined by points.
        rigid_body: the body in a table of Motive or Vicon; of one marker its name.
    """

    separator: Literal[",", ";", "|", "tab", "blank"] | None = None
    decimal: Literal[".", ","] | None = None
    names_line: Annotated[int, Field(ge=1)] | tuple[Annotated[int, Field(ge=1)], ...] | None = None
    rigid_body: str | None = None


class Way(Table):
    """The place of a stream in a log: a table of a map.

    Attributes:
        columns: their names, in the order of the stream's.
        topic: of a bag or a ULog; of several, such as one for each joint, the columns come one topic after another, and
            the samples of all are interpolated at the times of the first, as far as each has some without a gap. "" is
            the first topic that has the columns.
        unit: of the columns: that of the stream, or one of `UNITS` for it; "1" stands for that of the stream.
        offset: added to the columns before all else, or one for each.
        power: of the sizes of the columns, before factors: 0.5 for squares of speeds.
        scale: factor, or one for each column, beside that of the unit: signs for other axes.
        time: the column of stamps; of a list, the first that is there and has stamps.
        time_unit: of it.
        time_offset: a column, in the same unit, that is added to the stamps; 2³¹ − 1 marks a row without a reading.
        frame: "body" for a velocity in body axes, which the attitude turns into world axes.
        delay: by how much [s] the stamps are late.
        up: the axis of the columns that points up; "y" becomes our z, and z becomes −y. Of an attitude, of the world
            and of what is tracked.
        turn: rotation vector [deg] of the sensor's axes from the body's, after `up`: of an attitude, of what is
            tracked.
        angles: of an attitude in angles: the axes of the turns in the order of the columns, as in SciPy's
            `Rotation.from_euler`: "xyz" (small: about fixed axes) is roll, pitch, yaw, "ZYX" is yaw, pitch, roll;
            or "rotation vector".
        where: numbers that columns must have for a row to count; a column that is not there counts as 0.
    """

    columns: Annotated[tuple[str, ...], Field(min_length=1)]
    topic: str | tuple[str, ...] = ""
    unit: str = "1"
    offset: float | tuple[float, ...] = 0.0
    power: Annotated[float, Field(gt=0.0, le=4.0)] = 1.0
    scale: float | tuple[float, ...] = 1.0
    time: str | tuple[str, ...] = TIME
    time_unit: str = "s"
    time_offset: str = ""
    frame: Literal["", "body"] = ""
    delay: float = 0.0
    up: Literal["y", "z"] = "z"
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0)
    angles: str = ""
    where: dict[str, list[float]] = Field(default_factory=dict)

    @property
    def topics(self) -> tuple[str, ...]:
        """All topics."""
        return (self.topic,) if isinstance(self.topic, str) else self.topic

    @property
    def stamps(self) -> tuple[str, ...]:
        """The columns of stamps."""
        return (self.time,) if isinstance(self.time, str) else self.time

    @property
    def is_euler(self) -> bool:
        """Whether the columns are angles about axes."""
        return self.angles not in ("", ROTATION_VECTOR)

    @property
    def needs(self) -> list[str]:
        """All columns that it reads."""
        return [*self.columns, *self.stamps, *([self.time_offset] if self.time_offset else []), *self.where]


def map_in(path: Path) -> Map:
    """The map in a TOML file."""
    try:
        return toml_tables(path.read_text("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: {error}") from None


def table_settings(given: Map) -> TableSettings:
    """The settings among the keys of a map."""
    try:
        return TableSettings.model_validate(given)
    except ValidationError as error:
        problems = problems_in(TableSettings, error, dict(given), ())
        raise InputError("\n".join(problem.sentence for problem in problems)) from None


def ways_of(given: Map) -> dict[str, list[Way]]:
    """The ways to each stream of a map."""
    common = {key: given[key] for key in OF_ALL if key in given}
    return {
        name: [_way(name, common, table) for table in (tables if isinstance(tables, list) else [tables])]
        for name, tables in given.items()
        if name not in (*common, *OF_TABLE, OFFSET)
    }


def _way(name: str, common: Map, table: Any) -> Way:
    """A way to a stream, from its table in a map."""
    given, channel = {**common, **(table if isinstance(table, Mapping) else {})}, stream_channel(name)
    try:
        way = Way.model_validate(given)
    except ValidationError as error:
        problems = problems_in(Way, error, {name: given}, (name,))
        raise InputError("\n".join(problem.sentence for problem in problems)) from None
    if way.angles:
        _check_angles(name, way)
    elif name == MOTION[2] and len(way.columns) == 3:
        said = 'three columns are angles: say angles = "xyz" for roll, pitch, yaw, and unit = "deg" or "rad"'
        raise InputError(f"{name}.columns = {shown(list(way.columns))}: must be w, x, y, z of a quaternion; {said}")
    if any(way.turn) and channel.width == 1:
        raise InputError(f"{name}.turn = {shown(list(way.turn))}: {name} has no axes")
    for key, own in (("unit", "rad" if way.angles else channel.unit), ("time_unit", "s")):
        allowed = [*dict.fromkeys((own, *(unit for unit, (other, _) in UNITS.items() if other == own), "1"))]
        if getattr(way, key) not in allowed:
            raise InputError(f"{name}.{key} = {shown(getattr(way, key))}: must be one of {', '.join(allowed)}")
    return way


def _check_angles(name: str, way: Way) -> None:
    letters = way.angles.lower()
    fits = way.angles in (letters, way.angles.upper()) and {*letters} <= {*"xyz"} and len(letters) == 3
    if name != MOTION[2] or not (way.angles == ROTATION_VECTOR or (fits and letters[0] != letters[1] != letters[2])):
        need = f'{MOTION[2]} alone has angles: "xyz" for roll, pitch, yaw, "ZYX" for yaw, pitch, roll, or others'
        raise InputError(f'{name}.angles = {shown(way.angles)}: {need} in the order of columns, or "{ROTATION_VECTOR}"')
    if len(way.columns) != 3:
        raise InputError(f"{name}.columns = {shown(list(way.columns))}: must be three angles")


def factor_of(unit: str) -> float:
    """The factor from a unit to that of the stream."""
    return UNITS[unit][1] if unit in UNITS else 1.0
