"""Shells complete commands, missions, keys and other names: by click's protocol, and in real shells."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.shell_completion import BashComplete
from click.testing import CliRunner

import tandemlift as tl
from tandemlift.apps.cli import completion
from tandemlift.apps.cli.main import cli
from tandemlift.missions import built_in
from tools import need

SOURCES = Path(tl.__file__).resolve().parent.parent
ALONE = ("numpy", "pydantic", "matplotlib", "llvmlite")  # each takes longer to import than a shell should wait


@pytest.fixture(scope="module", autouse=True)
def shipped(tmp_path_factory):
    """The words as an install has them."""
    file = tmp_path_factory.mktemp("words") / "completion.json"
    file.write_text(json.dumps(completion.formed_words()), "utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(completion, "shipped_text", lambda: file.read_text("utf-8"))
        completion.known_words.cache_clear()
        yield file
    completion.known_words.cache_clear()


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine").mkdir()
    for name in ("mine.toml", "mine.py", "mine.npz", ".hidden.toml", "mine/inner.toml"):
        (tmp_path / name).touch()
    return tmp_path


def completed(line):
    """What completes the last word of a line."""
    *before, begun = line.split(" ")
    found = BashComplete(cli, {}, "tandemlift", "_TANDEMLIFT_COMPLETE").get_completions(before, begun)
    return [item.value for item in found]


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("li", ["live", "linearize"]),
        ("rnu", []),
        ("run zi", ["zigzag"]),
        ("run m", ["mine/", "mine.toml"]),
        ("run mine/", ["mine/inner.toml"]),
        ("run nowhere/", []),
        ("render m", ["mine/", "mine.npz", "mine.toml"]),
        ("run paper --con", ["--controller"]),
        ("run paper --controller p", ["pid"]),
        ("run paper --controller m", ["mine/", "mine.py"]),
        ("run paper --engine m", ["mujoco"]),
        ("compare paper --controllers nftsmc,s", ["nftsmc,smc", "nftsmc,super-twisting"]),
        ("run paper --set adm", ["admittance."]),
        ("run paper --set admittance.da", ["admittance.damping="]),
        ("run paper --set pushes.0.fo", ["pushes.0.force="]),
        ("run paper --set admittance.damping=2", []),
        ("explain supervision.watchd", ["supervision.watchdog."]),
        ("explain mission.dur", ["mission.duration"]),
        ("compile iris --target cor", ["cortex-m7"]),
        ("new mine.toml --quadrotor cr", ["crazyflie"]),
        ("compile iris --controller p", ["pid"]),
        ("tune hover --minimize position_rmse", ["position_rmse_m", "position_rmse_after_10s_m"]),
        ("linearize iris --of b", ["body"]),
        ("completion z", ["zsh"]),
    ],
)
def test_the_last_word_of_a_line_is_completed(line, found, folder):
    assert completed(line) == found


def test_each_mission_key_and_table_is_reached_one_dot_at_a_time_and_can_be_explained():
    known = completion.known_words()

    def reached(command, begun=""):
        for found in completed(f"{command} {begun}"):
            yield from reached(command, found) if found.endswith(".") else [found]

    assert set(reached("run paper --set")) == {f"{key}=" for key in known["key"]}
    explained = set(reached("explain"))
    assert explained == set(known["key"])
    for name in [*list(known["key"])[::25], *list(known["table"])[::8]]:
        assert CliRunner().invoke(cli, ["explain", name]).exit_code == 0, name


def test_the_words_are_those_that_the_package_lists():
    known = completion.known_words()
    assert known["mission"] == dict(built_in())
    for kind in ("controller", "engine"):
        listed = CliRunner().invoke(cli, [f"{kind}s"]).output.splitlines()
        assert [line.split()[0] for line in listed] == list(known[kind])
    metrics = tl.fly(tl.load_mission("one-push")).metrics()
    assert [name for name in metrics if name not in known["metric"]] == []


def program(folder, shipped):
    """A program `tandemlift` on the path, with the words as an install has them; an import of what is slow fails."""
    slow = dict.fromkeys(ALONE)
    code = f"import sys; sys.modules |= {slow!r}; sys.path.insert(0, {str(SOURCES)!r})\n"
    code += "from pathlib import Path\nfrom tandemlift.apps.cli import completion\n"
    code += f"completion.shipped_text = Path({str(shipped)!r}).read_text\n"
    code += "from tandemlift.apps.cli.main import main\nmain()\n"
    path = folder / "bin" / "tandemlift"
    path.parent.mkdir()
    path.write_text(f"#!{sys.executable}\n{code}", "utf-8")
    path.chmod(0o755)
    return {**os.environ, "PATH": f"{path.parent}:{os.environ['PATH']}", "HOME": str(folder)}


BASH = """
eval "$(tandemlift completion bash)"
complete() { :; }
compopt() { echo "$@"; }
for words in "tandemlift run zi" "tandemlift run paper --set admittance.da" "tandemlift run paper --out m"; do
    COMP_WORDS=($words) COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
    _tandemlift tandemlift
    echo "${COMPREPLY[*]}"
done
"""
FISH = """
tandemlift completion fish | source
complete -C 'tandemlift run zi'
complete -C 'tandemlift run paper --set admittance.da'
complete -C 'tandemlift run paper --out mine.n'
"""
ZSH = """
compdef() { echo "$@"; }
_describe() { echo "$found[1]${joined:+ joined}"; }
_files() { echo files; }
eval "$(tandemlift completion zsh)"
for line in "tandemlift run zi" "tandemlift run paper --set admittance.da" "tandemlift run paper --out m"; do
    words=(${(s: :)line}) CURRENT=$#words
    _tandemlift
done
"""


@pytest.mark.parametrize(
    ("shell", "script", "said"),
    [
        (["bash", "--norc", "-c"], BASH, ["zigzag", "-o nospace", "admittance.damping=", ""]),
        (["fish", "--no-config", "-c"], FISH, ["zigzag\t", "admittance.damping=\t", "mine.npz"]),
        (["zsh", "-f", "-c"], ZSH, ["_tandemlift tandemlift", "zigzag:", "admittance.damping=:", "files"]),
    ],
    ids=["bash", "fish", "zsh"],
)
def test_a_real_shell_completes_by_its_script_and_nothing_slow_is_imported(shell, script, said, folder, shipped):
    need(shell[0])
    before = sorted(folder.iterdir())
    done = subprocess.run(
        [*shell, script], env=program(folder, shipped), capture_output=True, text=True, timeout=300, check=False
    )
    lines = done.stdout.splitlines()
    assert done.stderr == ""
    assert [line.startswith(start) for line, start in zip(lines, said, strict=True)] == [True] * len(said), lines
    assert sorted(p for p in folder.iterdir() if p.name not in ("bin", ".local", ".config", ".cache")) == before
