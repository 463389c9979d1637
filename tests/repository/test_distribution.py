"""What the distributions say of the package, and which extra has which package."""

import ast
import re
import subprocess
import sys
import tomllib

import pytest
from hatchling.metadata.core import ProjectMetadata
from hatchling.plugin.manager import PluginManager
from house import PACKAGE
from repository import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]
WITHOUT_IMPORT = {"casadi", "jax"}  # laws take arrays of these as they are given
COMES_WITH = {  # an import's package, where it has another name
    **{"lz4": "rosbags", "pydantic_core": "pydantic", "mpl_toolkits": "matplotlib"},
    **{"PIL": "pillow", "cycler": "matplotlib", "markupsafe": "jinja2", "vtkmodules": "pyvista"},
}
NOT_IN_ALL = {"torch"}  # 5 GB
OF_NOTEBOOKS = {"IPython"}  # imported only where it runs
OF_ROS = {"rosgraph", "rospy", "rclpy", "rcl_interfaces", "std_srvs"}  # from Debian; from an installed ROS 2


def names(requirements):
    return {re.match(r"[\w.-]+", text)[0].lower().replace("_", "-") for text in requirements}


def packages_of(extra):
    """The packages of an extra, with those of the extras that it names."""
    found = set[str]()
    for requirement in EXTRAS[extra]:
        if inner := re.fullmatch(r"tandemlift\[(.*)\]", requirement):
            found = found.union(*map(packages_of, inner[1].split(",")))
        else:
            found |= names([requirement])
    return found


def imports(node, extra=None, types=False):
    """Imports below a node: name, the extra that is named if it is missing, whether for types alone."""
    if isinstance(node, ast.Import):
        yield from ((alias.name, extra, types) for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        yield node.module, extra, types
    types = types or (isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test))
    for item in node.items if isinstance(node, ast.With) else ():
        if isinstance(item.context_expr, ast.Call) and ast.unparse(item.context_expr.func) == "extra":
            extra = ast.literal_eval(item.context_expr.args[0])
    for child in ast.iter_child_nodes(node):
        yield from imports(child, extra, types)


def optional_imports():
    """Each optional package of a package file, with the extra that is named where it is missing, or None."""
    needed = names(PROJECT["dependencies"])
    elsewhere = {*sys.stdlib_module_names, "tandemlift", *OF_ROS, *OF_NOTEBOOKS}

    def package_of(module):
        root = module.partition(".")[0]
        (package,) = names([COMES_WITH.get(root, root)])
        return package if root not in elsewhere and package not in needed else None

    def of_file(file):
        text = file.read_text("utf-8")
        roots = re.findall(r"^ *(?:import|from) (\w+)", text, flags=re.M)
        if not any(map(package_of, roots)) and " extra(" not in text:
            return
        for module, extra, types in imports(ast.parse(text)):
            if not types and (package := package_of(module)):
                yield package, extra
            elif extra and module.startswith("tandemlift."):  # a folder that is entered where the extra is named
                folder = PACKAGE.parent.joinpath(*module.split(".")).parent
                yield from ((package, extra) for one in folder.glob("*.py") for package, _ in of_file(one))

    for file in PACKAGE.rglob("*.py"):
        yield from of_file(file)


def test_the_description_has_no_picture_no_relative_link_and_no_target_of_the_makefile():
    text = ProjectMetadata(str(ROOT), PluginManager()).core.readme
    assert text
    assert re.findall(r"!\[|<img|<picture", text) == []
    assert [link for link in re.findall(r"\]\(([^)]*)\)", text) if not link.startswith("https://")] == []
    assert re.findall(r"^make .*", text, flags=re.M) == []


def test_what_is_imported_is_a_dependency_or_in_the_extra_that_is_named_where_it_is_missing():
    found = set(optional_imports())
    assert found
    assert {(package, extra) for package, extra in found if extra and package not in packages_of(extra)} == set()
    named = {package for package, extra in found if extra}
    assert {package for package, _ in found} == named, "imported, but nothing says how to install it"
    assert packages_of("all") - named <= WITHOUT_IMPORT


def test_all_has_every_extra_but_the_largest():
    assert packages_of("all") == set().union(*map(packages_of, EXTRAS.keys() - NOT_IN_ALL))


