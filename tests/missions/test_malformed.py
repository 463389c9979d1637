import pytest
import tomli_w
from for_all import for_all
from malformed import CASES, QUADROTOR
from mission_schema import EVERYTHING

import tandemlift as tl
from tandemlift.missions import Mission, built_in, load_mission, tables_of
from tandemlift.missions.changes import value_at
from tandemlift.missions.key_descriptions import table_in
from tandemlift.missions.refusals import keys_of

JARGON = (
    "Input should",
    "Value error",
    "validation error",
    "tuple",
    "NoneType",
    "function-",
    "pydantic",
    "dict",
    "float_",
)


def refusal(name, changes=None) -> str:
    with pytest.raises(tl.InputError) as refused:
        load_mission(name, changes)
    return str(refused.value)


@pytest.fixture
def mine(tmp_path, monkeypatch):
    """Write a mission file beside which the test runs, and name it."""
    monkeypatch.chdir(tmp_path)

    def write(text: str | bytes, name: str = "mine.toml") -> str:
        (tmp_path / name).write_bytes(text if isinstance(text, bytes) else text.encode())
        return name

    return write


@for_all(CASES, lambda case: case.name)
def test_a_malformed_mission_is_refused_in_plain_words_with_file_key_value_and_what_is_allowed(mine, case):
    message = refusal(mine(f'extends = "{case.base}"\n{case.toml}\n'))
    assert [piece for piece in ("mine.toml: ", *case.pieces) if piece not in message] == []
    lines = message.splitlines()
    assert len(lines) == len(set(lines)) <= 9
    assert all(len(line) < 420 and line.isprintable() for line in lines)
    assert [word for word in JARGON if any(word in line for line in lines)] == []


def required_keys():
    """The places of all keys without a default, in tables and in lists of tables."""
    for place in keys_of(Mission):
        *above, name = place
        table = Mission
        for part in above:
            table = table_in(table.model_fields[part].annotation) if part != 0 else table
        if table.model_fields[name].is_required():
            yield place


@for_all([place for place in required_keys() if "bodies" not in place])  # which no mission has beside a beam
def test_a_missing_key_is_named(mine, place):
    tables = tables_of(load_mission("iris", EVERYTHING))
    tables["admittance"].pop("feel")  # which stands in for mass and damping
    del value_at(tables, place[:-1])[place[-1]]
    message = refusal(mine(tomli_w.dumps(tables)))
    assert f"mine.toml: {'.'.join(map(str, place))} is missing: it must be" in message
    assert len(message.splitlines()) == 1


def test_a_payload_without_dimensions_or_inertia_is_refused(mine):
    tables = tables_of(load_mission("paper"))
    del tables["vehicle"]["payload"]["radius"]
    assert "vehicle.payload: must have either inertia, or length and radius" in refusal(mine(tomli_w.dumps(tables)))


def test_all_that_is_wrong_is_told_at_once_but_not_without_end(mine):
    message = refusal(
        mine("extends = 'paper'\nmission.duration = -1\nphases.height = 'high'\ncontroller.gains.xi = 0\n")
    )
    assert [key for key in ("mission.duration", "phases.height", "controller.gains.xi") if key not in message] == []
    wrong = ", ".join([QUADROTOR.replace("mass", "mas") % "0, 0, 0"] * 64)
    lines = refusal(mine(f"extends = 'paper'\nvehicle.quadrotors = [{wrong}]\n")).splitlines()
    assert len(lines) == 9
    assert lines[-1] == "mine.toml: and 120 more"


