"""The record of a flight: named channels with unit and frame, the resolved mission, and the metrics.

Frames: `world` is inertial with z up; `body` is fixed to the vehicle; `zxy` are Euler angles roll, pitch, yaw.
"""

from __future__ import annotations

import json
import os
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

import numpy as np

from tandemlift.common.errors import InputError, suggestion
from tandemlift.common.files import atomic_write
from tandemlift.common.sensors import ADDITIONAL
from tandemlift.common.types import Array
from tandemlift.flight.old_names import renamed_tables, warn_of_old_names
from tandemlift.flight.tables import to_pandas, to_xarray

if TYPE_CHECKING:
    import pandas
    import xarray

FORMAT = 1


class Channel(NamedTuple):
    """What a channel holds: its unit, its frame, and a sentence."""

    unit: str
    frame: str
    meaning: str


CHANNELS: dict[str, Channel] = {
    "position": Channel("m", "world", "centre of mass of the vehicle"),
    "velocity": Channel("m/s", "world", "of the centre of mass"),
    "attitude": Channel("1", "body to world", "unit quaternion w, x, y, z"),
    "euler": Channel("rad", "zxy", "roll, pitch, yaw"),
    "rates": Channel("rad/s", "body", "angular velocity p, q, r"),
    "reference_position": Channel("m", "world", "what the position law tracks"),
    "reference_velocity": Channel("m/s", "world", "its rate"),
    "reference_acceleration": Channel("m/s^2", "world", "the rate of that"),
    "reference_euler": Channel("rad", "zxy", "what the attitude law tracks (filtered, if filtered)"),
    "admittance_position": Channel("m", "world", "T_r, the answer of the admittance to the push"),
    "admittance_velocity": Channel("m/s", "world", "its rate"),
    "admittance_acceleration": Channel("m/s^2", "world", "the rate of that, held over a step"),
    "admittance_force": Channel("N", "world", "the push behind the gate, 0 where the gate is closed"),
    "push_force": Channel("N", "world", "force of the person on the vehicle"),
    "push_moment": Channel("N m", "body", "moment of the person about the centre of mass"),
    "thrust": Channel("N", "body z", "commanded total thrust U1"),
    "moment": Channel("N m", "body", "commanded moments U2, U3, U4"),
    "rotor_thrusts": Channel("N", "body z", "of each rotor, quadrotor by quadrotor"),
    "joint_force": Channel("N", "body", "of each quadrotor on the payload, at its joint: x, y, z, one after another"),
    "joint_torque": Channel("N m", "body", "of each quadrotor on the payload, at its joint, likewise"),
    "rotor_commands": Channel("N", "body z", "thrust commanded of each rotor, where actuators are rotors"),
    "allocated_thrust": Channel("N", "body z", "what these commands, held within limits, give of U1"),
    "allocated_moment": Channel("N m", "body", "what they give of U2, U3, U4"),
    "allocation_share": Channel("1", "", "share of the wanted wrench that they give, 0 to 1"),
    "wind_velocity": Channel("m/s", "world", "of the air, where there is wind"),
    "wind_force": Channel("N", "world", "of the air on all parts together"),
    "contact_force": Channel("N", "world", "of floor and walls on the vehicle, where there is a floor"),
    "measured_position": Channel("m", "world", "reading of the motion measurement, where sensors are simulated"),
    "measured_velocity": Channel("m/s", "world", "reading of the motion measurement"),
    "measured_attitude": Channel("1", "body to world", "reading of the motion measurement, quaternion w, x, y, z"),
    "measured_rates": Channel("rad/s", "body", "reading of the gyroscope"),
    "measured_specific_force": Channel("m/s^2", "body", "reading of the accelerometer at the payload's centre of mass"),
    "measured_joint_force": Channel("N", "body", "reading of the sensor at each joint, as joint_force"),
    "measured_joint_torque": Channel("N m", "body", "reading of the sensor at each joint, as joint_torque"),
    "estimated_position": Channel("m", "world", "of the centre of mass, from inertial and motion sensors"),
    "estimated_velocity": Channel("m/s", "world", "likewise"),
    "estimated_attitude": Channel("1", "body to world", "likewise, quaternion w, x, y, z"),
    "estimated_rates": Channel("rad/s", "body", "the gyroscope's less its estimated bias"),
    "push_measured": Channel("N", "world", "push from the last readings of the joints, before the low-pass"),
    "push_estimate": Channel("N", "world", "the push behind the low-pass, zero until the tare is over"),
    "push_moment_estimate": Channel("N m", "body", "its moment about the payload's centre of mass"),
    "push_point_estimate": Channel("m", "body y", "where on the beam it acts, 0 if it is too small to tell"),
    "payload_mass_estimate": Channel("kg", "", "of the payload, identified during the tare if so asked"),
    "sensor_disagreement": Channel("N", "body", "by which one joint sensor alone would have to be wrong"),
    "push_usable": Channel("1", "", "1 while the push is estimated and the joint sensors agree, else 0"),
    "disturbance_force": Channel("N", "world", "what the observer finds besides rotors, weight and person"),
    "disturbance_moment": Channel("N m", "body", "likewise, about the centre of mass"),
    "disturbance_residual": Channel("m/s^2", "world", "by which it is behind: δ − δ̂ of the condition on λ₂"),
    "disturbance_turning_residual": Channel("rad/s^2", "body", "likewise, of turning"),
    "phase": Channel("1", "", "0 idle, 1 lift, 2 guided, 3 land, 4 hold, 5 stopped"),
    "push_heard": Channel("N", "world", "the push as the pilot hears it: low-passed, less its bias"),
    "push_on": Channel("1", "world", "1 while a push is heard along an axis, else 0"),
    "added_damping": Channel("N s/m", "", "that keeps the compliance passive"),
    "reference_yaw_rate": Channel("rad/s", "world", "of the heading that is tracked"),
    "alarm": Channel("1", "", "of the fault that is reacted to, as in docs/safety.md; 0 for none"),
    "refused": Channel("1", "", "number of the check that refuses to lift or to listen; 0 for none"),
    "rotor_lost": Channel("1", "", "number of the rotor that is taken for lost, 0 for none"),
}


