"""Missions: loading of TOML files with changes into a checked `Mission`; warnings; the reference of keys.

A file may start from another mission with `extends = "NAME or path"` and change some keys; tables merge, everything
else is replaced, and another `controller.name` starts from that controller's defaults.

A function that needs a part of a mission takes that table, or `Mission.hover`: their types are here, too.
"""

from tandemlift.core.plugs import load_plugin
from tandemlift.missions.acting import IdleKey, idle_keys, sentences
from tandemlift.missions.changes import (
    MISSING,
    Place,
    Tables,
    changed_tables,
    format_toml,
    merge,
    place_of,
    places_in,
    tables_of,
    value_at,
)
from tandemlift.missions.checking import Layer, changed, check
from tandemlift.missions.facts import RESTLESS, calm_time
from tandemlift.missions.loading import (
    MAX_FILE,
    MissionLike,
    MissionTemplate,
    built_in,
    load_mission,
    mission_from_text,
    mission_of,
    placed,
    read_tables,
)
from tandemlift.missions.mission import (
    HoverFacts,
    InitialTable,
    Mission,
    MissionTable,
    PersonTable,
    SensorsTable,
    VehicleTable,
    check_double,
    check_keys,
    with_precision,
)
from tandemlift.missions.refusals import problems_in
