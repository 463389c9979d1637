"""`tandemlift completion`: the script by which a shell completes the command line."""

from __future__ import annotations

import click

from tandemlift.apps.cli.terminal.console import echo
from tandemlift.apps.cli.terminal.shell_scripts import SCRIPTS


@click.command()
@click.argument("shell", type=click.Choice(list(SCRIPTS)))
def completion(shell: str) -> None:
    """Print the script that completes commands, options, missions, keys and other names in a SHELL.

    \b
    In the start file of the shell, where `tandemlift` is on the path:
      bash, ~/.bashrc:                    eval "$(tandemlift completion bash)"
      zsh, ~/.zshrc, after compinit:      eval "$(tandemlift completion zsh)"
      fish, ~/.config/fish/config.fish:   tandemlift completion fish | source
    """
    echo(SCRIPTS[shell], nl=False)
