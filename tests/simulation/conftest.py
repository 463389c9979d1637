"""A controller in plain Python that computes as the compiled one does, to the last bit."""

from typing import Any, NamedTuple

import numpy as np
import pytest

import tandemlift as tl
from tandemlift.compiler.machine_code.functions import compiled
from tandemlift.core.types import flat, leaves, unflat
from tandemlift.parts.controllers import CONTROLLERS, Measured, Reference, control, nftsmc, register
from tandemlift.simulation.preparation import COMMAND

SIZE = leaves(COMMAND)


class ByHand(NamedTuple):
    """Gains of a controller that Python calls, which calls the paper's law compiled by itself."""

    gains: Any


@pytest.fixture
def by_hand():
    """Changes to `iris` by which its controller is a function that the loop does not know how to compile."""
    laws: dict[str, Any] = {}

    @control.register(ByHand, compiled=False)
    def call(k: ByHand, memory: Any, measured: Measured, reference: Reference) -> Any:
        handed = k.gains, memory, measured, reference
        if "law" not in laws:
            laws["law"] = compiled(control, *handed)
        (numbers,) = laws["law"](np.array([[x for part in handed for x in flat(part)]]))
        return unflat(numbers[:SIZE], COMMAND), unflat(numbers[SIZE:], memory)

    class Settings(nftsmc.NFTSMCSettings):
        name: str = "by-hand"

    @register("by-hand", Settings)
    def start(settings, vehicle, step):
        """The paper's controller, called from Python."""
        gains, memory = nftsmc.start(settings, vehicle, step)
        return ByHand(gains), memory

    yield {"controller": {**tl.load_mission("iris").controller.model_dump(mode="json"), "name": "by-hand"}}
    CONTROLLERS.pop("by-hand")
    control.table.pop(ByHand)
    control.interpreted.discard(ByHand)
