"""The command line: its verbs, and its exit codes on errors."""

from __future__ import annotations

import signal
import sys
import warnings

import click

from tandemlift.apps.cli.console import compile_notices, exit_now
from tandemlift.apps.cli.export import compile, export, render
from tandemlift.apps.cli.flying import INTERRUPTED
from tandemlift.apps.cli.identify import identify, shadow
from tandemlift.apps.cli.keys import completion, controllers, engines, explain, missions, new, schema, template
from tandemlift.apps.cli.linearize import certify, check, excite, linearize
from tandemlift.apps.cli.live import docs, grade, live, page, replay, score
from tandemlift.apps.cli.report import paper, plot, report
from tandemlift.apps.cli.ros import crazyflie, gazebo, mavlink, ros
from tandemlift.apps.cli.run import run
from tandemlift.apps.cli.study import benchmark, compare, study
from tandemlift.apps.cli.tune import feel, train, tune
from tandemlift.core.errors import FlightWarning, InputError, suggestion
from tandemlift.core.files import __version__
from tandemlift.core.progress import watching

BAD_INPUT = 2


GROUPS: dict[str, tuple[click.Command, ...]] = {
    "Try first": (run, live, missions, docs),
    "Write a mission": (new, template, explain, check, controllers, engines, schema, completion),
    "Look at a flight": (report, plot, render, replay),
    "Fly many, compare, analyse": (
        compare,
        benchmark,
        score,
        grade,
        study,
        tune,
        train,
        feel,
        linearize,
        certify,
        paper,
    ),
    "Your vehicle": (excite, identify, shadow),
    "Take it elsewhere": (gazebo, ros, crazyflie, mavlink, page, export, compile),
}


class Commands(click.Group):
    """A group that lists its verbs in the order of `GROUPS`, and suggests the nearest one."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The verbs as they were added."""
        return list(self.commands)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the verbs in groups, each with its first sentence."""
        width = max(map(len, self.commands))
        for title, verbs in GROUPS.items():
            with formatter.section(title):
                formatter.write_dl([(f"{verb.name:{width}}", verb.get_short_help_str(80)) for verb in verbs])

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Resolve a verb as click does; for a misspelt one, raise an error with all verbs and the nearest one."""
        verb = args[0] if args else ""
        if verb and not ctx.resilient_parsing and not verb.startswith("-") and self.get_command(ctx, verb) is None:
            verbs = self.list_commands(ctx)
            ctx.fail(f"No such command {verb!r}; there are {', '.join(verbs)}.{suggestion(verb, verbs)}")
        return super().resolve_command(ctx, args)


@click.group(cls=Commands, commands=sum(GROUPS.values(), ()), context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="tandemlift")
def cli() -> None:
    """Simulate quadrotors that carry a load together, steered by a person who pushes it.

    \b
    Fly a mission:    tandemlift run paper
    Push it by hand:  tandemlift live
    Change a key:     tandemlift run paper --set controller.switching=saturation
    Your beam:        tandemlift new mine.toml
                      tandemlift run mine.toml
    Explain a key:    tandemlift explain admittance.damping
    Your controller:  tandemlift run mine.toml --controller my_pd.py

    Exit code 0: done. 2: bad input, one message, nothing written. Each command's
    help lists its other codes.
    """


def main() -> None:
    """Run the command line: bad input ends with one message and exit code 2, never with a traceback."""
    warnings.simplefilter("once", FlightWarning)
    warnings.showwarning = lambda message, *_, **__: click.echo(f"warning: {message}", err=True)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # as Ctrl-C: child processes are ended too
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="replace")  # a terminal that lacks a character shows '?'
    try:
        with watching(compile_notices):
            sys.exit(cli.main(prog_name="tandemlift", standalone_mode=False))
    except click.ClickException as error:
        error.show()
        if isinstance(error, click.NoSuchOption):
            from tandemlift.missions.key_descriptions import as_key

            if hint := as_key(error.option_name, sys.argv):
                click.echo(hint, err=True)
        sys.exit(error.exit_code)
    except (click.Abort, KeyboardInterrupt):
        click.echo("stopped; nothing more is written", err=True)
        exit_now(INTERRUPTED)
    except InputError as error:
        click.echo(f"error: {error}", err=True)
        sys.exit(BAD_INPUT)
    except OSError as error:
        click.echo(f"error: {error.filename or ''}: {error.strerror or error}".replace(": : ", ": "), err=True)
        sys.exit(BAD_INPUT)
