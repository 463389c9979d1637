"""The figures of joints, sensors, real rotors, wind, floor and walls: what they draw is what was flown."""

import dataclasses

import numpy as np
import pytest
from flights import cut
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_hex
from scipy.spatial.transform import Rotation

import tandemlift as tl
from tandemlift.engines.models.scene import floor_from
from tandemlift.flight.record import Ending
from tandemlift.parts.mechanics.vehicle import Vehicle
from tandemlift.pictures.drawing.figure import IEEE
from tandemlift.pictures.drawing.scene import NEAR, Scene3D, on_paper
from tandemlift.pictures.drawing.style import COMPONENTS, LIGHT_BLUE, PALE
from tandemlift.pictures.drawing.surroundings import clearance, draw_walls
from tandemlift.pictures.drawing.vehicle import floor_height, true_payload_mass
from tandemlift.pictures.figures.registry import figures, figures_for

WIND = {"wind.model": "air", "wind.velocity": [2.0, 1.0, 0.0], "wind.turbulence": 6.0}
AIR = ("wind_velocity", "wind_force")
KNOWN = ("push_measured", "push_estimate", "push_usable")
OBSERVED = ("disturbance_force", "disturbance_moment", "disturbance_residual", "disturbance_angular_residual")


def without(flight, *names):
    """The flight without some channels."""
    return dataclasses.replace(flight, channels={n: v for n, v in flight.channels.items() if n not in names})


def with_mission(flight, **tables):
    """The flight with some tables of its mission replaced."""
    return dataclasses.replace(flight, mission=flight.mission | tables)


