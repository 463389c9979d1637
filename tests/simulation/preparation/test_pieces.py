"""A step that is cut into functions, as machines with few registers want it, has the bits of the step in one."""

import re

import pytest
from flights import different

import tandemlift as tl
from tandemlift.core.caching import LastUsed
from tandemlift.simulation import plan
from tandemlift.simulation.preparation import compiled_flight
from tandemlift.simulation.preparation.loops import LoopWriter


@pytest.mark.parametrize(("mission", "largest"), [("paper", 100), ("iris", 500)])
def test_a_step_in_pieces_has_the_bits_of_the_step_in_one(mission, largest, tmp_path, monkeypatch):
    mission = tl.load_mission(mission, {"mission.duration": 4.0})
    whole, writers = tl.fly(mission), []

    def in_pieces(traced, lanes, alike):
        writers.append(LoopWriter(traced, lanes, largest=largest, alike=alike))
        return writers[-1]

    monkeypatch.setenv("TANDEMLIFT_CACHE", str(tmp_path))
    monkeypatch.setattr(plan, "LOOP_CODE", LastUsed(8))
    monkeypatch.setattr(compiled_flight, "LoopWriter", in_pieces)
    assert different(tl.fly(mission), whole) == []
    pieces = re.findall(r"(?ms)^define [^\n]*@(?:acting|end)\d+_part.*?^}", writers[0].module.text)
    assert len(pieces) > 2
    assert all(piece.count(" = f") < 3 * largest for piece in pieces)  # of arithmetic
    assert sum(piece.count(" = f") for piece in pieces) > largest
