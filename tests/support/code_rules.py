"""What breaks a rule about the source, found in the syntax tree of a file."""

import ast
from collections import Counter

PACKAGE_NAME = "tandemlift"
MANY_ARGUMENTS = 6
IMPORTERS = {"import_module", "__import__", "find_spec", "resolve_name", "run_module"}  # by a name in a string


def last_name(called):
    """The last part of what is called: `c` of `a.b.c`; empty for other expressions."""
    return called.attr if isinstance(called, ast.Attribute) else getattr(called, "id", "")


def public_classes(tree):
    """The public classes of a module, within functions too."""
    return [n.name for n in ast.walk(tree) if isinstance(n, ast.ClassDef) and not n.name.startswith("_")]


def without_docstring(tree):
    """Public functions, methods and classes without a docstring, and the module itself if it has none."""
    kinds = (ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)

    def variant(node):  # a signature alone; the function that follows has the docstring
        return any(last_name(decorator) == "overload" for decorator in node.decorator_list)

    def inside(node, above):
        for child in node.body:
            if isinstance(child, kinds) and not child.name.startswith("_") and not variant(child):
                if not ast.get_docstring(child):
                    yield f"{above}{child.name}"
                if isinstance(child, ast.ClassDef):
                    yield from inside(child, f"{above}{child.name}.")

    return [*([] if ast.get_docstring(tree) else ["the module"]), *inside(tree, "")]


def logic(tree):
    """The lines of an `__init__.py` that are more than a docstring, imports and `__all__`."""

    def allowed(node):
        text = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
        names = isinstance(node, ast.Assign) and [ast.unparse(t) for t in node.targets] == ["__all__"]
        return text or names or isinstance(node, ast.Import | ast.ImportFrom)

    return [node.lineno for node in tree.body if not allowed(node)]


def hidden_imports(tree, modules, own=""):
    """The lines that name a module of the package in a string, or look one up by a name that begins as one does.

    A module that starts a process of its own may name itself (`own`).
    """
    others, found = modules - {PACKAGE_NAME, own}, set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.strip(".") in others:
            found.add(node.lineno)
        looked_up = isinstance(node, ast.Call) and last_name(node.func) in IMPORTERS and node.args
        if looked_up and beginning(node.args[0]).startswith((PACKAGE_NAME, ".")):
            found.add(node.lineno)
    return sorted(found)


def beginning(text):
    """What a string begins with, as far as it is written out: `a.` of f"a.{b}" and of "a." + b."""
    while isinstance(text, ast.JoinedStr | ast.BinOp):
        text = text.values[0] if isinstance(text, ast.JoinedStr) else text.left
    return text.value if isinstance(text, ast.Constant) and isinstance(text.value, str) else ""


def positional(arguments):
    """The arguments by position, those of a list that is spread among them: `f(a, *[b, c])` has three."""
    for argument in arguments:
        if isinstance(argument, ast.Starred) and isinstance(argument.value, ast.List | ast.Tuple):
            yield from positional(argument.value.elts)
        elif isinstance(argument, ast.Starred) and isinstance(argument.value, ast.BinOp):  # *[a, b] + [c]
            yield from positional([ast.Starred(argument.value.left), ast.Starred(argument.value.right)])
        else:
            yield argument


def makes_an_object(called):
    """Whether a call makes an object, by the name of what is called: `State(…)`, `cls(…)`, `type(s)(…)`."""
    name = last_name(called).lstrip("_")
    return name == "cls" or name[:1].isupper() or (isinstance(called, ast.Call) and last_name(called.func) == "type")


def copies_by_position(tree):
    """What is made of six or more arguments by position, of which half or more are attributes of one value."""
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and makes_an_object(node.func):
            given = list(positional(node.args))
            sources = Counter(ast.unparse(a.value) for a in given if isinstance(a, ast.Attribute))
            if len(given) >= MANY_ARGUMENTS and 2 * max(sources.values(), default=0) >= len(given):
                found.append(ast.unparse(node.func))
    return found


def asserting_helpers(tree):
    """Functions and methods that assert, and are neither tests nor fixtures nor named `assert_…` or `check_…`."""
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef)]
    functions = [f for part in (tree, *classes) for f in part.body if isinstance(f, ast.FunctionDef)]
    names = set()
    for f in functions:
        fixture = any("fixture" in ast.unparse(decorator) for decorator in f.decorator_list)
        says_so = f.name.lstrip("_").startswith(("test", "assert_", "check_"))
        if not fixture and not says_so and any(isinstance(node, ast.Assert) for node in ast.walk(f)):
            names.add(f.name)
    return sorted(names)
