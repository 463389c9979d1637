"""What users bring, and the parts of the package beside it: one registry for each kind of part.

A plugin is a Python file, or an installed package with an entry point of the group `tandemlift`; what it registers is
chosen by name. A mission lists its plugins with name, text and digest, and so do records, studies and their workers.
The text of a record is never run: whoever flies it again gives the file.
"""

from __future__ import annotations

import hashlib
import importlib
import inspect
import json
import linecache
import os
import re
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache, partial
from importlib.util import decode_source
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any, NamedTuple, TypeVar

from tandemlift.core.caching import forget
from tandemlift.core.errors import InputError, unknown
from tandemlift.core.law import CHOICES, LAWS
from tandemlift.core.vector import dot

F = TypeVar("F", bound=Callable[..., Any])
KINDS = ("controller", "observer", "sensor", "gate", "engine", "metric", "figure")
GROUP = "tandemlift"  # of entry points
STUDY = "<study>"  # folder of the files that came with a study
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,63}")


class Plug(NamedTuple):
    """A part that was brought.

    Attributes:
        kind: of `KINDS`.
        name: by which it is chosen.
        summary: the first line of its docstring.
        start: what was registered.
        table: type of its settings, if it has some.
    """

    kind: str
    name: str
    summary: str
    start: Any
    table: Any = None


class Registry(dict[str, Any]):
    """The parts of a kind by name, and the function that registered each."""

    def __init__(self, kind: str) -> None:
        super().__init__()
        self.kind, self.made_by = kind, dict[str, Any]()
        self._take: Callable[[Plug], Any] = lambda made: made

    def open(self, take: Callable[[Plug], Any]) -> None:
        """Make parts of what is registered, by the module of the kind, which may be imported after a plugin."""
        self._take = take
        self.update({name: take(made) for name, made in self.items() if isinstance(made, Plug)})

    def take(self, made: Plug) -> None:
        """Add what is registered."""
        self.enter(made.name, self._take(made), made.start)

    def enter(self, name: str, entry: Any, made_by: Any) -> None:
        """Add a part. Registering a name again replaces the part if it comes from the same file or module.

        Raises:
            InputError: the name is no name, or another file or module has it.
        """
        if not isinstance(name, str) or not NAME.fullmatch(name):
            raise InputError(
                f"{_one(self.kind)} cannot be named {name!r}: letters, digits, '_' and '-', a letter first"
            )
        if name in self:
            held = self.made_by.get(name, made_by)
            if not _in_one_place(held, made_by):
                where = Path(file_of(held)).name
                raise InputError(f"the name {name!r} is taken by the {self.kind} in {where}; choose another")
        if not is_of_the_package(made_by):
            forget()
        self[name], self.made_by[name] = entry, made_by

    def own(self, name: str) -> bool:
        """Whether a part of that name is there, and was brought by a user."""
        return name in self and name in self.made_by and not is_of_the_package(self.made_by[name])


PLUGS = {kind: Registry(kind) for kind in KINDS}


def plug(kind: str, name: str, table: Any = None) -> Callable[[F], F]:
    """Register what a user brings.

    Args:
        kind: "controller", "observer", "sensor", "gate", "engine", "metric" or "figure".
        name: by which a mission, an option or a table names it.
        table: of a controller: the class of its settings; of a sensor: its row (`parts.sensors.vehicle_sensors`).

    Raises:
        InputError: there is no such kind, the name is taken or no name, or the part is not of its form.
    """
    if kind not in KINDS:
        raise unknown("kind of plug", kind, KINDS)

    def keep(part: F) -> F:
        summary = (inspect.getdoc(part) or "").partition("\n")[0]
        PLUGS[kind].take(Plug(kind, name, summary, part, table))
        return part

    return keep


def _one(kind: str) -> str:
    return f"{'an' if kind[0] in 'aeiou' else 'a'} {kind}"


def file_of(part: Any) -> str:
    """The file that defines a function, or a class."""
    code = getattr(inspect.unwrap(part), "__code__", None)
    return code.co_filename if code else str(getattr(sys.modules.get(part.__module__), "__file__", ""))


def is_of_the_package(part: Any) -> bool:
    """Whether a function or class is built in."""
    return str(getattr(part, "__module__", "")).startswith("tandemlift.")


def _in_one_place(held: Any, new: Any) -> bool:
    if held.__module__ == new.__module__:
        return True
    files = file_of(held), file_of(new)
    return not is_of_the_package(held) and (files[0] == files[1] or all(f.startswith(STUDY) for f in files))


