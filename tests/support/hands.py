"""Shared by tests of pushes: hands that hold on, and gusts that are none."""

import numpy as np


def gusts(*rows):
    return {"wind.model": "air", "wind.gusts": [dict(zip(("velocity", "start", "rise", "hold"), r)) for r in rows]}  # noqa: B905


def steady(force, start=15.0, lasts=30.0, width=0.2):
    """A steady push as a sum of Gaussians."""
    apart = 0.5 * width
    peak = (np.array(force) * apart / (width * np.sqrt(2.0 * np.pi))).tolist()
    return [{"force": peak, "time": start + apart * (i + 0.5), "sigma": width} for i in range(round(lasts / apart))]
