"""The four views of the paper's Figure 9: places of the cameras in Gazebo, and times of their pictures.

They show the vehicle standing at the start, on its path, at the end of the path, and landed. A flight of the same
mission in the compiled engine gives its places at these times.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tandemlift import Flight
from tandemlift.core.phases import GUIDED
from tandemlift.core.types import Array
from tandemlift.engines.models.sdf_elements import FixedCamera, reach_of

DISTANCE = 5.0  # from the vehicle to a camera, as a multiple of the vehicle's reach
ELEVATION, OFFSET = np.radians([34.0, 24.0])  # rad, of a camera above the horizon and beside the way
BEFORE = 1.0  # s, from the last picture to the end
LEAST = 0.5  # m of way that define a direction


class ViewRequest(NamedTuple):
    """A photograph to be taken: its title, the time [s] of the flight, and the camera."""

    title: str
    time: float
    camera: FixedCamera


def views_from(flight: Flight) -> list[ViewRequest]:
    """The four views of a flight, in the order of time.

    Args:
        flight: a flight of the mission, in any engine.
    """
    stands = [bool("contact_force" in flight and flight["contact_force"][k, 2] > 0.0) for k in (0, -1)]
    titles = (
        "standing" if stands[0] else "at the start",
        "on its way",
        "at the end of its way",
        "landed" if stands[1] else "at the end",
    )
    reach = reach_of(flight.mission)
    return [
        ViewRequest(title, float(flight.time[k]), _camera(f"view_{letter}", flight, k, DISTANCE * reach))
        for letter, title, k in zip("abcd", titles, _moments(flight), strict=True)
    ]


def _way(flight: Flight) -> Array:
    """Horizontal length (T,) of the way flown until each sample [m]."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(flight["position"][:, :2], axis=0), axis=1))])


def _moments(flight: Flight) -> tuple[int, int, int, int]:
    """The samples of the four views."""
    way = _way(flight)
    halfway, arrived = (int(np.searchsorted(way, share * way[-1])) for share in (0.5, 0.98))
    if "phase" in flight:
        guided = np.flatnonzero(flight["phase"] == GUIDED)
        arrived = int(guided[-1]) if len(guided) else arrived
    return 0, halfway, max(arrived, halfway), int(np.searchsorted(flight.time, flight.time[-1] - BEFORE))


def _camera(name: str, flight: Flight, k: int, distance: float) -> FixedCamera:
    """A camera that looks at sample k, forward along the way to come, or backward along the way flown."""
    path, way = flight["position"], _way(flight)
    target = path[k]
    ahead = way[k] < 0.75 * way[-1]
    along = _along(flight, k, ahead)
    heading = np.arctan2(along[1], along[0]) + OFFSET
    back = np.array([-np.cos(ELEVATION) * np.cos(heading), -np.cos(ELEVATION) * np.sin(heading), np.sin(ELEVATION)])
    return FixedCamera(name, target + distance * back, target)


def _along(flight: Flight, k: int, ahead: bool) -> Array:
    """Horizontal direction (2,) from sample k to a later position, or from an earlier one; x if it does not move."""
    path = flight["position"][:, :2]
    part = np.arange(k, len(path)) if ahead else np.arange(k, -1, -1)
    apart = np.linalg.norm(path[part] - path[k], axis=1)
    far = np.flatnonzero(apart > LEAST)
    return path[part[far[0]]] - path[k] if len(far) else np.array([1.0 if ahead else -1.0, 0.0])
