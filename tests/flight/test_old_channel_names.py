"""Flights and bags of e5ecfdc, before channels were renamed, are read by the new names."""

import dataclasses

import numpy as np
import pytest
from exported import flight_of

import tandemlift as tl
from tandemlift.export import recipes, topics
from tandemlift.export.reading import read_bag
from tandemlift.export.write import export
from tandemlift.flight.channels import CHANNELS
from tandemlift.flight.old_names import renamed_channel

NAMES = """
position velocity attitude euler rates reference_position reference_velocity reference_acceleration reference_euler
admittance_position admittance_velocity admittance_acceleration admittance_force push_force push_moment thrust moment
rotor_thrusts joint_force joint_torque rotor_commands allocated_thrust allocated_moment allocation_share wind_velocity
wind_force contact_force measured_position measured_velocity measured_attitude measured_rates measured_specific_force
measured_joint_force measured_joint_torque estimated_position estimated_velocity estimated_attitude estimated_rates
push_measured push_estimate push_moment_estimate push_point_estimate payload_mass_estimate sensor_disagreement
push_usable disturbance_force disturbance_moment disturbance_residual disturbance_turning_residual phase push_heard
push_on added_damping reference_yaw_rate alarm refused rotor_lost
"""
OF_E5ECFDC = NAMES.split()
OLD = {
    "allocation_share": "allocation_fraction",
    "disturbance_turning_residual": "disturbance_angular_residual",
    "push_heard": "push_filtered",
    "push_on": "push_active",
    "refused": "failed_check",
    "rotor_lost": "failed_rotor",
}


@pytest.fixture
def old():
    """A flight with every channel of then, by the names of then."""
    flight = flight_of("iris")
    names = {renamed_channel(name): name for name in OF_E5ECFDC}
    return dataclasses.replace(flight, channels={names[name]: flight[name] for name in flight if name in names})


def test_every_channel_of_then_is_a_channel_of_now(old):
    assert list(old) == OF_E5ECFDC
    assert {name: renamed_channel(name) for name in OF_E5ECFDC if renamed_channel(name) != name} == OLD
    assert {renamed_channel(name) for name in OF_E5ECFDC} <= set(CHANNELS)


def test_a_saved_flight_of_then_has_the_new_names_in_the_old_order_and_says_so(old, tmp_path):
    path = old.save(tmp_path / "flight.npz")
    with pytest.warns(tl.FlightWarning) as notices:
        loaded = tl.Flight.load(path)
    assert list(loaded) == [renamed_channel(name) for name in OF_E5ECFDC]
    for name in OF_E5ECFDC:
        assert np.array_equal(loaded[renamed_channel(name)], old[name]), name
    (notice,) = map(str, (found.message for found in notices))
    assert all(f"channel {before} was renamed to {now}" in notice for before, now in OLD.items())
    assert loaded.info("failed_check").meaning == CHANNELS["failed_check"].meaning


def test_a_flight_with_a_channel_by_both_names_is_refused(old, tmp_path):
    both = dataclasses.replace(old, channels={**old.channels, "push_active": old["push_on"]})
    with pytest.raises(tl.InputError, match="push_on and push_active: must not both be given"):
        tl.Flight.load(both.save(tmp_path / "flight.npz"))


@pytest.mark.parametrize("ending", ["bag", "mcap"])
def test_a_bag_of_then_has_the_new_names(ending, tmp_path, monkeypatch):
    pytest.importorskip("rosbags")
    flight, before = flight_of("iris"), {now: old for old, now in OLD.items()}
    labels = recipes._labels
    filtered = [r._replace(name=r.name.replace("push/filtered", "push/heard")) for r in topics.SOMETIMES]
    with monkeypatch.context() as then:
        then.setattr(topics, "SOMETIMES", tuple(filtered))
        then.setattr(topics, "PILOT", topics.PILOT[::-1])  # names tell which number is which, not their order
        then.setattr(
            recipes,
            "_labels",
            lambda name, width: [s.replace(name, before.get(name, name)) for s in labels(name, width)],
        )
        path = export(flight, tmp_path / f"flight.{ending}")
    found = read_bag(path)
    assert list(found) == list(flight)
    for name in OLD.values():
        assert np.array_equal(found[name], flight[name]), name
