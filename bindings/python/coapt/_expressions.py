"""Energies of one element as text: a small language of sums, products and functions, read without running anything."""
from __future__ import annotations

import ast
import difflib
import operator
from collections.abc import Callable, Mapping
from typing import Any

from . import symbolic
from ._errors import InputError

_OPERATORS: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.Pow: operator.pow, ast.MatMult: operator.mul}
_COMPARISONS: dict[type[ast.cmpop], str] = {ast.Lt: "Lt", ast.LtE: "Le", ast.Gt: "Gt", ast.GtE: "Ge"}
_OF_SYMPY = {"sqrt": "sqrt", "exp": "exp", "log": "log", "sin": "sin", "cos": "cos", "tan": "tan", "asin": "asin",
             "acos": "acos", "atan": "atan", "atan2": "atan2", "sinh": "sinh", "cosh": "cosh", "tanh": "tanh",
             "abs": "Abs", "min": "Min", "max": "Max"}
_COUNTS = {"atan2": (2,), "min": range(2, 100), "max": range(2, 100)}  # of arguments, where it is not one
_VECTORS = ("columns", "cross", "det", "dot", "gram", "inverse", "norm", "trace", "transpose")
WORDS = {*_OF_SYMPY, *_VECTORS, "where", "pi"}


def parsed(text: str, names: Mapping[str, Any]) -> Any:
    """The energy that a text gives: `NAME = ...` lines (or parts between semicolons), then the energy itself.

    Args:
        text: numbers, names, + - * / **, comparisons inside of where(condition, a, b), v[0], M[0, 1], and functions.
        names: what stands for positions and data.

    Raises:
        InputError: it cannot be read, or uses what is not there.
    """
    try:
        statements = ast.parse("\n".join(line.strip() for line in text.splitlines())).body
    except (SyntaxError, ValueError) as error:
        line = getattr(error, "lineno", None)
        raise InputError(f"expression: cannot be read{f' in line {line}' if line else ''} ({error})") from None
    known = dict(names)
    for k, statement in enumerate(statements):
        is_last = k + 1 == len(statements)
        if is_last and isinstance(statement, ast.Expr):
            return _value(statement.value, known)
        name = _assigned(statement)
        if is_last or name is None:
            break
        if name in names or name in WORDS:
            raise InputError(f"expression: {name!r} has a meaning already; take another name")
        known[name] = _value(statement.value, known)  # type: ignore[attr-defined]
    raise InputError("expression: expected NAME = ... lines and the energy in the last line")


def _assigned(statement: ast.stmt) -> str | None:
    if not isinstance(statement, ast.Assign) or len(statement.targets) != 1:
        return None
    target = statement.targets[0]
    return target.id if isinstance(target, ast.Name) else None


def _value(node: ast.expr, known: Mapping[str, Any]) -> Any:
    sympy = symbolic._sympy()
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return sympy.Rational(str(node.value)) if isinstance(node.value, int) else sympy.Float(node.value)
    if isinstance(node, ast.Name):
        return _named(node.id, known)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
        operand = _value(node.operand, known)
        return -operand if isinstance(node.op, ast.USub) else operand
    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        return _applied(node, _OPERATORS[type(node.op)], _value(node.left, known), _value(node.right, known))
    if isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in _COMPARISONS:
        compare = getattr(sympy, _COMPARISONS[type(node.ops[0])])
        return _applied(node, compare, _value(node.left, known), _value(node.comparators[0], known))
    if isinstance(node, ast.BoolOp):
        return (sympy.And if isinstance(node.op, ast.And) else sympy.Or)(*(_value(v, known) for v in node.values))
    if isinstance(node, ast.Subscript):
        return _entry(node, known)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        return _called(node.func.id, node, [_value(argument, known) for argument in node.args])
    raise InputError(f"expression: {ast.unparse(node)!r} is not part of the language; expected numbers, names, "
                     f"+ - * / **, indices, and the functions {', '.join(sorted(WORDS - {'pi'}))}")


def _named(name: str, known: Mapping[str, Any]) -> Any:
    if name in known:
        return known[name]
    if name == "pi":
        return symbolic._sympy().pi
    near = ([other for other in known if other.casefold() == name.casefold()]
            or difflib.get_close_matches(name, [*known, *WORDS], 1))
    hint = f"; did you mean {near[0]!r}?" if near else f"; it has {', '.join(known)}; give data as {name}=..."
    raise InputError(f"expression: {name!r} is not known{hint}")


def _called(name: str, node: ast.Call, arguments: list[Any]) -> Any:
    sympy = symbolic._sympy()
    if name == "where" and len(arguments) == 3:
        return _applied(node, lambda c, a, b: sympy.Piecewise((a, c), (b, True)), *arguments)
    if name in _OF_SYMPY and len(arguments) in _COUNTS.get(name, (1,)):
        return _applied(node, getattr(sympy, _OF_SYMPY[name]), *arguments)
    if name in _VECTORS:
        return _applied(node, getattr(symbolic, name), *arguments)
    if name in WORDS:
        raise InputError(f"expression: {ast.unparse(node)!r}: takes another number of arguments than {len(arguments)}")
    near = difflib.get_close_matches(name, WORDS, 1)
    hint = f"did you mean {near[0]!r}?" if near else f"functions are {', '.join(sorted(WORDS - {'pi'}))}"
    raise InputError(f"expression: {name}(...) is not known; {hint}")


def _entry(node: ast.Subscript, known: Mapping[str, Any]) -> Any:
    whole = _value(node.value, known)
    parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
    places = [part.value if isinstance(part, ast.Constant) else None for part in parts]
    try:
        if all(type(place) is int for place in places) and symbolic._is_matrix(whole):
            return whole[places[0]] if len(places) == 1 else whole[tuple(places)]
    except IndexError:
        pass
    raise InputError(f"expression: {ast.unparse(node)!r} names no entry of a vector or a matrix; places count from 0")


def _applied(node: ast.expr, function: Callable[..., Any], *arguments: Any) -> Any:
    """SymPy's refusals in our words."""
    try:
        return function(*arguments)
    except InputError as error:
        raise InputError(*(f"expression: {ast.unparse(node)!r}: {defect}" for defect in error.defects)) from None
    except Exception as error:  # shapes that do not fit, too many arguments, ...
        raise InputError(f"expression: {ast.unparse(node)!r}: {error}") from None
