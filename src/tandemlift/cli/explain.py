"""`tandemlift explain`: what a key of a mission is."""

from __future__ import annotations

import click

LOADED = "A controller of your own, whose keys are explained as well."


@click.command()
@click.argument("key", required=False)
@click.option("--controller", metavar="FILE", help=LOADED)
@click.option("--markdown", is_flag=True, help="Print all keys as the page docs/keys.md instead.")
def explain(key: str | None, controller: str | None, markdown: bool) -> None:
    """Explain a mission KEY: unit, meaning, bounds, default and its source.

    KEY is a dotted key or a table; without it, all tables are listed.

    \b
    Examples:
      tandemlift explain compliance.input_bandwidth
      tandemlift explain pushes.0.force
      tandemlift explain supervision.watchdog
      tandemlift explain controller.stiffness --controller my_pd.py
    """
    from tandemlift.cli.run import chosen_controller, echo
    from tandemlift.missions.reference.explaining import explained, index
    from tandemlift.missions.reference.markdown import keys_page

    if controller is not None:
        chosen_controller(controller)
    if markdown:
        echo(keys_page(), nl=False)
    else:
        echo(index() if key is None else explained(key))