FILES = {
    "an empty file": (
        b"",
        ["mission is missing", "vehicle is missing", "controller is missing", "admittance is missing"],
    ),
    "binary garbage": (bytes(range(256)) * 8, ["mine.toml is not text in UTF-8", "byte 128"]),
    "UTF-16": ('extends = "paper"'.encode("utf-16"), ["mine.toml is not text in UTF-8"]),
    "no TOML": (b"mission = {", ["mine.toml is not valid TOML", "end of document"]),
    "a NUL": (b'extends = "paper"\n\x00', ["mine.toml is not valid TOML", "line 2"]),
    "a key given twice": (b"mission.step = 1\nmission.step = 2\n", ["mine.toml is not valid TOML"]),
    "a number of 5000 digits": (b"mission.seed = " + b"9" * 5000, ["mine.toml is not valid TOML"]),
    "a hexadecimal of 5000 digits": (b"mission.seed = 0x" + b"f" * 5000, ["mission.seed = 0xfff", "a whole number"]),
    "10,000 brackets": (b"a = " + b"[" * 10_000, ["mine.toml is not a mission: nested too deeply"]),
    "10,000 nested tables": (b"extends = 'paper'\nmission" + b".a" * 10_000 + b" = 1", ["unknown key"]),
    "more than a megabyte": (b"# " + b"x" * 1_000_000, ["mine.toml is larger than 1000000 bytes"]),
}


@pytest.mark.parametrize("content", FILES.values(), ids=FILES)
def test_a_file_that_is_no_mission_is_refused(content, mine):
    text, pieces = content
    message = refusal(mine(text))
    assert "mine.toml" in message
    assert [piece for piece in pieces if piece not in message] == []


def test_a_missing_file_a_folder_and_a_misspelt_name_are_told_apart(mine, tmp_path):
    (tmp_path / "folder.toml").mkdir()
    assert refusal("absent.toml") == "mission file absent.toml does not exist."
    assert "Did you mean 'paper'?" in refusal("papr.toml")
    mine("")
    assert "Did you mean 'mine'?" in refusal("mien.toml")
    (tmp_path / "flown").mkdir()
    (tmp_path / "flown" / "mission.toml").touch()
    assert refusal("flown/flight.npz").endswith("the mission of its flight is flown/mission.toml")
    assert "--controller pd.py" in refusal("pd.py")
    assert refusal("folder.toml") == "folder.toml is a folder, not a mission file"
    assert f"unknown mission 'papper'; there are {', '.join(built_in())}. Did" in refusal("papper")
    assert "Did you mean 'paper'?" in refusal("PAPER")
    assert "ends in .toml" in refusal("mine")
    assert "does not exist" in refusal(tmp_path / "paper")
    assert "too long" in refusal(f"{'n' * 5000}.toml")
    assert refusal("a\0b.toml")


EXTENDS = {
    "itself": ("mine.toml", 'extends = "mine.toml": comes back to a file that extends it'),
    "a cycle": ("round.toml", "comes back to a file that extends it"),
    "a missing file": ("absent.toml", "mission file absent.toml does not exist"),
    "a misspelt name": ("papr", "Did you mean 'paper'?"),
    "a folder": ("folder/", "is a folder"),
}


@pytest.mark.parametrize("parent", EXTENDS.values(), ids=EXTENDS)
def test_what_cannot_be_extended_is_refused_by_name(parent, mine, tmp_path):
    (tmp_path / "folder").mkdir()
    mine('extends = "mine.toml"\n', "round.toml")
    name, piece = parent
    message = refusal(mine(f'extends = "{name}"\n'))
    assert "extends = " in message
    assert piece in message


def test_extends_must_be_text(mine):
    for value in ("5", "['paper']", "{name = 'paper'}"):
        assert "must be the name of a built-in mission or a path, in quotes" in refusal(mine(f"extends = {value}\n"))


def test_a_refusal_names_the_file_of_the_wrong_key(mine):
    mine("extends = 'paper'\nmission.step = 1.0\n", "base.toml")
    message = refusal(mine("extends = 'base.toml'\nmission.duration = -1\n"))
    assert message.splitlines() == [
        "mine.toml: mission.duration = -1: must be a number > 0",
        "base.toml: mission.step = 1.0: must be a number > 0 and ≤ 0.02",
    ]


def test_a_refusal_of_a_change_names_the_mission_that_it_changes(mine):
    mine("extends = 'paper'\nmission.step = 0.002\n", "base.toml")
    message = refusal(mine("extends = 'base.toml'\n"), {"mission.step": 1.0})
    assert message == "mine.toml: mission.step = 1.0: must be a number > 0 and ≤ 0.02"
