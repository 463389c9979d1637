"""A Gazebo 11 server that is started for a flight and ends with it.

It runs on this system or in the Debian 11 root that `tools/gazebo-root` makes. If the pilot's process dies, the plugin
ends the server.
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
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from types import MappingProxyType

from tandemlift.core.errors import InputError

ROOT = "TANDEMLIFT_GAZEBO_ROOT"
MASTER = "GAZEBO_MASTER_URI"
SETUP = "/usr/share/gazebo/setup.sh"
NOTHING_MORE: Mapping[str, str] = MappingProxyType({})
SHOWN_LINES = 12  # last lines of the server's output that are shown
COLORS = re.compile("\x1b\\[[0-9;]*m")
FAILING = ("Failed to load plugin libtandemlift", "the plugin rests")
SOUND = ("ALSA lib", "AL lib")  # complaints about missing loudspeakers

ENTER = """
mount --rbind /dev "$1/dev" && mount -t proc proc "$1/proc" && exec chroot "$1" /usr/bin/env -i \
PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 HOME=/tmp sh -c "$2"
"""  # in its own mount namespace, so that no mount is left behind


def root() -> Path | None:
    """The root folder in which Gazebo is installed; None for this system.

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
            f"tools/gazebo-root ROOT (as root, 2.4 GB) and set {ROOT}=ROOT; docs/how-to/gazebo.md"
        )
    return None


def free_port(kind: socket.SocketKind) -> int:
    """A free port of this machine."""
    with socket.socket(socket.AF_INET, kind) as s:
        s.bind(("127.0.0.1", 0))
        return int(s.getsockname()[1])


class GazeboServer:
    """A gzserver.

    Args:
        world: the text of its world.
        environment: variables beside Gazebo's own.
        grace: time in which it may end by itself when it is closed [s].

    Attributes:
        folder: the working folder of the server.
        master: address of Gazebo's own transport, for `gz` and `gzclient`; `GAZEBO_MASTER_URI` if that is set.

    Raises:
        InputError: there is no Gazebo.
    """

    def __init__(self, world: str, environment: Mapping[str, str] = NOTHING_MORE, grace: float = 0.0) -> None:
        inside, self._grace = root(), grace
        self.master = os.environ.get(MASTER) or f"http://127.0.0.1:{free_port(socket.SOCK_STREAM)}"
        self.folder = Path(tempfile.mkdtemp(prefix="tandemlift-", dir=None if inside is None else inside / "tmp"))
        seen = self.folder if inside is None else Path("/tmp") / self.folder.name
        (self.folder / "vehicle.world").write_text(world, "utf-8")
        script = f"cd {shlex.quote(str(seen))}\nexec gzserver --verbose vehicle.world"
        script = export_lines(environment) + with_gazebo_environment(self.master, script, seen)
        with (self.folder / "log").open("wb") as log:
            self._process = subprocess.Popen(
                shell_command(inside, script),
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                start_new_session=True,  # Ctrl-C is ours
            )

    def check(self) -> None:
        """Check that the server still runs and has loaded the plugin.

        Raises:
            InputError: the plugin is not built, or cannot start.
            ConnectionError: the server has ended.
        """
        if self._process.poll() is not None:
            code = self._process.returncode
            raise ConnectionError(f"engine 'gazebo': gzserver has ended (exit code {code}){self.last_output()}")
        for line in self._lines():
            if any(failing in line for failing in FAILING):
                raise InputError(f"engine 'gazebo' needs its plugin (docs/how-to/gazebo.md), and gzserver says: {line}")

    def _lines(self) -> list[str]:
        text = COLORS.sub("", (self.folder / "log").read_text("utf-8", "replace"))
        return [line for line in text.strip().splitlines() if line and not line.startswith(SOUND)]

    def last_output(self) -> str:
        """The last lines of the server's output, ready to be appended to a message; empty without output."""
        lines = self._lines()[-SHOWN_LINES:]
        return "; its last output:\n  " + "\n  ".join(lines) if lines else ""

    def close(self) -> None:
        """End the server, at once if it has no grace."""
        if self._grace > 0.0 and self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(self._grace)
        if self._process.poll() is None:
            self._process.kill()
            self._process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


def with_gazebo_environment(master: str, script: str, logs: Path = Path("/tmp")) -> str:
    """A shell script with Gazebo's environment, on loopback only and without a model database."""
    # the setup comes first: it sets a database and a master itself
    folder = shlex.quote(str(logs))
    return (
        f"[ ! -e {SETUP} ] || . {SETUP}; export {MASTER}={shlex.quote(master)} GAZEBO_MODEL_DATABASE_URI= "
        f"GAZEBO_IP=127.0.0.1 GAZEBO_LOG_PATH={folder} ROS_LOG_DIR={folder}; {script}"
    )


def export_lines(environment: Mapping[str, str]) -> str:
    """The first lines of a shell script: they set these variables."""
    return "".join(f"export {name}={shlex.quote(value)}; " for name, value in environment.items())


def shell_command(inside: Path | None, script: str) -> list[str]:
    """The command that runs a shell script on the system, or in the root, that has Gazebo."""
    if inside is None:
        return ["sh", "-c", script]
    own = [] if os.geteuid() == 0 else ["--map-root-user"]
    return ["unshare", *own, "--mount", "sh", "-c", ENTER, "sh", str(inside), script]


def shell_command_for_user(master: str, what: str) -> str:
    """The command line by which a user runs one of Gazebo's tools on this server."""
    inside, rights = root(), "" if os.geteuid() == 0 else "sudo "
    return f"{f'{rights}chroot {inside} ' if inside else ''}env {MASTER}={master} GAZEBO_IP=127.0.0.1 {what}"


def has_display() -> bool:
    """Whether there is a screen for a window."""
    return bool(os.environ.get("DISPLAY"))


@contextmanager
def gazebo_window(master: str) -> Iterator[None]:
    """Gazebo's window on a server, while the context is open."""
    if not has_display():
        raise InputError("Gazebo's window needs a display: DISPLAY is not set")
    inside, allowed = root(), Path(os.environ.get("XAUTHORITY", Path.home() / ".Xauthority"))
    with ExitStack() as closing:
        if inside and allowed.is_file():  # the display's cookie must be inside the root
            cookie = inside / "tmp" / f"tandemlift-{os.getpid()}.cookie"
            shutil.copy(allowed, cookie)
            closing.callback(cookie.unlink)
            allowed = Path("/tmp") / cookie.name
        show = f"export DISPLAY={os.environ['DISPLAY']} XAUTHORITY={allowed}; exec gzclient"
        quiet = subprocess.DEVNULL
        client = subprocess.Popen(
            shell_command(inside, with_gazebo_environment(master, show)),
            stdin=quiet,
            stdout=quiet,
            stderr=quiet,
            start_new_session=True,
        )
        try:
            yield
        finally:
            client.kill()
            client.wait()
