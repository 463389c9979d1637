"""Rules that every file of the package keeps, and that what finds a breach of them finds it."""

import ast
from collections import Counter

from house import PACKAGE, assert_none, python_files

FACE = "src/tandemlift/__init__.py"  # which loads what is asked for
FILES = [path.relative_to(PACKAGE.parent) for path in PACKAGE.rglob("*.py")]
NAMES = {f"src/{file.as_posix()}": ".".join(file.with_suffix("").parts).removesuffix(".__init__") for file in FILES}
MODULES = set(NAMES.values())
IMPORTERS = {"import_module", "__import__", "find_spec", "resolve_name", "run_module"}  # by a name in a string


def trees():
    """The syntax tree of each file."""
    return {name: tree for name, (_, tree) in python_files(PACKAGE).items()}


def test_no_public_class_has_the_name_of_another():
    classes = [node.name for tree in trees().values() for node in ast.walk(tree) if isinstance(node, ast.ClassDef)]
    named = Counter(name for name in classes if not name.startswith("_"))
    assert [name for name, count in named.items() if count > 1] == [], "say by the name what each of them is"


def logic(tree):
    """The lines of an `__init__.py` that are more than a docstring, imports and `__all__`."""

    def allowed(node):
        text = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
        names = isinstance(node, ast.Assign) and [ast.unparse(t) for t in node.targets] == ["__all__"]
        return text or names or isinstance(node, ast.Import | ast.ImportFrom)

    return [node.lineno for node in tree.body if not allowed(node)]


def test_an_init_file_holds_no_logic():
    assert logic(ast.parse('"""What it is."""\nfrom a import b\n__all__ = ["b"]')) == []
    assert logic(ast.parse("from a import b\nb()\nX = 1\nif TYPED:\n    import a\nclass A: ...")) == [2, 3, 4, 6]
    found = [name for name, tree in trees().items() if name.endswith("__init__.py") and name != FACE and logic(tree)]
    assert_none(found, "an __init__.py imports and says __all__: move the rest to a module beside it")


def test_what_the_package_loads_when_asked_is_what_type_checkers_are_told_and_all_that_it_lists():
    face = trees()[FACE].body
    said = {ast.unparse(n.targets[0]): n.value for n in face if isinstance(n, ast.Assign)}
    assert sorted(said) == ["_HOMES", "__all__"]
    (checked,) = [node for node in face if isinstance(node, ast.If)]
    assert ast.unparse(checked.test) == "TYPE_CHECKING"
    imported = {alias.name: node.module for node in checked.body for alias in node.names}
    homes = ast.literal_eval(said["_HOMES"])
    assert {name: f"tandemlift.{home}" for name, home in homes.items()} == imported, "one home for each name"
    assert ast.literal_eval(said["__all__"]) == sorted(homes)


def hidden_imports(tree, own=""):
    """The lines that name a module of the package in a string, or look one up by a name that begins as one does.

    A module that starts a process of its own may name itself (`own`).
    """
    others, found = MODULES - {"tandemlift", own}, set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.strip(".") in others:
            found.add(node.lineno)
        if isinstance(node, ast.Call) and node.args:
            called = ast.unparse(node.func).rpartition(".")[2]
            if called in IMPORTERS and beginning(node.args[0]).startswith(("tandemlift", ".")):
                found.add(node.lineno)
    return sorted(found)


def beginning(text):
    """What a string begins with, as far as it is written out: `a.` of f"a.{b}" and of "a." + b."""
    while isinstance(text, ast.JoinedStr | ast.BinOp):
        text = text.values[0] if isinstance(text, ast.JoinedStr) else text.left
    return text.value if isinstance(text, ast.Constant) and isinstance(text.value, str) else ""


HIDDEN = """importlib.import_module('tandemlift.engines.models.sdf')
import_module(f'tandemlift.{name}')
__import__('tandemlift.' + name)
import_module('.sdf', __package__)
NAMES = ['tandemlift.engines.models.sdf']
"""
OPEN = """import tandemlift.engines.models.sdf
import_module(f'rosbags.{part}')
prog = 'tandemlift'
find_spec(f'{package}.{part}')
run([sys.executable, '-m', 'tandemlift.engines.models.mjcf'])
"""


def test_no_import_is_hidden_in_a_string():
    assert hidden_imports(ast.parse(HIDDEN)) == [1, 2, 3, 4, 5]
    assert hidden_imports(ast.parse(OPEN), own="tandemlift.engines.models.mjcf") == []
    found = [name for name, tree in trees().items() if name != FACE and hidden_imports(tree, NAMES[name])]
    assert_none(found, "import it by an import statement, in the function if it is seldom needed")