@pytest.mark.parametrize("file", ["src", "docs", "README.md", "CONTRIBUTING.md"])
def test_extras_that_a_command_names_exist(file):
    path = ROOT / file
    for one in [p for p in path.rglob("*") if p.suffix in (".py", ".md")] if path.is_dir() else [path]:
        for given in re.findall(r"(?:tandemlift|\.)\[([a-z0-9,]+)\]'", one.read_text("utf-8")):
            assert set(given.split(",")) <= EXTRAS.keys(), one


def test_the_page_of_the_installation_has_a_row_for_each_extra():
    text = (ROOT / "docs" / "start" / "install.md").read_text("utf-8")
    cells = re.findall(r"^\| (`.*?) \|", text, flags=re.M)
    assert {name for cell in cells for name in re.findall(r"`(\w+)`", cell)} == EXTRAS.keys() - {"all"}


def test_the_build_imports_no_package_that_it_does_not_ask_for():
    """`pip install` builds in an environment that has what hatch_build.py asks for, and nothing else."""
    build = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["hatch"]["build"]
    asked = names(build["targets"]["wheel"]["hooks"]["custom"]["dependencies"])
    others = {package for extra in EXTRAS for package in packages_of(extra)} | names(PROJECT["dependencies"])
    missing = [{"pillow": "PIL"}.get(package, package.replace("-", "_")) for package in sorted(others - asked)]
    program = (
        f"import sys; sys.modules.update(dict.fromkeys({missing}))\n"  # None: importing one fails
        "from tandemlift.apps.cli.completion import formed_words\n"
        "from tandemlift.apps.live.page_modules import build_modules\n"
        "print(len(formed_words()))\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == ("8\n", "")


@pytest.fixture
def repository(tmp_path):
    """A clean repository with what `make release` reads before it builds; its names are as they are recorded."""
    files = {
        "src/tandemlift/core/files.py": '__version__ = "1.2.0"\n',
        "CITATION.cff": "version: 1.2.0\n",
        "CHANGELOG.md": "# Changelog\n\n## [1.2.0] - 2027-01-01\n\n- News.\n\n## [1.1.0] - 2026-12-01\n\n- Old.\n",
        ".gitignore": ".venv/\n",
        ".venv/bin/pytest": "#!/bin/sh\nexit 0\n",
        "Makefile": "docs:\n\t@exit 7\n",
        "tools/release": (ROOT / "tools" / "release").read_text("utf-8"),
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, "utf-8")
    for name in ("tools/release", ".venv/bin/pytest"):
        (tmp_path / name).chmod(0o755)
    subprocess.run(["git", "init", "-q", tmp_path], check=True)
    return tmp_path


@pytest.mark.parametrize(
    ("name", "text", "committed", "said"),
    [
        ("README.md", "", True, "docs] Error 7"),  # nothing is in its way: it builds, of which there is nothing here
        ("stray.txt", "", False, "make release: the tree is not clean: commit or remove\n?? stray.txt\n"),
        ("CITATION.cff", "version: 1.1.0\n", True, "make release: CITATION.cff: must have version: 1.2.0\n"),
        (
            "CHANGELOG.md",
            "## [1.2.0]\n\n## [1.1.0]\n\n- Old.\n",
            True,
            "CHANGELOG.md: must have a section [1.2.0] with",
        ),
        (
            ".venv/bin/pytest",
            "#!/bin/sh\necho key a.b >&2; exit 1\n",
            True,
            "key a.b\nmake release: public names changed",
        ),
    ],
)
def test_a_release_is_refused_before_anything_is_built(repository, name, text, committed, said):
    commit = ("-c", "user.name=a", "-c", "user.email=a@example.org", "commit", "-qm", "All")
    (repository / name).write_text(text, "utf-8") if committed else None
    for words in (("add", "."), commit):
        subprocess.run(["git", "-C", repository, *words], check=True)
    (repository / name).write_text(text, "utf-8")
    done = subprocess.run([repository / "tools" / "release"], capture_output=True, text=True, check=False)
    assert (done.returncode, said in done.stderr) == (2, True), done.stderr
    assert (repository / "out").exists() == ("Error 7" in said)
