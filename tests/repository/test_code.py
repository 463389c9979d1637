"""Rules that every file of the package keeps, and that what finds a breach of them finds it."""

import ast
from collections import Counter

import pytest
from code_rules import hidden_imports, logic, public_classes
from house import PACKAGE, assert_none, python_files

FACE = "src/tandemlift/__init__.py"  # which loads what is asked for
FILES = [path.relative_to(PACKAGE.parent) for path in PACKAGE.rglob("*.py")]
NAMES = {f"src/{file.as_posix()}": ".".join(file.with_suffix("").parts).removesuffix(".__init__") for file in FILES}
MODULES = set(NAMES.values())


def trees(folder=PACKAGE):
    return {name: tree for name, (_, tree) in python_files(folder).items()}


def test_no_public_class_has_the_name_of_another():
    named = Counter(name for tree in trees().values() for name in public_classes(tree))
    assert named
    assert [name for name, count in named.items() if count > 1] == [], "say by the name what each of them is"


def test_an_init_file_holds_no_logic():
    found = [name for name, tree in trees().items() if name.endswith("__init__.py") and name != FACE and logic(tree)]
    assert_none(found, "an __init__.py imports and says __all__: move the rest to a module beside it")


def test_what_the_package_loads_when_asked_is_what_type_checkers_are_told_and_all_that_it_lists():
    said = {ast.unparse(n.targets[0]): n.value for n in trees()[FACE].body if isinstance(n, ast.Assign)}
    assert sorted(said) == ["_HOMES", "__all__"]
    (checked,) = [node for node in trees()[FACE].body if isinstance(node, ast.If)]
    assert ast.unparse(checked.test) == "TYPE_CHECKING"
    imported = {alias.name: node.module for node in checked.body for alias in node.names}
    homes = ast.literal_eval(said["_HOMES"])
    assert {name: f"tandemlift.{home}" for name, home in homes.items()} == imported, "one home for each name"
    assert ast.literal_eval(said["__all__"]) == sorted(homes)
    assert {node.name for node in trees()[FACE].body if isinstance(node, ast.FunctionDef)} == {"__getattr__", "__dir__"}


def test_no_import_is_hidden_in_a_string():
    found = [name for name, tree in trees().items() if name != FACE and hidden_imports(tree, MODULES, NAMES[name])]
    advice = "import it by an import statement, in the function if it is seldom needed"
    assert_none(found, advice)


# ---- A breach is found


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("importlib.import_module('tandemlift.engines.models.sdf')", [1]),
        ("import_module(f'tandemlift.{name}')", [1]),
        ("__import__('tandemlift.' + name)", [1]),
        ("import_module('.sdf', __package__)", [1]),
        ("NAMES = ['tandemlift.engines.models.sdf']", [1]),
        ("import tandemlift.engines.models.sdf", []),
        ("import_module(f'rosbags.{part}')", []),
        ("prog = 'tandemlift'", []),
        ("find_spec(f'{package}.{part}')", []),
        ("run([sys.executable, '-m', 'tandemlift.engines.models.mjcf'])", []),
    ],
)
def test_an_import_in_a_string_is_found(line, found):
    assert hidden_imports(ast.parse(line), MODULES, own="tandemlift.engines.models.mjcf") == found


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ('"""What it is."""\nfrom a import b\n__all__ = ["b"]', []),
        ("from a import b\nb()", [2]),
        ("X = 1", [1]),
        ("if TYPE_CHECKING:\n    import a", [1]),
        ("class A: ...", [1]),
    ],
)
def test_logic_in_an_init_file_is_found(text, found):
    assert logic(ast.parse(text)) == found
