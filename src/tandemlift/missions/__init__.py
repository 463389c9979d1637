"""Missions: loading of TOML files with changes into a checked `Mission`; warnings; the reference of keys.

A file may start from another mission with `extends = "NAME or path"` and change some keys; tables merge, everything
else is replaced, and another `controller.name` starts from that controller's defaults.
"""

from tandemlift.missions.changes import merge
from tandemlift.missions.checking import changed, check, in_turn
from tandemlift.missions.files import DATA, built_in, format_toml, tables_of, to_toml
from tandemlift.missions.loading import MissionTemplate, load_mission
from tandemlift.missions.tables.mission import Mission, check_keys

__all__ = [
    "DATA",
    "Mission",
    "MissionTemplate",
    "built_in",
    "changed",
    "check",
    "check_keys",
    "format_toml",
    "in_turn",
    "load_mission",
    "merge",
    "tables_of",
    "to_toml",
]
