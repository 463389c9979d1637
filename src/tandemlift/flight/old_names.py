"""Names that changed after e5ecfdc: mission keys, choices and channels, each old name with its new one.

This is the only place that knows an old name. Whatever takes names from outside (a mission file, the mission in
`flight.npz`, `--set`) has them translated here, and warns of what was renamed.
"""

from __future__ import annotations

import functools
import warnings
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from tandemlift.common.errors import FlightWarning, InputError
from tandemlift.common.toml import MAX_PARTS, too_deep

KEYS: dict[str, str] = {
    "compliance.hearing": "compliance.input_bandwidth",
    "compliance.easing": "compliance.output_bandwidth",
    "compliance.release": "compliance.release_fraction",
    "compliance.forget": "compliance.bias_time_constant",
    "compliance.braking": "compliance.braking_gain",
    "compliance.thrust_share": "compliance.thrust_fraction",
    "compliance.lead": "compliance.reference_lead",
    "compliance.press": "compliance.touchdown_depth",
    "compliance.spool": "compliance.spin_up_time",
    "compliance.max_descent": "compliance.max_descent_speed",
    "compliance.yaw.leash": "compliance.yaw.max_lead_angle",
    "compliance.tank.size": "compliance.tank.capacity",
    "compliance.tank.low": "compliance.tank.low_energy",
    "compliance.tank.refill": "compliance.tank.refill_fraction",
    "compliance.tank.fade": "compliance.tank.fade_time",
    "detection.forget": "detection.bias_bandwidth",
    "detection.habit": "detection.scatter_bandwidth",
    "detection.spread": "detection.thrust_uncertainty",
    "detection.evidence": "detection.threshold",
    "detection.margin": "detection.isolation_margin",
    "detection.unexplained": "detection.unexplained_fraction",
    "detection.retest": "detection.retest_time",
    "estimator.least_force": "estimator.min_force",
    "supervision.patience": "supervision.hold_timeout",
    "supervision.calm": "supervision.recovery_time",
    "supervision.deeper": "supervision.blind_descent_depth",
    "supervision.sinking": "supervision.blind_descent_acceleration",
    "supervision.touch": "supervision.touchdown_gap",
    "supervision.checks.thrust_share": "supervision.checks.thrust_fraction",
    "supervision.checks.payload_least": "supervision.checks.min_payload_ratio",
    "supervision.checks.payload_most": "supervision.checks.max_payload_ratio",
    "supervision.watch": "supervision.watchdog",
    "supervision.watch.stale": "supervision.watchdog.stale_time",
    "supervision.watch.invalid": "supervision.watchdog.invalid_time",
    "supervision.watch.frozen": "supervision.watchdog.frozen_samples",
    "supervision.watch.force": "supervision.watchdog.max_force",
    "supervision.watch.torque": "supervision.watchdog.max_torque",
    "supervision.watch.specific_force": "supervision.watchdog.max_specific_force",
    "supervision.watch.rates": "supervision.watchdog.max_rates",
    "supervision.watch.position": "supervision.watchdog.max_position",
    "supervision.watch.velocity": "supervision.watchdog.max_velocity",
    "supervision.watch.turn_bandwidth": "supervision.watchdog.rates_bandwidth",
    "supervision.watch.way_bandwidth": "supervision.watchdog.velocity_bandwidth",
    "supervision.fence.slowing": "supervision.fence.braking_gain",
    "supervision.limits.thrust_share": "supervision.limits.thrust_fraction",
    "supervision.limits.error": "supervision.limits.tracking_error",
    "supervision.limits.error_time": "supervision.limits.tracking_error_time",
    "supervision.reactions.unit": "supervision.reactions.imu",
    "supervision.reactions.joints_apart": "supervision.reactions.joints_inconsistent",
    "supervision.reactions.attitude_apart": "supervision.reactions.attitude_inconsistent",
    "supervision.reactions.velocity_apart": "supervision.reactions.velocity_inconsistent",
    "supervision.reactions.speed_apart": "supervision.reactions.speed_inconsistent",
    "supervision.reactions.error": "supervision.reactions.tracking_error",
    "partner": "person",
    "partner.approach": "person.approach_gain",
    "partner.breakaway": "person.breakaway_force",
    "partner.trimming": "person.trim_rate",
    "partner.corner": "person.corner_distance",
    "partner.arrive": "person.arrival_radius",
    "partner.slow": "person.landing_speed",
    "partner.turn_gain": "person.yaw_gain",
    "partner.turn_damping": "person.yaw_damping",
    "partner.start": "person.start_time",
    "partner.height_share": "person.height_fraction",
}
"""A mission key's old dotted name and its new one; lists have no number in it. A table brings what is in it along."""

VALUES: dict[str, dict[str, str]] = {"sensor_faults.sensor": {"unit": "imu"}}
"""By a mission key's new dotted name: choices that it had under another name."""

CHANNELS: dict[str, str] = {
    "allocation_share": "allocation_fraction",
    "disturbance_turning_residual": "disturbance_angular_residual",
    "push_heard": "push_filtered",
    "push_on": "push_active",
    "refused": "failed_check",
    "rotor_lost": "failed_rotor",
}
"""A channel's old name and its new one."""

TOPICS: dict[str, str] = {"/tandemlift/push/heard": "/tandemlift/push/filtered"}
"""An old name of a topic in a bag and its new one."""

MOST_NAMED, FIRST = 8, 3  # renamed things that a warning names: all of so many, else the first

