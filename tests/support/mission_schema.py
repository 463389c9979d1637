"""All keys of a mission, by walking its tables."""

import copy
import functools

from tandemlift.missions import Mission, load_mission, merge, tables_of
from tandemlift.missions.key_descriptions import table_in
from tandemlift.missions.refusals import keys_of
from tandemlift.parts.controllers import CONTROLLERS


def schema_keys():
    """Dotted key and field of every key of a mission, with the settings of every registered controller."""
    models = [(Mission, ()), *((c.settings, ("controller",)) for c in CONTROLLERS.values() if c.name == "nftsmc")]
    for model, above in models:
        for place in keys_of(model, above):
            table = model
            for part in place[len(above) : -1]:
                table = next_table(table, part)
            field = table.model_fields[place[-1]]
            if next_table(table, place[-1]) is None:
                yield ".".join(map(str, place)), field


def next_table(table, part):
    return table if part == 0 else table_in(table.model_fields[part].annotation)


EVERYTHING = {  # on top of mission iris: one entry of every list of tables, and all that is left out by default
    "admittance": {"feel": {"force": 2.7, "speed": 1.5}},
    "allocation": {"notches": [{"frequency": 300.0, "axes": ["yaw"]}]},
    "faults": [{"quadrotor": 1, "rotor": 1, "time": 60.0}],
    "wind": {"model": "air", "gusts": [{"velocity": [1.0, 0.0, 0.0], "start": 15.0, "rise": 1.0}]},
    "pilot": {"guidance": "interactive"},
    "requests": [{"time": 60.0, "action": "land"}],
    "excitation": {"lines": [{"axis": "yaw", "frequency": 0.5, "amplitude": 0.2}]},
    "sensors": {"additional": [{"name": "altimeter"}]},
    "sensor_faults": [{"sensor": "joints", "quadrotor": 1, "kind": "bias", "time": 60.0, "until": 61.0}],
    "walls": [{"start": [20.0, -3.0], "end": [20.0, 3.0]}],
    "person": {"path": [{"point": [1.0, 0.0], "heading": 0.0}]},
    "changes": [{"time": 5.0, "key": "admittance.damping", "value": 4.0}],
}
BEYOND = {"sensors": {"additional": [{"name": "altimeter"}]}}  # on top of that: a sensor of one's own, if it were there
SCHEMA = dict(reversed(list(schema_keys())))  # of `controller.name`, what every mission asks for


def every_table():
    """The tables of a mission that has everything, for a test to change."""
    return copy.deepcopy(_every_table())


@functools.cache
def _every_table():
    return merge(tables_of(load_mission("iris", EVERYTHING)), BEYOND)
