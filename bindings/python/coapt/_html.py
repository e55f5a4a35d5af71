"""What a notebook shows of a result: a picture of its shape, and its figures."""
from __future__ import annotations

import base64
import html
import importlib
import io
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._equilibrium import Equilibrium
    from ._result import Result

_UNITS = {"mm": "mm", "mm2": "mm²", "mm3": "mm³", "n": "N", "kpa": "kPa", "percent": "%"}


def of_result(result: Result) -> str:
    """HTML of a result: what is in doubt and warnings first, the picture, and the figures that its scene defines."""
    rows = [("energy", f"{_number(result.fun)} mJ"), ("residual", f"{result.residual:.2e}"), ("iterations", str(result.nit)),
            ("time", f"{result.seconds:.2f} s"), ("stability", str(result.certificate.get("stability", "")).replace("_", " ")),
            ("mesh", f"{result.x.shape[0]} nodes, {result.faces.shape[0]} triangles, {result.lines.shape[0]} lines")]
    figures = [_figure(name, value) for name, value in result.metrics.items() if isinstance(value, (int, float))]
    title = result.headline if result.success else f"NOT converged: {result.message}"
    return _page(title, result.warnings, rows, figures, picture(result), result.success and bool(result.doubts))


def of_equilibrium(equilibrium: Equilibrium) -> str:
    """HTML of an equilibrium that is followed: its picture and its parameters."""
    rows = [(name, f"{numbers.size} numbers" if numbers.size > 1 else _number(float(numbers.item())))
            for name, numbers in equilibrium.split(equilibrium.value).items()]
    title = f"equilibrium of {equilibrium.x.shape[0]} nodes, {len(equilibrium.faces)} triangles"
    return _page(title, [], rows, [], picture(equilibrium))


def picture(of: Result | Equilibrium) -> str:
    """An image of the shape as HTML; a sentence where matplotlib is not installed."""
    try:
        figure = importlib.import_module("matplotlib.figure").Figure(figsize=(5, 3.6), dpi=100)
    except ImportError:
        return "<p>With matplotlib (Debian: python3-matplotlib) the shape is drawn here.</p>"
    from . import plot
    plot.shape(of, ax=figure.add_subplot())
    file = io.BytesIO()
    figure.savefig(file, format="png", bbox_inches="tight")
    data = base64.b64encode(file.getvalue()).decode()
    return f'<img alt="the closed shape" src="data:image/png;base64,{data}">'


def _figure(name: str, value: float) -> tuple[str, str]:
    words, _, unit = name.rpartition("_")
    if unit not in _UNITS:
        words, unit = name, ""
    return words.replace("_", " "), f"{_number(value)} {_UNITS.get(unit, '')}".rstrip()


def _number(value: Any) -> str:
    return "unknown" if value is None else f"{value:.6g}"


def _page(title: str, warnings: Sequence[str], rows: Sequence[tuple[str, str]], figures: Sequence[tuple[str, str]],
          image: str, is_in_doubt: bool = False) -> str:
    told = "".join(f"<p><b>Warning:</b> {html.escape(warning)}</p>" for warning in warnings)
    more = f"<details><summary>{len(figures)} figures</summary>{_table(figures)}</details>" if figures else ""
    colour = ' style="color:#8a5200"' if is_in_doubt else ""
    return f"<div><p{colour}><b>{html.escape(title)}</b></p>{told}{image}{_table(rows)}{more}</div>"


def _table(rows: Sequence[tuple[str, str]]) -> str:
    cells = "".join(f"<tr><td>{html.escape(name)}</td><td>{html.escape(value)}</td></tr>" for name, value in rows)
    return f"<table>{cells}</table>"
