"""What editors and git hooks are told is what the project does."""

import configparser
import re
import subprocess
from fnmatch import fnmatch

from for_all import for_all
from repository import ROOT

DOCS = sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").rglob("*.md"))
DOCS.remove("docs/history.md")  # whose targets and paths are those of their time
MADE = "src/tandemlift/data/page/*"  # by `make page`


def tracked_texts():
    """The tracked files that are text and written by hand, with their bytes."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in filter(None, listed.split("\0")):
        path = ROOT / name
        if path.is_file() and not fnmatch(name, MADE) and b"\0" not in (content := path.read_bytes()):
            yield name, content


def editorconfig():
    parser = configparser.ConfigParser(comment_prefixes="#")
    parser.read_string("[top]\n" + (ROOT / ".editorconfig").read_text("utf-8"))
    return parser


def test_files_are_as_editors_are_told_to_write_them():
    rules = editorconfig()["*"]
    assert (rules["charset"], rules["end_of_line"], rules["indent_style"]) == ("utf-8", "lf", "space")
    assert rules["insert_final_newline"] == rules["trim_trailing_whitespace"] == "true"
    wrong = []
    for name, content in tracked_texts():
        lines = content.decode("utf-8").split("\n")
        tabs = name != "Makefile" and any(line.startswith("\t") for line in lines)
        spaces = any(line != line.rstrip() for line in lines)  # or a carriage return
        if tabs or spaces or (content and not content.endswith(b"\n")):
            wrong.append(name)
    assert wrong == []


def test_editors_and_the_linter_know_one_length_of_a_line():
    project = (ROOT / "pyproject.toml").read_text("utf-8")
    assert f"line-length = {editorconfig()['*']['max_line_length']}\n" in project


def test_a_commit_is_checked_by_the_targets_of_the_makefile_and_by_nothing_else():
    config = (ROOT / ".pre-commit-config.yaml").read_text("utf-8")
    assert re.findall(r"repo: (.*)", config) == ["local"]
    assert re.findall(r"entry: (.*)", config) == ["make lint", "make types", "make imports"]
    assert re.search(r"^test: lint types imports tests ", (ROOT / "Makefile").read_text("utf-8"), flags=re.M)


@for_all(["CONTRIBUTING.md", "SECURITY.md", "README.md", *DOCS])
def test_targets_and_paths_that_a_document_names_exist(document):
    text, makefile = (ROOT / document).read_text("utf-8"), (ROOT / "Makefile").read_text("utf-8")
    for targets in re.findall(r"\bmake ((?:[a-z][a-z-]+ ?)+)(?=[`\n#;&]|  )", text):
        for target in targets.split():
            assert re.search(rf"^{target}:", makefile, flags=re.M), target
    for path in re.findall(r"`((?:src|tests|tools|docs|benchmarks|web|lock|gazebo)/[\w./-]*)`", text):
        assert "NAME" in path or (ROOT / path).exists(), path  # a new file is named by its writer
