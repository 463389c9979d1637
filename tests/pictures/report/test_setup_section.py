"""The set-up of a flight in words."""

import pytest

import tandemlift as tl
from tandemlift.pictures.report.setup_section import setup_rows

pytestmark = pytest.mark.filterwarnings("ignore::tandemlift.FlightWarning")
PINE = {"vehicle.payload.material": "pine", "vehicle.payload.radius": 0.011}
SPRUNG = {"vehicle.quadrotors.0.joint_stiffness": [2e4, 2e4, 1e4, 15.0, 15.0, 40.0]}


@pytest.mark.parametrize(
    ("keys", "vehicle"),
    [
        ({}, "2 quadrotors and a payload of 0.5 kg, 3.5 kg in all"),
        (PINE, "2 quadrotors and a payload of 0.5 kg, which bends (pine), 3.5 kg in all"),
        (SPRUNG, "2 quadrotors and a payload of 0.5 kg, 3.5 kg in all; mounts give"),
    ],
)
def test_the_vehicle_says_what_bends_and_what_gives(keys, vehicle):
    flight = tl.fly(tl.load_mission("iris", {**keys, "mission.duration": 0.1}))
    assert setup_rows(flight)[0] == ("Vehicle", vehicle)
