"""A flight that goes on after a crash: its figures, page and summary say where metrics and scales end."""

import warnings

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.flight.record import counted_until
from tandemlift.pictures.figures.registry import figures_for
from tandemlift.pictures.report.flight_report import write_report
from tandemlift.pictures.report.printed_summary import summary_lines

FALL = {"disturbance.moment": [0.0, 20.0, 0.0], "actuators.model": "rotors", "mission.duration": 4.0}


@pytest.fixture(scope="module", params=(3.0, 0.0), ids=("goes on", "stops"))
def flight(request):
    with warnings.catch_warnings(action="ignore"):
        return tl.fly(tl.load_mission("one-push", FALL | {"crash.fly_on": request.param}))


@pytest.mark.thorough
def test_figures_over_time_mark_the_crash_and_are_scaled_to_the_time_before_it(flight):
    goes_on = flight.mission["crash"]["fly_on"] > 0.0
    assert counted_until(flight) == (flight.ending.time if goes_on else None)
    drawn = {name: figure.draw(flight) for name, figure in figures_for(flight).items() if name != "path"}
    for figure in drawn.values():
        marks = {line.get_xdata()[0] for ax in figure.axes for line in ax.get_lines() if line.get_gid() == "crash"}
        assert marks == ({flight.ending.time} if goes_on else set())
    before = flight.time <= flight.ending.time
    low, high = drawn["inputs"].axes[0].get_ylim()
    span = np.ptp(flight["thrust"][before])
    assert span < high - low < 2.0 * span
    errors = np.abs(flight["position_error"][before, 2]).max()
    legend = [text.get_text() for text in drawn["tracking"].axes[10].get_legend().get_texts()]
    assert f"{1e3 * errors:.3g} mm" in legend[2]


def test_the_page_and_the_summary_say_that_metrics_end_at_the_crash(flight, tmp_path):
    goes_on = flight.mission["crash"]["fly_on"] > 0.0
    page = write_report(flight, [], tmp_path / "report.html").read_text("utf-8")
    assert (f"They end at the crash at {flight.ending.time:.3f} s" in page) is goes_on
    assert ("until crash" in "\n".join(summary_lines(flight))) is goes_on
