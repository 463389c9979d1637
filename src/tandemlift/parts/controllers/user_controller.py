"""Controllers by name or file; loading of a user's controller from a Python file."""

from __future__ import annotations

import hashlib
import linecache
import re
import sys
from importlib.util import decode_source
from pathlib import Path
from types import FunctionType, ModuleType

from tandemlift.core.errors import InputError, unknown
from tandemlift.core.law import LAWS
from tandemlift.core.vector import dot
from tandemlift.parts.controllers.registry import CONTROLLERS, Controller, error_text, file_of

_loaded: dict[str, list[Controller]] = {}  # by their modules


def controller(given: str) -> Controller:
    """The registered controller of that name, or the one of a Python file.

    Raises:
        InputError: there is no such controller, or the file defines none.
    """
    if given.endswith(".py") or "/" in given:
        return load_controller(given)
    if given not in CONTROLLERS:
        error = unknown("controller", given, sorted(CONTROLLERS))
        raise InputError(f"{error} One of your own must be loaded first, as with --controller FILE.")
    return CONTROLLERS[given]


def load_controller(path: str | Path) -> Controller:
    """Run a Python file that registers one controller, and return it. An unchanged file runs only once.

    Raises:
        InputError: the file is missing, fails, or registers no controller.
    """
    return run_controller(file_text(path), Path(path).resolve())


def file_text(path: str | Path) -> str:
    """The text of a Python file.

    Raises:
        InputError: it is missing, or no text.
    """
    path = Path(path).resolve()
    if not path.is_file():
        raise InputError(f"controller file {path} does not exist")
    try:
        return decode_source(path.read_bytes())
    except (SyntaxError, UnicodeDecodeError) as error:
        raise InputError(f"controller file {error_text(error, str(path))}") from error


def controller_text(controller: Controller) -> str:
    """The text of the file that registered a controller, as it ran."""
    return "".join(linecache.getlines(file_of(controller)))


def run_controller(text: str, path: Path) -> Controller:
    """Run the text of a file that registers one controller, and return it; nothing is read at `path`, which names it.

    Raises:
        InputError: the text fails, or registers no controller.
    """
    return run_file(text, path, one=True)[1][0]


def run_file(text: str, path: Path, *, one: bool = False) -> tuple[ModuleType, list[Controller]]:
    """Run the text of a file, and return its module and the controllers that it registers; with `one`, it must be one.

    The module is named by its content, so that its compiled loop is found again on disk, wherever it lies.

    Raises:
        InputError: the text fails, or does not register one controller.
    """
    digest = hashlib.sha256(text.encode()).hexdigest()[:12]
    module = ModuleType(f"tandemlift_user_{re.sub(r'[^A-Za-z0-9_]', '_', path.stem)}_{digest}")
    held = _loaded.get(module.__name__)
    if held and all(CONTROLLERS.get(each.name) is each for each in held) and (len(held) == 1 or not one):
        return sys.modules[module.__name__], held
    module.__file__ = str(path)
    before = dict(CONTROLLERS), sys.modules.get(module.__name__)
    sys.modules[module.__name__] = module  # also while it runs: annotations are looked up there
    try:
        code = compile(text, str(path), "exec")
        lines = text.splitlines(True)
        linecache.cache[str(path)] = len(text), None, lines, str(path)  # the traced text, even if the file changes
        exec(code, module.__dict__)
        new = [c for name, c in CONTROLLERS.items() if before[0].get(name) is not c]
        if one and len(new) != 1:
            raise InputError(f"registers {len(new)} controllers; it must register one with @register(NAME, SETTINGS)")
        _check_calls(module)
    except (Exception, SystemExit) as error:
        CONTROLLERS.clear()
        CONTROLLERS.update(before[0])
        sys.modules.pop(module.__name__)
        if before[1] is not None:
            sys.modules[module.__name__] = before[1]
        raise InputError(f"controller file {error_text(error, str(path))}") from error
    _loaded[module.__name__] = new
    return module, new


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
