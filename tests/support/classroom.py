"""Notebooks that a class hands in, and the command that grades them."""

import json
import os
import subprocess
import sys
from pathlib import Path

from tandemlift.apps.teaching.hand_ins import Notebook

EXERCISES = Path(__file__).parents[2] / "exercises"


def source(name: str) -> str:
    return (EXERCISES / "solutions" / f"{name}.py").read_text("utf-8")


def handed_in(folder: Path, name: str, exercise: str, *codes: str, tags: tuple[str, ...] = ()) -> Notebook:
    cells = [{"cell_type": "code", "metadata": {"tags": list(tags)}, "source": code, "outputs": []} for code in codes]
    notebook = {"cells": cells, "metadata": {"tandemlift": {"exercise": exercise}}, "nbformat": 4, "nbformat_minor": 5}
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.ipynb").write_text(json.dumps(notebook), "utf-8")
    return Notebook(name, exercise, folder / f"{name}.ipynb")


def graded(folder: Path, *more: str, **environment: str) -> tuple[int, str]:
    """The exit code and the output of the command, in a process of its own: others here may have threads."""
    command = [sys.executable, "-m", "tandemlift", "grade", folder, "--exercises", EXERCISES, *more]
    env = os.environ | environment
    done = subprocess.run(list(map(str, command)), env=env, capture_output=True, text=True, check=False)
    assert done.returncode in (0, 3), done.stderr
    return done.returncode, done.stdout
