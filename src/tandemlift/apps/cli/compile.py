"""`tandemlift compile`: a mission as code for other machines."""

from __future__ import annotations

from pathlib import Path

import click

from tandemlift.apps.cli.terminal.completion import MISSIONS, names
from tandemlift.apps.cli.terminal.console import echo
from tandemlift.apps.cli.terminal.mission_options import chosen_controller, controller_option, load, set_option


@click.command()
@click.argument("mission", shell_complete=MISSIONS)
@click.option(
    "--target",
    required=True,
    metavar="TARGET",
    shell_complete=names("target"),
    help="wasm32, c, aarch64 or cortex-m7.",
)
@click.option("--out", metavar="DIR", help="Folder for the files; by default out/NAME-TARGET.")
@click.option("--single", is_flag=True, help="For C: compute in single precision.")
@set_option
@controller_option
def compile(
    mission: str, target: str, out: str | None, single: bool, settings: tuple[str, ...], controller: str | None
) -> None:
    """Compile a mission for another machine: pilot, body and loop, with the same bits everywhere.

    \b
    wasm32     NAME.wasm, without imports, for browsers and Node.js
    c          C99 sources with CMake: the pilot alone, and the whole flight
    aarch64    NAME.o for 64-bit ARM with Linux
    cortex-m7  NAME.o for microcontrollers with double precision

    The code takes the numbers of a mission file: masses, gains, pushes. NAME.json, the manifest, lists them with unit
    and bounds, and the channels of a flight. docs/how-to/compile.md shows how to call the code.

    \b
    Examples:
      tandemlift compile iris --target wasm32
      tandemlift compile iris --target c --single --out pilot
      tandemlift compile zigzag --target aarch64 --set vehicle.payload.mass=0.6
      tandemlift compile hover --target c --controller my_pd.py
    """
    from tandemlift.codegen.compiling import compile_mission

    chosen = None if controller is None else chosen_controller(controller)
    what = load(mission, settings, chosen)
    folder = Path(out) if out else Path("out") / f"{what.mission.name}-{target}"
    for path in compile_mission(what, target, folder, single=single):
        echo(f"{path} ({path.stat().st_size / 1e3:.0f} kB)")
