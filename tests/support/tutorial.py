"""Tutorials that the site does not run: their commands, run in the order in which the page has them.

A block of shell commands has its name in the comment above it, `<!-- run: NAME -->`. The block of text below it is what
it must print, where `…` stands for anything within a line.
"""

import os
import re
import shlex
import signal
import subprocess
import sys
from typing import NamedTuple

from patience import COMPILING, completed, ended, until
from repository import ROOT

BLOCK = re.compile(r"^<!-- run: ([\w-]+) -->\n```sh\n(.*?)^```$(?:\n\n^```text\n(.*?)^```$)?", re.M | re.S)
SET_ASIDE = re.compile(r"^<!-- not run: .+ -->\n```sh\n", re.M)


class Command(NamedTuple):
    """Shell commands of a page, and the lines that they show."""

    name: str
    code: str
    shown: str


class Terminal:
    """Commands that go on until they are interrupted."""

    def __init__(self, command, log, **options):
        self.command, self._log = command, log
        with log.open("wb") as file:
            self._process = subprocess.Popen(
                ["bash", "-c", command.code], stdout=file, stderr=subprocess.STDOUT, start_new_session=True, **options
            )

    def printed(self):
        return self._log.read_text("utf-8", "replace")

    def says(self, pattern):
        """Wait until it has printed that; the match."""

        def found():
            assert self._process.poll() is None or re.search(pattern, self.printed()), self.printed()
            return re.search(pattern, self.printed())

        return until(found, pattern, COMPILING)

    def interrupt(self):
        """What Ctrl-C does; the status at its end."""
        if self._process.poll() is None:
            os.killpg(self._process.pid, signal.SIGINT)
        return ended(self._process, None)


class Tutorial:
    """A page of docs/tutorials in a folder of its own.

    `instead` has programs that another stands for, with its own arguments before those of the page.
    """

    def __init__(self, name, folder, environment, instead):
        text = (ROOT / "docs" / "tutorials" / f"{name}.md").read_text("utf-8")
        self._commands = [Command(n, code, shown) for n, code, shown in BLOCK.findall(text)]
        assert len(self._commands) + len(SET_ASIDE.findall(text)) == text.count("```sh\n"), "a block has no name"
        self.folder, self._programs, self._terminals = folder / "here", folder / "bin", []
        self.folder.mkdir()
        self._programs.mkdir()
        ours = f"env PYTHONPATH={shlex.quote(os.pathsep.join(p for p in sys.path if p))} {shlex.quote(sys.executable)}"
        for program, command in {"tandemlift": f"{ours} -m tandemlift", "python": ours, **instead}.items():
            script = self._programs / program
            script.write_text(f'#!/bin/sh\nexec {command} "$@"\n', "utf-8")
            script.chmod(0o755)
        path = os.pathsep.join([str(self._programs), environment["PATH"]])
        self._options = {"cwd": self.folder, "env": environment | {"PATH": path, "PYTHONUNBUFFERED": "1"}}

    def _next(self, name):
        command = self._commands.pop(0)
        assert command.name == name, "the page has its commands in this order"
        return command

    def run(self, name):
        """Run the page's next commands to their end; what they print."""
        command = self._next(name)
        done = completed(
            ["bash", "-e", "-c", command.code],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            **self._options,
        )
        assert done.returncode in (0, 124), done.stdout  # 124: of a `timeout`
        check_shown(command.shown, done.stdout)
        return done.stdout

    def start(self, name):
        """Run the page's next commands in a terminal of their own."""
        command = self._next(name)
        self._terminals.append(Terminal(command, self._programs / f"{name}.log", **self._options))
        return self._terminals[-1]

    def watch(self, line):
        """Run a line that the page does not have in a terminal of its own."""
        self._terminals.append(Terminal(Command("watch", line, ""), self._programs / "watch.log", **self._options))
        return self._terminals[-1]

    def paste(self, line):
        """Run a line that a command printed."""
        return completed(["bash", "-c", line], check=True, capture_output=True, text=True, **self._options).stdout

    def check_complete(self):
        """Nothing of the page is left to run, and what went on has printed what the page shows."""
        assert self._commands == []
        for terminal in self._terminals:
            check_shown(terminal.command.shown, terminal.printed())

    def close(self):
        for terminal in self._terminals:
            terminal.interrupt()


def check_shown(shown, printed):
    """Compare the lines that a page shows with what was printed."""
    for line in shown.splitlines():
        pattern = ".*".join(re.escape(part) for part in line.split("…"))
        assert re.search(f"^{pattern}$", printed, re.M), f"the page shows {line!r}, printed was\n{printed}"
