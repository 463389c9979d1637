"""A flight as a pandas DataFrame or an xarray Dataset: names of components, units, frames, metrics."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any, Protocol

import numpy as np

from tandemlift.core.errors import extra
from tandemlift.core.types import Array
from tandemlift.flight.channels import Channel, column_names, dimensions


class LoggedFlight(Protocol):
    """The attributes of a `Flight` that tables need."""

    @property
    def name(self) -> str:
        """The mission's name."""

    @property
    def time(self) -> Array:
        """Times of the samples [s] (T,)."""

    @property
    def channels(self) -> dict[str, Array]:
        """The channels by name."""

    @property
    def mission(self) -> dict[str, Any]:
        """The tables of the resolved mission."""

    @property
    def ending(self) -> object:
        """Why the flight ended early, or None."""

    @property
    def version(self) -> dict[str, str]:
        """Versions of the software that flew it."""

    def info(self, name: str) -> Channel:
        """Unit, frame and meaning of a channel."""

    def metrics(self) -> dict[str, Any]:
        """The metrics of the flight."""


def columns(flight: LoggedFlight) -> Iterator[tuple[str, Channel, Any]]:
    """Name, channel and values (T,) of every number of every channel."""
    for name, values in flight.channels.items():
        info = flight.info(name)
        for column_name, column in zip(
            column_names(name, info, values.shape[1:]), np.atleast_2d(values.T), strict=True
        ):
            yield column_name, info, column


def to_pandas(flight: LoggedFlight) -> Any:
    """See `Flight.to_pandas`."""
    with extra("pandas", "to_pandas"):
        import pandas
    found = list(columns(flight))
    frame = pandas.DataFrame(
        {name: values for name, _, values in found}, index=pandas.Index(flight.time.copy(), name="time")
    )
    frame.attrs = {
        "name": flight.name,
        "units": {"time": flight.info("time").unit} | {name: info.unit for name, info, _ in found},
        "metrics": flight.metrics(),
        "ending": None if flight.ending is None else str(flight.ending),
    }
    return frame


def to_xarray(flight: LoggedFlight) -> Any:
    """See `Flight.to_xarray`."""
    with extra("xarray", "to_xarray"):
        import xarray
    variables = dict[str, Any]()
    coordinates: dict[str, Any] = {"time": ("time", flight.time.copy(), _attributes(flight.info("time")))}
    for name, values in flight.channels.items():
        info = flight.info(name)
        dims = dimensions(info, values.shape[1]) if values.ndim > 1 else ()
        coordinates |= {d.name: (d.name, list(d.labels), {}) for d in dims}
        shape = [len(flight.time), *[len(d.labels) for d in dims]]
        variables[name] = ["time", *[d.name for d in dims]], values.reshape(shape).copy(), _attributes(info)
    return xarray.Dataset(variables, coordinates, _record(flight))


def _attributes(info: Channel) -> dict[str, str]:
    """Unit, frame and meaning of a channel as attributes, without empty ones."""
    given = {"units": info.unit, "frame": info.frame, "long_name": info.meaning}
    return {name: text for name, text in given.items() if text}


def _record(flight: LoggedFlight) -> dict[str, str]:
    """The mission, metrics and versions of a flight as JSON texts."""
    tables = {"mission": flight.mission, "metrics": flight.metrics(), "version": flight.version}
    texts = {name: json.dumps(table, allow_nan=False) for name, table in tables.items()}
    return {"name": flight.name, **texts} | ({"ending": str(flight.ending)} if flight.ending else {})
