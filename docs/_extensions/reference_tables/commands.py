"""The commands, as `tandemlift VERB --help` has them: usage, text, examples, options."""

from __future__ import annotations

import inspect
import re
import textwrap
from collections.abc import Iterator

import click

from reference_tables.markdown import linked, table
from tandemlift.apps.cli.main import cli

LISTED = re.compile(r"(?!tandemlift )(\S+(?: \S+)*) {2,}(\S.*)")
CODE = re.compile(r"`([^`]+)`|(?<![\w`])(--?[a-z][\w-]*)")


def verbs() -> str:
    """A line for each verb."""
    return table(("command", "purpose"), [(f"[{name}](#{name})", _first(verb)) for name, verb in _verbs()])


def commands() -> str:
    """A section for each verb."""
    return "\n".join(_section(name, verb) for name, verb in _verbs())


def _verbs() -> Iterator[tuple[str, click.Command]]:
    with click.Context(cli, info_name="tandemlift") as context:
        for name in cli.list_commands(context):
            verb = cli.get_command(context, name)
            assert verb is not None
            yield name, verb


def _first(verb: click.Command) -> str:
    """The first sentence of a verb's help, whole."""
    return _marked(" ".join(inspect.cleandoc(verb.help or "").partition("\n\n")[0].split()))


def _section(name: str, verb: click.Command) -> str:
    context = click.Context(verb, info_name=f"tandemlift {name}", terminal_width=80)
    usage = " ".join([f"tandemlift {name}", *verb.collect_usage_pieces(context)])
    records = [one.get_help_record(context) for one in verb.params if isinstance(one, click.Option)]
    rows = [(f"`{names}`", _marked(text)) for names, text in filter(None, records)]
    body = "\n\n".join(_paragraphs(inspect.cleandoc(verb.help or "")))
    options = f"\n\n{table(('option', 'what'), rows)}" if rows else "\n"
    return f"## {name}\n\n```text\n{usage}\n```\n\n{body}{options}"


def _paragraphs(text: str) -> Iterator[str]:
    """The paragraphs of a help text; one whose lines click keeps (after a backspace) is code below its first line."""
    for paragraph in text.split("\n\n"):
        kept, lines = paragraph.startswith("\b\n"), paragraph.removeprefix("\b\n").splitlines()
        if not kept:
            yield _marked(" ".join(line.strip() for line in lines))
            continue
        if lines[0].endswith(":") and len(lines) > 1:
            yield f"**{lines.pop(0)}**"
        code = textwrap.dedent("\n".join(lines))
        if LISTED.match(code):
            yield _listed(code)
        else:
            yield f"```sh\n{code}\n```" if code.startswith("tandemlift ") else _marked(" ".join(code.split()))


def _listed(text: str) -> str:
    """Names with their meanings, such as files and exit codes, as a table; a meaning may take several lines."""
    rows: list[list[str]] = []
    for line in text.splitlines():
        named = LISTED.match(line)
        if named:
            rows.append([f"`{named[1]}`", named[2]])
        else:
            rows[-1][1] += f" {line.strip()}"
    return table(("", ""), [(name, _marked(meaning)) for name, meaning in rows])


def _marked(text: str) -> str:
    """A text whose options are code, and which Markdown changes in no other way."""
    parts = [part or "" for part in CODE.split(text)]
    plain = (re.sub(r"([*\[\]<>])", r"\\\1", part) for part in parts[::3])
    code = (f"`{named or option}`" for named, option in zip(parts[1::3], parts[2::3], strict=True))
    return linked("".join(piece for pair in zip(plain, [*code, ""], strict=True) for piece in pair))
