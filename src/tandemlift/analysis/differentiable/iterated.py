"""A step from state to state, repeated with the same parameters, and its derivatives: functions over lanes of arrays.

`advance` gives the states after each step; `tangent` and `cotangent` take these beside the arguments, so that nothing
else is kept from step to step. Each is `i64 @kind(ptr arrays, i64 first, i64 end, i64 steps)` and does lanes `first` to
`end` - 1. For each argument and result, in the order of `ARGUMENTS`, `arrays` has three 64-bit words: the address of
its first number, and how many numbers lie from lane to lane and from step to step; 0 for what is common to them.

A step may have two forms, of which conditions choose one. Its last number other than 0 in a place of the state means
that no step is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, cast

from tandemlift.compiler.machine_code.derivatives import cotangents, tangents
from tandemlift.compiler.tracer import Function, Graph, Module, Place, Read, Symbol

Kind = Literal["advance", "tangent", "cotangent"]
ARGUMENTS: dict[
    Kind, tuple[tuple[str, ...], tuple[str, ...]]
] = {  # of each kind: its arguments and its results, by the names of their sizes
    "advance": (("state", "parameter", "action"), ("states",)),
    "tangent": (("state", "parameter", "action", "states", "state", "dparameter", "action"), ("states",)),
    "cotangent": (("state", "parameter", "action", "states", "states"), ("state", "dparameter", "action")),
}
INPUTS = ("state", "parameter", "action")
OF_STEPS = frozenset({"action", "states"})  # arrays with numbers for each step; an action may be held
WORDS = 3  # of an array in a call: address, numbers from lane to lane, numbers from step to step
SELDOM, QUICKLY = "form1", "attributes #3 = { nounwind noinline optnone }"  # the form of few steps, the longer one


class StepForm(NamedTuple):
    """A form of a step.

    Attributes:
        after: the numbers of the next state; inputs are "state", "parameter", "action", and others that `begin` binds.
        stands_for: inputs that have the derivative of a node.
        begin: writes what comes first in a function, and binds further inputs; its memory is %work.
    """

    after: Sequence[Symbol]
    stands_for: Mapping[int, int]
    begin: Callable[[Function], None]

    @property
    def graph(self) -> Graph:
        """The graph of its numbers."""
        return cast(Graph, self.after[0].graph)


@dataclass(frozen=True)
class IteratedStep:
    """A step that is repeated.

    Attributes:
        forms: one or two.
        otherwise: conditions on the state, over the graph of the first form: if one holds, the second form is taken.
        sizes: numbers of state, parameters, action and scratch memory.
        smooth: the numbers of each kind of input with a derivative, of the state also after a step.
        ended: the place in the state whose number other than 0 means that no step is taken.
        shared: writes functions that forms call.
    """

    forms: Sequence[StepForm]
    otherwise: Sequence[Symbol]
    sizes: Mapping[str, int]
    smooth: Mapping[str, frozenset[int]]
    ended: int
    shared: Callable[[Module], None]

    def written(self, kind: Kind, with_parameters: bool) -> str:
        """The text of a module with the function of that name.

        Args:
            kind: of the function.
            with_parameters: whether derivatives by parameters are formed; else its arrays of them are empty.
        """
        module = Module()
        self.shared(module)
        for number, form in enumerate(self.forms):
            self._write_form(module, kind, f"form{number}", form, with_parameters)
        self._write_choice(module, kind)
        self._write_lanes(module, kind, self.sizes_of(with_parameters))
        module.functions.append(QUICKLY)
        return module.text

    def sizes_of(self, with_parameters: bool) -> dict[str, int]:
        """The sizes of arguments and results, of a step, by the names in `ARGUMENTS`, and those of `sizes`."""
        n, m = self.sizes["state"], self.sizes["parameter"] if with_parameters else 0
        return {**self.sizes, "states": n, "dparameter": m}

    def _write_form(self, module: Module, kind: Kind, name: str, form: StepForm, with_parameters: bool) -> None:
        """The function of one step; a cotangent is added to that of parameters and action."""
        attributes = "#3" if name == SELDOM else "#1"
        f = self._function(module, form.graph, f"internal void @{name}({_pointers(kind)}) {attributes}")
        form.begin(f)
        g = form.graph
        given = [n for n, op in enumerate(g.ops) if op == "in" and g.args[n][0] in INPUTS]
        wanted = {n: g.args[n] for n in given if g.args[n][1] in self.smooth[g.args[n][0]]}
        if not with_parameters:
            wanted = {n: place for n, place in wanted.items() if place[0] != "parameter"}
        if kind == "advance":
            self._store(f, "%r0", dict(enumerate(form.after)))
        elif kind == "tangent":
            seeds = {n: g.input(f"d{of}", i) for n, (of, i) in wanted.items()}
            found = tangents(g, [s.node for s in form.after], seeds, form.stands_for)
            moved = {
                i: found[s.node] for i, s in enumerate(form.after) if i in self.smooth["state"] and s.node in found
            }
            self._store(f, "%r0", moved, self.sizes["state"])
        else:
            bars = [(form.after[i].node, g.input("bar", i)) for i in sorted(self.smooth["state"])]
            found = cotangents(g, bars, wanted.keys(), form.stands_for)
            made = [(*place, found[n]) for n, place in wanted.items() if n in found]
            f.values([value for *_, value in made])
            for number, of in enumerate(INPUTS):
                own = {i: value for kind_of, i, value in made if kind_of == of}
                self._store(f, f"%r{number}", own, self.sizes["state"] if of == "state" else 0, adds=of != "state")
        f.end()

    def _function(self, module: Module, graph: Graph, head: str) -> Function:
        f = Function(module, graph, 1, head)
        places: dict[str, Read] = {of: _place(f"%a{i}") for i, of in enumerate(INPUTS)}
        f.read = places | {f"d{of}": _place(f"%a{i + 4}") for i, of in enumerate(INPUTS)} | {"bar": _place("%a4")}
        return f

    def _store(self, f: Function, to: str, values: Mapping[int, Symbol], size: int = 0, *, adds: bool = False) -> None:
        """Write values to memory, and 0 to the others of `size`."""
        f.values(values.values())
        for i in sorted({*values, *range(size)}):
            value = f.value(values[i]) if i in values else f.zero
            f.store(f.op(f"fadd double {f.load(to, i)}, {value}") if adds else value, to, i)

    def _write_choice(self, module: Module, kind: Kind) -> None:
        """`step_`: one step, in the form that applies; after the end a state, its tangent and its cotangent stay."""
        f = self._function(module, self.forms[0].graph, f"internal void @step_({_pointers(kind)}) #1")
        names = ", ".join(f"ptr {name}" for name in _names(kind))
        over = f.op(f"fcmp une double {f.load('%a0', self.ended)}, 0.0")
        f.do(f"br i1 {over}, label %over, label %goes")
        f.lines.append("over:")
        with f.repeat(self.sizes["state"]) as i:
            f.store(f.load("%a0" if kind == "advance" else "%a4", i), "%r0", i)
        f.do("ret void")
        f.lines.append("goes:")
        if len(self.forms) > 1:
            second = "false"
            for value in f.values(self.otherwise):
                second = f.op(f"or i1 {second}, {value}")
            f.do(f"br i1 {second}, label %second, label %first")
            f.lines.append("second:")
            f.do(f"call void @form1({names})")
            f.do("ret void")
            f.lines.append("first:")
        f.do(f"call void @form0({names})")
        f.end()

    def _write_lanes(self, module: Module, kind: Kind, sizes: Mapping[str, int]) -> None:
        """The function of that kind: all steps of some lanes."""
        f = Function(module, self.forms[0].graph, 1, f"i64 @{kind}(ptr %arrays, i64 %first, i64 %end, i64 %steps) #0")
        words = {
            name[1:]: [f.load("%arrays", WORDS * i + j, word) for j, word in enumerate(("ptr", "i64", "i64"))]
            for i, name in enumerate(_names(kind)[:-1])
        }
        work, carried = f.own_memory(max(self.sizes["work"], 1)), f.own_memory(self.sizes["state"])
        with f.repeat("%end", "%first") as lane:
            arrays = {
                name: (f.at(first, f.integer("mul", lane, by)), step) for name, (first, by, step) in words.items()
            }
            with f.repeat("%steps") as number:
                k = f.integer("sub", f.integer("sub", "%steps", 1), number) if kind == "cotangent" else number
                self._write_step(f, kind, arrays, k, {"work": work, "carried": carried}, sizes)
        f.end("i64 0")

    def _write_step(
        self,
        f: Function,
        kind: Kind,
        arrays: Mapping[str, tuple[str, str]],
        k: str,
        memory: Mapping[str, str],
        sizes: Mapping[str, int],
    ) -> None:
        """Step k of a lane; cotangents are formed backward, and their results begin at 0."""

        def at(name: str, k: str) -> str:
            first, apart = arrays[name]
            return f.at(first, f.integer("mul", k, apart))

        is_first, before = f.op(f"icmp eq i64 {k}, 0"), f.integer("sub", k, 1)
        own = {name: at(name, k) for name in arrays} | {"work": memory["work"]}
        after = at("r0" if kind == "advance" else "a3", before)
        own["a0"] = f.op(f"select i1 {is_first}, ptr {own['a0']}, ptr {after}")
        if kind == "tangent":
            own["a4"] = f.op(f"select i1 {is_first}, ptr {own['a4']}, ptr {at('r0', before)}")
        elif kind == "cotangent":
            is_last = f.op(f"icmp eq i64 {f.integer('add', k, 1)}, %steps")
            for name, of in zip(("r0", "r1", "r2"), ARGUMENTS[kind][1], strict=True):
                moves = f.op(f"icmp ne i64 {arrays[name][1]}, 0")
                with f.when(f.op(f"or i1 {is_last}, {moves}")), f.repeat(sizes[of]) as i:
                    f.store(f.zero, own[name], i)
            with f.repeat(sizes["state"]) as i:
                f.store(f.op(f"fadd double {f.load(own['r0'], i)}, {f.load(own['a4'], i)}"), memory["carried"], i)
            own["a4"] = memory["carried"]
        f.do(f"call void @step_({', '.join(f'ptr {own[name[1:]]}' for name in _names(kind))})")


def _names(kind: Kind) -> list[str]:
    """The names of the pointers that the function of a step takes."""
    arguments, results = ARGUMENTS[kind]
    return [*[f"%a{i}" for i in range(len(arguments))], *[f"%r{i}" for i in range(len(results))], "%work"]


def _pointers(kind: Kind) -> str:
    return ", ".join(f"ptr noalias {name}" for name in _names(kind))


def _place(base: str) -> Read:
    return lambda i: Place(base, i)
