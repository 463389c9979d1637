"""The modes of a MAVLink vehicle: hold, take-off, land, offboard, arming, and the failsafe on lost setpoints.

Numbers of modes and names of parameters are PX4's, as clients expect them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from tandemlift import InputError
from tandemlift.apps.clients.setpoints import ZERO, FullStateSetpoint, PositionSetpoint, QuadrotorState, Setpoint, Stop


class MavlinkMode(NamedTuple):
    """A mode: its name, main and sub mode."""

    name: str
    main: int
    sub: int = 0

    @property
    def custom(self) -> int:
        """Its number in a heartbeat."""
        return self.main << 16 | self.sub << 24


HOLD, TAKEOFF, LAND, OFFBOARD = (
    MavlinkMode("hold", 4, 3),
    MavlinkMode("take-off", 4, 2),
    MavlinkMode("land", 4, 6),
    MavlinkMode("offboard", 6),
)
MODES = {(mode.main, mode.sub): mode for mode in (HOLD, TAKEOFF, LAND, OFFBOARD)}
AUTOPILOTS = {"generic": 0, "px4": 12}  # MAV_AUTOPILOT, by which clients choose their names and numbers of modes
LOSS_TIME, LOSS_ACTION, HEIGHT = "COM_OF_LOSS_T", "COM_OBL_RC_ACT", "MIS_TAKEOFF_ALT"
CLIMB, SINK = "MPC_TKO_SPEED", "MPC_LAND_SPEED"
ACTIONS = {4.0: LAND, 5.0: HOLD}  # of the failsafe
PARAMETERS = {  # value at the start, bounds
    LOSS_TIME: (1.0, 0.1, 60.0),  # s; as PX4
    LOSS_ACTION: (4.0, 4.0, 5.0),
    HEIGHT: (2.5, 0.3, 100.0),  # m; as PX4
    CLIMB: (0.7, 0.1, 2.0),  # m/s; chosen
    SINK: (0.5, 0.1, 2.0),  # m/s; chosen
}
LIFTOFF, DRIFT, DWELL = 0.05, 0.1, 0.5  # m above the start; m/s; s on the floor, after which a landing has ended
DEEPEST = 1.0  # m below the start, where a landing ends, so that the rotors let go


class Autopilot:
    """The modes of one quadrotor, whose `parameters` may change; its heartbeats name a `kind` of autopilot.

    Attributes:
        state: the last one.
        origin: where it stood at the start [m, world].
        failsafe: the mode that lost setpoints have just led to, until the caller resets it to None.
        crew: the autopilots of all quadrotors on the body, itself among them: armed ones land and disarm together.
    """

    def __init__(self, state: QuadrotorState, parameters: Mapping[str, float], kind: int = 0) -> None:
        self.kind, self.state, self.origin, self._parameters = kind, state, state.position, parameters
        self.armed, self.crew = False, [self]
        self.failsafe: MavlinkMode | None = None
        self._setpoint: Setpoint = Stop()
        self._heard, self._sender = -math.inf, object()
        self.enter(HOLD)

    @property
    def in_air(self) -> bool:
        """Whether it is off the floor that it started from."""
        return self.state.position[2] - self.origin[2] > LIFTOFF

    def enter(self, mode: MavlinkMode) -> None:
        """Begin a mode, here and with this yaw, whatever it needs."""
        self.mode, self._settled, self._waits = mode, math.inf, mode is HOLD and not self.in_air
        self._target, self._yaw = self.state.position, self.state.euler[2]

    def _enter_together(self, mode: MavlinkMode) -> MavlinkMode:
        """Begin a mode with all that are armed, or land with those that do: targets must not pull on each other."""
        armed = [one for one in self.crew if one.armed]
        mode = LAND if any(one.mode is LAND for one in armed) else mode
        for one in armed:
            if one.mode is not LAND:
                one.enter(mode)
        return mode

    def arm(self) -> None:
        """Let the rotors turn, as soon as a mode asks for it; offboard, if that was chosen before."""
        if not self.armed:
            self.armed = True
            if self.mode is HOLD:
                self.enter(HOLD)
                self._waits = True  # also in the air, where it is carried

    def disarm(self, *, force: bool) -> None:
        """Stop the rotors; in the air only by force, else an `InputError`."""
        if self.armed and self.in_air and not force:
            raise InputError("in the air: land, or disarm by force")
        self.armed = False
        self.enter(HOLD)

    def take_off(self, height: float | None = None) -> None:
        """Climb to a height above the start [m], that of the parameter if None, and hold; or an `InputError`."""
        height, (_, low, high) = self._parameters[HEIGHT] if height is None else height, PARAMETERS[HEIGHT]
        if not self.armed or (self.in_air and not self._waits):
            raise InputError(f"take-off: {'in the air' if self.armed else 'arm first'}")
        if not low <= height <= high:
            raise InputError(f"take-off: {low:g} to {high:g} m above the start")
        self._top = self.origin[2] + height
        self.enter(TAKEOFF)

    def switch(self, mode: MavlinkMode) -> None:
        """Begin a mode, or an `InputError`: offboard without setpoints, take-off or landing while not armed."""
        if mode is TAKEOFF:
            self.take_off()
        elif mode is OFFBOARD and self._has_lost_setpoints():
            raise InputError("offboard: send setpoints first")
        elif mode is LAND:
            if not self.armed:
                raise InputError("land: not armed")
            self._enter_together(LAND)
        else:
            self.enter(mode)

    def offer(self, setpoint: Setpoint, sender: object) -> None:
        """Keep the setpoint of a client; or an `InputError`, as long as another client's come in time."""
        if sender != self._sender and not self._has_lost_setpoints():
            raise InputError("setpoints: another client sends them")
        self._setpoint, self._heard, self._sender = setpoint, self.state.time, sender

    def step(self, state: QuadrotorState) -> Setpoint:
        """The setpoint for the present state."""
        dt, self.state = state.time - self.state.time, state
        if self.armed and self.mode is OFFBOARD and self._has_lost_setpoints():
            self.failsafe = self._enter_together(ACTIONS[self._parameters[LOSS_ACTION]])
        if self.mode is LAND and self._has_landed():
            for one in self.crew:
                one.disarm(force=True)
        if not self.armed or self._waits:
            return Stop()
        if self.mode is OFFBOARD:
            return self._setpoint
        x, y, z = self._target
        if self.mode is TAKEOFF and z >= self._top:
            self.mode = HOLD
        if self.mode is HOLD:
            return PositionSetpoint(self._target, self._yaw)
        speed = self._parameters[CLIMB] if self.mode is TAKEOFF else -self._parameters[SINK]
        self._target = x, y, max(z + speed * dt, self.origin[2] - DEEPEST)
        return FullStateSetpoint(self._target, (0.0, 0.0, speed), ZERO, self._yaw)

    def _has_lost_setpoints(self) -> bool:
        return self.state.time - self._heard > self._parameters[LOSS_TIME]

    def _has_landed(self) -> bool:
        """Whether it has stood on the floor for a while."""
        rests = not self.in_air and math.hypot(*self.state.velocity) < DRIFT
        self._settled = min(self._settled, self.state.time) if rests else math.inf
        return self.state.time - self._settled > DWELL
