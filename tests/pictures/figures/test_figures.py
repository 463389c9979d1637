"""The figures: what they draw is what was flown, for every flight, and the files are whole."""

import dataclasses
import re
import struct
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.collections import PolyCollection
from matplotlib.patches import FancyArrowPatch
from patience import completed
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.core.findings import Finding
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.pictures.drawing import style as figure_style
from tandemlift.pictures.drawing.panels import decimate, intervals, normalised
from tandemlift.pictures.drawing.vehicle import skeleton, true_weight
from tandemlift.pictures.figures.registry import figures, figures_for, save_figures


@pytest.fixture(scope="module")
def paper():
    return tl.fly(tl.load_mission("paper"))


def with_vehicle(flight, **table):
    """The flight with another vehicle in its mission."""
    return dataclasses.replace(flight, mission=flight.mission | {"vehicle": table})


@pytest.fixture(scope="module")
def flights(paper):
    quiet = {"pushes": [], "initial.position": 0.0, "initial.euler": 0.0, "mission.duration": 12.0}
    quadrotor = paper.mission["vehicle"]["quadrotors"][0] | {"position": [0.0, 0.0, 0.075]}
    compact = {"mass": 0.5, "inertia": [0.01, 0.01, 0.01]}
    return {
        "hover": tl.fly(tl.load_mission("paper", quiet)),
        "one quadrotor": with_vehicle(paper, payload=compact, quadrotors=[quadrotor]),
        "four quadrotors": with_vehicle(paper, **tl.load_mission("four").model_dump(mode="json")["vehicle"]),
    }


@pytest.fixture(scope="module")
def drawn(paper):
    """The figures of the paper's flight."""
    return {name: figure.draw(paper) for name, figure in figures_for(paper).items()}


@pytest.fixture(scope="module")
def path_figure(drawn):
    return drawn["path"]


@pytest.fixture(scope="module")
def arrows(path_figure):
    """Tails and heads of the drawn arrows (n, 2, 2), in metres on paper."""
    patches = [p for p in path_figure.axes[0].patches if isinstance(p, FancyArrowPatch)]
    return np.array([p._posA_posB for p in patches])


@pytest.fixture(scope="module")
def projection(paper, arrows):
    """The matrix (3, 2) from space to paper that the tails of the arrows follow."""
    times = [push["time"] for push in paper.mission["pushes"]]
    places = np.column_stack([np.interp(times, paper.time, x) for x in paper["position"].T])
    matrix, _, rank, _ = np.linalg.lstsq(places, arrows[:, 0])
    assert rank == 3
    assert places @ matrix == pytest.approx(arrows[:, 0], abs=1e-9)
    return matrix


def test_the_drawing_library_is_loaded_only_to_draw_and_never_with_a_window_system(paper, tmp_path):
    flight = paper.save(tmp_path / "flight.npz")
    code = f"""
import sys, tandemlift.pictures.figures.registry
from tandemlift.flight.record import Flight
assert "matplotlib" not in sys.modules
tandemlift.pictures.figures.registry.figures()["reference"].draw(Flight.load({str(flight)!r}))
assert "matplotlib.figure" in sys.modules and "matplotlib.pyplot" not in sys.modules
"""
    completed([sys.executable, "-W", "error", "-c", code], check=True)


def test_the_path_is_drawn_in_parallel_projection_at_one_scale(paper, path_figure, projection):
    assert projection.T @ projection == pytest.approx(np.eye(2), abs=1e-9)
    (path,) = (line for line in path_figure.axes[0].get_lines() if line.get_gid() == "path")
    assert path.get_xydata()[[0, -1]] == pytest.approx(paper["position"][[0, -1]] @ projection, abs=1e-9)
    axes = path_figure.axes[0]
    across, up = axes.get_window_extent().size
    assert across / np.diff(axes.get_xlim()) == pytest.approx(up / np.diff(axes.get_ylim()))


def test_every_push_has_an_arrow_along_it_as_long_as_it_was_strong(paper, arrows, projection):
    forces = np.array([push["force"] for push in paper.mission["pushes"]])
    drawn = arrows[:, 1] - arrows[:, 0]
    assert len(arrows) == len(forces) == 8
    per_newton = np.vdot(forces @ projection, drawn) / np.vdot(forces @ projection, forces @ projection)
    assert per_newton > 0.0
    assert drawn == pytest.approx(per_newton * forces @ projection, abs=1e-9)


