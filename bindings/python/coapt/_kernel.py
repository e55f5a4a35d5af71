"""Energies from expressions as kernels in C++: a header with one struct that `ElementTerm` takes."""
from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from . import _core, _derivatives, symbolic
from ._energy import law_of, names_of
from ._errors import InputError

_ROLES = {"internal": "Internal", "load": "Load", "contact": "Contact"}
_KEYWORDS = set("""alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t char32_t char8_t class
    co_await co_return co_yield compl concept const const_cast consteval constexpr constinit continue decltype default
    delete do double dynamic_cast else enum explicit export extern false float for friend goto if inline int long mutable
    namespace new noexcept not not_eq nullptr operator or or_eq private protected public register reinterpret_cast
    requires return short signed sizeof static static_assert static_cast struct switch template this thread_local throw
    true try typedef typeid typename union unsigned using virtual void volatile wchar_t while xor xor_eq""".split())

_HEADER = """\
// {type_name}: the energy of one element of {nodes}, written by coapt {version} from its formula.
{source}
// Energies in mJ, lengths in mm, forces in N. Never throws. Where no condition holds the energy is infinite.
#pragma once

#include "energy/element_term.hpp"
{include}
#include <cmath>
#include <limits>

struct {type_name} {{
  static constexpr int kNodes = {count};
  static constexpr std::string_view kType = "{scene_name}";
  static constexpr coapt::TermRole kRole = coapt::TermRole::{role};
  using Vector = Eigen::Vector<double, {size}>;
  using Matrix = Eigen::Matrix<double, {size}, {size}>;

  // The data of an element, and what depends on them alone.
  struct Rest {{
{fields}
  }};

  static Rest rest({parameters}) {{
{rest}
  }}

  // Energy at x (node after node); derivatives only where asked.
  static double evaluate(const Rest& rest, const Vector& x, Vector* g, Matrix* H) {{
    if (H == nullptr && g == nullptr) return energy(rest, x);
    if (H == nullptr) return with_gradient(rest, x, *g);
    Vector unused;
    return with_hessian(rest, x, g == nullptr ? unused : *g, *H);
  }}
{projection}
 private:
  static double square(double a) {{ return a * a; }}
  static double cube(double a) {{ return a * a * a; }}
  static double fourth(double a) {{ return square(a * a); }}

  static double energy([[maybe_unused]] const Rest& rest, const Vector& x) {{
{energy}
  }}

  static double with_gradient([[maybe_unused]] const Rest& rest, const Vector& x, Vector& g) {{
{gradient}
  }}

  static double with_hessian([[maybe_unused]] const Rest& rest, const Vector& x, Vector& g, Matrix& H) {{
{hessian}
  }}
}};
"""

_PROJECTION = """
  // The same, all derivatives wanted, with the negative eigenvalues of the Hessian set to zero.
  static double evaluate_projected(const Rest& rest, const Vector& x, Vector* g, Matrix* H) {{
    const double energy = with_hessian(rest, x, *g, *H);
    coapt::{project}<{count}>(x, *H);
    return energy;
  }}
"""


def kernel_text(expression: Any, nodes: int, shapes: Mapping[str, tuple[int, ...]], type_name: str, *,
                role: str = "internal", source: str = "") -> str:
    """The header.

    Args:
        expression: in SymPy, as `_energy.expression_of` gives it.
        nodes: of an element.
        shapes: of each data of one element, () for a number; `X` gives corners of the element at rest.
        type_name: of the struct, such as "NeoHookeanTriangle".
        role: "internal", "load" or "contact".
        source: what the expression was written as, for the comment.

    Raises:
        InputError: a name that C++ does not take, or a role that there is not.
    """
    defects = [f"{name}: is no name in C++" for name in (type_name, *shapes) if name in _KEYWORDS or not name.isidentifier()
               or not name.isascii()]
    if role not in _ROLES:
        defects.append(f"role: is {role!r}; expected one of {', '.join(_ROLES)}")
    if defects:
        raise InputError(*defects)
    return _Writer(expression, nodes, shapes).text(type_name, role, source)


