"""The command line: `tandemlift run MISSION` and what there is to choose from."""

from __future__ import annotations

import json
import re
import sys
import time
import tomllib
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tandemlift import __version__
from tandemlift.errors import FlightWarning, InputError, suggestion

if TYPE_CHECKING:
    from tandemlift.flight import Flight
    from tandemlift.settings import Mission

DIVERGED = 3
LONG_RUN = 5_000_000  # steps from which a progress bar is shown


class Commands(click.Group):
    """A group that suggests the nearest verb."""

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        """As click does, with a suggestion for a misspelt verb."""
        verb = args[0] if args else ""
        if verb and not verb.startswith("-") and self.get_command(ctx, verb) is None:
            verbs = self.list_commands(ctx)
            ctx.fail(f"No such command {verb!r}; there are {', '.join(verbs)}.{suggestion(verb, verbs)}")
        return super().resolve_command(ctx, args)


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="tandemlift")
def cli() -> None:
    """Carry a load with quadrotors that a person steers by pushing it.

    \b
    Start with:   tandemlift run paper
    Change it:    tandemlift run paper --set controller.switching=saturation
    Your own:     tandemlift template > mine.toml && tandemlift run mine.toml
    """


@cli.command()
@click.argument("mission")
@click.option("--engine", default="compiled", show_default=True, help="Where the body lives; see `tandemlift engines`.")
@click.option("--out", type=click.Path(path_type=Path), help="Folder for the results.  [default: out/NAME]")
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="KEY=VALUE",
    help="Change one key of the mission: a dotted key and a TOML value, such as mission.duration=5.0, "
    "pushes.0.force=[1.0,0,0] or admittance.gate=soft. May be given many times.",
)
@click.option("--controller", metavar="NAME|FILE", help="Fly this controller, registered or from a .py file of yours.")
@click.option("--no-figures", is_flag=True, help="Leave the figures out.")
def run(
    mission: str, engine: str, out: Path | None, settings: tuple[str, ...], controller: str | None, no_figures: bool
) -> None:
    """Fly MISSION (a built-in name or a .toml file), print a summary and write the results.

    \b
    Written to the folder, replacing only files of these names:
      mission.toml   the mission with every key resolved
      flight.npz     the flight: all channels, readable with NumPy or tl.Flight.load
      metrics.json   the metrics, SI units, formed from every step
      figures/       reference, path, tracking, inputs, interaction (PNG and PDF)
      report.html    everything on one page, needs no network

    Exit code: 0; 2 for bad input (nothing is written); 3 if the flight diverged.
    """
    from tandemlift.engines import engine_named

    began = time.perf_counter()
    engine_named(engine)
    loaded = _load(mission, settings, controller)
    folder = _folder(out or Path("out") / loaded.mission.name)
    flight = _fly(loaded, engine)
    _print_summary(flight, time.perf_counter() - began)
    _write(flight, loaded, folder, figures=not no_figures)
    if flight.divergence:
        click.echo(f"{flight.name}: {flight.divergence}", err=True)
        sys.exit(DIVERGED)


def _load(mission: str, settings: tuple[str, ...], controller: str | None) -> Mission:
    from tandemlift.laws.controllers import load_controller
    from tandemlift.missions import load_mission

    chosen: Any = load_controller(controller) if controller and controller.endswith(".py") else controller
    return load_mission(mission, dict(map(parse_setting, settings)), controller=chosen)


def parse_setting(text: str) -> tuple[str, Any]:
    """The dotted key and the value of KEY=VALUE; VALUE is a TOML literal, or an unquoted word for a string.

    Raises:
        InputError: the text has no such form.
    """
    key, equals, literal = (part.strip() for part in text.partition("="))
    if not equals or not re.fullmatch(r"[A-Za-z0-9_]+(\.[A-Za-z0-9_]+)*", key):
        raise InputError(f"--set {text}: must be KEY=VALUE with a dotted key, such as mission.duration=5.0")
    try:
        parsed = tomllib.loads(f"value = {literal}")
    except tomllib.TOMLDecodeError:
        if re.fullmatch(r"[A-Za-z][A-Za-z0-9_.+-]*", literal):
            return key, literal
        parsed = {}
    if list(parsed) != ["value"]:
        raise InputError(f"--set {key}: {literal!r} is not a TOML value (a number, true, false, [list] or a word)")
    return key, parsed["value"]


def _folder(folder: Path) -> Path:
    """The folder for the results, if it is or can become one."""
    existing = next((p for p in (folder, *folder.parents) if p.exists()), None)
    if existing is not None and not existing.is_dir():
        raise InputError(f"--out {folder}: {existing} is a file, not a folder")
    return folder


