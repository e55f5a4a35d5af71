"""Arguments as the library wants them. What is wrong is added to a list, so that one pass finds all of it."""
from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import InputError

Defects = list[str]
LARGEST_NODE = 2**31 - 1


def _array(value: Any, name: str, wanted: str, kinds: str, defects: Defects) -> npt.NDArray[Any] | None:
    try:
        array = np.asarray(value)
    except Exception as error:  # a ragged list, or an object whose conversion fails
        defects.append(f"{name}: cannot become an array ({error}); expected {wanted}")
        return None
    if array.dtype.kind not in kinds:
        defects.append(f"{name}: has dtype {array.dtype}; expected {wanted}")
        return None
    return array


def positive(value: Any, name: str, unit: str, defects: Defects) -> None:
    if not (isinstance(value, (int, float)) and not isinstance(value, bool) and value > 0):
        defects.append(f"{name}: is {value!r}; expected a number above 0{unit}")


def numbers(value: Any, name: str, wanted: str, shape: tuple[int, ...] | None = None) -> npt.NDArray[np.float64]:
    """Finite float64, C-contiguous, of a shape where one is given. Raises InputError."""
    defects: Defects = []
    array = _array(value, name, wanted, "fiu", defects)
    if array is not None and shape is not None and array.shape != shape:
        defects.append(f"{name}: has shape {array.shape}; expected {wanted}")
    elif array is not None and not np.isfinite(array).all():
        defects.append(f"{name}: holds a number that is not finite")
    if array is None or defects:
        raise InputError(*defects)
    return np.array(array, dtype=np.float64, order="C", ndmin=array.ndim)


def points(value: Any, name: str, defects: Defects) -> npt.NDArray[np.float64] | None:
    """(n, 3) float64, C-contiguous; the caller's own array where it is that already."""
    wanted = "real numbers of shape (n, 3) [mm]"
    array = _array(value, name, wanted, "fiu", defects)
    if array is None:
        return None
    if array.ndim != 2 or array.shape[1] != 3:
        hint = "; transpose it" if array.ndim == 2 and array.shape[0] == 3 else ""
        defects.append(f"{name}: has shape {array.shape}; expected {wanted}{hint}")
        return None
    return np.ascontiguousarray(array, dtype=np.float64)


def triangles(value: Any, name: str, vertex_count: int, defects: Defects) -> npt.NDArray[np.int32] | None:
    """(m, 3) int32, C-contiguous; the caller's own array where it is that already."""
    wanted = "whole numbers of shape (m, 3), the corners of each triangle counted from 0"
    array = _array(value, name, wanted, "iu", defects)
    if array is None:
        return None
    if array.ndim != 2 or array.shape[1] != 3 or array.shape[0] == 0:
        defects.append(f"{name}: has shape {array.shape}; expected {wanted}")
        return None
    wrong = np.flatnonzero(((array < 0) | (array >= vertex_count)).any(axis=1))
    if wrong.size:
        first = wrong[0]
        defects.append(f"{name}: triangle {first} has corners {array[first].tolist()} ({wrong.size} such triangles); "
                       f"V has {vertex_count} vertices, counted from 0")
        return None
    return np.ascontiguousarray(array, dtype=np.int32)


def regions(value: Any, triangle_count: int, defects: Defects) -> tuple[list[int], list[str]]:
    """Region of each triangle and the names of all regions; both empty for None."""
    if value is None:
        return [], []
    array = _array(value, "regions", f"one name for each triangle, shape ({triangle_count},)", "U", defects)
    if array is None:
        return [], []
    if array.shape != (triangle_count,):
        defects.append(f"regions: has shape {array.shape}; expected ({triangle_count},), one name for each triangle")
        return [], []
    names, number = np.unique(array, return_inverse=True)
    return number.tolist(), names.tolist()


def supports(fixed: Any, vertex_count: int, defects: Defects) -> list[dict[str, Any]]:
    """Entries of `boundary` for node numbers, the name of a set, or a mask of shape (n,) or (n, 3)."""
    if fixed is None:
        return []
    if isinstance(fixed, str):
        return [{"nodes": fixed, "fix": True}]
    wanted = (f"node numbers, the name of a set, or true and false in shape ({vertex_count},) or ({vertex_count}, 3)")
    array = _array(fixed, "fixed", wanted, "iub", defects)
    if array is None or array.size == 0:
        return []
    if array.dtype.kind != "b" and array.ndim == 1:
        return [{"nodes": array.tolist(), "fix": True}]
    if array.dtype.kind != "b" or array.shape not in ((vertex_count,), (vertex_count, 3)):
        defects.append(f"fixed: has shape {array.shape} and dtype {array.dtype}; expected {wanted}")
        return []
    mask = array if array.ndim == 2 else np.repeat(array[:, None], 3, axis=1)
    entries = []
    for axes in np.unique(mask, axis=0):
        if axes.any():
            nodes = np.flatnonzero((mask == axes).all(axis=1))
            entries.append({"nodes": nodes.tolist(), "fix": [a for a, on in zip("xyz", axes) if on]})
    return entries


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return dict(value)
    raise TypeError(f"holds a {type(value).__name__}, which is no text, number, list or dict")


def scene_text(scene: Mapping[str, Any]) -> str:
    """A scene as JSON; arrays and paths become lists and texts. Raises InputError."""
    try:
        return json.dumps(dict(scene), default=_plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise InputError(f"scene: {error}") from None


def split_terms(terms: Sequence[Any], defects: Defects) -> tuple[list[Mapping[str, Any]], list[Any], list[int]]:
    """Terms of the table, terms of the caller, and the place in `terms` of each of the first."""
    if isinstance(terms, (Mapping, str)) or not isinstance(terms, Sequence):
        defects.append(f"terms: is a {type(terms).__name__}; expected a list")
        return [], [], []
    table: list[Mapping[str, Any]] = []
    own: list[Any] = []
    places: list[int] = []
    for k, term in enumerate(terms):
        if isinstance(term, Mapping):
            table.append(term)
            places.append(k)
        elif callable(getattr(term, "value", None)) and callable(getattr(term, "gradient", None)):
            role = getattr(term, "role", "internal")
            if role not in ("internal", "load", "contact"):
                defects.append(f"terms[{k}].role: is {role!r}; expected \"internal\", \"load\" or \"contact\"")
            # An energy without a name of its own gets one that differs from those before it.
            named_among = getattr(term, "named_among", None)
            own.append(term if named_among is None else named_among([getattr(other, "name", "") for other in own]))
        else:
            defects.append(f"terms[{k}]: is a {type(term).__name__}; expected a dict with the keys of docs/scene.md, or "
                           "an object with value(x) and gradient(x)")
    return table, own, places


def hessians(terms: Any, defects: Defects) -> None:
    """Own terms of an equilibrium that is followed have one."""
    for k, term in enumerate(terms if isinstance(terms, Sequence) else []):
        if callable(getattr(term, "value", None)) and getattr(term, "hessian", None) is None:
            defects.append(f"terms[{k}] ({getattr(term, 'name', type(term).__name__)}): has no hessian(), which an "
                           "equilibrium that is followed needs for its steps and its derivatives; define it "
                           "(coapt.check_term() checks it), or solve without derivatives by minimize() with method=\"lbfgs\"")


def as_written(error: InputError, places: Sequence[int]) -> InputError:
    """Defects of scene terms under the numbers that they have among all terms."""
    def place(match: re.Match[str]) -> str:
        k = int(match[1])
        return f"terms[{places[k]}]" if k < len(places) else match[0]
    return InputError(*(re.sub(r"\bterms\[(\d+)\]", place, defect) for defect in error.defects))
