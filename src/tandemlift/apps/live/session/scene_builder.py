"""The scene of a mission, from its settings or the tables of a saved flight; and the frames of a flight in progress."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from tandemlift.apps.live.session import frames
from tandemlift.apps.live.session import server_messages as server
from tandemlift.core.files import __version__
from tandemlift.core.phases import PHASE_NAMES
from tandemlift.core.refusals import ALARM_TEXTS
from tandemlift.core.types import Array
from tandemlift.engines.models.visuals import BEAM_RADIUS, SHAPELESS, VisualShape, vehicle_shapes
from tandemlift.parts.contact.surroundings import floor_height_of
from tandemlift.parts.mechanics.vehicle import Quadrotor, Vehicle

if TYPE_CHECKING:
    from tandemlift.missions import Mission
    from tandemlift.simulation.plan import FlightPlan

SPRING = server.SceneSpring(stiffness=8.0, damping=2.0, max_force=8.0)  # of a page's hand, where a mission has none
WALL_THICKNESS = 0.02  # m, as drawn; walls have none
TURNING = ("blades", "rotor")  # begin the names of the shapes that turn
DIGITS = 6  # decimals of shapes [m]
PLOT_SPAN, PLOT_RATE = 20, 20  # s that a page's plots show; samples that they keep of a second


def scene_of(mission: Mission, engine: str) -> server.FlightScene:
    """The scene of a mission in an engine, without the parameters that may be changed in flight."""
    from tandemlift.missions import tables_of

    vehicle = Vehicle.from_settings(mission.vehicle)
    floor = floor_height_of(vehicle, tables_of(mission))
    height = _lowest(mission.initial.position[2], vehicle) if floor is None else floor
    walls = [w.model_dump(mode="json") for w in mission.all_walls]
    scene, hover = scene_of_tables(tables_of(mission), walls, vehicle, engine, height), mission.hover
    if hover.actuators.model == "rotors":
        across = hover.weight * math.tan(getattr(mission.controller, "max_tilt", None) or mission.compliance.max_tilt)
        scene["authority"] = [across, hover.weight, hover.lift - hover.weight, *hover.authority.tolist()]
    return scene


def scene_of_tables(
    tables: Mapping[str, Any], walls: Sequence[Mapping[str, Any]], vehicle: Vehicle, engine: str, floor: float
) -> server.FlightScene:
    """The scene of a mission given as nested tables, with all its walls.

    `floor` [m]: the height of the floor, or of the level drawn.
    """
    return server.FlightScene(
        mission=tables["mission"]["name"],
        controller=tables["controller"]["name"],
        engine=engine,
        version=__version__,
        step=tables["mission"]["step"],
        rate=frames.RATE,
        vehicle=_vehicle(vehicle),
        ground=tables.get("ground", {}).get("model", "none") != "none",
        floor=floor,
        walls=[_wall(w, floor) for w in walls if w["top"] > floor],
        corridor=_corridor(tables.get("corridor", {})),
        threshold=list(tables["admittance"]["threshold"]),
        spring=SPRING,
        phases=list(PHASE_NAMES),
        alarms=list(ALARM_TEXTS),
        fields=list(frames.layout_for(vehicle.rotor_count)),
        parameters=[],
    )


def _lowest(height: float, vehicle: Vehicle) -> float:
    """Height of the soles of a level vehicle with its centre of mass at a height [m]."""
    return float(height + np.min(vehicle.soles[:, 2]))


def _vehicle(vehicle: Vehicle) -> server.SceneVehicle:
    payload = vehicle.payload
    low, high = payload.box
    if payload.hulls:
        width, length, height = high - low
    elif payload.length:
        length, width = payload.length, 2.0 * (payload.radius or BEAM_RADIUS)
        height = width
    else:
        length, width, height = SHAPELESS, SHAPELESS, SHAPELESS
    middle = vehicle.origin + 0.5 * (low + high) if payload.hulls else vehicle.origin
    shapes = vehicle_shapes(vehicle)
    blades, discs = ([_shape(s) for s in shapes if s.name.startswith(name)] for name in TURNING)
    turning = list(zip(blades, discs, strict=True))
    parts = zip(vehicle.quadrotors, vehicle.lever_arms, strict=True)
    return server.SceneVehicle(
        quadrotors=[_quadrotor(q, center, turning[4 * i : 4 * i + 4]) for i, (q, center) in enumerate(parts)],
        payload=server.ScenePayload(
            position=_list(middle), length=float(length), width=float(width), height=float(height)
        ),
        shapes=[_shape(s) for s in shapes if not s.name.startswith(TURNING)],
        mass=vehicle.mass,
    )


def _quadrotor(
    quadrotor: Quadrotor, center: Array, shapes: Sequence[tuple[server.SceneShape, server.SceneShape]]
) -> server.SceneQuadrotor:
    """A quadrotor at `center`; `shapes`: blades and disc of each rotor."""
    rotors = [
        server.SceneRotor(
            position=_list(center + np.array([x, y, 0.0])),
            spin=int(spin),
            radius=quadrotor.rotor_radius,
            max_thrust=quadrotor.thrust_limit,
            max_speed=quadrotor.max_speed,
            blades=blades,
            disc=disc,
        )
        for (x, y), spin, (blades, disc) in zip(quadrotor.rotors, quadrotor.spins, shapes, strict=True)
    ]
    return server.SceneQuadrotor(position=_list(center), guard=quadrotor.guard_radius, rotors=rotors)


def _shape(shape: VisualShape) -> server.SceneShape:
    return server.SceneShape(
        kind=shape.kind,
        size=_list(np.round(shape.size, DIGITS)),
        position=_list(np.round(shape.position, DIGITS)),
        axes=_list(np.round(shape.axes.T.ravel(), DIGITS)),
        color=shape.color,
    )


def _wall(wall: Mapping[str, Any], floor: float) -> server.SceneWall:
    """A wall from the floor to its top."""
    (x, y), (end_x, end_y), top = wall["start"], wall["end"], wall["top"]
    return server.SceneWall(
        center=[(x + end_x) / 2.0, (y + end_y) / 2.0, (floor + top) / 2.0],
        size=[math.hypot(end_x - x, end_y - y), WALL_THICKNESS, top - floor],
        heading=math.atan2(end_y - y, end_x - x),
    )


def _corridor(corridor: Mapping[str, Any]) -> server.SceneCorridor | None:
    if not corridor.get("centreline"):
        return None
    return server.SceneCorridor(centreline=corridor["centreline"], width=corridor["width"], height=corridor["height"])


def _list(values: Array) -> list[float]:
    return [float(v) + 0.0 for v in values]


class FrameBuilder:
    """Builds the frames of a mission's flight.

    Args:
        plan: of the mission in its engine.

    Attributes:
        scene: the description that a page needs to interpret frames.
    """

    def __init__(self, plan: FlightPlan) -> None:
        from tandemlift.missions import tables_of

        mission = plan.mission
        self.scene = scene_of(mission, plan.engine)
        self._layout = frames.layout_for(Vehicle.from_settings(mission.vehicle).rotor_count)
        self._phases, self._columns = (
            frames.phase_times(tables_of(mission)["phases"]),
            frames.channel_columns(plan.sample),
        )
        self._start = plan.model.flight_state.state

    def values(self, sample: Array, at: float) -> dict[str, frames.Components]:
        """The values of the fields in a sample, at a time [s], component by component."""
        channels = {name: tuple(map(float, sample[columns])) for name, columns in self._columns.items()}
        return frames.field_values(channels, at, self._phases)

    def past(self, time: Array, samples: Array) -> list[bytes]:
        """The frames of the last seconds of a log, of samples (n, …) at times (n,) [s], oldest first."""
        last = len(time) - 1
        every = max(round(last / (PLOT_RATE * time[-1])), 1) if last else 1
        seen = slice(max(last - PLOT_RATE * PLOT_SPAN * every, last % every), None, every)
        time, samples = time[seen], samples[seen]
        channels = {name: frames.components_of(samples[:, columns]) for name, columns in self._columns.items()}
        values = frames.arrays_of(frames.field_values(channels, time, self._phases))
        return [row.tobytes() for row in frames.pack_frames(self._layout, values, len(time))]

    def frame(self, values: Mapping[str, ArrayLike]) -> bytes:
        """The frame of some values."""
        return frames.pack_frames(self._layout, values).tobytes()

    def first(self) -> bytes:
        """The frame of a flight that has not begun."""
        s = self._start
        at = {"position": s.position, "attitude": s.attitude, "velocity": s.velocity, "reference": s.position}
        return self.frame({name: np.array(value) for name, value in at.items()})
