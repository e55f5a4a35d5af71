"""Exact derivatives of the energy of one element, by SymPy, in the fewest operations.

What depends on data alone is named and computed once (`constants`). An energy that depends on differences of
positions alone is differentiated by those: of a triangle 21 second derivatives instead of 45. An energy that is put
together from pieces (min, max, abs, where) becomes branches, each smooth, the first whose condition holds.
"""
from __future__ import annotations

import functools
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from . import symbolic
from ._errors import InputError

MOST_BRANCHES = 8  #: beyond, pieces stay inside of the expression
Assignments = list[tuple[Any, Any]]


@dataclass(frozen=True, eq=False)
class Branch:
    """Energy where `condition` holds, and no earlier one does."""
    condition: Any
    energy: Any
    gradient: list[Any]  #: by `unknowns`
    hessian: list[Any]  #: upper triangle, row after row


@dataclass(frozen=True, eq=False)
class ElementLaw:
    """One element in the variables of which its energy is a function."""
    nodes: int
    is_relative: bool  #: variables are the differences to node 0, else all positions
    unknowns: list[Any]  #: symbols, coordinates node after node
    constants: Assignments  #: functions of data alone
    branches: list[Branch]

    @property
    def first(self) -> int:
        """The first node that has unknowns of its own."""
        return 1 if self.is_relative else 0


def element_law(energy: Any, nodes: int) -> ElementLaw:
    """Of an expression in symbols x0_0, x0_1, ... of positions; every other symbol is data."""
    sympy = symbolic._sympy()
    positions = symbolic.nodes(nodes)
    energy, constants = _hoisted(_in_pieces(energy), {s for x in positions for s in x})
    differences = [[symbolic._symbol(f"d{a}_{c}_") for c in range(3)] for a in range(nodes)]
    moved = energy.xreplace({positions[a][c]: positions[0][c] + differences[a][c]
                             for a in range(1, nodes) for c in range(3)})
    is_relative = nodes > 1 and not moved.free_symbols & set(positions[0])
    unknowns = [s for x in (differences[1:] if is_relative else positions) for s in x]
    energy = moved if is_relative else energy
    branches = []
    for condition, piece in _branches(energy):
        gradient = [sympy.diff(piece, s) for s in unknowns]
        hessian = [sympy.diff(gradient[i], unknowns[j]) for i in range(len(unknowns)) for j in range(i, len(unknowns))]
        branches.append(Branch(condition, piece, gradient, hessian))
    return ElementLaw(nodes, is_relative, unknowns, constants, branches)


def _in_pieces(energy: Any) -> Any:
    """min, max, abs and sign as pieces: their derivatives are those of the piece, without distributions at the joints."""
    sympy = symbolic._sympy()

    def smaller(*parts: Any) -> Any:
        return functools.reduce(lambda a, b: sympy.Piecewise((a, sympy.Le(a, b)), (b, True)), parts)

    def greater(*parts: Any) -> Any:
        return functools.reduce(lambda a, b: sympy.Piecewise((a, sympy.Ge(a, b)), (b, True)), parts)

    def size(a: Any) -> Any:
        return sympy.Piecewise((a, sympy.Ge(a, 0)), (-a, True))

    def sign(a: Any) -> Any:
        return sympy.Piecewise((1, sympy.Gt(a, 0)), (-1, sympy.Lt(a, 0)), (0, True))

    for kind, pieces in ((sympy.Min, smaller), (sympy.Max, greater), (sympy.Abs, size), (sympy.sign, sign)):
        energy = energy.replace(kind, pieces)
    return energy


def _branches(energy: Any) -> Assignments:
    """(condition, smooth energy) in order, the first that holds counts."""
    sympy = symbolic._sympy()
    branches: Assignments = [(sympy.true, energy)]
    while True:
        pieced = next((k for k, (_, e) in enumerate(branches) if e.has(sympy.Piecewise)), None)
        if pieced is None:
            return branches
        condition, whole = branches[pieced]
        inner = next(p for p in sorted(whole.atoms(sympy.Piecewise), key=sympy.default_sort_key)
                     if not any(argument.has(sympy.Piecewise) for argument in p.args))
        parts = [(_without_choice(sympy.And(condition, c)), whole.xreplace({inner: e})) for e, c in inner.args]
        parts = [(c, e) for c, e in parts if c != sympy.false]
        if len(branches) - 1 + len(parts) > MOST_BRANCHES:
            return [(sympy.true, _without_choice(energy))]
        branches[pieced:pieced + 1] = parts


