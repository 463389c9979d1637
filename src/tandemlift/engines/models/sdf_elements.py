"""Elements of SDF: XML with numbers, poses, colours and shapes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.core.types import Array
from tandemlift.engines.models.visuals import LEVEL, rgba_of

Element = ElementTree.Element


def numbers(values: ArrayLike, digits: int | None = None) -> str:
    """Numbers separated by spaces, with all digits of their float64, or rounded to `digits`."""
    flat = np.ravel(np.asarray(values, dtype=float))
    return " ".join(repr(float(v) + 0.0) for v in (flat if digits is None else np.round(flat, digits)))


def euler_of(R: Array) -> Array:
    """Roll, pitch, yaw (3) [rad] of R = Rz(yaw) Ry(pitch) Rx(roll), the order of SDF, not of missions."""
    yaw = np.arctan2(R[1, 0], R[0, 0])
    c, s = np.cos(yaw), np.sin(yaw)  # exact also at 90° of pitch
    roll = np.arctan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1])
    return np.array([roll, np.arctan2(-R[2, 0], c * R[0, 0] + s * R[1, 0]), yaw])


def add(parent: Element, tag: str, text: str | int | None = None, **attributes: str) -> Element:
    """Add a child with a text and attributes; the child."""
    child = ElementTree.SubElement(parent, tag, attributes)
    child.text = None if text is None else str(text)
    return child


def fill(parent: Element, content: dict[str, Any]) -> None:
    """Add children by name: numbers, text, or a dictionary of children."""
    for tag, value in content.items():
        if isinstance(value, dict):
            fill(add(parent, tag), value)
        else:
            add(parent, tag, value if isinstance(value, (str, int)) else numbers(value))


def pose(parent: Element, position: ArrayLike, R: Array = LEVEL, digits: int | None = None) -> None:
    """Add a pose: position (3) [m] and orientation R (3 × 3)."""
    add(parent, "pose", numbers([*np.asarray(position, dtype=float), *euler_of(R)], digits))


def rgba(color: str, opacity: float = 1.0) -> str:
    """A colour #rrggbb and an opacity as four numbers from 0 to 1."""
    return numbers(rgba_of(color, opacity), 3)


def geometry(parent: Element, kind: str, size: Sequence[float], digits: int | None = None) -> None:
    """Add the geometry of a box, a sphere or a cylinder of a size [m]."""
    names = {"box": ["size"], "sphere": ["radius"], "cylinder": ["radius", "length"]}[kind]
    shape = add(add(parent, "geometry"), kind)
    for name, values in zip(names, [size] if kind == "box" else [[number] for number in size], strict=True):
        add(shape, name, numbers(values, digits))
