"""The recipe "Add a figure" of CONTRIBUTING.md, followed: its file and its place among the others, and it is drawn."""

import pytest
from edited_package import EditedPackage

FIGURE = '''"""The speed of the air over time."""

import numpy as np
from matplotlib.figure import Figure

from tandemlift.pictures.drawing.figure import Caption, with_any_of
from tandemlift.pictures.drawing.overlay import over_time
from tandemlift.pictures.drawing.panels import fit, line, time_axis
from tandemlift.pictures.drawing.style import ACTUAL, column_figure, journal
from tandemlift.flight.record import Flight

CAPTION = Caption("Air", "Speed of the air.", "A panel over time of the air’s speed.")
IN_FLIGHTS = with_any_of("wind_velocity")
OVERLAY = over_time("wind_velocity")


@journal
def draw(flight: Flight) -> Figure:
    """Draw the speed [m/s]."""
    figure = column_figure(1.5)
    ax, speed = figure.subplots(), np.linalg.norm(flight["wind_velocity"], axis=1)
    line(ax, flight.time, speed, **ACTUAL)
    fit(ax, speed, least=0.1)
    time_axis(ax, flight)
    return figure
'''
PROGRAM = """
from pathlib import Path
import tandemlift as tl
from tandemlift.pictures.figures.registry import figures, figures_for, save_flight_figure
from tandemlift.pictures.report.flight_report import write_report

windy = {"wind.model": "air", "wind.velocity": [3.0, -4.0, 0.0]}
calm, flight = (tl.fly(tl.load_mission("paper", {"mission.duration": 0.05, **more})) for more in ({}, windy))
page = write_report(flight, save_flight_figure(flight, "air", Path()), "windy.html").read_text("utf-8")
assert list(figures())[-1] == list(figures_for(flight))[-1] == "air"
assert 'id="air"' in page and "Speed of the air." in page and "A panel over time of the air’s speed." in page
assert "air" not in figures_for(calm)
print("drawn")
"""


@pytest.mark.thorough
def test_a_figure_is_added_by_its_file_and_its_place_among_the_others(tmp_path):
    package = EditedPackage(tmp_path)
    package.write("pictures/figures/air.py", FIGURE)
    package.insert("pictures/figures/registry.py", "    from tandemlift.pictures.figures import (\n", "        air,\n")
    package.insert("pictures/figures/registry.py", "rotors, surroundings, corridor", ", air")
    assert package.run(PROGRAM) == "drawn\n"
