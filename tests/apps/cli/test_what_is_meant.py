"""What the command line says of a key that is misspelt, renamed or written as an option, and of checks that advise."""

import sys

import pytest

import tandemlift as tl
from tandemlift.apps.cli.main import main
from tandemlift.core.errors import CLOSE, FAILS, OK, judged
from tandemlift.missions import load_mission
from tandemlift.missions.checks import check_lines
from tandemlift.missions.key_descriptions import as_key, sections
from tandemlift.missions.reference import explained, plain_name
from tandemlift.missions.refusals import RENAMED, present_name


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--wind", "3"], "--set wind.velocity=[3,0,0]"),
        (["--wind=-2.5"], "--set wind.velocity=[-2.5,0,0]"),
        (["--duration", "5"], "--set mission.duration=5"),
        (["--nothing", "5"], ""),
    ],
)
def test_an_unknown_option_that_is_a_key_is_told_as_one(words, said):
    assert as_key(words[0].partition("=")[0], ["tandemlift", "run", "hover", *words]).endswith(said)


def test_the_command_line_says_so_and_exits_with_two(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["tandemlift", "run", "hover", "--wind", "3"])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    assert "--set wind.velocity=[3,0,0]" in capsys.readouterr().err


def test_the_nearest_of_a_misspelt_key_are_of_its_table():
    with pytest.raises(tl.InputError) as refused:
        explained("wind.velocty")
    names = str(refused.value).partition("the nearest are ")[2].split(", ")
    assert names[0] == "wind.velocity"
    assert all(name.startswith("wind.") for name in names)


@pytest.mark.parametrize(
    ("key", "now"),
    [
        ("mission.fused", "mission.fma"),
        ("admittance.reanchor", "admittance.hold_after_release"),
        ("compliance.hearing", "compliance.input_bandwidth"),
        ("supervision.fence.slowing", "supervision.fence.braking_gain"),
    ],
)
def test_a_former_key_names_its_successor(key, now):
    with pytest.raises(tl.InputError, match=f"unknown key; .* It is {now} now"):
        load_mission("iris", {key: 1})
    with pytest.raises(tl.InputError, match=f"it is {now} now"):
        explained(key)
    assert present_name(now) == now


def test_every_former_key_has_a_successor_that_is_there_and_is_none_itself():
    names = {plain_name(key.name) for section in sections() for key in section.keys}
    known = names | {name.rpartition(".")[0] for name in names}
    for table, pairs in RENAMED.items():
        for old, new in (pair.split("=") for pair in pairs.split()):
            before, after = (f"{table}.{name}".lstrip(".") for name in (old, new))
            assert present_name(before) == after
            assert after in known
            assert before not in known


def test_a_report_of_checks_has_failures_first_and_no_margin_of_advice():
    advice = judged("push", 3.0, 0.3, "N", "")._replace(verdict=CLOSE)
    lines = [line for _, line in check_lines([judged("a", 0.1, 1.0, "N", ""), advice, judged("b", 2.0, 1.0, "N", "x")])]
    assert [line.split()[-1] for line in lines[1:4]] == [FAILS, CLOSE, OK]
    assert "advice" in lines[2]
    assert "-900 %" not in "\n".join(lines)
