"""Rules that every file of the package keeps, and that what finds a breach of them finds it."""

import ast
from collections import Counter

import pytest
from code_rules import asserting_helpers, copies_by_position, hidden_imports, logic, public_classes, without_docstring
from house import PACKAGE, TESTS, assert_none, python_files

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


def test_nothing_is_copied_field_by_field():
    found = [f"{name}: {called}" for name, tree in trees().items() for called in copies_by_position(tree)]
    advice = "six or more arguments by position, half of them of one value: use _replace, or name the arguments"
    assert_none(found, advice)


def test_every_public_module_function_and_class_has_a_docstring():
    found = {name: lacking for name, tree in trees().items() if (lacking := without_docstring(tree))}
    assert found == {}, "say in a docstring what it is for, with shapes, units, frames and errors"


def test_a_helper_of_tests_that_asserts_says_so_by_its_name():
    tests = {name: tree for name, tree in trees(TESTS).items() if "/support/" not in name}
    assert tests
    found = [f"{name}: {helper}" for name, tree in tests.items() for helper in asserting_helpers(tree)]
    assert_none(found, "name it assert_… or check_…, or raise where it only guards itself")


# ---- A breach is found


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("State(a.p, a.v, a.q, r, s, t)", ["State"]),
        ("State(*[a.p, a.v, a.q, r, s, t])", ["State"]),
        ("State(r, *(a.p, a.v), *[a.q, s, t])", ["State"]),
        ("State(*([a.p, a.v, a.q] + [r, s, t]))", ["State"]),
        ("cls(a.b.p, a.b.v, a.b.q, r, s, t)", ["cls"]),
        ("type(a)(a.p, a.v, a.q, r, s, t)", ["type(a)"]),
        ("laws.State(a.p, a.v, a.q, r, s, t)", ["laws.State"]),
        ("State(a.p, a.v, q, r, s, t)", []),
        ("State(a.p, a.v, b.q, b.r, c.s, c.t)", []),
        ("State(a.p, a.v, a.q, a.r, a.s)", []),
        ("State(p=a.p, v=a.v, q=a.q, r=r, s=s, t=t)", []),
        ("advance(a.p, a.v, a.q, a.r, a.s, a.t)", []),
    ],
)
def test_a_copy_by_position_is_found_however_it_is_written(line, found):
    assert copies_by_position(ast.parse(line)) == found


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


def test_helpers_that_assert_are_found():
    text = "def f():\n    assert a\ndef check_g():\n    assert a\ndef test_h():\n    assert a\ndef k():\n    return a\n"
    text += "class Page:\n    def closed(self):\n        assert a\n@pytest.fixture()\ndef page():\n    assert a\n"
    assert asserting_helpers(ast.parse(text)) == ["closed", "f"]


def test_what_has_no_docstring_is_found():
    text = "class A:\n    def f(self): ...\n    def _g(self): ...\n    class B:\n        '''B.'''\n"
    text += "def h(): ...\ndef _k(): ...\n@overload\ndef k(): ..."
    assert without_docstring(ast.parse(text)) == ["the module", "A", "A.f", "h"]
    assert without_docstring(ast.parse('"""M."""\ndef f():\n    """F."""\n    def inner(): ...')) == []
