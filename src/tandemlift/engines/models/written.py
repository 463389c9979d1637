"""A mission as the model of another simulator, or of its vehicle: the text of a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tandemlift.parts.mechanics.vehicle import Vehicle

if TYPE_CHECKING:
    from tandemlift.engines.models.scene import Scene

ENDINGS = (".sdf", ".xml", ".urdf")  # of a world of Gazebo, a model of MuJoCo, a robot description of ROS
WORLD, _, ROBOT = ENDINGS


def model_of(scene: Scene, ending: str, plugin: int | str | None = None) -> str:
    """The text of a file with this ending.

    Args:
        scene: of a mission.
        ending: one of `ENDINGS`.
        plugin: of a world, the port of Gazebo's plugin, or "ros" for the one that is led over ROS 1.

    Raises:
        InputError: the vehicle cannot be such a model, or MuJoCo is not installed.
    """
    if ending == WORLD:
        from tandemlift.engines.models.sdf import world

        return world(scene, plugin)
    if ending == ROBOT:
        return robot_of(Vehicle.from_settings(scene.vehicle), scene.mission.name)
    from tandemlift.engines.models.mjcf import model_text

    return model_text(scene)


def robot_of(vehicle: Vehicle, name: str) -> str:
    """The robot description of a vehicle."""
    from tandemlift.engines.models.urdf import urdf

    return urdf(vehicle, name)
