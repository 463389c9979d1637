"""`tandemlift linearize`: what it prints and writes, and what it refuses."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from scipy.io import loadmat
from verbs import verb

from tandemlift.core.errors import InputError
from tandemlift.pictures.drawing import linear_model_figure
from tandemlift.pictures.drawing.linear_model_figure import Response

call = partial(verb, "linearize")


def test_modes_kinks_and_assumptions_are_printed_and_files_written(tmp_path):
    code, text, _ = call(
        "paper", "--out", tmp_path / "a" / "m.npz", "--figure", tmp_path / "m.pdf", "--style", "slides"
    )
    assert code == 0
    for piece in ("paper: the loop at 9.5 s", "modes, the slowest", "kinks:", "assumptions:", "position"):
        assert piece in text
    assert np.load(tmp_path / "a" / "m.npz")["A"].shape == (22, 22)
    assert b"/MediaBox [ 0 0 453.5433" in (tmp_path / "m.pdf").read_bytes(), "160 mm"


def test_the_body_alone_has_the_rotors_as_inputs():
    code, text, _ = call("hover", "--of", "body", "--inputs", "rotor_thrusts", "--outputs", "position,euler")
    assert code == 0
    assert "13 states, of which 13 connect the 8 inputs with the 6 outputs" in text


def test_the_figure_has_the_inputs_and_outputs_that_were_asked_for(tmp_path, monkeypatch):
    titles = []
    monkeypatch.setattr(linear_model_figure, "Response", lambda *words: titles.append(words[0]) or Response(*words))
    code, _, _ = call(
        *("hover", "--inputs", "disturbance_force", "--outputs", "velocity"),
        *("--figure", tmp_path / "m.png", "--out", tmp_path / "m.mat"),
    )
    assert (code, titles) == (0, ["disturbance force → velocity: 3 of 9 responses"])
    assert loadmat(tmp_path / "m.mat")["C"].shape[0] == 3


@pytest.mark.parametrize(
    ("arguments", "piece"),
    [
        (["paper", "--out", "m.txt"], "must end in .npz or .json or .mat"),
        (["paper", "--figure", "m.gif"], "must end in .png"),
        (["paper", "--at", "1e9"], "mission.duration"),
        (["paper", "--inputs", "hand"], "unknown input"),
    ],
)
def test_bad_input_is_refused_before_anything_is_written(arguments, piece, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    _, _, error = call(*arguments)
    assert isinstance(error, InputError)
    assert piece in str(error)
    assert list(tmp_path.iterdir()) == []