class _Writer:
    def __init__(self, expression: Any, nodes: int, shapes: Mapping[str, tuple[int, ...]]) -> None:
        sympy = symbolic._sympy()
        self.printer = _derivatives.power_printer(symbolic._sympy("sympy.printing.cxx").CXX17CodePrinter)({})
        numbers = {e: sympy.Float(e, 17) for e in expression.atoms(sympy.NumberSymbol)}  # pi, e
        self.nodes, self.shapes, self.law = nodes, shapes, law_of(expression.xreplace(numbers), nodes)
        names = names_of(nodes, shapes)
        #: symbols of data by how they are called in rest(), and those of them that the energy itself needs
        self.given = {symbol: place for name, value in names.items() if not re.fullmatch(r"x\d+", name)
                      for symbol, place in self._places(name, value)}
        branches = [e for b in self.law.branches for e in (b.condition, b.energy, *b.gradient, *b.hessian)]
        used = {s for e in branches for s in e.free_symbols}
        self.kept = [s for s in self.given if s in used]
        self.stored = {s: sympy.Symbol(f"rest.{s.name}") for s in (*self.kept, *(name for name, _ in self.law.constants))}

    def text(self, type_name: str, role: str, source: str) -> str:
        fields = [*self.kept, *(name for name, _ in self.law.constants)]
        projects = 2 <= self.nodes <= 4  # those that energy/project_element.hpp knows
        return _HEADER.format(
            include='#include "energy/project_element.hpp"\n' if projects else "",
            projection=_PROJECTION.format(
                count=self.nodes, project="project_invariant_element" if self.law.is_relative else "project_element") if projects else "",
            type_name=type_name, nodes=f"{self.nodes} node{'s' if self.nodes > 1 else ''}", version=_core.version(),
            source="\n".join(f"//   {line.strip()}" for line in source.strip().splitlines()), count=self.nodes,
            scene_name=re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", type_name).lower(), role=_ROLES[role], size=3 * self.nodes,
            fields="\n".join(f"    double {name} = 0;" for name in fields), parameters=", ".join(self._parameters()),
            rest="\n".join(self._rest(fields)), energy="\n".join(self._body(False, False)),
            gradient="\n".join(self._body(True, False)), hessian="\n".join(self._body(True, True)))

    def _places(self, name: str, value: Any) -> list[tuple[Any, str]]:
        if not symbolic._is_matrix(value):
            return [(value, name)]
        if value.cols == 1:
            return [(value[k], f"{name}[{k}]") for k in range(value.rows)]
        return [(value[i, j], f"{name}({i}, {j})") for i in range(value.rows) for j in range(value.cols)]

    def _parameters(self) -> list[str]:
        found = []
        for name, shape in self.shapes.items():
            if name == "X":
                found += [f"const coapt::Vec3& X{node}" for node in range(self.nodes)]
            elif len(shape) == 2:
                found.append(f"const Eigen::Matrix<double, {shape[0]}, {shape[1]}>& {name}")
            else:
                found.append(f"const Eigen::Vector<double, {shape[0]}>& {name}" if shape else f"double {name}")
        return found

    def _rest(self, fields: Sequence[Any]) -> list[str]:
        sympy = symbolic._sympy()
        given = {symbol: sympy.Symbol(place) for symbol, place in self.given.items()}
        shared, values = _derivatives.assignments([*self.kept, *(value for _, value in self.law.constants)], "s")
        lines = [f"    const double {name} = {self._code(value, given)};" for name, value in shared]
        return [*lines, f"    return {{{', '.join(self._code(value, given) for value in values)}}};"]

    def _body(self, wants_gradient: bool, wants_hessian: bool) -> list[str]:
        """Statements of a function that returns the energy and sets what is wanted."""
        lines = [f"    const double {s} = x[{3 * self.law.first + k}]{f' - x[{k % 3}]' if self.law.is_relative else ''};"
                 for k, s in enumerate(self.law.unknowns)]
        branches = self.law.branches
        known, conditions = _derivatives.assignments([b.condition for b in branches], "k") if len(branches) > 1 else ([], [])
        lines += [f"    const double {name} = {self._code(value)};" for name, value in known]
        whole: list[tuple[Any, Any]] = []
        for name, value in known:  # in terms of the unknowns, as the branches have it
            whole.append((name, value.xreplace(dict(whole))))
        for k, branch in enumerate(branches):
            is_rest = branch.condition == True  # noqa: E712  (SymPy's)
            statements = self._branch(branch, wants_gradient, wants_hessian, whole)
            lines += statements if is_rest else [f"    if ({self._code(conditions[k])}) {{",
                                                 *("  " + line for line in statements), "    }"]
            if is_rest:
                return lines
        return [*lines, "    return std::numeric_limits<double>::infinity();"]

    def _branch(self, branch: _derivatives.Branch, wants_gradient: bool, wants_hessian: bool,
                known: Sequence[tuple[Any, Any]]) -> list[str]:
        first, size = self.law.first, len(self.law.unknowns)
        targets = [f"g[{3 * first + k}]" for k in range(size)] if wants_gradient else []
        upper = [(3 * first + i, 3 * first + j) for i in range(size) for j in range(i, size)] if wants_hessian else []
        targets += [f"H({i}, {j})" + (f" = H({j}, {i})" if i != j else "") for i, j in upper]
        outputs = [branch.energy, *(branch.gradient if wants_gradient else []), *(branch.hessian if wants_hessian else [])]
        shared, values = _derivatives.assignments(outputs, "t", known)
        lines = [f"    const double {name} = {self._code(value)};" for name, value in shared]
        lines += [f"    {target} = {self._code(value)};" for target, value in zip(targets, values[1:])]
        if self.law.is_relative and wants_gradient:
            lines.append(f"    g.head<3>() = -{self._sum([f'g.segment<3>({3 * a})' for a in self._others()])};")
        if self.law.is_relative and wants_hessian:
            for b in self._others():
                lines.append(f"    {_block(0, b)} = -{self._sum([_block(a, b) for a in self._others()])};")
                lines.append(f"    {_block(b, 0)} = {_block(0, b)}.transpose();")
            lines.append(f"    {_block(0, 0)} = -{self._sum([_block(0, b) for b in self._others()])};")
        return [*lines, f"    return {self._code(values[0])};"]

    def _others(self) -> range:
        return range(1, self.nodes)

    def _sum(self, parts: Sequence[str]) -> str:
        return f"({' + '.join(parts)})" if len(parts) > 1 else parts[0]

    def _code(self, expression: Any, names: Mapping[Any, Any] | None = None) -> str:
        found: str = self.printer.doprint(expression.xreplace(self.stored if names is None else names))
        return found


def _block(a: int, b: int) -> str:
    return f"H.block<3, 3>({3 * a}, {3 * b})"
