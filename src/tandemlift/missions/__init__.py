"""Missions: loading of TOML files with changes into a checked `Mission`; warnings; the reference of keys.

A file may start from another mission with `extends = "NAME or path"` and change some keys; tables merge, everything
else is replaced, and another `controller.name` starts from that controller's defaults.

A function that needs a part of a mission takes that table, or `Mission.hover`: their types are here, too.
"""

from tandemlift.core.plugs import load_plugin
from tandemlift.missions.acting import IdleKey, idle_keys, sentences
from tandemlift.missions.changes import format_toml, merge, tables_of
from tandemlift.missions.checking import changed, check
from tandemlift.missions.loading import (
    DATA,
    MissionLike,
    MissionTemplate,
    built_in,
    load_mission,
    mission_from_text,
    mission_of,
)
from tandemlift.missions.mission import (
    HoverFacts,
    InitialTable,
    Mission,
    PersonTable,
    SensorsTable,
    VehicleTable,
    check_keys,
)
from tandemlift.missions.mission import check_double as check_double
from tandemlift.missions.mission import with_precision as with_precision

__all__ = [
    "DATA",
    "HoverFacts",
    "IdleKey",
    "InitialTable",
    "Mission",
    "MissionLike",
    "MissionTemplate",
    "PersonTable",
    "SensorsTable",
    "VehicleTable",
    "built_in",
    "changed",
    "check",
    "check_keys",
    "format_toml",
    "idle_keys",
    "load_mission",
    "load_plugin",
    "merge",
    "mission_from_text",
    "mission_of",
    "sentences",
    "tables_of",
]
