"""`tandemlift gazebo` without Gazebo: what it refuses, and what it says."""

import pytest


@pytest.mark.parametrize(
    ("arguments", "words"), [(("--by-hand", "--fast"), "--fast"), (("--no-window",), "tools/gazebo-root")]
)
def test_a_fast_flight_by_hand_or_one_without_gazebo_is_refused_and_nothing_is_written(
    arguments, words, run, tmp_path, monkeypatch
):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("TANDEMLIFT_GAZEBO_ROOT", raising=False)
    code, _, err = run("gazebo", "hover", *arguments)
    assert code == 2
    assert words in err
    assert list(tmp_path.iterdir()) == []
