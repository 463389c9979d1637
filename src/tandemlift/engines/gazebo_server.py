"""A Gazebo 11 server of our own: started for a flight, and ended with it.

It runs where Gazebo is installed, or in the Debian 11 root that `tools/gazebo-root` makes. If the pilot dies without a
word, the plugin ends the server.
"""

from __future__ import annotations

import contextlib
import os
import re
import shlex
import shutil
import signal
import socket
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from tandemlift.common.errors import InputError

ROOT = "TANDEMLIFT_GAZEBO_ROOT"
MASTER = "GAZEBO_MASTER_URI"
SETUP = "/usr/share/gazebo/setup.sh"
NOTHING_MORE: Mapping[str, str] = MappingProxyType({})
SHOWN = 12  # last lines of what the server said
COLORS = re.compile("\x1b\\[[0-9;]*m")
FAILING = ("Failed to load plugin libtandemlift", "the plugin rests")
SOUND = ("ALSA lib", "AL lib")  # about loudspeakers that there are none

ENTER = """
mount --rbind /dev "$1/dev" && mount -t proc proc "$1/proc" && exec chroot "$1" /usr/bin/env -i \
PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 HOME=/tmp sh -c "$2"
"""  # in a mount namespace of its own, so that no mount is left behind

UNSEEN = """\
Xvfb -displayfd 1 -terminate -nolisten tcp > display 2> /dev/null &
while kill -0 $! && ! [ -s display ]; do sleep 0.05; done
DISPLAY=:$(cat display); export DISPLAY
"""  # a display of its own, which ends with its only client


def root() -> Path | None:
    """The root that Gazebo is installed in, None for this system's.

    Raises:
        InputError: there is no Gazebo.
    """
    given = os.environ.get(ROOT)
    if given:
        path = Path(given).absolute()
        if not (path / "usr/bin/gzserver").exists():
            raise InputError(f"{ROOT} = {given}: has no /usr/bin/gzserver; make it with: tools/gazebo-root {given}")
        return path
    if shutil.which("gzserver") is None:
        raise InputError(
            "engine 'gazebo' needs Gazebo 11: install it, or make a Debian 11 root that has it by "
            f"tools/gazebo-root ROOT (as root, 2.4 GB) and set {ROOT}=ROOT; docs/gazebo.md"
        )
    return None


def free_port(kind: socket.SocketKind) -> int:
    """A port of this machine that nobody has."""
    with socket.socket(socket.AF_INET, kind) as s:
        s.bind(("127.0.0.1", 0))
        return int(s.getsockname()[1])


class GazeboServer:
    """A gzserver.

    Args:
        world: the text of its world.
        environment: variables that it has beside Gazebo's own.
        grace: seconds in which it may end by itself when it is closed.
        draws: whether there are cameras in it: it then draws, on a display that nobody sees (Xvfb), and its cameras
            keep step with the world.

    Attributes:
        folder: its own, in which it runs.
        master: address of Gazebo's own transport, for `gz` and `gzclient`; `GAZEBO_MASTER_URI` if that is set.

    Raises:
        InputError: there is no Gazebo.
    """

    def __init__(
        self, world: str, environment: Mapping[str, str] = NOTHING_MORE, grace: float = 0.0, *, draws: bool = False
    ) -> None:
        inside, self._grace = root(), grace
        self.master = os.environ.get(MASTER) or f"http://127.0.0.1:{free_port(socket.SOCK_STREAM)}"
        self.folder = Path(tempfile.mkdtemp(prefix="tandemlift-", dir=None if inside is None else inside / "tmp"))
        seen = self.folder if inside is None else Path("/tmp") / self.folder.name
        (self.folder / "vehicle.world").write_text(world, "utf-8")
        with (self.folder / "log").open("wb") as log:
            self._process = subprocess.Popen(
                command(inside, exported(environment) + self._script(seen, draws)),
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                start_new_session=True,  # Ctrl-C is ours
            )

    def _script(self, folder: Path, draws: bool) -> str:
        server = f"{UNSEEN}exec gzserver --lockstep" if draws else "exec gzserver"
        return in_gazebo(self.master, f"cd {shlex.quote(str(folder))}\n{server} --verbose vehicle.world", folder)

    def check(self) -> None:
        """See that it still runs, and has the plugin.

        Raises:
            InputError: the plugin is not built, or cannot begin.
            ConnectionError: the server has ended.
        """
        if self._process.poll() is not None:
            code = self._process.returncode
            raise ConnectionError(f"engine 'gazebo': gzserver has ended (exit code {code}){self.said()}")
        for line in self._lines():
            if any(failing in line for failing in FAILING):
                raise InputError(f"engine 'gazebo' needs its plugin (docs/gazebo.md), and gzserver says: {line}")

    def _lines(self) -> list[str]:
        text = COLORS.sub("", (self.folder / "log").read_text("utf-8", "replace"))
        return [line for line in text.strip().splitlines() if line and not line.startswith(SOUND)]

    def said(self) -> str:
        """The last lines that the server said, with a word before; empty if there are none."""
        lines = self._lines()[-SHOWN:]
        return "; it said:\n  " + "\n  ".join(lines) if lines else ""

    def close(self) -> None:
        """End it, at once without a grace: there is nothing that it would have to save."""
        if self._grace > 0.0 and self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(self._grace)
        if self._process.poll() is None:
            self._process.kill()
            self._process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


def in_gazebo(master: str, script: str, logs: Path = Path("/tmp")) -> str:
    """A shell script run with Gazebo's environment, on loopback alone, and with no model database to look for."""
    # the setup first: it sets a database and a master of its own
    folder = shlex.quote(str(logs))
    return (
        f"[ ! -e {SETUP} ] || . {SETUP}; export {MASTER}={shlex.quote(master)} GAZEBO_MODEL_DATABASE_URI= "
        f"GAZEBO_IP=127.0.0.1 GAZEBO_LOG_PATH={folder} ROS_LOG_DIR={folder}; {script}"
    )


def exported(environment: Mapping[str, str]) -> str:
    """The beginning of a shell script that has these variables."""
    return "".join(f"export {name}={shlex.quote(value)}; " for name, value in environment.items())


def command(inside: Path | None, script: str) -> list[str]:
    """The command that runs a shell script where Gazebo is."""
    if inside is None:
        return ["sh", "-c", script]
    own = [] if os.geteuid() == 0 else ["--map-root-user"]
    return ["unshare", *own, "--mount", "sh", "-c", ENTER, "sh", str(inside), script]


def by_yourself(master: str, what: str) -> str:
    """The command by which a person runs one of Gazebo's own where Gazebo is."""
    inside = root()
    return f"{f'sudo chroot {inside} ' if inside else ''}env {MASTER}={master} GAZEBO_IP=127.0.0.1 {what}"