def test_the_drawn_beam_is_as_long_as_the_beam_and_as_tilted_as_the_vehicle(paper, path_figure, projection):
    masses = np.array([0.5, 1.5, 1.5])
    parts = np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.075], [0.0, -1.0, 0.075]])
    ends = np.array([[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]]) - masses @ parts / masses.sum()
    attitude = paper["attitude"][0]
    assert abs(attitude[1:]).max() > 0.05
    expected = Rotation.from_quat(np.roll(attitude, -1)).apply(ends) + paper["position"][0]

    drawn = skeleton(Vehicle.from_mission(paper.mission)).placed(paper["position"][0], attitude)
    assert drawn.beam == pytest.approx(expected, abs=1e-12)
    assert np.linalg.norm(drawn.beam[1] - drawn.beam[0]) == pytest.approx(2.0)
    beams = [line.get_xydata() for line in path_figure.axes[0].get_lines() if line.get_gid() == "payload"]
    assert min(np.abs(beam - expected @ projection).max() for beam in beams) < 1e-9


@pytest.mark.parametrize(("layout", "first"), [("+", 0.0), ("x", 45.0)])
def test_rotors_stand_an_arm_from_where_their_quadrotor_is_mounted(layout, first):
    table = tl.load_mission("paper").model_dump(mode="json", exclude_none=True)["vehicle"]
    for quadrotor in table["quadrotors"]:
        quadrotor["layout"] = layout
    body = skeleton(Vehicle.from_mission({"vehicle": table}))
    mounts = body.struts[:, 1]
    assert mounts[0] - mounts[1] == pytest.approx([0.0, 2.0, 0.0])
    hubs = body.rotors.mean(axis=1).reshape(2, 4, 3) - mounts[:, None]
    angles = np.degrees(np.arctan2(hubs[..., 1], hubs[..., 0])) % 360.0
    assert np.linalg.norm(hubs, axis=2) == pytest.approx(np.full((2, 4), 0.25))
    off = (angles - [first, first + 90.0, first + 180.0, first + 270.0] + 180.0) % 360.0 - 180.0
    assert off == pytest.approx(np.zeros((2, 4)), abs=1e-9)


def test_grey_is_where_the_push_is_beyond_the_threshold(paper, drawn):
    for axis, threshold in enumerate(paper.mission["admittance"]["threshold"]):
        panel = drawn["interaction"].axes[axis]
        (shading,) = (c for c in panel.collections if isinstance(c, PolyCollection))
        grey = np.array([(p.vertices[:, 0].min(), p.vertices[:, 0].max()) for p in shading.get_paths()])
        expected = []
        for push in paper.mission["pushes"]:
            if abs(push["force"][axis]) > threshold:  # |A| exp(-(t - t0)² / 2σ²) = threshold
                half = push["sigma"] * np.sqrt(2.0 * np.log(abs(push["force"][axis]) / threshold))
                expected.append((push["time"] - half, push["time"] + half))
        assert grey == pytest.approx(np.array(expected), abs=0.5 * paper.mission["mission"]["log_interval"] + 1e-9)


def test_both_axes_of_the_interaction_have_their_zero_at_one_height(drawn):
    axes = drawn["interaction"].axes
    for force, reference in zip(axes[:3], axes[3:], strict=True):
        zeros = [ax.transData.transform((0.0, 0.0))[1] for ax in (force, reference)]
        assert zeros[0] == pytest.approx(zeros[1], abs=1e-6)


def test_normalised_errors_peak_at_exactly_one_and_keep_their_shape(paper, drawn):
    panels = drawn["tracking"].axes[9:]
    for panel, name in zip(panels, ("attitude_error", "position_error", "velocity_error"), strict=True):
        for axis in range(3):
            error, shown = paper[name][:, axis], panel.get_lines()[axis].get_ydata()
            assert np.abs(shown).max() == 1.0
            k = np.argmax(np.abs(error))
            assert np.sign(shown[np.argmax(np.abs(shown))]) == np.sign(error[k])


def test_rounding_is_not_blown_up_to_an_error_of_one():
    assert normalised(np.array([0.0, 3e-17, -1e-12])) == (pytest.approx(np.zeros(3), abs=0.0), 0.0)


def test_a_disturbed_start_does_not_hide_the_rest(paper, drawn, flights):
    axes = np.reshape(drawn["inputs"].axes, (4, 2))
    start, whole = axes[1]
    roll = paper["moment"][:, 0]
    late = roll[paper.time > 1.0]
    assert start.get_ylim()[0] < roll.min() < -1000.0
    assert whole.get_ylim()[0] > 2.0 * late.min() > -500.0
    assert whole.get_ylim()[0] < late.min() < late.max() < whole.get_ylim()[1]
    assert len(figures()["inputs"].draw(flights["hover"]).axes) == 4


def test_the_thrust_is_compared_with_the_weight(paper, drawn):
    panel = drawn["inputs"].axes[1]
    assert panel.get_lines()[-1].get_ydata() == pytest.approx([3.5 * 9.81] * 2)
    assert panel.get_legend().get_texts()[0].get_text() == "weight, 34.34 N"
    heavier = dataclasses.replace(paper, mission=paper.mission | {"plant": {"mass_scale": 1.1}})
    assert true_weight(heavier) == pytest.approx(1.1 * 3.5 * 9.81)