def _fly(mission: Mission, engine: str) -> Flight:
    from tandemlift.simulate import fly, needs_compiling

    if needs_compiling(mission):
        click.echo("Compiling the flight loop for this machine (once, a few seconds) …", err=True)
    with _bar("Flying", mission.mission.steps, shown=mission.mission.steps >= LONG_RUN) as progress:
        return fly(mission, engine, progress=progress)


@contextmanager
def _bar(label: str, length: int, *, shown: bool = True) -> Iterator[Callable[[int, int], None] | None]:
    """A progress bar on standard error as a callback of (done, total), or None."""
    if not shown:
        yield None
        return
    with click.progressbar(length=length, label=label, file=sys.stderr) as bar:
        yield lambda done, total: bar.update(done - bar.pos)


def _print_summary(flight: Flight, seconds: float) -> None:
    m = flight.metrics()
    late = "_after_10s" if m["position_rmse_after_10s_m"] else ""
    when = "after 10 s" if late else "whole flight"
    rows = [
        ("final position", _list(m["final_position_m"], 3), "m"),
        ("final reference", _list(m["final_reference_m"], 3), "m"),
        (f"position RMSE, {when}", _list(m[f"position_rmse{late}_m"], 2, 1e3), "mm"),
        (f"position error at most, {when}", _list(m[f"position_max_error{late}_m"], 2, 1e3), "mm"),
        ("attitude RMSE", _list(m["attitude_rmse_rad"], 2, 57.29577951308232), "deg"),
        ("thrust after 10 s", _list([m["thrust_min_after_10s_n"], m["thrust_max_after_10s_n"]], 2), "N (least, most)"),
        ("human work", _list([m["human_work_j"]], 2), "J"),
    ]
    click.echo(f"{flight.name}: {m['steps']} steps, flown in {m['wall_s'] * 1e3:.1f} ms ({seconds:.2f} s in all)")
    for label, value, unit in rows:
        if value:
            click.echo(f"  {label:36}{value} {unit}")


def _list(values: list[float | None] | None, digits: int, scale: float = 1.0) -> str:
    """Numbers side by side, '' where there are none."""
    if not values or any(v is None for v in values):
        return ""
    return "  ".join(f"{round(v * scale, digits) + 0.0:8.{digits}f}" for v in values if v is not None)


def _write(flight: Flight, mission: Mission, folder: Path, *, figures: bool) -> None:
    from tandemlift.figures import FIGURES, save_figures
    from tandemlift.missions import to_toml
    from tandemlift.report import write_report

    folder.mkdir(parents=True, exist_ok=True)
    _replace(folder / "mission.toml", to_toml(mission))
    flight.save(folder / "flight.npz")
    _replace(folder / "metrics.json", json.dumps(flight.metrics(), indent=2, allow_nan=False) + "\n")
    for name in FIGURES:
        for kind in ("png", "pdf"):
            (folder / "figures" / f"{name}.{kind}").unlink(missing_ok=True)
    if figures:
        with _bar("Drawing", len(FIGURES), shown=sys.stderr.isatty()) as progress:
            save_figures(flight, folder / "figures", progress)
    write_report(flight, folder / "figures", folder / "report.html")
    click.echo(f"  report: {folder / 'report.html'}")


def _replace(path: Path, text: str) -> None:
    """Write a file whole or not at all."""
    partial = path.with_name(f".{path.name}.partial")
    partial.write_text(text, "utf-8")
    partial.replace(path)


def _print_table(rows: dict[str, str]) -> None:
    width = max(map(len, rows)) + 2
    for name, summary in rows.items():
        click.echo(f"{name:{width}}{summary}")


@cli.command()
def missions() -> None:
    """List the built-in missions."""
    from tandemlift.missions import built_in

    _print_table(built_in())


@cli.command()
def controllers() -> None:
    """List the controllers."""
    from tandemlift.laws.controllers import CONTROLLERS

    _print_table({name: c.summary for name, c in sorted(CONTROLLERS.items())})


@cli.command()
def engines() -> None:
    """List the engines."""
    from tandemlift.engines import ENGINES

    _print_table({name: e.summary for name, e in ENGINES.items()})


@cli.command()
def template() -> None:
    """Print a mission file with every key, its unit and its meaning."""
    from tandemlift.missions import template_text

    click.echo(template_text(), nl=False)


def _show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    click.echo(f"warning: {message}", err=True)


def main() -> None:
    """Run the command line: bad input ends with one message and exit code 2, never with a traceback."""
    warnings.simplefilter("always", FlightWarning)
    warnings.showwarning = _show_warning
    try:
        cli(prog_name="tandemlift")
    except InputError as error:
        click.echo(f"error: {error}", err=True)
        sys.exit(2)
    except OSError as error:
        click.echo(f"error: {error.filename}: {error.strerror}", err=True)
        sys.exit(2)


if __name__ == "__main__":
    main()
