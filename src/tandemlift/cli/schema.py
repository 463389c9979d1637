"""`tandemlift schema`: the JSON Schema of mission files."""

from __future__ import annotations

import json

import click


@click.command()
@click.option("--controller", metavar="FILE", help="A controller of your own, whose keys are in the schema as well.")
def schema(controller: str | None) -> None:
    """Print the JSON Schema of mission files, for editors of TOML.

    An editor that knows it completes keys, shows their meaning, and marks what is wrong. With Even Better TOML or
    another editor that uses Taplo, name the file in the first line of the mission:

    \b
      tandemlift schema > mission.schema.json
      #:schema ./mission.schema.json
    """
    from tandemlift.cli.run import chosen_controller, echo
    from tandemlift.missions.reference.schema import mission_schema

    if controller is not None:
        chosen_controller(controller)
    echo(json.dumps(mission_schema(), indent=2, ensure_ascii=False))
