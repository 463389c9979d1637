"""The flow of data: from a mission through the steps of a flight to its record, and the record's readers."""

from __future__ import annotations

from itertools import pairwise

from drawings.canvas import Box, arrow, drawing, words


def data_flow() -> str:
    """A mission, one step of its flight, and the record."""
    mission = Box(10, 20, 110, 56, "mission", "a TOML file")
    start = Box(10, 130, 110, 56, "assembly", "a flight at t = 0")
    step = Box(150, 10, 440, 300, "one step of the flight", kind="frame")
    names = [
        ("perceive", "estimators"),
        ("guide", "admittance"),
        ("control", "sliding mode"),
        ("allocate", "to rotors"),
    ]
    pilot = [Box(166 + 106 * i, 76, 92, 56, title, text, "pilot") for i, (title, text) in enumerate(names)]
    sensors, body, rotors = (
        Box(x, 222, width, 56, title, text, "body")
        for x, width, title, text in (
            (166, 92, "sensors", "with errors"),
            (290, 164, "body", "compiled, MuJoCo,\nGazebo"),
            (484, 92, "rotors", "lag, limits"),
        )
    )
    person = Box(290, 340, 164, 44, "person", "simulated, mouse, caller", "box")
    flight = Box(630, 130, 120, 56, "flight", "channels, events", "pilot")
    readers = Box(630, 250, 120, 96, "", "metrics, findings\nfigures, report\nstudies\nbags, tables", "box")
    perceive, *_, allocate = pilot
    parts = [b.svg() for b in (step, mission, start, *pilot, sensors, body, rotors, person, flight, readers)]
    parts += [
        words(166, 66, "pilot", "note", "start"),
        words(166, 212, "vehicle", "note", "start"),
        arrow(mission.bottom, start.top),
        arrow(start.right, (step.x, start.right[1])),
        *(arrow(a.right, b.left) for a, b in pairwise(pilot)),
        arrow(allocate.bottom, rotors.top),
        words(rotors.top[0] - 6, 182, "thrusts", "text", "end"),
        arrow(rotors.left, body.right),
        arrow(body.left, sensors.right),
        arrow(sensors.top, perceive.bottom),
        words(sensors.top[0] + 6, 182, "readings", "text", "start"),
        arrow((352, person.y), (352, body.y + body.height)),
        words(346, 330, "push", "text", "end"),
        arrow((392, body.y + body.height), (392, person.y)),
        words(398, 330, "sees", "text", "start"),
        arrow((step.x + step.width, flight.left[1]), flight.left),
        words(610, 150, "log", "text"),
        arrow(flight.bottom, readers.top),
    ]
    return drawing(760, 394, "A mission becomes a flight; every step is logged; everything else reads the log.", parts)