def channel_of(name: str) -> Channel:
    """What a channel of that name holds; of an additional sensor, as that was registered."""
    sensor = ADDITIONAL.get(name.removeprefix("measured_"))
    if name in CHANNELS or sensor is None:
        return CHANNELS.get(name, TIME if name == "time" else OTHER)
    return Channel(sensor.unit, sensor.frame, f"reading of the sensor {sensor.name!r}: {sensor.meaning}")


TIME = Channel("s", "", "time")
OTHER = Channel("", "", "not one of tandemlift's own")

DERIVED: dict[str, tuple[str, str, Channel]] = {
    "position_error": ("reference_position", "position", Channel("m", "world", "desired minus actual")),
    "velocity_error": ("reference_velocity", "velocity", Channel("m/s", "world", "desired minus actual")),
    "attitude_error": ("reference_euler", "euler", Channel("rad", "zxy", "desired minus actual")),
}


class Divergence(NamedTuple):
    """Why a flight was stopped: which quantity, at what time [s], its value, and the limit it broke."""

    quantity: str
    time: float
    value: float
    limit: str

    def __str__(self) -> str:
        return f"diverged at {self.time:.6g} s: {self.quantity} = {self.value:.6g}, {self.limit}"


@dataclass(frozen=True, eq=False)
class Flight(Mapping[str, Array]):
    """A flight's channels by name, each an array (T,) or (T, n) over the logged times.

    Attributes:
        time: logged times (T,) [s].
        channels: the recorded arrays by name; `flight[name]` also gives the differences in `DERIVED`.
        mission: the resolved mission as nested tables.
        results: the metrics, formed from every step and not from the log.
        divergence: why the flight was stopped before its end, or None.
        version: of tandemlift and of what it flew with.
    """

    time: Array
    channels: dict[str, Array]
    mission: dict[str, Any]
    results: dict[str, Any]
    divergence: Divergence | None = None
    version: dict[str, str] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The mission's name."""
        return self.mission["mission"]["name"]

    def __getitem__(self, name: str) -> Array:
        if name in self.channels:
            return self.channels[name]
        if name in DERIVED:
            desired, actual, _ = DERIVED[name]
            return self.channels[desired] - self.channels[actual]
        if name == "time":
            return self.time
        known = [*self.channels, *DERIVED]
        raise KeyError(f"no channel {name!r}; there are {', '.join(known)}.{suggestion(name, known)}")

    def __iter__(self) -> Iterator[str]:
        return iter(self.channels)

    def __len__(self) -> int:
        return len(self.channels)

    def __repr__(self) -> str:
        last = f"{self.time[-1]:g} s" if len(self.time) else "nothing logged"
        return f"<Flight {self.name}: {len(self.time)} samples to {last}, {len(self.channels)} channels>"

    def __eq__(self, other: object) -> bool:
        """Whether two flights are the same to the last bit, records and all."""
        return isinstance(other, Flight) and self._parts() == other._parts()

    def __hash__(self) -> int:
        return hash(self.time.tobytes())

    def _parts(self) -> tuple[Any, ...]:
        arrays = {name: (a.shape, a.tobytes()) for name, a in {"time": self.time, **self.channels}.items()}
        return arrays, self.mission, self.results, str(self.divergence), self.version

    def info(self, name: str) -> Channel:
        """Unit, frame and meaning of a channel."""
        self[name]
        return DERIVED[name][2] if name in DERIVED else channel_of(name)

    def metrics(self) -> dict[str, Any]:
        """The flight's metrics: flat, SI, the unit at the end of each name; None where it could not be formed."""
        return dict(self.results)

    def to_pandas(self) -> pandas.DataFrame:
        """The channels as a table: a row for each sample, a column for each component, indexed by `time` [s].

        Columns are called `position_x`, `attitude_w`, `euler_roll`, `rotor_thrusts_rotor_1`,
        `joint_force_quadrotor_1_x`, and `thrust` where there is one component. `attrs` holds `name`, `units` by column,
        `metrics`, and `divergence` as text or None.

        Raises:
            InputError: pandas is not installed (extra: pandas).
        """
        return to_pandas(self)

    def to_xarray(self) -> xarray.Dataset:
        """The channels as variables over `time` [s] and `axis`, `angle`, `quaternion`, `rotor` or `quadrotor`.

        Each has `units`, `frame` and `long_name` in its `attrs`, where they say something. Those of the dataset are
        texts: `name`; `mission`, `metrics` and `version` in JSON; `divergence`, if the flight has one.

        Raises:
            InputError: xarray is not installed (extra: xarray).
        """
        return to_xarray(self)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the flight to an .npz file, exactly; the file appears whole or not at all. Returns its path."""
        path = Path(path)
        header = {
            "format": FORMAT,
            "mission": self.mission,
            "metrics": self.results,
            "divergence": _written(self.divergence),
            "version": self.version,
            "channels": {name: self.info(name)._asdict() for name in self.channels},
        }
        text = np.array(json.dumps(header, allow_nan=False))
        with atomic_write(path) as partial, partial.open("wb") as file:
            np.savez(file, header=text, time=self.time, **self.channels)  # type: ignore
        return path

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Flight:
        """Read a flight that `save` wrote.

        Raises:
            InputError: the file is missing, damaged, no flight, or of a newer format.
        """
        path = Path(path)
        try:
            with path.open("rb") as file:
                header, arrays = _read(file)
            flight = _flight(header, arrays)
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
        except OSError as error:
            raise InputError(f"{path}: {error.strerror or error}") from None
        except Exception as error:  # whatever a file of any content can do to the readers of ZIP, NPY and JSON
            raise InputError(f"{path} is damaged or no flight that tandemlift saved ({error})") from error
        return _by_new_names(flight, str(path))


def _written(divergence: Divergence | None) -> list[Any] | None:
    """A divergence for a strict JSON text: its value, which may be nan, as text."""
    return divergence and [divergence.quantity, divergence.time, repr(divergence.value), divergence.limit]


def _read(file: BinaryIO) -> tuple[dict[str, Any], dict[str, Array]]:
    """The header and the arrays of a flight's file."""
    if not zipfile.is_zipfile(file):
        raise InputError("no flight that tandemlift saved, or only a part of one")
    file.seek(0)
    with np.load(file, allow_pickle=False) as content:
        if "header" not in content.files:
            raise InputError("no flight that tandemlift saved: it has no header")
        header = json.loads(str(content["header"]))
        number = header["format"]
        if number > FORMAT:
            raise InputError(f"written by a newer tandemlift: its format is {number}, this one reads up to {FORMAT}")
        return header, {name: content[name] for name in ("time", *header["channels"])}


def _by_new_names(flight: Flight, source: str) -> Flight:
    """A flight that may have been saved before mission keys were renamed."""
    try:
        mission, notices = renamed_tables(flight.mission)
    except InputError as error:
        raise InputError(f"{source}: {error}") from None
    warn_of_old_names(source, notices)
    return replace(flight, mission=mission)


def _flight(header: dict[str, Any], arrays: dict[str, Array]) -> Flight:
    """The flight of a header and its arrays, if they fit each other."""
    time = arrays.pop("time")
    for name, array in {"time": time, **arrays}.items():
        if array.dtype != np.float64 or array.ndim not in (1, 2) or len(array) != len(time):
            raise InputError(f"damaged: channel {name} is {array.dtype} {array.shape}, beside {len(time)} times")
    divergence = header["divergence"]
    if divergence is not None:
        quantity, at, value, limit = divergence
        divergence = Divergence(quantity, at, float(value), limit)
    mission, metrics, version = (dict(header[key]) for key in ("mission", "metrics", "version"))
    return Flight(time, arrays, mission, metrics, divergence, version)
