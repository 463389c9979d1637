"""The variants of the body with contact are functions of their own in a flight alone; blocks compute them in place."""

import re

from flights import LOST, different, lanes

import tandemlift as tl
from tandemlift.simulation.plan import FlightPlan
from tandemlift.simulation.preparation import LANES

SLOW = {"sensors.interval": 0.004, "sensors.motion.interval": 0.008}  # numbers that are written before the body moves


def functions(mission, width):
    """The functions of a loop's module: the lines of each, and its attributes."""
    code = FlightPlan(mission).loop_code
    text = code.written("loop" if width == 1 else "loop sensors", width).text
    found = re.findall(r"^define [^\n]*@(\w+)\([^\n]*\) (#\d) \{\n(.*?)^\}", text, re.M | re.S)
    attributes = dict(re.findall(r"^attributes (#\d) = \{ (.*) \}$", text, re.M))
    return {name: (body.count("\n"), attributes[number].split()) for name, number, body in found}


def test_a_flight_alone_has_most_of_its_contact_where_llvm_looks_for_no_vectors():
    alone = functions(tl.load_mission("zigzag"), 1)
    lines, attributes = alone["near_body"]
    assert "noimplicitfloat" in attributes  # LLVM's SLPVectorizerPass leaves such functions out
    assert lines > sum(n for name, (n, _) in alone.items() if name not in ("near_body", "fly_"))
    assert all("noimplicitfloat" not in about for name, (_, about) in alone.items() if name != "near_body")
    assert not {"near_body", "feet_body"} & functions(tl.load_mission("zigzag"), LANES).keys()


def test_with_rates_a_vehicle_that_is_thrown_over_falls_alone_with_the_bits_of_a_block():
    flown = lanes("zigzag", **SLOW)
    together = tl.fly_many(flown)
    for i in LOST:  # whose hulls strike the floor or a wall
        alone = tl.fly(flown[i])
        assert alone.ending is not None
        assert different(together[i], alone) == []