def _without_choice(e: Any) -> Any:
    """With and, or, not in place of SymPy's if-then-else of conditions, which no printer writes."""
    sympy = symbolic._sympy()
    return e.replace(sympy.ITE, lambda c, a, b: sympy.Or(sympy.And(c, a), sympy.And(sympy.Not(c), b)))


def _hoisted(energy: Any, positions: set[Any]) -> tuple[Any, Assignments]:
    """The energy with what depends on data alone under names c0_, c1_, ..., and these, each a function of data."""
    sympy = symbolic._sympy()
    constants: dict[Any, Any] = {}
    known: dict[Any, Any] = {}

    def is_fixed(e: Any) -> bool:
        return not e.free_symbols & positions

    def named(e: Any) -> Any:
        if not e.free_symbols or e.is_Atom:
            return e
        return constants.setdefault(e, symbolic._symbol(f"c{len(constants)}_"))

    def reduced(e: Any) -> Any:
        if e not in known:
            known[e] = _reduced(e)
        return known[e]

    def _reduced(e: Any) -> Any:
        if not isinstance(e, sympy.Expr):  # conditions
            return e.func(*(reduced(a) for a in e.args)) if e.args else e
        if is_fixed(e):
            return named(e)
        if not (e.is_Add or e.is_Mul):
            return e.func(*(reduced(a) for a in e.args)) if e.args else e
        fixed = [a for a in e.args if is_fixed(a)]
        rest = [reduced(a) for a in e.args if not is_fixed(a)]
        if not any(a.free_symbols for a in fixed):
            return e.func(*fixed, *rest)
        return e.func(named(e.func(*fixed)), *rest)

    found = reduced(energy)
    return found, [(symbol, value) for value, symbol in constants.items()]


def assignments(outputs: Sequence[Any], prefix: str, known: Sequence[tuple[Any, Any]] = ()) -> tuple[Assignments, list[Any]]:
    """What outputs have in common under names, in an order in which it can be computed; and the outputs in them.

    Roots are computed once whatever their power. Names end in an underscore, which those of data do not.

    Args:
        prefix: of the names.
        known: names that stand for an expression already.
    """
    sympy = symbolic._sympy()
    there = {value: name for name, value in known}
    roots: dict[Any, Any] = {}
    names = (symbolic._symbol(f"{prefix}{k}_") for k in itertools.count())

    def rooted(e: Any) -> Any:
        e = there.get(e, e)
        if not e.args:
            return e
        if e.is_Pow and e.exp.is_Rational and e.exp.q == 2 and e.base.free_symbols:
            base = rooted(e.base)
            root = there.get(sympy.sqrt(e.base)) or roots.setdefault(base, symbolic._symbol(f"{prefix}r{len(roots)}_"))
            return root ** e.exp.p
        return e.func(*(rooted(a) for a in e.args))

    wanted = [rooted(sympy.sympify(e)) for e in outputs]
    bases = list(roots)
    found, reduced = sympy.cse(wanted + bases, symbols=names)
    found = found + [(roots[base], sympy.sqrt(e)) for base, e in zip(bases, reduced[len(wanted):])]
    return _in_order(found), reduced[:len(wanted)]


def _in_order(found: Assignments) -> Assignments:
    """Each name after those that its expression needs."""
    waiting, ordered = dict(found), []
    while waiting:
        ready = [name for name, e in waiting.items() if not e.free_symbols & waiting.keys()]
        ordered += [(name, waiting.pop(name)) for name in ready]
        if not ready:
            raise InputError("expression: its parts depend on each other")
    return ordered


@functools.lru_cache
def power_printer(kind: type[Any]) -> type[Any]:
    """A code printer of SymPy that writes small whole powers as square(a), cube(a) and fourth(a)."""
    names = {1: "", 2: "square", 3: "cube", 4: "fourth"}

    def _print_Pow(self: Any, e: Any, **settings: Any) -> str:  # noqa: N802
        size = abs(int(e.exp)) if e.exp.is_Integer else 0
        if size not in names:
            found: str = kind._print_Pow(self, e, **settings)
            return found
        power = f"{names[size]}({self._print(e.base)})"
        return power if e.exp > 0 else f"(1.0/{power})"

    return type("Printer", (kind,), {"_print_Pow": _print_Pow})