@given(st.integers(1, 40_000), st.integers(0, 2**32 - 1))
def test_thinning_keeps_every_peak_and_both_ends(count, seed):
    values = np.random.default_rng(seed).standard_normal(count)
    kept = decimate(values)
    assert len(kept) <= 2402
    assert np.all(np.diff(kept) > 0)
    assert {0, count - 1, int(values.argmin()), int(values.argmax())} <= set(kept.tolist())


def test_thinning_passes_over_gaps():
    values = np.full(100_000, np.nan)
    values[54_321] = 7.0
    assert 54_321 in decimate(values)


@given(st.lists(st.booleans(), min_size=1, max_size=300))
def test_intervals_hold_the_active_samples_and_no_others(active):
    time = 0.5 + 0.1 * np.arange(len(active))
    spans = intervals(time, np.array(active))
    held = [any(a <= t <= b for a, b in spans) for t in time]
    assert held == active
    assert (spans[:, 0] <= spans[:, 1]).all()


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["hover", "one quadrotor", "four quadrotors"])
def test_every_figure_of_every_flight_is_drawn_whole_without_a_warning(flights, name):
    for figure_name, kind in figures_for(flights[name]).items():
        figure = kind.draw(flights[name])
        width, height = figure.get_size_inches()
        assert 3.5 <= round(width, 3) <= 7.16
        cut_off = figure.get_tightbbox().extents * [-1.0, -1.0, 1.0, 1.0] > [0.01, 0.01, width + 0.01, height + 0.01]
        assert not cut_off.any(), figure_name


def test_a_long_flight_stays_small_and_keeps_its_peaks(paper, tmp_path):
    at = np.arange(30_000) % len(paper.time)
    channels = {name: values[at] for name, values in paper.channels.items()}
    long = dataclasses.replace(paper, time=np.arange(len(at)) * 0.01, channels=channels)
    figure = figures()["inputs"].draw(long)
    lines = [line for ax in figure.axes for line in ax.get_lines()]
    assert max(len(line.get_xdata()) for line in lines) <= 2402
    assert min(np.min(line.get_ydata()) for line in lines) == paper["moment"].min()
    assert figure_style.save(figure, tmp_path / "inputs.pdf").stat().st_size < 100_000


@pytest.mark.thorough
def test_saving_writes_every_figure_as_png_and_pdf_and_tells_how_far_it_is(paper, tmp_path):
    told = []
    files = save_figures(paper, tmp_path / "new" / "figures", lambda done, total: told.append((done, total)))
    assert told == [(i, 6) for i in range(7)]
    assert [f.name for f in files] == [f"{name}.{kind}" for name in figures_for(paper) for kind in ("png", "pdf")]
    assert sorted(files) == sorted((tmp_path / "new" / "figures").iterdir())
    assert sum(file.stat().st_size for file in files) < 2_000_000, "a page can hold them"
    for file in files:
        data = file.read_bytes()
        if file.suffix == ".png":
            width, _ = struct.unpack(">II", data[16:24])
            assert data.startswith(b"\x89PNG\r\n\x1a\n")
            assert data.endswith(b"IEND\xaeB`\x82")
            assert width == (1050 if file.stem == "interaction" else 2148)
        else:
            assert data.startswith(b"%PDF-")
            assert data.rstrip().endswith(b"%%EOF")
            assert b"/CIDFontType2" in data, "fonts are embedded as TrueType"
            assert b"/Type3" not in data
            assert len(data) < 60_000
            assert len(re.findall(rb"/Type /Page\b", data)) == 1


def test_the_figure_of_tracking_marks_the_times_at_which_findings_begin(paper, drawn):
    def marks(figure):
        lines = [line for ax in figure.axes for line in ax.get_lines() if line.get_marker() == "v"]
        return [np.asarray(line.get_xdata()).tolist() for line in lines]

    text = "tilted by 34° (promised: 29°)"
    found = tuple(Finding("off-track", t, 0.5, None, "tilt", 0.6, "rad", 0.5, text) for t in (1.0, 2.5))
    assert marks(drawn["tracking"]) == []
    assert marks(figures()["tracking"].draw(dataclasses.replace(paper, findings=found))) == [[1.0, 2.5]] * 3


def test_a_failure_leaves_no_half_file_and_the_old_one_as_it_was(drawn, tmp_path, monkeypatch):
    target = tmp_path / "reference.pdf"
    target.write_bytes(b"old")
    figure = drawn["reference"]

    def fail(path, **_):
        path.write_bytes(b"half")
        raise OSError("disk full")

    monkeypatch.setattr(figure, "savefig", fail)
    with pytest.raises(OSError, match="disk full"):
        figure_style.save(figure, target)
    assert [(p.name, p.read_bytes()) for p in tmp_path.iterdir()] == [("reference.pdf", b"old")]
