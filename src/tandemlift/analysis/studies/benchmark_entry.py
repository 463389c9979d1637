"""Entries of the benchmark: an observer, a controller or a policy, each in one file."""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args

import numpy as np

from tandemlift.core.errors import InputError
from tandemlift.core.plugs import run_file
from tandemlift.core.types import Array
from tandemlift.missions import Mission
from tandemlift.parts.controllers import CONTROLLERS

Kind = Literal["controllers", "observers", "policies"]
KINDS: tuple[Kind, ...] = get_args(Kind)
RECORDED = "kalman"  # the observer that flies with a function
WRENCH, POLICY = "estimator.wrench", "compliance.policy"
NETWORK = {f"{POLICY}.model": "network"}
CHECKSUMS = "SHA256SUMS"
WHAT = (
    "an entry is a .py file that registers one controller or observer, or defines `observer`, or a .toml file with the "
    "weights of a policy, such as tuned.toml of `tandemlift train`"
)


def nothing(table: Any) -> Array:
    """An observer, as a function of a table, that says nothing."""
    return np.zeros((len(table), 6))


class BenchmarkEntry(NamedTuple):
    """An entry of the benchmark.

    Attributes:
        kind: of table that it is scored in.
        name: of the row.
        changes: of every mission that it flies.
        controller: its name, or its file; "" for the mission's.
        function: an observer that is a function of a table (see `benchmark.of_function`); None for others.
        file: of the entry; None for a baseline.
    """

    kind: Kind
    name: str
    changes: dict[str, Any]
    controller: str = ""
    function: Callable[..., Any] | None = None
    file: Path | None = None


def baselines(kind: Kind) -> list[BenchmarkEntry]:
    """The entries of a kind that the package has."""
    if kind == "controllers":
        own = [name for name, c in sorted(CONTROLLERS.items()) if c.start.__module__.startswith("tandemlift.")]
        return [BenchmarkEntry(kind, name, {}, name) for name in own]
    if kind == "observers":
        observers = Mission.model_fields["estimator"].annotation.model_fields["wrench"].annotation  # type: ignore[union-attr]
        found = [BenchmarkEntry(kind, name, {WRENCH: name}) for name in get_args(observers)]
        return [*found, BenchmarkEntry(kind, "zero", {WRENCH: RECORDED}, function=nothing)]
    return [
        BenchmarkEntry(kind, "damping of 1.6 N s/m", {f"{POLICY}.model": "none"}),
        BenchmarkEntry(kind, "damping of 1.0 N s/m", {f"{POLICY}.model": "none", "admittance.damping": 1.0}),
        BenchmarkEntry(kind, "the policy that ships", NETWORK),
    ]


def entry_of(file: Path) -> BenchmarkEntry:
    """The entry in a file.

    Raises:
        InputError: there is no such file, or it holds none, or more than one, or has the name of a baseline.
    """
    if file.stem in [one.name for kind in KINDS for one in baselines(kind)]:
        raise InputError(f"{file}: a baseline has this name: rename the file")
    if file.suffix == ".toml":
        return _policy(file)
    if file.suffix != ".py":
        raise InputError(f"{file}: {WHAT}")
    loaded = run_file(file, "file")
    function = vars(loaded.module).get("observer")
    laws = {name: kind for kind, name, _ in loaded.entries if kind in ("controller", "observer")}
    found = [f"the {kind} {name!r}" for name, kind in laws.items()] + ["an observer"] * callable(function)
    if len(found) != 1:
        raise InputError(f"{file.name} holds {' and '.join(found) or 'no entry'}; it must hold one: {WHAT}")
    if callable(function):
        return BenchmarkEntry("observers", file.stem, {WRENCH: RECORDED}, function=function, file=file)
    ((name, kind),) = laws.items()
    if kind == "controller":
        return BenchmarkEntry("controllers", file.stem, {}, str(file.resolve()), file=file)
    return BenchmarkEntry("observers", file.stem, {WRENCH: name}, file=file)


def _policy(file: Path) -> BenchmarkEntry:
    try:
        weights = tomllib.loads(file.read_text("utf-8"))["compliance"]["policy"]["weights"]
    except (OSError, ValueError) as error:
        raise InputError(f"{file}: {getattr(error, 'strerror', None) or error}") from None
    except (KeyError, TypeError):
        raise InputError(f"{file}: has no weights in [compliance.policy]; {WHAT}") from None
    return BenchmarkEntry("policies", file.stem, {**NETWORK, f"{POLICY}.weights": weights}, file=file)


def checked_folder(folder: Path) -> int:
    """The number of files of the benchmark's folder, each with the checksum that `SHA256SUMS` says.

    Raises:
        InputError: a file is missing, or is another one.
    """
    sums = folder / CHECKSUMS
    if not sums.is_file():
        raise InputError(f"{folder}: must be the folder of the benchmark, with its {CHECKSUMS}, or a file; {WHAT}")
    lines = [line.split("  ", 1) for line in sums.read_text("utf-8").splitlines()]
    for digest, name in lines:
        path = folder / name
        if not path.is_file():
            raise InputError(f"{path}: is missing; {CHECKSUMS} names it")
        with path.open("rb") as file:
            if hashlib.file_digest(file, "sha256").hexdigest() != digest:
                raise InputError(f"{path}: is not the file of the benchmark: its checksum differs from {CHECKSUMS}")
    return len(lines)
