"""Several flights over each other: each line is the channel of one flight, and the legend says of which."""

import dataclasses

import numpy as np
import pytest
from click.testing import CliRunner
from flights import cut
from matplotlib.colors import to_hex

import tandemlift as tl
from tandemlift.apps.cli.main import cli
from tandemlift.flight.record import Ending

QUICK = {"mission.duration": 12.0, "mission.log_interval": 0.05}
AS_DRAWN = {"euler": np.degrees(1.0)}  # angles are drawn in degrees


@pytest.fixture(scope="module")
def flights():
    damping = {"admittance.damping": 4.0}
    return {name: tl.fly(tl.load_mission("one-push", QUICK | more)) for name, more in (("soft", {}), ("firm", damping))}


@pytest.fixture(scope="module")
def unlike(flights):
    """Flights that differ in all that a figure depends on: parts, quadrotors, length, ending."""
    paper, ending = tl.fly(tl.load_mission("paper", QUICK)), Ending("position", 0.0, float("inf"), "must be finite")
    huge = {name: np.where(paper.time < 9.0, v.T, 1e9).T for name, v in paper.channels.items()}
    return {
        **flights,
        "paper": paper,
        "four": tl.fly(tl.load_mission("four", QUICK)),
        "iris": tl.fly(tl.load_mission("iris", QUICK)),
        "diverged": dataclasses.replace(paper, channels=huge, ending=ending),
        "one sample": cut(paper, 1),
        "no sample": cut(paper, 0, ending=ending),
    }


def curves(ax):
    """The lines of a panel (n, 2) but for that at zero."""
    return [line.get_xydata() for line in ax.get_lines() if len(line.get_xydata()) > 2]


def legend(figure):
    """The colours of the legend's lines, by their names."""
    (one,) = figure.legends
    return {text.get_text(): to_hex(line.get_color()) for text, line in zip(one.texts, one.get_lines(), strict=True)}


@pytest.mark.parametrize("channel", ["position_error", "euler", "rotor_thrusts"])
def test_each_panel_has_a_component_of_each_flight(flights, channel):
    figure = tl.plot(flights, channel)
    columns = [f[channel].reshape(len(f.time), -1).T * AS_DRAWN.get(channel, 1.0) for f in flights.values()]
    assert len(figure.axes) == len(columns[0])
    for ax, *components in zip(figure.axes, *columns, strict=True):
        for flight, values, drawn in zip(flights.values(), components, curves(ax), strict=True):
            assert drawn[:, 0] == pytest.approx(flight.time)
            assert drawn[:, 1] == pytest.approx(values)


def test_panels_of_rotors_are_named_as_in_the_figure_of_one_flight(flights):
    figure = tl.plot(flights, "rotor_thrusts")
    titles = [f"quadrotor {quadrotor}, rotor {rotor}" for quadrotor in (1, 2) for rotor in (1, 2, 3, 4)]
    assert [ax.get_title() for ax in figure.axes] == titles
    assert [ax.get_ylabel() for ax in figure.axes] == [*["rotor thrusts\n(N)", "", "", ""] * 2]


def test_lines_of_a_flight_have_its_colour_in_all_panels_and_in_the_legend(flights):
    figure = tl.plot(flights, "reference")
    assert list(legend(figure)) == ["soft", "firm"]
    for ax in figure.axes:
        assert [to_hex(line.get_color()) for line in ax.get_lines()[:2]] == list(legend(figure).values())


def test_a_flight_without_a_channel_has_no_line_and_keeps_its_colour(unlike):
    figure = tl.plot({"paper": unlike["paper"], "iris": unlike["iris"]}, "push_estimate")
    ax, colours = figure.axes[0], legend(figure)
    assert list(colours) == ["paper", "iris"]
    assert len(curves(ax)) == 1
    assert to_hex(ax.get_lines()[0].get_color()) == colours["iris"]


def test_a_flight_that_diverged_does_not_set_the_scale(unlike):
    alone, both = (tl.plot({n: unlike[n] for n in names}, "thrust") for names in (("paper",), ("paper", "diverged")))
    assert both.axes[0].get_ylim() == alone.axes[0].get_ylim()
    assert list(legend(both)) == ["paper", "diverged (diverged)"]


def test_a_disturbed_start_is_cut_and_the_panel_says_so(unlike):
    figure, paper = tl.plot({"paper": unlike["paper"], "iris": unlike["iris"]}, "moment"), unlike["paper"]
    low, high = figure.axes[0].get_ylim()
    late = paper["moment"][paper.time > 1.0, 0]
    assert paper["moment"][:, 0].min() < low < late.min() <= late.max() < high
    assert figure.axes[0].get_title() == "moment x*"
    assert "first second" in figure.get_supxlabel()


def test_paths_are_drawn_where_a_figure_of_one_flight_draws_them(flights):
    def drawn(figure):
        return [line.get_xydata() for line in figure.axes[0].get_lines() if line.get_gid() == "path"]

    alone = [drawn(tl.plot(flight, "path"))[0] for flight in flights.values()]
    assert all(a == pytest.approx(b) for a, b in zip(alone, drawn(tl.plot(flights, "path")), strict=True))


@pytest.mark.parametrize("name", ["path", "joints"])
def test_a_figure_is_drawn_whole_whatever_the_flights(name, unlike):
    figure = tl.plot(unlike, name)
    width, height = figure.get_size_inches()
    cut_off = figure.get_tightbbox().extents * [-1.0, -1.0, 1.0, 1.0] > [0.01, 0.01, width + 0.01, height + 0.01]
    assert not cut_off.any()


def test_flights_of_one_mission_are_numbered(flights):
    assert list(legend(tl.plot(list(flights.values()), "position"))) == ["one-push 1", "one-push 2"]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("corridor", "unknown figure 'corridor'; there are reference, path"),
        ("traking", "Did you mean 'tracking'"),
        ("positions", "such as position. Did you mean 'position'"),
    ],
)
def test_what_no_flight_has_is_refused(name, message, flights):
    with pytest.raises(tl.InputError, match=message):
        tl.plot(flights, name)


def test_a_view_of_one_flight_is_refused_for_several():
    walled = tl.fly(tl.load_mission("zigzag", QUICK))
    assert tl.plot(walled, "corridor").axes
    with pytest.raises(tl.InputError, match="corridor: cannot be drawn of several flights; draw `path`"):
        tl.plot([walled, walled], "corridor")
    with pytest.raises(tl.InputError, match="no flight to draw"):
        tl.plot([], "path")


def test_the_command_names_flights_as_their_folders(flights, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, flight in flights.items():
        (tmp_path / name).mkdir()
        flight.save(tmp_path / name / "flight.npz")
    shown = CliRunner().invoke(cli, ["plot", "position", "soft", "firm/flight.npz", "--out", "new/both.svg"])
    assert (shown.exit_code, shown.output) == (0, "position: new/both.svg\n")
    text = (tmp_path / "new/both.svg").read_text("utf-8")
    assert "<!-- soft -->" in text
    assert "<!-- firm -->" in text
