"""`tandemlift gazebo` without Gazebo: what it refuses, and what it says."""

import pytest

from tandemlift.apps.cli.main import main


def test_a_flight_by_hand_is_not_fast(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", ["tandemlift", "gazebo", "hover", "--by-hand", "--fast"])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 2
    assert "--fast" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_without_gazebo_the_command_says_where_to_get_it_and_writes_nothing(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("TANDEMLIFT_GAZEBO_ROOT", raising=False)
    monkeypatch.setattr("sys.argv", ["tandemlift", "gazebo", "hover", "--no-window"])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 2
    assert "tools/gazebo-root" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
