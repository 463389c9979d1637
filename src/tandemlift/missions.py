"""Missions: from TOML files, with changes on top, to a checked `settings.Mission`, and back.

A file may start from another mission with `extends = "NAME or path"` and change some keys; tables merge, lists are
replaced. Every refusal names the file, the key, the value and what is allowed.
"""

from __future__ import annotations

import copy
import tomllib
import warnings
from collections.abc import Iterable, Mapping
from importlib import resources
from pathlib import Path
from typing import Any

import tomli_w
from pydantic import BaseModel, ValidationError

from tandemlift.errors import FlightWarning, InputError, suggestion, unknown
from tandemlift.laws.controllers import CONTROLLERS, Controller, controller
from tandemlift.settings import Mission
from tandemlift.vehicle import Vehicle

MAX_FILE = 1_000_000  # bytes
MAX_STEPS = 1_000_000_000
MAX_LOG = 4_000_000_000  # bytes
ROW = 8 * 64  # bytes of a logged sample, about

Tables = dict[str, Any]


def built_in() -> dict[str, str]:
    """The built-in missions and their one-line summaries (the first comment of each file)."""
    folder = resources.files("tandemlift") / "data" / "missions"
    files = sorted((f for f in folder.iterdir() if f.name.endswith(".toml")), key=lambda f: f.name)
    return {f.name[:-5]: f.read_text("utf-8").partition("\n")[0].lstrip("# ") for f in files}


def template_text() -> str:
    """A commented mission file with every key, its unit and its meaning."""
    return (resources.files("tandemlift") / "data" / "template.toml").read_text("utf-8")


def _path_of(name: str | Path, beside: Path | None = None) -> Path:
    """The file of a built-in mission, or the path given (relative to the file that names it)."""
    text = str(name)
    if isinstance(name, str) and text in built_in():
        return Path(str(resources.files("tandemlift") / "data" / "missions" / f"{text}.toml"))
    if not text.endswith(".toml") and "/" not in text:
        raise InputError(f"{unknown('mission', text, built_in())} A file of your own ends in .toml.")
    path = Path(text) if beside is None else beside.parent / text
    if not path.is_file():
        raise InputError(f"mission file {path} does not exist")
    return path


