"""The command line within the process of a test."""

from click.testing import CliRunner

from tandemlift.apps.cli.main import cli


def verb(name, *arguments):
    """Exit code, output and exception of a verb."""
    result = CliRunner().invoke(cli, [name, *map(str, arguments)])
    return result.exit_code, result.output, result.exception
