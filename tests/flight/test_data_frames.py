"""A flight as a pandas DataFrame and as an xarray Dataset: every number, its name and its unit."""

import json
import sys

import numpy as np
import pytest
import xarray

import tandemlift as tl
from tandemlift.flight.data_frames import to_pandas, to_xarray

FLOWN = {
    "iris": {"mission.duration": 0.5, "wind.model": "air"},
    "zigzag": {"mission.duration": 0.5},
    "four": {"mission.duration": 0.5},
}


@pytest.fixture(scope="module", params=FLOWN)
def flight(request):
    return tl.fly(tl.load_mission(request.param, FLOWN[request.param]))


def columns_of(table, name):
    """The columns of a channel, in their order."""
    own = [c for c in table if c == name or (c.startswith(f"{name}_") and c.removeprefix(f"{name}_") in PARTS)]
    return table[own].to_numpy()


ROTORS = {f"rotor_{i}" for i in range(1, 17)}
JOINTS = {f"quadrotor_{i}_{axis}" for i in range(1, 5) for axis in "xyz"}
PARTS = {*"wxyz", "roll", "pitch", "yaw", *ROTORS, *JOINTS}


def test_a_data_frame_has_every_number_of_every_channel_and_nothing_else(flight):
    table = flight.to_pandas()
    assert table.index.name == "time"
    assert table.index.to_numpy().tobytes() == flight.time.tobytes()
    for name, values in flight.channels.items():
        np.testing.assert_array_equal(columns_of(table, name).reshape(values.shape), values, err_msg=name)
    assert table.shape[1] == sum(values[0].size for values in flight.channels.values())
    assert table.columns.is_unique


def test_the_columns_of_a_data_frame_are_named_by_component_and_have_units(flight):
    table, units = flight.to_pandas(), flight.to_pandas().attrs["units"]
    for column, values, unit in [
        ("position_z", flight["position"][:, 2], "m"),
        ("attitude_w", flight["attitude"][:, 0], "1"),
        ("euler_yaw", flight["euler"][:, 2], "rad"),
        ("thrust", flight["thrust"], "N"),
        ("rotor_thrusts_rotor_5", flight["rotor_thrusts"][:, 4], "N"),
        ("joint_torque_quadrotor_2_x", flight["joint_torque"][:, 3], "N m"),
    ]:
        np.testing.assert_array_equal(table[column], values)
        assert units[column] == unit
    assert units.keys() == {"time", *table.columns}
    assert table.attrs["metrics"] == flight.metrics()
    assert table.attrs["name"] == flight.name
    assert table.attrs["ending"] is None


def test_a_data_set_has_every_channel_with_its_unit_frame_and_meaning(flight):
    data = flight.to_xarray()
    assert set(data.data_vars) == set(flight.channels)
    assert data["time"].values.tobytes() == flight.time.tobytes()
    for name, values in flight.channels.items():
        info = flight.info(name)
        np.testing.assert_array_equal(data[name].values.reshape(values.shape), values, err_msg=name)
        assert data[name].attrs == {
            k: v for k, v in {"units": info.unit, "frame": info.frame, "long_name": info.meaning}.items() if v
        }
        assert "component" not in data[name].dims
    assert data["time"].attrs["units"] == "s"
    assert json.loads(data.attrs["metrics"]) == flight.metrics()
    assert json.loads(data.attrs["mission"]) == flight.mission
    assert json.loads(data.attrs["version"]) == flight.version


def test_a_data_set_is_selected_by_axis_angle_rotor_and_quadrotor(flight):
    data = flight.to_xarray()
    for found, expected in [
        (data["position"].sel(axis="z"), flight["position"][:, 2]),
        (data["attitude"].sel(quaternion="w"), flight["attitude"][:, 0]),
        (data["euler"].sel(angle="yaw"), flight["euler"][:, 2]),
        (data["rotor_thrusts"].sel(rotor=5), flight["rotor_thrusts"][:, 4]),
        (data["joint_force"].sel(quadrotor=2, axis="x"), flight["joint_force"][:, 3]),
        (data["position"].sel(time=0.25, axis="x"), flight["position"][25, 0]),
    ]:
        np.testing.assert_array_equal(found, expected)


def test_a_data_set_written_to_netcdf_is_read_back_the_same(flight, tmp_path):
    written = flight.to_xarray()
    written.to_netcdf(tmp_path / "flight.nc", engine="scipy")
    with xarray.open_dataset(tmp_path / "flight.nc", engine="scipy") as read:
        xarray.testing.assert_equal(read.load(), written)
        assert read.attrs == written.attrs
        assert all(read[name].attrs == written[name].attrs for name in (*written.data_vars, "time"))


def test_what_is_changed_in_a_table_leaves_the_flight_as_it_is():
    flight = tl.fly(tl.load_mission("hover", {"mission.duration": 0.1}))
    before = {name: values.copy() for name, values in flight.channels.items()} | {"time": flight.time.copy()}
    table, data = flight.to_pandas(), flight.to_xarray()
    table.loc[:, :] = 1.0
    for variable in data.data_vars.values():
        variable[:] = 1.0
    table.attrs["metrics"]["steps"] = 0
    assert all(np.array_equal(flight[name], values) for name, values in before.items())
    assert flight.metrics()["steps"] == 100


def test_a_flight_that_turned_over_says_so():
    lost = tl.fly(tl.load_mission("hover", {"disturbance.moment": [0.0, 60.0, 0.0]}))
    assert lost.to_pandas().attrs["ending"] == str(lost.ending)
    data = lost.to_xarray()
    assert data.attrs["ending"] == str(lost.ending)
    assert json.loads(data.attrs["metrics"]) == lost.metrics()


@pytest.mark.parametrize(("package", "convert"), [("pandas", to_pandas), ("xarray", to_xarray)])
def test_without_the_package_the_command_that_installs_it_is_said(package, convert, monkeypatch):
    flight = tl.fly(tl.load_mission("hover", {"mission.duration": 0.1}))
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(tl.InputError, match=rf"to_{package} needs {package}: pip install 'tandemlift\[{package}\]'"):
        convert(flight)
