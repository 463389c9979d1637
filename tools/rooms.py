"""Draw the package from its imports: which parts there are, how they stand above one another, and who imports whom.

A room is a folder with modules of its own, or a module beside the folders. An arrow leads from a room to each room that
one of its modules imports, be it at the top of the file, within a function or for types alone. Each room stands one
floor above the highest one that it imports. Rooms that import each other, directly or not, are a circle.
"""

from __future__ import annotations

import argparse
import ast
from collections import defaultdict
from collections.abc import Container, Iterable, Iterator
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import NamedTuple

PACKAGE = Path(__file__).resolve().parent.parent / "src" / "tandemlift"
APART = {"__init__", "__main__"}  # of the package itself: its face, and where it starts


class Import(NamedTuple):
    """A module imports names of another; all of it if there are none."""

    importer: str
    imported: str
    names: tuple[str, ...]

    def __str__(self) -> str:
        return f"{self.importer} imports {self.imported}" + (f": {', '.join(self.names)}" if self.names else "")


@dataclass(frozen=True)
class Drawing:
    """The rooms of a package, and the imports that an arrow hangs on: (room, room that it imports) → imports."""

    rooms: tuple[str, ...]
    arrows: dict[tuple[str, str], list[Import]]

    @cached_property
    def below(self) -> dict[str, set[str]]:
        """The imports of each room, directly or by others."""
        found: dict[str, set[str]] = {}
        for room in self.rooms:
            reached, new = set[str](), {room}
            while new:
                new = {b for a, b in self.arrows if a in new} - reached
                reached |= new
            found[room] = reached
        return found

    @property
    def circles(self) -> list[list[str]]:
        """Rooms that import each other, directly or by others."""
        return sorted(list(circle) for circle in {tuple(self._beside(room)) for room in self.rooms} if len(circle) > 1)

    @cached_property
    def floors(self) -> list[list[str]]:
        """The rooms of each floor, from the lowest: those that import nothing. The rooms of a circle share a floor."""
        heights = dict[str, int]()
        for room in sorted(self.rooms, key=lambda r: len(self.below[r] - set(self._beside(r)))):
            lower = self.below[room] - set(self._beside(room))  # each has fewer below it, so its height is known
            heights[room] = 1 + max((heights[r] for r in lower), default=-1)
        return [[room for room in self.rooms if heights[room] == k] for k in sorted(set(heights.values()))]

    def _beside(self, room: str) -> list[str]:
        """The rooms of the circle that a room is in: itself, if in none."""
        return sorted({room} | {r for r in self.below[room] if room in self.below[r]})


@cache
def draw(package: Path = PACKAGE) -> Drawing:
    """The drawing of a package in a folder."""
    modules = dict(_modules(package))
    rooms = {name: _room(name, path) for name, path in modules.items()}
    filled = {rooms[name] for name, path in modules.items() if path.name != "__init__.py"} - APART
    arrows = defaultdict[tuple[str, str], list[Import]](list)
    for name, path in modules.items():
        for one in _imports(name, path, modules):
            a, b = rooms[name], rooms[one.imported]
            if a != b and {a, b} <= filled:
                arrows[a, b].append(one)
    return Drawing(tuple(sorted(filled)), dict(arrows))


def draw_doors(package: Path = PACKAGE) -> Drawing:
    """The drawing of a package with each folder at its top as one room, whatever is behind it."""
    behind = draw(package)
    arrows = defaultdict[tuple[str, str], list[Import]](list)
    for (a, b), imports in behind.arrows.items():
        one, other = a.partition(".")[0], b.partition(".")[0]
        if one != other:
            arrows[one, other] += imports
    return Drawing(tuple(sorted({room.partition(".")[0] for room in behind.rooms})), dict(arrows))


def draw_files(package: Path = PACKAGE) -> Drawing:
    """The drawing of a package with each module as a room of its own; a folder's `__init__.py` is none."""
    modules = dict(_modules(package))
    files = {name for name, path in modules.items() if path.name != "__init__.py"}
    arrows = defaultdict[tuple[str, str], list[Import]](list)
    for name in files:
        for one in _imports(name, modules[name], modules):
            if one.imported in files and one.imported != name:
                arrows[name, one.imported].append(one)
    return Drawing(tuple(sorted(files)), dict(arrows))


def uses(package: Path, doors: Container[str]) -> dict[str, set[str]]:
    """What other doors use of the modules behind some: their names; of a module imported whole, its attributes."""
    modules, found = dict(_modules(package)), defaultdict[str, set[str]](set)
    for name, path in modules.items():
        whole = dict[str, str]()
        for one in [] if _door(name) in {"", *APART} or _door(name) in doors else _imports(name, path, modules):
            if _door(one.imported) in doors:
                found[one.imported].update(one.names)
                whole |= {} if one.names else {one.imported.rpartition(".")[2]: one.imported}
        for node in ast.walk(ast.parse(path.read_text("utf-8"))) if whole else ():
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in whole:
                found[whole[node.value.id]].add(node.attr)
    return dict(found)


def _door(module: str) -> str:
    """The folder at the package's top that a module is in, or the module itself; "" of the package."""
    return (*module.split("."), "")[1]


def _modules(package: Path) -> Iterator[tuple[str, Path]]:
    """Dotted name and path of each module; a folder is named as its `__init__.py`."""
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package.parent).with_suffix("").parts
        yield ".".join(parts[:-1] if parts[-1] == "__init__" else parts), path


def _room(name: str, path: Path) -> str:
    """The room of a module: its folder, or itself beside the folders."""
    _, *parts = name.split(".")
    folder = parts if path.name == "__init__.py" else parts[:-1]
    return ".".join(folder or parts or ["__init__"])


def _imports(name: str, path: Path, modules: Iterable[str]) -> Iterator[Import]:
    """The imports of a module from its package, at any place."""
    package = name.split(".") if path.name == "__init__.py" else name.split(".")[:-1]
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            yield from (Import(name, alias.name, ()) for alias in node.names if alias.name in modules)
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else []
            source = ".".join([*above, *filter(None, [node.module])])
            submodules = [f"{source}.{alias.name}" for alias in node.names if f"{source}.{alias.name}" in modules]
            names = tuple(alias.name for alias in node.names if f"{source}.{alias.name}" not in modules)
            yield from (Import(name, module, ()) for module in submodules)
            if names and source in modules:
                yield Import(name, source, names)


def main() -> None:
    """Print the drawing: the floors from the top, the counts, and with -v the arrows."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("package", nargs="?", type=Path, default=PACKAGE, help="folder of the package (tandemlift)")
    parser.add_argument("-v", "--verbose", action="store_true", help="list the arrows and the imports behind each")
    given = parser.parse_args()
    drawing, doors = draw(given.package.resolve()), draw_doors(given.package.resolve())
    for height, rooms in reversed(list(enumerate(drawing.floors, 1))):
        print(f"floor {height:2d}   {'  '.join(rooms)}")
    for what, one in (("doors", doors), ("rooms", drawing)):
        counts = (len(one.rooms), len(one.floors), len(one.arrows), len(one.circles))
        print(f"{counts[0]} {what}, {counts[1]} floors, {counts[2]} arrows, {counts[3]} circles")
    for circle in drawing.circles:
        print(f"circle: {'  '.join(circle)}")
    if given.verbose:
        for (a, b), imports in sorted(drawing.arrows.items()):
            print(f"\n{a} → {b}", *(f"    {one}" for one in imports), sep="\n")


if __name__ == "__main__":
    main()