def of_count(flight, count):
    """A flight of `count` quadrotors, whose channels are those of the given one over and over, each a bit larger."""
    channels = dict(flight.channels)
    for name, width in {"joint": 3, "rotor": 4}.items():
        for own in [n for n in channels if name in n and channels[n].ndim > 1]:
            copies = np.tile(channels[own], count)[:, : width * count]
            channels[own] = copies * np.repeat(1.0 + 0.01 * np.arange(count), width)
    first = flight.mission["vehicle"]["quadrotors"][0]
    fleet = [first | {"position": [0.8 * (i // 2), 0.9 - 1.8 * (i % 2), 0.075]} for i in range(count)]
    flight = with_mission(flight, vehicle=flight.mission["vehicle"] | {"quadrotors": fleet})
    return dataclasses.replace(flight, channels=channels)


def lines(ax):
    """The series of a panel: its lines that are neither level nor upright, each as (x, y)."""
    series = [line.get_xydata() for line in ax.get_lines()]
    return [xy for xy in series if len(xy) > 2]


def assert_drawn(xy, time, values):
    """A drawn series has only samples of the flight, both ends, and the peaks."""
    at = np.searchsorted(time, xy[:, 0])
    assert time[at] == pytest.approx(xy[:, 0], abs=0.0)
    assert np.array_equal(values[at], xy[:, 1], equal_nan=True)
    assert {0, len(time) - 1} <= set(at.tolist())
    if np.isfinite(values).any():
        assert (np.nanmin(xy[:, 1]), np.nanmax(xy[:, 1])) == (np.nanmin(values), np.nanmax(values))


def shaded(ax, color):
    """The intervals (K, 2) that a panel shades in a colour."""
    (bars,) = (c for c in ax.collections if to_hex(c.get_facecolor()[0]) == IEEE.palette[int(color[1:])])
    return np.array([(p.vertices[:, 0].min(), p.vertices[:, 0].max()) for p in bars.get_paths()])


@pytest.fixture(scope="module")
def windy():
    """A flight with everything: sensors, real rotors, wind and floor."""
    return tl.fly(tl.load_mission("iris", WIND))


@pytest.fixture(scope="module")
def paper():
    return tl.fly(tl.load_mission("paper"))


@pytest.fixture(scope="module")
def drawn(windy):
    return {name: figures()[name].draw(windy) for name in ("path", "push", "rotors", "surroundings")}


def test_a_flight_has_the_figures_of_its_parts_and_no_others(windy, paper):
    always = ["reference", "path", "tracking", "inputs", "interaction", "joints"]
    assert list(figures_for(paper)) == always
    assert list(figures_for(windy)) == [name for name in figures() if name != "corridor"]  # it has no walls
    assert "push" not in figures_for(without(windy, *KNOWN))
    assert "disturbance" not in figures_for(without(windy, *OBSERVED))
    assert "rotors" not in figures_for(without(windy, "rotor_commands"))
    assert "surroundings" in figures_for(without(windy, *AIR))
    assert "surroundings" in figures_for(without(windy, "contact_force"))
    assert "surroundings" not in figures_for(without(windy, *AIR, "contact_force"))


@pytest.mark.parametrize("count", [1, 10])
def test_figures_of_fleets_of_any_size_are_drawn_whole(windy, count):
    flight = of_count(cut(windy, 2000), count)
    for name in ("joints", "rotors"):
        figure = figures()[name].draw(flight)
        width, height = figure.get_size_inches()
        cut_off = figure.get_tightbbox().extents * [-1.0, -1.0, 1.0, 1.0] > [0.01, 0.01, width + 0.01, height + 0.01]
        assert not cut_off.any(), name
        assert height < 10.0
        said = [text.get_text() for text in figure.texts]
        assert said == (["quadrotors 1 to 8 of 10"] if count == 10 else [])


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["no sample", "diverged to infinity"])
def test_every_figure_of_flights_that_end_early_is_drawn_whole_without_a_warning(windy, name):
    huge = cut(windy, 50, ending=Ending("velocity", 0.49, float("inf"), "must be finite"))
    huge.channels.update({name: values.copy() for name, values in huge.channels.items()})
    for values in huge.channels.values():
        values[-1], values[-2], values[-3], values[-4] = np.nan, np.inf, -np.inf, 1e300
    none = cut(windy, 0, ending=Ending("position", 0.0, float("nan"), "must be finite"))
    flight = {"no sample": none, "diverged to infinity": huge}[name]
    for figure_name, kind in figures_for(flight).items():
        figure = kind.draw(flight)
        width, height = figure.get_size_inches()
        assert any(text.get_text().startswith("diverged at ") for text in figure.texts)
        if name == "no sample":
            continue  # lines without a point have no extent to check
        cut_off = figure.get_tightbbox().extents * [-1.0, -1.0, 1.0, 1.0] > [0.01, 0.01, width + 0.01, height + 0.01]
        assert not cut_off.any(), figure_name


def test_true_estimated_and_measured_push_are_drawn_together_within_the_threshold(windy, drawn):
    channels = ("push_force", "push_estimate", "push_measured")
    for axis, panel in enumerate(drawn["push"].axes[:3]):
        for xy, name in zip(lines(panel), channels, strict=True):
            assert_drawn(xy, windy.time, windy[name][:, axis])
        level = [line.get_ydata()[0] for line in panel.get_lines() if len(line.get_ydata()) == 2]
        assert sorted(level) == [-0.3, 0.3]
        low, high = panel.get_ylim()
        assert all(low < v[:, axis].min() <= v[:, axis].max() < high for v in map(windy.__getitem__, channels))


def test_the_push_is_grey_where_it_is_not_usable_and_blue_during_the_tare(windy):
    flight = with_mission(windy, estimator=windy.mission["estimator"] | {"tare_start": 9.0, "tare_duration": 3.0})
    usable = np.ones(len(flight.time))
    usable[flight.time < 12.0] = usable[(flight.time > 40.0) & (flight.time < 41.0)] = 0.0
    flight = dataclasses.replace(flight, channels=flight.channels | {"push_usable": usable})
    for panel in figures()["push"].draw(flight).axes:
        half = flight.mission["mission"]["log_interval"] / 2.0 + 1e-9
        assert shaded(panel, PALE) == pytest.approx(np.array([[0.0, 12.0], [40.0, 41.0]]), abs=2.0 * half)
        assert shaded(panel, LIGHT_BLUE) == pytest.approx(np.array([[9.0, 12.0]]), abs=half)


def test_the_interaction_is_grey_only_while_a_push_is_followed(windy):
    for axis, panel in enumerate(figures()["interaction"].draw(windy).axes[:3]):
        active = windy["push_active"][:, axis] > 0.0
        assert (windy["admittance_force"][~active, axis] != 0.0).any() or not active.any()
        grey = shaded(panel, PALE) if active.any() else np.empty((0, 2))
        seconds = float((grey[:, 1] - grey[:, 0]).sum())
        assert seconds == pytest.approx(active.sum() * windy.mission["mission"]["log_interval"], abs=0.05)


def test_the_disturbance_is_grey_as_soon_as_the_pilot_is_ready_to_follow_a_person(windy):
    kind = figures()["disturbance"]
    drawn = kind.draw(windy)
    assert shaded(drawn.axes[0], PALE)[0, 0] < windy.mission["pushes"][0]["time"]
    assert drawn.legends[0].get_texts()[-1].get_text() == "ready"
    assert "Grey: the pilot is ready to follow a person." in kind.CAPTION.text


def test_where_a_push_acts_is_told_from_the_payload_and_only_while_it_is_large_enough(windy):
    level = np.tile([1.0, 0.0, 0.0, 0.0], (len(windy.time), 1))
    told = np.where((windy.time > 20.5) & (windy.time < 23.0), 0.4, 0.0)
    channels = windy.channels | {"attitude": level, "push_point_estimate": told}
    first, second = windy.mission["vehicle"]["quadrotors"]
    pushes = [
        {"force": [3.0, 0.0, 0.0], "time": 22.0, "sigma": 0.6, "point": [0.0, 0.5, 0.0]},
        {"force": [0.0, 9.0, 0.0], "time": 30.0, "sigma": 0.6, "point": [0.0, 0.5, 0.0]},
    ]
    vehicle = windy.mission["vehicle"] | {"quadrotors": [first | {"mass": 3.0}, second]}
    flight = with_mission(dataclasses.replace(windy, channels=channels), vehicle=vehicle, pushes=pushes)
    panel = figures()["push"].draw(flight).axes[3]
    across, along, estimate = lines(panel)
    seen = across[np.isfinite(across[:, 1])]
    half = 0.6 * np.sqrt(2.0 * np.log(3.0 / windy.mission["estimator"]["min_force"]))
    assert seen[[0, -1], 0] == pytest.approx([22.0 - half, 22.0 + half], abs=0.05)
    assert seen[:, 1] == pytest.approx(0.5 + (3.0 * 1.0 - 1.5 * 1.0) / 5.0)  # and the centre of mass of all
    assert not np.isfinite(along[:, 1]).any(), "a push along the beam has no place on it"
    seen = estimate[np.isfinite(estimate[:, 1])]
    assert set(seen[:, 1].tolist()) == {0.4}
    assert seen[[0, -1], 0] == pytest.approx([20.5, 23.0], abs=0.05)
    assert panel.get_ylim()[1] > 1.0 > 0.9 * panel.get_ylim()[1], "as wide as the beam"


def test_the_payload_that_flew_has_what_the_vehicle_weighs_more(windy):
    heavier = with_mission(windy, plant=windy.mission["plant"] | {"mass_scale": 3.8 / 3.5})
    assert true_payload_mass(heavier) == pytest.approx(0.8)
    panel = figures()["push"].draw(heavier).axes[4]
    assert panel.get_lines()[0].get_ydata() == pytest.approx([0.8, 0.8])
    assert_drawn(lines(panel)[0], windy.time, windy["payload_mass_estimate"])


def test_joints_are_drawn_quadrotor_by_quadrotor_with_what_was_measured_behind(windy):
    flight = of_count(windy, 4)
    axes = np.reshape(figures()["joints"].draw(flight).axes, (4, 2))
    for row, pair in enumerate(axes):
        for panel, name in zip(pair, ("joint_force", "joint_torque"), strict=True):
            measured, true = np.split(np.array(panel.get_lines(), dtype=object)[:6], 2)
            for axis in range(3):
                column = 3 * row + axis
                assert_drawn(true[axis].get_xydata(), flight.time, flight[name][:, column])
                assert_drawn(measured[axis].get_xydata(), flight.time, flight[f"measured_{name}"][:, column])
                assert true[axis].get_color() == measured[axis].get_color() == COMPONENTS[axis]["color"]
                assert true[axis].get_zorder() > measured[axis].get_zorder()


def test_joints_of_a_flight_without_sensors_are_scaled_to_what_follows_a_disturbed_start(paper):
    figure = figures()["joints"].draw(paper)
    assert len(figure.legends[0].get_texts()) == 3
    late = paper.time > 1.0
    for row in range(2):
        panel, part = figure.axes[2 * row], slice(3 * row, 3 * row + 3)
        low, high = panel.get_ylim()
        assert low < paper["joint_force"][late, part].min() < paper["joint_force"][late, part].max() < high
        assert np.abs(paper["joint_force"][:, part]).max() > high
        assert len(lines(panel)) == 3
    assert "first second" in figure.axes[0].get_title()


def test_every_rotor_is_drawn_between_its_limits(windy):
    flight = of_count(windy, 4)
    quadrotor = flight.mission["vehicle"]["quadrotors"][0]
    most = quadrotor["thrust_constant"] * quadrotor["max_speed"] ** 2
    *panels, share = figures()["rotors"].draw(flight).axes
    assert len(panels) == 4 * 4
    for rotor, panel in enumerate(panels):
        command, thrust = lines(panel)
        assert_drawn(command, flight.time, flight["rotor_commands"][:, rotor])
        assert_drawn(thrust, flight.time, flight["rotor_thrusts"][:, rotor])
        limits = [line.get_ydata()[0] for line in panel.get_lines()[2:]]
        assert limits == pytest.approx([0.0, most])
        assert panel.get_ylim()[0] < 0.0 < most < panel.get_ylim()[1]
    assert_drawn(lines(share)[0], flight.time, flight["allocation_fraction"])


def test_commands_far_beyond_the_limits_do_not_hide_the_thrust(windy, drawn):
    wild = dataclasses.replace(windy, channels=windy.channels | {"rotor_commands": 1e3 * windy["rotor_commands"]})
    low, high = figures()["rotors"].draw(wild).axes[0].get_ylim()
    assert (low, high) == drawn["rotors"].axes[0].get_ylim()
    assert high < 10.0


def test_a_fault_is_marked_at_its_time_and_lowers_the_limit_to_what_is_left(windy):
    fault = {"quadrotor": 2, "rotor": 3, "time": 15.0, "efficiency": 0.25, "known_after": 0.05}
    late = fault | {"rotor": 4, "time": 1e3}
    flight = with_mission(windy, faults=[fault, late])
    figure = figures()["rotors"].draw(flight)
    quadrotor = flight.mission["vehicle"]["quadrotors"][1]
    most = quadrotor["thrust_constant"] * quadrotor["max_speed"] ** 2
    marked = [[line for line in ax.get_lines() if line.get_gid() == "fault"] for ax in figure.axes]
    assert [i for i, found in enumerate(marked) if found] == [4 + 2]
    assert marked[6][0].get_xdata()[0] == 15.0
    limit = next(line.get_xydata() for line in figure.axes[6].get_lines() if len(line.get_xdata()) == 4)
    assert np.interp([14.9, 15.1], limit[:, 0], limit[:, 1]) == pytest.approx([most, 0.25 * most])
    assert [text.get_text() for text in figure.axes[6].texts] == ["25 % left"]
    assert "rotor fails" in [text.get_text() for text in figure.legends[0].get_texts()]
    quiet = figures()["rotors"].draw(with_mission(windy, faults=[late]))
    assert "rotor fails" not in [text.get_text() for text in quiet.legends[0].get_texts()]


def test_wind_contact_and_height_are_drawn_as_far_as_there_are_any(windy, drawn):
    axes = drawn["surroundings"].axes
    assert len(axes) == 4
    for panel, name in zip(axes, (*AIR, "contact_force"), strict=False):
        for axis in range(3):
            assert_drawn(lines(panel)[axis], windy.time, windy[name][:, axis])
    assert len(figures()["surroundings"].draw(without(windy, *AIR)).axes) == 2
    unbound = with_mission(without(windy, "contact_force"), ground={"model": "none"})
    assert len(figures()["surroundings"].draw(unbound).axes) == 2


def test_grey_is_where_the_vehicle_is_in_contact(windy, drawn):
    touching = np.linalg.norm(windy["contact_force"], axis=1) > 0.0
    half = windy.mission["mission"]["log_interval"] / 2.0 + 1e-9
    for panel in drawn["surroundings"].axes:
        grey = shaded(panel, PALE)
        assert grey[0, 0] == 0.0
        assert grey[-1, 1] == windy.time[-1]
        inside = [any(start - half <= t <= end + half for start, end in grey) for t in windy.time]
        assert np.array(inside)[touching].all()
        assert np.mean(inside) == pytest.approx(np.mean(touching), abs=0.01)


def test_the_height_is_the_lowest_soles_over_the_floor_that_the_engine_has(windy, drawn):
    mission = tl.load_mission("iris", WIND)
    vehicle = Vehicle.from_settings(mission.vehicle)
    floor = floor_from(mission, vehicle).height
    assert floor_height(windy) == pytest.approx(floor, abs=1e-12)
    height = clearance(windy, floor)
    assert_drawn(lines(drawn["surroundings"].axes[3])[0], windy.time, height)
    k = int(np.argmax(np.abs(windy["euler"]).max(axis=1)))
    turn = Rotation.from_quat(np.roll(windy["attitude"][k], -1))
    soles = [
        windy["position"][k] + turn.apply(np.add(arm, [x * q.feet_spread, y * q.feet_spread, -q.feet_depth]))
        for q, arm in zip(vehicle.quadrotors, vehicle.lever_arms, strict=True)
        for x in (-1.0, 1.0)
        for y in (-1.0, 1.0)
    ]
    assert height[k] == pytest.approx(min(z for _, _, z in soles) - floor, abs=1e-12)
    assert height[0] == pytest.approx(-mission.ground.sinkage, rel=1e-3), "at first it stands"


def test_a_floor_may_be_given_or_absent(windy, paper):
    assert floor_height(paper) is None
    assert floor_height(with_mission(windy, ground={"model": "floor", "height": -3.0})) == -3.0
    shadows = [figures()["path"].draw(flight).legends[0].get_texts()[1].get_text() for flight in (paper, windy)]
    assert shadows == ["its shadow", "its shadow on the floor"]


def polygons(figure, gid):
    """The corners on paper of what is filled under a name, and the order in which it is drawn."""
    found = (c for c in figure.axes[0].collections if isinstance(c, PolyCollection) and c.get_gid() == gid)
    return [(c.get_paths()[0].vertices[:4], c.get_zorder()) for c in found]


def on_the_paper(points, corners):
    """Whether each point is one of the corners of a polygon."""
    return [np.abs(corners - on_paper(p)).max(axis=1).min() < 1e-6 for p in points]


def test_the_floor_is_filled_at_its_height_and_none_where_there_is_none(windy, paper, drawn):
    ((corners, _),) = polygons(drawn["path"], "floor")
    level = corners - on_paper([0.0, 0.0, floor_height(windy)])
    places = np.linalg.solve(on_paper(np.eye(3)[:2]).T, level.T)
    assert places == pytest.approx(np.round(places), abs=1e-9), "the floor ends on the grid of metres"
    path = windy["position"].T[:2]
    assert (places.min(axis=1) <= path.min(axis=1)).all()
    assert (places.max(axis=1) >= path.max(axis=1)).all()
    assert polygons(figures()["path"].draw(paper), "floor") == []
    deep = with_mission(windy, ground={"model": "floor", "height": -100.0})
    assert polygons(figures()["path"].draw(deep), "floor") == []


def test_walls_are_drawn_where_they_stand_before_or_behind_the_path(windy, drawn):
    middle = windy["position"].mean(axis=0)
    away = 1.5 * NEAR[:2] / np.linalg.norm(NEAR[:2])
    along = np.array([-away[1], away[0]])
    ends = {"near": middle[:2] + 2.0 * away, "far": middle[:2] - 2.0 * away, "lost": middle[:2] + 500.0}
    walls = [{"start": list(p - 0.2 * along), "end": list(p + 0.2 * along), "top": 1.25} for p in ends.values()]
    floor = floor_height(windy)
    figure = figures()["path"].draw(with_mission(windy, walls=walls))
    near, far = polygons(figure, "wall")
    (path,) = (line for line in figure.axes[0].get_lines() if line.get_gid() == "path")
    assert near[1] > path.get_zorder() > far[1]
    for (corners, _), wall in zip((near, far), walls, strict=False):
        stands = [[*wall[end], z] for end in ("start", "end") for z in (floor, 1.25)]
        assert all(on_the_paper(stands, corners))
    assert "wall" in [text.get_text() for text in figure.legends[0].get_texts()]
    assert "wall" not in [text.get_text() for text in drawn["path"].legends[0].get_texts()]


def test_a_long_wall_is_cut_off_and_does_not_shrink_the_path(windy, drawn):
    bare = drawn["path"].axes[0]
    wall = {"start": [-500.0, 2.5], "end": [500.0, 2.5], "top": 90.0}
    walled = figures()["path"].draw(with_mission(windy, walls=[wall])).axes[0]
    assert np.ptp(walled.get_xlim()) < 2.0 * np.ptp(bare.get_xlim())


def test_walls_whose_corner_is_just_beyond_the_box_have_no_hole_there():
    corner = [15.0, -2.25]
    tables = [{"start": [9.0, 1.0], "end": corner}, {"start": corner, "end": [21.0, 1.0]}]
    points = np.array([[-1.0, -1.0, 0.0], [27.0, 5.0, 2.5], [*corner, 2.5]])
    scene = Scene3D(points)
    assert scene.box[1, 0] == -2.0
    walls = draw_walls(scene, tables, points)
    assert [wall.ends for wall in walls] == [(True, True), (True, True)]


@pytest.mark.parametrize("length", [3.0, 60.0])
def test_the_box_of_a_path_has_all_but_30_cm_of_what_is_shown(length):
    points = np.array([[0.0, -1.0, -0.2], [length, 1.0, 0.2]])
    box = Scene3D(points).box
    assert (box[:, 0] <= points[0] + 0.3).all()
    assert (box[:, 1] >= points[1] - 0.3).all()
