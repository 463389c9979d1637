"""What one looks up: `tandemlift missions`, `controllers`, `engines`, keys of mission files, words for shells."""

from __future__ import annotations

import json
from collections.abc import Mapping

import click

from tandemlift.apps.cli.completion import SCRIPTS, keys, names
from tandemlift.apps.cli.console import echo
from tandemlift.apps.cli.flying import chosen_controller
from tandemlift.core.errors import unknown

controller_option = click.option(
    "--controller", metavar="FILE", help="Your own controller (.py file): its keys are included."
)


@click.command()
def template() -> None:
    """Print a mission file with every key, its unit and meaning.

    \b
    Examples:
      tandemlift template > mine.toml
      tandemlift run mine.toml
    """
    from tandemlift.missions.reference import template_text

    echo(template_text(), nl=False)


@click.command()
@click.argument("key", required=False, shell_complete=keys)
@controller_option
@click.option("--markdown", is_flag=True, help="Print the reference of all keys in Markdown instead.")
def explain(key: str | None, controller: str | None, markdown: bool) -> None:
    """Explain a mission KEY: unit, meaning, bounds and default.

    KEY is a dotted key or a table. Without KEY, all tables are listed.

    \b
    Examples:
      tandemlift explain compliance.input_bandwidth
      tandemlift explain pushes.0.force
      tandemlift explain supervision.watchdog
      tandemlift explain controller.stiffness --controller my_pd.py
      tandemlift explain controller --controller my_pd.py
    """
    from tandemlift.missions.reference import explained, index, key_tables

    own = "" if controller is None else chosen_controller(controller).name
    if markdown:
        echo(key_tables(), nl=False)
    else:
        echo(index() if key is None else explained(key, own))


@click.command()
@controller_option
def schema(controller: str | None) -> None:
    """Print the JSON Schema of mission files, for TOML editors.

    With the schema, an editor completes keys, shows their meaning and marks errors. Editors that use Taplo (such as
    Even Better TOML) find it by the first line of the mission file:

    \b
      tandemlift schema > mission.schema.json
      #:schema ./mission.schema.json
    """
    from tandemlift.missions.schema import mission_schema

    if controller is not None:
        chosen_controller(controller)
    echo(json.dumps(mission_schema(), indent=2, ensure_ascii=False))


@click.command()
@click.argument("shell", type=click.Choice(list(SCRIPTS)))
def completion(shell: str) -> None:
    """Print the script by which a SHELL completes commands and names.

    \b
    In the start file of the shell, where `tandemlift` is on the path:
      bash, ~/.bashrc:                    eval "$(tandemlift completion bash)"
      zsh, ~/.zshrc, after compinit:      eval "$(tandemlift completion zsh)"
      fish, ~/.config/fish/config.fish:   tandemlift completion fish | source
    """
    echo(SCRIPTS[shell].read_text("utf-8"), nl=False)


def _print_table(rows: Mapping[str, str]) -> None:
    width = max(map(len, rows)) + 2
    for name, summary in rows.items():
        echo(f"{name:{width}}{summary}")


@click.command()
@click.argument("name", required=False, shell_complete=names("mission"))
def missions(name: str | None) -> None:
    """List the built-in missions, or print the file of one.

    \b
    Examples:
      tandemlift missions
      tandemlift missions iris > mine.toml
    """
    from tandemlift.missions import DATA, built_in

    if name is None:
        _print_table(built_in())
    elif name in built_in():
        echo((DATA / "missions" / f"{name}.toml").read_text("utf-8"), nl=False)
    else:
        raise unknown("mission", name, built_in())


@click.command()
def controllers() -> None:
    """List the controllers."""
    from tandemlift.parts.controllers import CONTROLLERS

    _print_table({name: c.summary for name, c in sorted(CONTROLLERS.items())})


@click.command()
def engines() -> None:
    """List the engines."""
    from tandemlift.engines.registry import ENGINES

    _print_table({name: e.summary for name, e in ENGINES.items()})