# ---- Plugins: files and packages


class PluginText(NamedTuple):
    """What missions, records and studies hold of a plugin.

    Attributes:
        name: of the file, or of the entry point.
        digest: SHA-256 of the text; of a package, of all its sources.
        text: its source, as it ran; of a package, that of its module.
    """

    name: str
    digest: str
    text: str


class Plugin(NamedTuple):
    """A file or package that was loaded.

    Attributes:
        said: its name, digest and text.
        module: that it became.
        entries: kind and name of all that it registered, and the function that was.
    """

    said: PluginText
    module: ModuleType | None
    entries: tuple[tuple[str, str, Any], ...]

    @property
    def is_current(self) -> bool:
        """Whether all that it registered is registered still."""
        return all(name in PLUGS[kind] and PLUGS[kind].made_by[name] is part for kind, name, part in self.entries)

    def parts(self, kind: str) -> list[Any]:
        """What it registered of a kind."""
        return [PLUGS[of][name] for of, name, _ in self.entries if of == kind]


_loaded: dict[tuple[str, str], Plugin] = {}  # by name and digest
GIVEN: list[Plugin] = []
"""Plugins of the command that runs: each of its missions lists them."""


def load_plugin(path: str | os.PathLike[str]) -> Plugin:
    """Run a Python file that registers parts, and return what it brings. An unchanged file runs only once.

    Raises:
        InputError: the file is missing, can be changed by others, or fails, or registers nothing; or another file has
            registered such a name. Nothing of it is then registered.
    """
    loaded = run_file(path)
    if not loaded.entries:
        raise InputError(f"plugin {Path(path).name} registers nothing; register with @plug(KIND, NAME)")
    return loaded


def run_file(path: str | os.PathLike[str], what: str = "plugin") -> Plugin:
    """Run a Python file, whether it registers parts or not; `what` it is, in messages.

    Raises:
        InputError: as of `file_text` and `run_text`.
    """
    return run_text(file_text(path, what), Path(path).resolve(), what)


def file_text(path: str | os.PathLike[str], what: str = "plugin") -> str:
    """The text of a Python file.

    Raises:
        InputError: it is missing, or no text, or others can change it.
    """
    path = Path(path).resolve()
    if not path.is_file():
        raise InputError(f"{what} {path} does not exist")
    for place in (path, path.parent):
        status = place.stat()
        sticky = place != path and status.st_mode & 0o1000  # as of /tmp: others cannot change what is there
        group = status.st_mode & 0o020 and hasattr(os, "getegid") and status.st_gid != os.getegid()
        if hasattr(os, "geteuid") and (status.st_mode & 0o002 or group) and not sticky:
            raise InputError(f"{what} {path}: others can write {place}, and so decide what runs; chmod go-w {place}")
    try:
        return decode_source(path.read_bytes())
    except (SyntaxError, UnicodeDecodeError) as error:
        raise InputError(f"{what} {error_text(error, str(path))}") from error


def run_text(text: str, path: Path, what: str = "plugin", check: Callable[[Plugin], None] | None = None) -> Plugin:
    """Run the text of a plugin; nothing is read at `path`, which names it.

    The module is named by its content, so that its compiled loop is found again on disk, wherever it lies.

    Args:
        text: of the file.
        path: of the file.
        what: it is, in messages.
        check: raises if it is not as it must be.

    Raises:
        InputError: the text fails. Nothing of it is then registered.
    """
    digest = hashlib.sha256(text.encode()).hexdigest()
    held = _loaded.get((path.name, digest))
    if held and held.module and held.is_current:
        if check:
            check(held)
        return held
    module = ModuleType(f"tandemlift_user_{re.sub(r'[^A-Za-z0-9_]', '_', path.stem)}_{digest[:12]}")
    module.__file__ = str(path)

    def run() -> ModuleType:
        code = compile(text, str(path), "exec")
        linecache.cache[str(path)] = len(text), None, text.splitlines(True), str(path)  # as it ran, even if it changes
        sys.modules[module.__name__] = module  # also while it runs: annotations are looked up there
        exec(code, module.__dict__)
        return module

    try:
        with _all_or_nothing(module.__name__):
            loaded = _brought(run, lambda _: PluginText(path.name, digest, text))
            _check_calls(module)
            if check:
                check(loaded)
    except (Exception, SystemExit) as error:
        raise InputError(f"{what} {error_text(error, str(path))}") from error
    _loaded[path.name, digest] = loaded
    return loaded


