"""Libraries of an FMU for several platforms, by this machine's C compiler or by that of `ziglang`."""

from __future__ import annotations

import platform
import shutil
import struct
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from tandemlift.codegen.fmu_description import FLAGS
from tandemlift.core.errors import InputError, extra, unknown

COMPILERS = ("cc", "gcc", "clang")
HOST, SOURCES = "host", "none"


class FmuPlatform(NamedTuple):
    """A platform: ending of a library, folders for each version of FMI, and the machines that it joins.

    `machines`: zig's names of targets, by their folders in FMI 3.
    """

    meaning: str
    ending: str
    fmi2: str
    machines: dict[str, str]


PLATFORMS = {
    "linux": FmuPlatform("Linux, x86-64", "so", "linux64", {"x86_64-linux": "x86_64-linux-gnu.2.17"}),
    "linux-arm64": FmuPlatform("Linux, ARM64", "so", "aarch64-linux", {"aarch64-linux": "aarch64-linux-gnu.2.17"}),
    "windows": FmuPlatform("Windows, x86-64", "dll", "win64", {"x86_64-windows": "x86_64-windows-gnu"}),
    "macos": FmuPlatform(
        "macOS, ARM64 and x86-64",
        "dylib",
        "darwin64",
        {"aarch64-darwin": "aarch64-macos", "x86_64-darwin": "x86_64-macos"},
    ),
}
SYSTEMS = {"Linux": "linux", "Darwin": "darwin", "Windows": "windows"}
ARCHITECTURES = {"x86_64": "x86_64", "amd64": "x86_64", "aarch64": "aarch64", "arm64": "aarch64"}
CPU_TYPES = {"aarch64-darwin": (0x0100000C, 0), "x86_64-darwin": (0x01000007, 3)}  # of Mach-O
PAGE = 14  # bits: an architecture in a universal file begins at a multiple of 2¹⁴ bytes


def host() -> tuple[str, str]:
    """This machine's platform, and its folder in FMI 3.

    Raises:
        InputError: it is none of those that an FMU is made for.
    """
    system, machine = SYSTEMS.get(platform.system(), ""), ARCHITECTURES.get(platform.machine().lower(), "")
    for name, known in PLATFORMS.items():
        if f"{machine}-{system}" in known.machines:
            return name, f"{machine}-{system}"
    raise InputError(f"platforms: this machine ({platform.system()}, {platform.machine()}) is none of {_known()}")


def _machines(name: str) -> dict[str, str]:
    """Zig's names of the targets of a platform, by their folders in FMI 3."""
    if name != HOST:
        return PLATFORMS[name].machines
    name, folder = host()
    return {folder: PLATFORMS[name].machines[folder]}


def _known() -> str:
    return ", ".join([*PLATFORMS, SOURCES])


def chosen_platforms(names: Sequence[str]) -> list[str]:
    """The platforms by names, each once; [] for "none", which are sources alone.

    Raises:
        InputError: they are no list of names, a platform is unknown, or no compiler for it is installed.
    """
    if isinstance(names, str) or not names:
        raise InputError(f"platforms = {names!r}: must be a list of names of {_known()}")
    wanted = list(dict.fromkeys(name.strip() for name in names))
    if wanted == [SOURCES]:
        return []
    if SOURCES in wanted:
        raise InputError(
            f"platforms = {', '.join(wanted)}: {SOURCES!r} is for sources alone; leave it or the others out"
        )
    for name in wanted:
        if name != HOST and name not in PLATFORMS:
            raise unknown("platform", name, [*PLATFORMS, SOURCES])
    for name in wanted:
        for folder, target in _machines(name).items():
            _command(folder, target)
    return wanted


def local_compiler() -> str | None:
    """The C compiler of this machine, if there is one that takes the options of gcc."""
    return next((found for name in COMPILERS if (found := shutil.which(name))), None)


def zig(user: str) -> list[str]:
    """The compiler of `ziglang`; `user`: what needs it."""
    with extra("fmu", user):
        import ziglang
    return [sys.executable, "-m", str(ziglang.__name__), "cc"]


def _command(folder: str, target: str) -> list[str]:
    """The compiler for a machine: this machine's own, or else that of `ziglang`.

    Raises:
        InputError: there is none.
    """
    if folder == host()[1] and (local := local_compiler()):
        return [local]
    without = f" without {', '.join(COMPILERS[:-1])} or {COMPILERS[-1]}" if folder == host()[1] else ""
    return [*zig(f"a library for {folder}{without}"), "-target", target]


def libraries(sources: list[Path], identifier: str, name: str, fmi: int, work: Path) -> dict[str, bytes]:
    """The libraries of sources for a platform, by their paths in an FMU.

    Args:
        sources: files of C.
        identifier: of the model.
        name: of the platform; "host" for this machine alone.
        fmi: version of FMI.
        work: a folder for intermediate files.

    Raises:
        InputError: the compiler fails.
    """
    machines = _machines(name)
    name = host()[0] if name == HOST else name
    ending, built = PLATFORMS[name].ending, dict[str, bytes]()
    for folder, target in machines.items():
        library = work / f"{identifier}-{folder}.{ending}"
        command = _command(folder, target)
        options = [*FLAGS.split(), "-shared", "-fvisibility=hidden", *(["-s"] if ending != "dylib" else [])]
        options += ["-fPIC"] if ending != "dll" else []
        run = subprocess.run(
            [*command, *options, *map(str, sources), "-o", str(library), *(["-lm"] if ending == "so" else [])],
            check=False,
            capture_output=True,
            text=True,
        )
        if run.returncode:
            raise InputError(f"platforms: {command[0]} failed for {folder}: {run.stderr.strip()[-2000:]}")
        built[folder] = library.read_bytes()
    if fmi == 3:
        return {f"binaries/{folder}/{identifier}.{ending}": code for folder, code in built.items()}
    whole = universal(built) if len(built) > 1 else next(iter(built.values()))
    return {f"binaries/{PLATFORMS[name].fmi2}/{identifier}.{ending}": whole}


def universal(libraries: dict[str, bytes]) -> bytes:
    """A file of macOS with libraries of several architectures, by their folders in FMI 3."""
    size, at = 1 << PAGE, 1 << PAGE
    head, body = struct.pack(">II", 0xCAFEBABE, len(libraries)), b""
    for folder, code in libraries.items():
        head += struct.pack(">IIIII", *CPU_TYPES[folder], at, len(code), PAGE)
        padded = code + bytes(-len(code) % size)
        body, at = body + padded, at + len(padded)
    return head.ljust(size, b"\0") + body
