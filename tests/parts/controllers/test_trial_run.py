"""What gains may hold: numbers, and symbols that stand for numbers while a controller's start is traced."""

import pytest
from law_values import paper_vehicle

from tandemlift.compiler.tracer.graph import Graph
from tandemlift.core.errors import InputError
from tandemlift.parts.controllers import controller
from tandemlift.parts.controllers.trial_run import check_started


def test_gains_hold_numbers_or_symbols_and_nothing_else():
    chosen = controller("pid")
    gains, memory = chosen.start(chosen.settings.model_validate({"name": "pid"}), paper_vehicle(), 0.001)
    check_started("pid", gains, memory)
    check_started("pid", gains, memory._replace(velocity=Graph().inputs("x", memory.velocity)))
    with pytest.raises(InputError, match=r"memory\.velocity is str; it must be a number"):
        check_started("pid", gains, memory._replace(velocity="fast"))