def _read(path: Path) -> Tables:
    size = path.stat().st_size
    if size > MAX_FILE:
        raise InputError(f"{path}: {size} bytes; a mission file has at most {MAX_FILE}")
    try:
        return tomllib.loads(path.read_text("utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise InputError(f"{path}: not valid TOML: {error}") from None


def merge(base: Tables, changes: Tables) -> Tables:
    """`base` with `changes` on top: tables merge, everything else is replaced."""
    merged = dict(base)
    for key, value in changes.items():
        both = isinstance(value, dict) and isinstance(merged.get(key), dict)
        merged[key] = merge(merged[key], value) if both else value
    return merged


def _extended(path: Path, seen: tuple[Path, ...] = ()) -> Tables:
    if path.resolve() in seen:
        raise InputError(f"{path}: `extends` comes back to this file")
    tables = _read(path)
    parent = tables.pop("extends", None)
    if parent is None:
        return tables
    if not isinstance(parent, str):
        raise InputError(f"{path}: extends = {parent!r}: must be the name of a built-in mission or a path, in quotes")
    return merge(_extended(_path_of(parent, path), (*seen, path.resolve())), tables)


def _set(tables: Any, key: str, value: Any) -> None:
    """Set one dotted key; a number in it picks an entry of a list."""
    *parents, leaf = key.split(".")
    at = tables
    for depth, part in enumerate(parents):
        if isinstance(at, list):
            at = at[_index(at, part, key)]
            continue
        if part not in at:
            at[part] = {}
        at = at[part]
        if not isinstance(at, (dict, list)):
            raise InputError(f"{key}: {'.'.join(parents[: depth + 1])} is a value, not a table")
    if isinstance(at, list):
        at[_index(at, leaf, key)] = value
    elif leaf:
        at[leaf] = value
    else:
        raise InputError(f"{key!r} is not a dotted key such as controller.gains.xi")


def _index(items: list[Any], part: str, key: str) -> int:
    if not part.isdigit() or int(part) >= len(items):
        raise InputError(f"{key}: {part!r} must be a number from 0 to {len(items) - 1} here")
    return int(part)


def load_mission(
    name: str | Path,
    changes: Mapping[str, Any] | None = None,
    *,
    controller: Controller | str | None = None,
) -> Mission:
    """Load a built-in mission or a TOML file.

    Args:
        name: name of a built-in mission, or path of a TOML file.
        changes: values by dotted key, such as {"mission.duration": 5.0, "pushes.0.force": [1.0, 0.0, 0.0]}.
        controller: fly this controller instead of the mission's, with its own default settings.

    Raises:
        InputError: the mission does not exist, cannot be read or cannot be flown; the message says what is allowed.
    """
    path = _path_of(name)
    source = str(name) if isinstance(name, str) and name in built_in() else str(path)
    tables = copy.deepcopy(_extended(path))
    if controller is not None:
        tables["controller"] = {"name": controller if isinstance(controller, str) else controller.name}
    for key, value in (changes or {}).items():
        _set(tables, key, copy.deepcopy(value))
    return check(tables, source)


def check(tables: Tables, source: str = "mission") -> Mission:
    """A checked mission from nested tables; `source` names them in messages.

    Raises:
        InputError: something is missing, unknown, of the wrong type, out of range, or cannot fly.
    """
    tables = dict(tables)
    try:
        table = tables.get("controller")
        if isinstance(table, dict):
            chosen = _controller_of(table, source)
            tables["controller"] = _validated(chosen.settings, table, tables, source, ("controller",))
        mission = _validated(Mission, tables, tables, source, ())
        _check_flyable(mission, source)
    except RecursionError:
        raise InputError(f"{source}: nested too deeply") from None
    return mission


def _controller_of(table: Tables, source: str) -> Controller:
    name = table.get("name")
    if not isinstance(name, str):
        raise InputError(f"{source}: controller.name = {name!r}: must be one of {', '.join(sorted(CONTROLLERS))}")
    try:
        return controller(name)
    except InputError as error:
        raise InputError(f"{source}: controller.name: {error}") from None


def _validated(model: type[BaseModel], data: Any, root: Any, source: str, prefix: tuple[str, ...]) -> Any:
    try:
        return model.model_validate(data)
    except ValidationError as error:
        lines = [_explain(model, problem, prefix) for problem in error.errors(include_url=False)]
        raise InputError("\n".join(f"{source}: {line}" for line in dict.fromkeys(lines))) from None


def _explain(model: type[BaseModel], problem: Any, prefix: tuple[str, ...]) -> str:
    """One sentence: the key, the value given, and what is allowed."""
    place = [*prefix, *problem["loc"]]
    key = ".".join(map(str, place))
    kind, given, context = problem["type"], problem.get("input"), problem.get("ctx", {})
    if kind == "extra_forbidden":
        known = _keys_at(model, problem["loc"][:-1])
        return f"unknown key {key}; this table has {', '.join(known)}.{suggestion(str(place[-1]), known)}"
    if kind == "missing":
        return f"{key} is missing: it is required"
    allowed = {
        "greater_than": "must be > {gt}",
        "greater_than_equal": "must be ≥ {ge}",
        "less_than": "must be < {lt}",
        "less_than_equal": "must be ≤ {le}",
        "finite_number": "must be a finite number",
        "float_type": "must be a number",
        "int_type": "must be a whole number",
        "int_from_float": "must be a whole number",
        "bool_type": "must be true or false",
        "string_type": "must be a string in quotes",
        "literal_error": "must be {expected}",
        "model_type": "must be a table",
        "tuple_type": "must be a list",
        "string_pattern_mismatch": "must be 1 to 64 letters, digits, '.', '_' or '-', starting with a letter or digit",
    }.get(kind)
    if allowed is None:
        allowed = f"must be {problem['msg']}" if problem["msg"][:1].islower() or kind == "axes" else problem["msg"]
    shown = repr(given) if len(repr(given)) <= 80 else repr(given)[:77] + "…"
    shown = "" if isinstance(given, (dict, BaseModel)) else f" = {shown}"
    near = suggestion(given, _quoted(context)) if kind == "literal_error" and isinstance(given, str) else ""
    return f"{key}{shown}: {allowed.format(**context)}{'.' + near if near else ''}"


def _quoted(context: Mapping[str, Any]) -> Iterable[str]:
    return [part.strip("' ") for part in context.get("expected", "").replace(" or ", ",").split(",")]


def _keys_at(model: type[BaseModel], place: Iterable[Any]) -> list[str]:
    """The keys of the table at a place in a model."""
    at: Any = model
    for part in place:
        if not isinstance(part, str):
            continue
        at = _table_in(at.model_fields[part].annotation)
    return list(at.model_fields)


def _table_in(annotation: Any) -> Any:
    """The table class inside an annotation such as `tuple[Quadrotor, ...]`."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    inner = (_table_in(a) for a in getattr(annotation, "__args__", ()))
    return next((t for t in inner if t is not None), None)


def _check_flyable(m: Mission, source: str) -> None:
    """Refuse what no pilot could fly, and warn of what may fly badly, with the numbers."""
    steps = m.mission.duration / m.mission.step
    if steps > MAX_STEPS:
        raise InputError(
            f"{source}: mission.duration = {m.mission.duration} and mission.step = {m.mission.step} make {steps:.3g} "
            f"steps; at most {MAX_STEPS:.0e} are allowed"
        )
    if m.mission.step > m.mission.duration:
        raise InputError(f"{source}: mission.step = {m.mission.step}: must not be longer than mission.duration")
    size = m.mission.steps / m.mission.log_every * ROW
    if size > MAX_LOG:
        raise InputError(
            f"{source}: mission.log_interval = {m.mission.log_interval} makes a log of {size / 1e9:.3g} GB; at most "
            f"{MAX_LOG / 1e9:.0f} GB: use at least {m.mission.log_interval * size / MAX_LOG:.2g}"
        )
    vehicle = Vehicle.from_settings(m.vehicle)
    try:
        vehicle.H(m.allocation.weights)
    except InputError as error:
        raise InputError(f"{source}: {error}") from None
    _check_admittance(m, source)
    if vehicle.weight > vehicle.max_thrust:
        warnings.warn(
            f"{source}: the vehicle weighs {vehicle.weight:.4g} N and its rotors lift {vehicle.max_thrust:.4g} N; it "
            "flies only because actuators.model is ideal",
            FlightWarning,
            stacklevel=4,
        )


def _check_admittance(m: Mission, source: str) -> None:
    """Refuse an admittance that grows without a push when sampled: an eigenvalue beyond the unit circle."""
    a, h = m.admittance, m.mission.step
    for axis, (M, C, K) in enumerate(zip(a.mass, a.damping, a.stiffness, strict=True)):
        c, k = C / M * h, K / M * h * h
        # z² − (2 − c − k/2) z + 1 − c + k/2: Jury's conditions
        trace, product = 2.0 - c - k / 2.0, 1.0 - c + k / 2.0
        if abs(product) > 1.0 + 1e-12 or abs(trace) > 1.0 + product + 1e-12:
            raise InputError(
                f"{source}: admittance on {'xyz'[axis]} with mass {M:g}, damping {C:g}, stiffness {K:g} is unstable at "
                f"mission.step = {h:g} s: damping must lie between stiffness·step/2 = {K * h / 2:.4g} and about "
                f"2·mass/step = {2 * M / h:.4g} N s/m"
            )


def tables_of(mission: Mission) -> Tables:
    """The mission as nested tables of plain values, all keys resolved; keys that are not set are left out."""
    return mission.model_dump(mode="json", exclude_none=True)


def to_toml(mission: Mission) -> str:
    """The resolved mission as TOML; loading it gives the same mission."""
    return tomli_w.dumps(tables_of(mission))
