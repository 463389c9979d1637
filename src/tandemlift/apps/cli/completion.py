"""Completion of arguments and options by shells, given to them as `shell_complete=`, and the words that it offers.

It reads names and folders, and never flies, compiles or writes.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable
from functools import cache
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import click
from click.shell_completion import CompletionItem

from tandemlift.core.files import DATA

SCRIPTS = {shell: DATA / "completion" / f"tandemlift.{shell}" for shell in ("bash", "zsh", "fish")}
"""Each asks the program itself, by click's protocol: it calls it with the words so far in the environment. Unlike after
click's own scripts, no space follows a word that goes on (`admittance.`, `KEY=`), and where the program knows no word,
the shell's own names of files are offered."""

Completion = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def names(*kinds: str, files: Iterable[str] = ()) -> Completion:
    """Completes words of some kinds (`words`), folders, and files with some endings."""

    def complete(_: click.Context, __: click.Parameter, begun: str) -> list[CompletionItem]:
        known = [item for kind in kinds for item in known_words()[kind].items()]
        return _beginning_with(begun, known) + (_paths(begun, tuple(files)) if files else [])

    return complete


def separated(complete: Completion) -> Completion:
    """Completes the last of several words that are separated by commas."""

    def complete_last(ctx: click.Context, parameter: click.Parameter, begun: str) -> list[CompletionItem]:
        before, comma, last = begun.rpartition(",")
        found = complete(ctx, parameter, last)
        return [CompletionItem(f"{before}{comma}{item.value}", help=item.help) for item in found]

    return complete_last


def settings(_: click.Context, __: click.Parameter, begun: str) -> list[CompletionItem]:
    """Completes KEY= of a mission's keys, one table at a time."""
    return [] if "=" in begun else _dotted(begun, "=")


def keys(_: click.Context, __: click.Parameter, begun: str) -> list[CompletionItem]:
    """Completes keys and tables of missions, one table at a time."""
    tables = {name: text for name, text in known_words()["table"].items() if name == begun}
    return _beginning_with(begun, tables.items()) + _dotted(begun, "")


def _beginning_with(begun: str, known: Iterable[tuple[str, str]]) -> list[CompletionItem]:
    return [CompletionItem(name, help=text) for name, text in known if name.startswith(begun)]


def _dotted(begun: str, end: str) -> list[CompletionItem]:
    """Dotted keys, up to the next dot; a whole key is followed by `end`."""
    depth, words = begun.count("."), known_words()
    found: dict[str, str] = {}
    for name, text in words["key"].items():
        parts = name.split(".")
        if name.startswith(begun) and len(parts) > depth:
            short = ".".join(parts[: depth + 1])
            whole = len(parts) == depth + 1
            found.setdefault(short + (end if whole else "."), text if whole else words["table"].get(short, ""))
    return _beginning_with("", found.items())


def _paths(begun: str, endings: tuple[str, ...]) -> list[CompletionItem]:
    """Folders, and files with some endings, whose path begins so, except for unreadable ones."""
    folder, name = os.path.split(begun)
    try:
        entries = sorted(Path(os.path.expanduser(folder) or ".").iterdir())
    except OSError:
        return []
    shown = [entry for entry in entries if entry.name.startswith(name) and (name or not entry.name.startswith("."))]
    texts = [(os.path.join(folder, entry.name), entry.is_dir()) for entry in shown]
    return [CompletionItem(text + "/" * is_folder) for text, is_folder in texts if is_folder or text.endswith(endings)]


MISSIONS = names("mission", files=[".toml", ".zip"])
FLIGHTS = names(files=[".npz", ".zip", ".mcap", ".bag"])
FLIGHTS_AND_MISSIONS = names("mission", files=[".npz", ".zip", ".toml"])
CONTROLLERS = names("controller", files=[".py"])


SHIPPED = "extra_metadata/words.json"  # among the metadata of the installed package
Words = dict[str, dict[str, str]]


@cache
def known_words() -> Words:
    """The words by kind, each with its meaning: as the install has them, or else formed."""
    shipped = shipped_text()
    return json.loads(shipped) if shipped else formed_words()


def shipped_text() -> str | None:
    """The words as the install has them, in JSON; None without an install, or of one that has none."""
    try:
        return distribution("tandemlift").read_text(SHIPPED)
    except PackageNotFoundError:
        return None


def formed_words() -> Words:
    """The words as the package defines them; a key of a list of tables has its entry 0."""
    from tandemlift.analysis.studies.metric_descriptions import METRIC_GROUPS
    from tandemlift.apps.cli.new_mission import quadrotor_models
    from tandemlift.codegen.mission_module import TARGETS
    from tandemlift.engines.registry import ENGINES
    from tandemlift.missions import built_in
    from tandemlift.missions.key_descriptions import sections
    from tandemlift.parts.controllers import CONTROLLERS

    tables = list(sections())
    return {
        "quadrotor": dict(quadrotor_models()),
        "mission": dict(built_in()),
        "controller": {name: controller.summary for name, controller in sorted(CONTROLLERS.items())},
        "engine": {name: engine.summary for name, engine in ENGINES.items()},
        "target": dict(TARGETS),
        "metric": {name: metric.meaning for group in METRIC_GROUPS for name, metric in group.metrics.items()},
        "table": {table.name: table.text[0] for table in tables if table.name},
        "key": {key.name: key.facts.meaning or "" for table in tables for key in table.keys},
    }
