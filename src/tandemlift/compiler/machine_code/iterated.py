"""A step from state to state, repeated with the same parameters and action, and its derivatives: handlers for XLA.

XLA calls a handler with a frame of pointers (`xla/ffi/api/c_api.h`, its foreign function interface). A handler repeats
the step for each lane of its arrays: `advance` gives the states (steps, n) after each step; `tangent` and `cotangent`
take all but the last of these beside the arguments, so that nothing else is kept from step to step.

A step may have two forms, of which conditions choose one. Its last number other than 0 in a place of the state means
that no step is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple, cast

from tandemlift.compiler.machine_code.differentiated import cotangents, tangents
from tandemlift.compiler.tracer import Function, Graph, Module, Place, Symbol
from tandemlift.compiler.tracer.llvm import Read

Kind = Literal["advance", "tangent", "cotangent"]
ARGUMENTS: dict[
    Kind, tuple[tuple[str, ...], tuple[str, ...]]
] = {  # of each kind: its arguments and its results, by the names of their sizes
    "advance": (("state", "parameter", "action"), ("states",)),
    "tangent": (("state", "parameter", "action", "between", "state", "dparameter", "action"), ("states",)),
    "cotangent": (("state", "parameter", "action", "between", "states"), ("state", "dparameter", "action")),
}
INPUTS = ("state", "parameter", "action")
HANDLER = """define i64 @{name}(ptr %frame) #0 {{
entry:
  %e0 = getelementptr i8, ptr %frame, i64 8
  %extension = load ptr, ptr %e0, align 8
  %asked = icmp ne ptr %extension, null
  br i1 %asked, label %about, label %run
about:
  %e1 = getelementptr i8, ptr %extension, i64 24
  %facts = load ptr, ptr %e1, align 8
  %e2 = getelementptr i8, ptr %facts, i64 24
  store i32 {version[0]}, ptr %e2, align 4
  %e3 = getelementptr i8, ptr %facts, i64 28
  store i32 {version[1]}, ptr %e3, align 4
  %e4 = getelementptr i8, ptr %facts, i64 32
  store i32 0, ptr %e4, align 4
  ret i64 0
run:
  call void @lanes_(ptr %frame)
  ret i64 0
}}"""
SELDOM, QUICKLY = "form1", "attributes #3 = { nounwind noinline optnone }"  # the form of few steps, the longer one
FRAME = {"arguments": 72, "results": 112}  # bytes to the pointers of buffers in a frame
DATA, RANK, DIMENSIONS = 24, 32, 40  # bytes to these in a buffer


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

    def written(self, kind: Kind, steps: int, with_parameters: bool, version: tuple[int, int]) -> str:
        """The text of a module whose function of that name is a handler.

        Args:
            kind: of the handler.
            steps: how many times the step is repeated.
            with_parameters: whether derivatives by parameters are formed; else the results have none for them.
            version: of XLA's interface.
        """
        module = Module()
        self.shared(module)
        for number, form in enumerate(self.forms):
            self._write_form(module, kind, f"form{number}", form, with_parameters)
        self._write_choice(module, kind)
        self._write_lanes(module, kind, steps, self.sizes_of(steps, with_parameters))
        module.functions += [HANDLER.format(name=kind, version=version), QUICKLY]
        return module.text

    def sizes_of(self, steps: int, with_parameters: bool) -> dict[str, int]:
        """The sizes of arguments and results by the names in `ARGUMENTS`, and those of `sizes`."""
        n, m = self.sizes["state"], self.sizes["parameter"] if with_parameters else 0
        return {**self.sizes, "states": steps * n, "between": (steps - 1) * n, "dparameter": m}

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

    def _write_lanes(self, module: Module, kind: Kind, steps: int, sizes: Mapping[str, int]) -> None:
        """`lanes_`: all steps of all lanes; their number is the product of the first array's leading dimensions."""
        f = Function(module, self.forms[0].graph, 1, "internal void @lanes_(ptr %frame) #1")
        pointers = dict[str, str]()
        for group, letter, own in zip(FRAME, "ar", ARGUMENTS[kind], strict=True):
            listed = f.load(f.at("%frame", FRAME[group], "i8"), 0, "ptr")
            buffers = [f.load(listed, i, "ptr") for i in range(len(own))]
            pointers |= {f"{letter}{i}": f.load(f.at(b, DATA, "i8"), 0, "ptr") for i, b in enumerate(buffers)}
            if letter == "a":
                first = buffers[0]
        count = f.own_memory(1)
        f.store("1", count, 0, "i64")
        dimensions = f.load(f.at(first, DIMENSIONS, "i8"), 0, "ptr")
        with f.repeat(f.integer("sub", f.load(f.at(first, RANK, "i8"), 0, "i64"), 1)) as i:
            f.store(f.integer("mul", f.load(count, 0, "i64"), f.load(dimensions, i, "i64")), count, 0, "i64")
        work = f.own_memory(max(self.sizes["work"], 1))
        carried = f.own_memory(self.sizes["state"])
        with f.repeat(f.load(count, 0, "i64")) as lane:
            at = {
                name: f.at(pointer, f.integer("mul", lane, sizes[ARGUMENTS[kind][name[0] == "r"][int(name[1])]]))
                for name, pointer in pointers.items()
            }
            if kind == "cotangent":
                for name, of in zip(("r0", "r1", "r2"), ARGUMENTS[kind][1], strict=True):
                    with f.repeat(sizes[of]) as i:
                        f.store(f.zero, at[name], i)
            self._write_steps(f, kind, steps, {**at, "work": work}, carried)
        f.end()

    def _write_steps(self, f: Function, kind: Kind, steps: int, at: dict[str, str], carried: str) -> None:
        """All steps of a lane, whose arrays are `at` these places; backward for cotangents."""
        n = self.sizes["state"]
        with f.repeat(steps) as number:
            k = f.integer("sub", steps - 1, number) if kind == "cotangent" else number
            here = f.integer("mul", k, n)
            is_first = f.op(f"icmp eq i64 {k}, 0")
            before = f.integer("sub", here, n)
            states = at["r0"] if kind == "advance" else at["a3"]
            own = at | {"a0": f.op(f"select i1 {is_first}, ptr {at['a0']}, ptr {f.at(states, before)}")}
            if kind == "cotangent":
                with f.repeat(n) as i:
                    more = f.load(at["a4"], f.integer("add", here, i))
                    f.store(f.op(f"fadd double {f.load(at['r0'], i)}, {more}"), carried, i)
                own["a4"] = carried
            else:
                own["r0"] = f.at(at["r0"], here)
            if kind == "tangent":
                own["a4"] = f.op(f"select i1 {is_first}, ptr {at['a4']}, ptr {f.at(at['r0'], before)}")
            f.do(f"call void @step_({', '.join(f'ptr {own[name[1:]]}' for name in _names(kind))})")


def _names(kind: Kind) -> list[str]:
    """The names of the pointers that the function of a step takes."""
    arguments, results = ARGUMENTS[kind]
    return [*[f"%a{i}" for i in range(len(arguments))], *[f"%r{i}" for i in range(len(results))], "%work"]


def _pointers(kind: Kind) -> str:
    return ", ".join(f"ptr noalias {name}" for name in _names(kind))


def _place(base: str) -> Read:
    return lambda i: Place(base, i)
