"""A flight in real time that a middleware publishes and that pushes, requests and parameters from it change."""

from __future__ import annotations

import importlib.util
import shlex
import signal
import sys
import threading
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from tandemlift import Flight
from tandemlift.apps.export.recipes import WRENCH
from tandemlift.apps.export.topics import ROOT
from tandemlift.apps.live.session.server_messages import ENDS
from tandemlift.apps.live.session.session import Session
from tandemlift.apps.ros.dds_types import missing_packages
from tandemlift.apps.ros.diagnostics import FlightDiagnostics
from tandemlift.apps.ros.middleware import Middleware
from tandemlift.apps.ros.parameters import Parameters
from tandemlift.apps.ros.pushes import REQUESTS, Pushes, RequestServices
from tandemlift.apps.ros.sample_queue import Clock, SampleBatch, SampleQueue, as_flight, steps_between_samples
from tandemlift.apps.ros.topics import LatchedTopics, MarkerTopics, SampleTopics
from tandemlift.core.errors import InputError, install_command, without_flight_warnings
from tandemlift.engines.rospy import has_rospy
from tandemlift.missions import tables_of

PUSH = f"{ROOT}/push"
RATE = 100.0  # Hz
MARKERS, PATHS, STATUS, STILL, PARAMETERS = 0.05, 0.2, 1.0, 2.0, 0.2  # s, from one to the next
PATIENCE = 0.1  # s, for a sample


class FlightNode:
    """Publishes a session's flight, and passes messages of the middleware to it.

    Args:
        session: the flight; not yet started.
        middleware: publishes and receives.
        rate: of samples [Hz].

    Raises:
        InputError: the rate is not possible.
    """

    def __init__(self, session: Session, middleware: Middleware, rate: float = RATE) -> None:
        self._session, self._middleware = session, middleware
        self._flight = session.flight
        vehicle = self._flight.now.hover.vehicle
        self._tables = tables_of(self._flight.now)
        self._clock = Clock(session)
        self._queue = SampleQueue(steps_between_samples(rate, self._flight.dt), self._clock)
        self.diagnostics = FlightDiagnostics(middleware)
        self._pushes = Pushes(session, self.diagnostics.add)
        self._parameters = Parameters(session, middleware, self.diagnostics.add)
        self._samples = SampleTopics(middleware, self._first(), vehicle)
        self._markers = MarkerTopics(middleware, vehicle)
        self._once, self._vehicle = LatchedTopics(middleware), vehicle
        self._due = dict.fromkeys((MARKERS, PATHS, STATUS, STILL), 0.0)
        self._published, self._stopping = 0, threading.Event()
        self._keeper = threading.Thread(target=self._keep_parameters, name="parameters", daemon=True)

    def _first(self) -> Flight:
        """The sample of the step that was taken last."""
        taken = SampleBatch([self._flight.step - 1], [0], self._flight.sample[None])
        return as_flight(taken, self._flight, self._tables)

    def start(self) -> None:
        """Set the parameters, subscribe, and begin to fly."""
        self._parameters.exchange()
        self._session.watchers += [self._queue.note, self._pushes.watch]
        self._once.publish_vehicle(self._session.scene, self._vehicle, time.time_ns())
        self._publish_mission()
        self._middleware.subscribe(PUSH, WRENCH, self._pushes.handle)
        requests = RequestServices(self._session, self.diagnostics.add)
        for what in REQUESTS:
            self._middleware.serve(f"{ROOT}/{what}", partial(requests.answer, what))
        self._queue.note(self._flight)
        self._session.start()
        self._keeper.start()

    def spin(self) -> str:
        """Publish until the middleware is shut down, or the flight is over; the phase that it ended in."""
        while not self._middleware.over:
            if not self.publish() and self._session.status()["phase"] in ENDS:
                if self._flight.interruption:
                    self.diagnostics.add(str(self._flight.interruption))
                    self.diagnostics.flush()
                break
        return self._session.status()["phase"]

    def stop(self) -> None:
        """End the flight."""
        self._stopping.set()
        self._session.stop()
        if self._keeper.is_alive():
            self._keeper.join()

    def publish(self) -> bool:
        """Publish new samples and whatever else is due; return whether there was a sample."""
        taken = self._queue.take(PATIENCE)
        if taken:
            self._publish(taken)
        self.diagnostics.flush()
        return taken is not None

    def _publish(self, taken: SampleBatch) -> None:
        stamps = taken.stamps
        flight = as_flight(taken, self._flight, self._tables)
        self._samples.publish(flight, stamps)
        self.diagnostics.follow(flight, stamps)
        self._published += len(stamps)
        if self._is_due(MARKERS):
            self._markers.move(flight, stamps[-1])
        if self._is_due(PATHS):
            self._markers.extend_paths(flight, stamps[-1])
        if self._is_due(STILL):
            self._once.draw()
        if self._is_due(STATUS):
            self._report(stamps[-1])

    def _is_due(self, interval: float) -> bool:
        """Whether something that is done at an interval [s] is due."""
        now = time.monotonic()
        due = now >= self._due[interval]
        if due:
            self._due[interval] = max(self._due[interval] + interval, now - interval)
        return due

    def _report(self, stamp: int) -> None:
        """Publish the state of the flight."""
        status, published = self._session.status(), self._published
        self._published = 0
        more = {
            "samples in the last second": f"{published}",
            "time of the flight over time of the wall": f"{status['factor']:.3f}",
            "behind the clock, at most [ms]": f"{status['behind_ms']:.1f}",
            "late for good [s]": f"{self._clock.late:.3f}",
            "alarm": status["alarm"],
            **{f"{what} refused": str(refusal or "") for what, refusal in self._session.refusals._asdict().items()},
            "flown [s]": f"{status['recorded_s']:.1f}",
        }
        self.diagnostics.report(stamp, status["phase"], not status["alarm"], more)

    def _keep_parameters(self) -> None:
        """Exchange parameters until the end, in a thread of their own: a change may take long to prepare."""
        before = ""
        while not self._stopping.wait(PARAMETERS):
            said = ""
            try:
                if self._parameters.exchange():
                    self._publish_mission()
            except Exception as error:  # of a middleware that is not there for a while
                said = f"parameters cannot be changed: {error}"[:300]
            if said != before:
                self.diagnostics.add(said or "parameters can be changed again")
            before = said

    def _publish_mission(self) -> None:
        self._once.publish_mission(tables_of(self._flight.now))


