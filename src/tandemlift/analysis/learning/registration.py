"""The names of the environments in Gymnasium's registry."""

from __future__ import annotations

from typing import Any, cast

from tandemlift.analysis.learning.gymnasium_tasks import TASKS
from tandemlift.core.errors import extra


def register_environments() -> None:
    """Register `tandemlift/Transport-v0` and the other environments with Gymnasium.

    Raises:
        InputError: Gymnasium is not installed.
    """
    with extra("gymnasium", "an environment for learning"):
        from gymnasium.envs.registration import register, registry

    from tandemlift.analysis.learning.gymnasium_environments import FlightEnv, FlightVectorEnv

    for task in TASKS:
        name = f"tandemlift/{task}-v0"
        if name not in registry:
            alone, many = cast("Any", FlightEnv), cast("Any", FlightVectorEnv)  # whose first argument has a name
            register(name, entry_point=alone, vector_entry_point=many, kwargs={"task": task})
