"""What breaks a rule about the source, found in the syntax tree of a file."""

import ast

PACKAGE_NAME = "tandemlift"
IMPORTERS = {"import_module", "__import__", "find_spec", "resolve_name", "run_module"}  # by a name in a string


def last_name(called):
    """The last part of what is called: `c` of `a.b.c`; empty for other expressions."""
    return called.attr if isinstance(called, ast.Attribute) else getattr(called, "id", "")


def public_classes(tree):
    """The public classes of a module, within functions too."""
    return [n.name for n in ast.walk(tree) if isinstance(n, ast.ClassDef) and not n.name.startswith("_")]


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