_IN_TABLE = {(new.rpartition(".")[0], old.rpartition(".")[2]): new.rpartition(".")[2] for old, new in KEYS.items()}
_PLACES = {  # of all that was renamed, and of the tables around it, by their new names
    ".".join(parts[:depth]) for parts in (name.split(".") for name in (*KEYS.values(), *VALUES)) for depth in range(9)
}


class _At(NamedTuple):
    """A place in a mission, as it was given and by its new name; numbers of list entries are left out."""

    given: tuple[str, ...] = ()
    now: tuple[str, ...] = ()

    def key(self, name: str) -> _At:
        """A key of the table at this place."""
        return _At((*self.given, name), (*self.now, _IN_TABLE.get((".".join(self.now), name), name)))


def _at(key: str) -> _At:
    at = _At()
    for part in key.split("."):
        at = at if part.isdigit() else at.key(part)
    return at


@functools.lru_cache(maxsize=1024)
def renamed_key(key: str) -> str:
    """A dotted key of a mission by its new name; numbers in it, which pick entries of lists, stay.

    Raises:
        InputError: it has more parts than any key.
    """
    if key.count(".") >= MAX_PARTS:
        raise too_deep(key)
    names = iter(_at(key).now)
    return ".".join(part if part.isdigit() else next(names) for part in key.split("."))


def renamed_tables(tables: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """A mission's nested tables by their new names, and a sentence for each old name.

    Raises:
        InputError: a table has a key by its old and its new name at once.
    """
    notices = list[str]()
    new = _renamed(tables, _At(), notices)
    if isinstance(new.get("changes"), list):
        new["changes"] = [_renamed_change(change, notices) for change in new["changes"]]
    return new, list(dict.fromkeys(notices))


def renamed_setting(key: str, value: Any) -> tuple[str, Any, list[str]]:
    """A dotted key and its value by their new names, and a sentence for each old name.

    Raises:
        InputError: the value is a table that has a key by its old and its new name at once.
    """
    new = renamed_key(key)
    notices = [] if new == key else [_notice(key, new)]
    return new, _renamed(value, _at(key), notices) if isinstance(value, (str, list, Mapping)) else value, notices


def renamed_channels(channels: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Channels by their new names, in the same order, and a sentence for each old name.

    Raises:
        InputError: there is a channel by its old and its new name at once.
    """
    old = [name for name in channels if name in CHANNELS]
    for name in old:
        if CHANNELS[name] in channels:
            raise _both(name, CHANNELS[name])
    notices = [f"channel {_notice(name, CHANNELS[name])}" for name in old]
    return {CHANNELS.get(name, name): values for name, values in channels.items()}, notices


def renamed_channel(name: str) -> str:
    """A channel by its new name."""
    return CHANNELS.get(name, name)


def renamed_topic(name: str) -> str:
    """A topic of a bag by its new name."""
    return TOPICS.get(name, name)


def check_said_once(changes: Iterable[str]) -> None:
    """Refuse dotted keys that are given by their old and their new name at once.

    Raises:
        InputError: with both names.
    """
    given = {key for key in changes if isinstance(key, str)}
    for key in given:
        new = renamed_key(key)
        if new != key and new in given:
            raise _both(key, new)


def warn_of_old_names(source: str, notices: list[str]) -> None:
    """Warn in one line of the old names that a source uses, if there are any; of many, the first and their number."""
    if len(notices) > MOST_NAMED:
        more = f"and {len(notices) - FIRST} others were renamed; `tandemlift explain OLD_KEY` prints a new name"
        notices = [*notices[:FIRST], more]
    if notices:
        warnings.warn(f"{source}: {', '.join(notices)}", FlightWarning, stacklevel=3)


def _notice(old: str, new: str) -> str:
    return f"{old} was renamed to {new}"


def _both(old: str, new: str) -> InputError:
    return InputError(f"{old} and {new}: must not both be given: {_notice(old, new)}")


def _renamed(value: Any, at: _At, notices: list[str]) -> Any:
    """What stands at a place, by its new names."""
    if ".".join(at.now) not in _PLACES:
        return value
    if isinstance(value, Mapping):
        return dict(_items(value, at, notices))
    if isinstance(value, list):
        return [_renamed(entry, at, notices) for entry in value]
    new = VALUES.get(".".join(at.now), {}).get(value) if isinstance(value, str) else None
    if new is not None:
        notices.append(_notice(f'{".".join(at.given)} = "{value}"', f'"{new}"'))
    return value if new is None else new


def _items(table: Mapping[str, Any], at: _At, notices: list[str]) -> Iterator[tuple[str, Any]]:
    """The items of the table at a place, by their new names."""
    for key, value in table.items():
        if not isinstance(key, str):
            yield key, value
            continue
        inner = at.key(key)
        old, new = ".".join(inner.given), ".".join(inner.now)
        if inner.now[-1] != key:
            if inner.now[-1] in table:
                raise _both(old, new)
            notices.append(_notice(old, new))
        yield inner.now[-1], _renamed(value, inner, notices)


def _renamed_change(change: Any, notices: list[str]) -> Any:
    """One of `[[changes]]`, whose key and value are those of a mission."""
    if not isinstance(change, dict) or not isinstance(change.get("key"), str):
        return change  # which the key's own rules explain
    key, value, more = renamed_setting(change["key"], change.get("value"))
    notices.extend(more)
    return {**change, "key": key} | ({"value": value} if "value" in change else {})