def _brought(run: Callable[[], ModuleType], said: Callable[[ModuleType], PluginText]) -> Plugin:
    """What a module registers while it runs, or has registered before."""
    before = {kind: dict(registry.made_by) for kind, registry in PLUGS.items()}
    module = run()
    entries = [
        (kind, name, part)
        for kind, registry in PLUGS.items()
        for name, part in registry.made_by.items()
        if registry.own(name) and (before[kind].get(name) is not part or part.__module__ == module.__name__)
    ]
    return Plugin(said(module), module, tuple(entries))


@contextmanager
def _all_or_nothing(name: str) -> Iterator[None]:
    """A context after whose errors nothing is registered, and no module of that name is there, that was not before."""
    tables: list[dict[Any, Any]] = [
        *PLUGS.values(),
        *(registry.made_by for registry in PLUGS.values()),
        *(c.table for c in CHOICES),
    ]
    before, laws, module = [dict(table) for table in tables], len(LAWS), sys.modules.get(name)
    try:
        yield
    except BaseException:
        own = [[key for key, made in table.items() if not _is_first_seen(table, key, made)] for table in tables]
        for table, keys, old in zip(tables, own, before, strict=True):
            for key in keys:
                del table[key]
            table.update(old)
        LAWS[laws:] = filter(is_of_the_package, LAWS[laws:])
        sys.modules.pop(name, None)
        if module is not None:
            sys.modules[name] = module
        raise


def _is_first_seen(table: Any, key: Any, made: Any) -> bool:
    """Whether a part is one of the package, whose module the plugin may have been the first to import."""
    return not table.own(key) if isinstance(table, Registry) else is_of_the_package(made)


def _check_calls(module: ModuleType) -> None:
    """Reject a law that calls a function that is not a law, which the compiler could not trace."""
    laws = set(map(id, LAWS))
    for function in LAWS:
        if function.__globals__ is not module.__dict__:
            continue
        for name in function.__code__.co_names:
            called = module.__dict__.get(name)
            if isinstance(called, FunctionType) and called is not dot and id(called) not in laws:
                line = function.__code__.co_firstlineno
                raise InputError(f"{function.__name__}() in line {line} calls {name}(), which is no law: mark it @law")


def _entry_points() -> dict[str, Any]:
    from importlib.metadata import entry_points

    return {point.name: point for point in entry_points(group=GROUP)}


def load_installed(name: str) -> Plugin:
    """Import an installed package by the name of its entry point, and return what it brings.

    Raises:
        InputError: there is no such entry point, or its package fails; nothing of it is then registered.
    """
    points = _entry_points()
    if name not in points:
        known = ", ".join(sorted(points)) or "none"
        raise InputError(f"plugin {name!r}: no installed package has it; there is {known}. A file's name ends in .py.")
    try:
        with _all_or_nothing(points[name].module):
            run = partial(importlib.import_module, points[name].module)
            loaded = _brought(run, lambda module: _sources(name, module))
    except (Exception, SystemExit) as error:
        raise InputError(f"plugin {name!r}: its package fails: {type(error).__name__}: {error}") from error
    return _loaded.setdefault(loaded.said[:2], loaded)


def _sources(name: str, module: ModuleType) -> PluginText:
    """The text of a package's module, and the digest of all its sources."""
    file = Path(str(module.__file__))
    files = sorted(file.parent.rglob("*.py")) if file.name == "__init__.py" else [file]
    digest = hashlib.sha256()
    for one in files:
        digest.update(one.relative_to(file.parent).as_posix().encode() + b"\0" + one.read_bytes() + b"\0")
    return PluginText(name, digest.hexdigest(), file.read_text("utf-8"))


@cache
def load_all_installed() -> None:
    """Import the packages that have entry points, once: before a name is called unknown, or all are listed.

    Raises:
        InputError: a package fails.
    """
    for name in sorted(_entry_points()):
        load_installed(name)


def has(kind: str, name: object) -> bool:
    """Whether there is a part of that name, in an installed package if nowhere else."""
    if isinstance(name, str) and name not in PLUGS[kind]:
        load_all_installed()
    return isinstance(name, str) and name in PLUGS[kind]


