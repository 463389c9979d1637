"""The variants of a study: each mission with each controller in each engine, with all files that they need.

A variant can be sent to another machine and kept in the folder of the study: it holds the mission's tables, the source
of a user's controller and the bytes of a recording.
"""

from __future__ import annotations

import base64
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from tandemlift.analysis.studies.design.settings import StudySettings
from tandemlift.core.errors import InputError, unknown, without_flight_warnings
from tandemlift.core.plugs import Plugin, PluginText, has, listed, load_sent, plugins_in
from tandemlift.engines.registry import engine_named
from tandemlift.missions import Layer, MissionTemplate, Tables, check, merge, placed, read_tables, value_at
from tandemlift.missions.recording import hold_recording
from tandemlift.parts.controllers import CONTROLLERS, Controller, controller, load_controller

RECORDING = ("person", "recording")


def variant_from(said: Mapping[str, Any]) -> Variant:
    """A variant from its JSON form."""
    plugins = tuple(PluginText(*one) for one in said["plugins"])
    return Variant(**said)._replace(plugins=plugins, recording=tuple(said["recording"]))


class Variant(NamedTuple):
    """A mission, a controller and an engine.

    Attributes:
        mission: name of the mission.
        controller: name of the controller.
        engine: name of the engine.
        tables: the mission's tables as its files say them, unchecked.
        plugins: name, digest and source of what users bring: parts that it names, and its engine.
        recording: name and base64 text of the mission's recording; empty without one.
    """

    mission: str
    controller: str
    engine: str
    tables: Tables
    plugins: tuple[PluginText, ...] = ()
    recording: tuple[str, ...] = ()

    def template(self, changes: Mapping[str, Any] | None = None) -> MissionTemplate:
        """Forms missions of this variant, with changes that all have; without warnings, because findings are counted.

        Raises:
            InputError: a plugin fails, or is another one here, or a change has no place in the mission.
        """
        return MissionTemplate(self._tables(), [Layer(self.mission, self.tables)], changes, quiet=True)

    def _tables(self) -> Tables:
        """The tables on this machine."""
        for plugin in self.plugins:
            load_sent(plugin)
        if self.recording:
            name, coded = self.recording
            return merge(self.tables, {"person": {"recording": hold_recording(name, base64.b64decode(coded))}})
        return self.tables


def variants_of(settings: StudySettings, folder: Path) -> list[Variant]:
    """All variants of a study, engines innermost.

    Args:
        settings: of the study; each variant has the plugins of all that they name.
        folder: where relative paths start.

    Raises:
        InputError: a mission, controller or engine does not exist or cannot be read.
    """
    study, said = settings.study, settings.model_dump_json()
    brought = [listed(placed(one, folder)) for one in study.plugins]
    for engine in study.engines:
        engine_named(engine)
    brought += plugins_in(said)
    return [
        variant._replace(engine=engine)
        for mission in study.missions
        for chosen in study.controllers or (None,)
        for variant in [_variant(mission, chosen, brought, folder)]
        for engine in study.engines
    ]


def _variant(mission: str, chosen: str | None, brought: list[Plugin], folder: Path) -> Variant:
    held = None if chosen is None else _controller(chosen, folder)
    try:
        tables, layers = read_tables(mission, held, folder)
    except OSError as error:
        raise InputError(f"study.missions: {mission}: {error.strerror or error}") from None
    except RecursionError:
        raise InputError(f"study.missions: {mission} is not a mission: nested too deeply") from None
    _check_known(value_at(tables, ("controller", "name")), f"study.missions: {mission}: controller.name")
    with without_flight_warnings():
        loaded = check(tables, layers[-1].source, layers)
    plugins = loaded.with_plugins(one.said for one in brought).plugins
    if plugins:
        tables = {**tables, "plugins": [one._asdict() for one in plugins]}
    return Variant(loaded.mission.name, loaded.controller.name, "compiled", tables, plugins, _recording(tables))


def _controller(chosen: str, folder: Path) -> Controller:
    if chosen.endswith(".py") or "/" in chosen:
        return load_controller(folder / chosen)
    _check_known(chosen, "study.controllers")
    return controller(chosen)


def _check_known(name: object, key: str) -> None:
    """Reject the name of a controller that is not registered, with the way in which a study loads one."""
    if isinstance(name, str) and not has("controller", name):
        error = unknown("controller", name, sorted(CONTROLLERS))
        raise InputError(f"{key}: {error} For one of your own, name its file in study.controllers.")


def _recording(tables: Tables) -> tuple[str, ...]:
    path = value_at(tables, RECORDING)
    if not isinstance(path, str):
        return ()
    try:
        return Path(path).name, base64.b64encode(Path(path).read_bytes()).decode()
    except OSError as error:
        raise InputError(f"person.recording = {path!r}: {error.strerror or error}") from None
