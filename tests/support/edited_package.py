"""A copy of the package that a test edits as a recipe of CONTRIBUTING.md says, and flies in a process of its own."""

import os
import shutil
import sys

from patience import completed
from repository import ROOT

import tandemlift

TABLES = (ROOT / "docs" / "_extensions", ROOT / "tools")  # what makes the tables of the reference


class EditedPackage:
    """A copy of the package in a folder; what is changed in it changes nothing else."""

    def __init__(self, folder):
        self.folder = folder
        self.source = shutil.copytree(os.path.dirname(tandemlift.__file__), folder / "tandemlift")

    def write(self, path, text):
        """A new file."""
        assert not (self.folder / "tandemlift" / path).exists()
        (self.folder / "tandemlift" / path).write_text(text, "utf-8")

    def replace(self, path, before, after):
        """Put one text in the place of another that a file has; of several, the first."""
        file = self.folder / "tandemlift" / path
        text = file.read_text("utf-8")
        assert before in text, f"{path} has no {before!r}"
        file.write_text(text.replace(before, after, 1), "utf-8")

    def insert(self, path, after, text):
        """Put text after a piece that a file has."""
        self.replace(path, after, after + text)

    def run(self, program):
        """What a Python program prints that imports the copy."""
        options = {"cwd": self.folder, "capture_output": True, "text": True}
        environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(self.folder), *map(str, TABLES)])}
        ended = completed([sys.executable, "-c", program], env=environment, **options)
        assert ended.returncode == 0, ended.stderr
        return ended.stdout
