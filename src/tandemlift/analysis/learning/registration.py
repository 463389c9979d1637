"""The names of the environments in Gymnasium's registry."""

from __future__ import annotations

from tandemlift.analysis.learning.tasks import TASKS
from tandemlift.core.errors import InputError

HOME = "tandemlift.analysis.learning.environments"


def register_environments() -> None:
    """Register `tandemlift/FollowHand-v0` and the others with Gymnasium, as `import tandemlift` does once it is loaded.

    Raises:
        InputError: Gymnasium is not installed.
    """
    try:
        from gymnasium.envs.registration import register, registry
    except ImportError:
        raise InputError("gymnasium is not installed: pip install 'tandemlift[gymnasium]'") from None
    for name in TASKS:
        if f"tandemlift/{name}-v0" not in registry:
            register(
                f"tandemlift/{name}-v0",
                entry_point=f"{HOME}:FlightEnv",
                vector_entry_point=f"{HOME}:FlightVectorEnv",
                kwargs={"task": name},
                order_enforce=True,
            )