class Chosen:
    """Marks a key of missions that names a part of a kind: one of its choices, or one that a user has brought."""

    def __init__(self, kind: str) -> None:
        self.kind = kind

    def names(self, built_in: Iterable[str]) -> list[str]:
        """Its choices, and what users have brought."""
        return [*built_in, *(name for name in PLUGS[self.kind] if PLUGS[self.kind].own(name))]

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        from pydantic_core import core_schema

        as_text = core_schema.to_string_ser_schema()
        return core_schema.no_info_wrap_validator_function(self._chosen, handler(source), serialization=as_text)

    def _chosen(self, value: Any, built_in: Callable[[Any], Any]) -> Any:
        try:
            return built_in(value)
        except ValueError:  # as pydantic's are; a known flight never loads it
            if has(self.kind, value):
                return value
            raise


# ---- What a mission lists


def plugin_of(kind: str, name: object) -> Plugin | None:
    """The plugin that brought a part; None of one that is built in, or not there."""
    registry = PLUGS[kind]
    if not isinstance(name, str) or not registry.own(name):
        return None
    made_by = registry.made_by[name]
    for held in _loaded.values():
        if (kind, name, made_by) in held.entries:
            return held
    file = file_of(made_by)  # registered by a script or a notebook
    text = "".join(linecache.getlines(file))
    own = [(k, n, r.made_by[n]) for k, r in PLUGS.items() for n in r if r.own(n) and file_of(r.made_by[n]) == file]
    said = PluginText(Path(file).name, hashlib.sha256(text.encode()).hexdigest(), text)
    made = _loaded[said[:2]] = Plugin(said, None, tuple(own))
    return made


def plugins_in(text: str) -> list[Plugin]:
    """The plugins that brought the parts that a JSON text names."""
    named = [(kind, name) for kind in KINDS for name in sorted(PLUGS[kind]) if json.dumps(name) in text]
    return [plugin for kind, name in named if (plugin := plugin_of(kind, name))]


def load_sent(said: PluginText) -> None:
    """Load a plugin that came with a study: run the text of a file, or import an installed package.

    Raises:
        InputError: it fails, or the package is another one here.
    """
    if said.name.endswith(".py"):
        run_text(said.text, Path(STUDY, said.digest[:16], Path(said.name).name))
    else:
        listed(said._asdict())


def listed(said: Any) -> Plugin:
    """The plugin that an entry of `plugins` names: the path of a file, the name of an entry point, or what a mission
    holds of a loaded one.

    Raises:
        InputError: it cannot be loaded, or is not the one that is loaded.
    """
    if isinstance(said, str):
        return load_plugin(said) if said.endswith(".py") or "/" in said else load_installed(said)
    if not isinstance(said, Mapping) or not all(isinstance(said.get(key), str) for key in PluginText._fields):
        raise InputError(f"plugins: {said!r:.80} must be the path of a Python file, in quotes")
    name, digest = said["name"], said["digest"]
    held = _loaded.get((name, digest))
    if held and held.is_current:
        return held
    if not name.endswith(".py"):
        load_installed(name)
        if held := _loaded.get((name, digest)):
            return held
    others = [one for (own, _), one in _loaded.items() if own == name and one.is_current]
    if others:
        raise InputError(
            f"plugins: {name} has changed since this was made: its digest was {digest[:16]}, that of the one loaded is "
            f'{others[-1].said.digest[:16]}; to fly the new one, set plugins = ["{name}"], or load the mission again'
        )
    raise InputError(
        f"plugins: {name} with the digest {digest[:16]} is not loaded: give it by --plugin {name}, or load_plugin; its "
        "text is beside the digest"
    )


# ---- Errors


def explained(error: Exception) -> Exception:
    """The error of what a user has brought, with the line of its file; any other error unchanged."""
    if isinstance(error, InputError):
        return error
    files = {frame.filename for frame in traceback.extract_tb(error.__traceback__)}
    for kind, registry in PLUGS.items():
        for name in registry:
            if registry.own(name) and (file := file_of(registry.made_by[name])) in files:
                return InputError(f"{kind} {name!r} fails: {error_text(error, file)}")
    return error


def error_text(error: BaseException, file: str) -> str:
    """An error in one line, with its line in the file."""
    name, kind = Path(file).name, "" if isinstance(error, InputError) else f"{type(error).__name__}: "
    lines: list[Any] = [f.lineno for f in traceback.extract_tb(error.__traceback__) if f.filename == file]
    said: object = error
    if isinstance(error, SyntaxError) and error.filename == file:
        lines, said = [error.lineno], error.msg
    return f"{name}{f', line {lines[-1]}' if lines else ''}: {kind}{said}"
