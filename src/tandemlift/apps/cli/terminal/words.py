"""The words that shells complete: names of missions, controllers, engines, targets and metrics, and mission keys.

Forming them imports half of the package. A shell cannot wait for that, so every install, of a checkout too, keeps them
as they were when it was made (`hatch_build.py`).
"""

from __future__ import annotations

import json
from functools import cache
from importlib.metadata import PackageNotFoundError, distribution

SHIPPED = "extra_metadata/words.json"  # among the metadata of the installed package
Words = dict[str, dict[str, str]]


@cache
def known_words() -> Words:
    """By kind, the words and what each is: as the install has them, or else formed."""
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
    from tandemlift.codegen.mission_module import TARGETS
    from tandemlift.engines.registry import ENGINES
    from tandemlift.flight.metric_descriptions import METRIC_GROUPS
    from tandemlift.missions import built_in
    from tandemlift.missions.sections import sections
    from tandemlift.parts.controllers import CONTROLLERS

    tables = list(sections())
    return {
        "mission": dict(built_in()),
        "controller": {name: controller.summary for name, controller in sorted(CONTROLLERS.items())},
        "engine": {name: engine.summary for name, engine in ENGINES.items()},
        "target": dict(TARGETS),
        "metric": {name: metric.meaning for group in METRIC_GROUPS for name, metric in group.metrics.items()},
        "table": {table.name: table.text[0] for table in tables if table.name},
        "key": {key.name: key.facts.meaning or "" for table in tables for key in table.keys},
    }