STOPPED = "stopped"


def fly_in_ros(session: Session, middleware: Middleware, rate: float, begun: Callable[[], None], *, rviz: bool) -> str:
    """Fly until the flight ends; its last phase, or `STOPPED` after SIGINT or SIGTERM.

    Args:
        session: whose flight is prepared.
        middleware: connected to a ROS.
        rate: at which samples are published [Hz].
        begun: called once pushes are heard.
        rviz: whether to start RViz, too.
    """
    from tandemlift.apps.ros.ros1 import start_rviz

    node = FlightNode(session, middleware, rate)
    beside = start_rviz("rviz" if middleware.types.numbered else "rviz2") if rviz else None
    for number in (signal.SIGINT, signal.SIGTERM):  # roslaunch may have set them to be ignored
        signal.signal(number, signal.default_int_handler)
    try:
        node.start()
        begun()
        return node.spin()
    except KeyboardInterrupt:
        return STOPPED
    finally:
        node.stop()
        if beside:
            beside.terminate()


def fly_and_save(
    session: Session,
    middleware: Middleware,
    rate: float,
    what: str,
    save: str | None,
    say: Callable[[str], None],
    *,
    rviz: bool,
) -> list[str]:
    """Fly until the flight ends, and save it whatever the reason; return the reason of a failure, if any."""

    def begun() -> None:
        say(f"{what}: topics below /tandemlift, pushes by /tandemlift/push; Ctrl-C ends it")
        sys.stdout.flush()

    try:
        end = fly_in_ros(session, middleware, rate, begun, rviz=rviz)
    except BaseException:
        if session.flight.step > 1:
            _save(session, save, say)
        raise
    if end == STOPPED:
        say(STOPPED)
    _save(session, save, say)
    ending = session.flight.ending
    return [str(ending or end)] if ending or end == "failed" else []


def shut_down(middleware: Middleware) -> list[str]:
    """Disconnect from ROS; return a message if it is gone."""
    try:
        middleware.shutdown()
    except OSError as error:
        return [str(error)]
    return []


def _save(session: Session, save: str | None, say: Callable[[str], None]) -> None:
    if save:
        with without_flight_warnings():  # the mission was checked when it was loaded
            session.flight.snapshot().save(Path(save))
        recorded = shlex.quote(str(Path(save) / "recorded.toml"))
        say(f"saved: {save}; `tandemlift run {recorded}` flies it again")


# ---- Which ROS it speaks


def has_rclpy() -> bool:
    """Whether this Python has rclpy; nothing is imported."""
    return importlib.util.find_spec("rclpy") is not None


def version_for(asked: str | None) -> str:
    """The version of ROS to speak: 2 if there is rclpy, else 1 if there is rospy, else 2 by DDS, unless one is chosen.

    Args:
        asked: "1", "2" or "2-dds"; None to take what is there.

    Raises:
        InputError: none is chosen, and there is none; the text names the package to install.
    """
    if asked is not None:
        return asked
    if has_rclpy():
        return "2"
    if has_rospy():
        return "1"
    if not missing_packages():
        return "2"
    raise InputError(
        f"no ROS is found. For ROS 2, which needs no installed ROS: {install_command('ros2')}; "
        "for ROS 1, on Debian: apt-get install python3-rospy"
    )


def middleware_for(version: str, arguments: Sequence[str], say: Callable[[str], None], *, asked: bool) -> Middleware:
    """Connect to a ROS.

    Args:
        version: "1", "2" (by rclpy where that can be used, else by DDS) or "2-dds".
        arguments: remappings NAME:=VALUE, or `--ros-args` and what follows, as a launch file gives them.
        say: told why rclpy is not used although it is there.
        asked: whether a person chose this version; if not, the error names the other if there is one.

    Raises:
        InputError: what it needs is not installed, or does not run.
    """
    from tandemlift.apps.ros import rclpy_node, ros1, ros2

    if version == "2" and has_rclpy():
        try:
            return rclpy_node.RclpyNode(arguments)
        except rclpy_node.UnusableRclpyError as error:
            say(f"rclpy is installed but cannot be used, so the node speaks DDS itself: {error}")
    if version != "1":
        return ros2.Ros2()
    try:
        return ros1.Ros1(arguments)
    except InputError as error:
        if asked or missing_packages():
            raise
        raise InputError(f"{error}; or fly in ROS 2: --version 2") from None
