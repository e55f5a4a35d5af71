"""What is to be solved: a scene, or a mesh in memory, with energies of the caller's own and a start."""
from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Concatenate, ParamSpec, TypeVar

import numpy.typing as npt

from . import _arguments, _core
from ._errors import InputError

Path = str | os.PathLike[str]
Options = ParamSpec("Options")
Found = TypeVar("Found")


@dataclass(frozen=True)
class Given:
    """All that a solve starts from, sound as far as Python can tell."""
    core: _core.Input
    places: Sequence[int] = ()  #: in `terms`, of each term of the scene

    def solve(self, function: Callable[Concatenate[_core.Input, Options], Found], *args: Options.args,
              **options: Options.kwargs) -> Found:
        """function(core, ...), whose defects name terms by their numbers in `terms`."""
        try:
            return function(self.core, *args, **options)
        except InputError as error:
            raise _arguments.as_written(error, self.places) from None


def of_scene(scene: Path | Mapping[str, Any], terms: Sequence[Any], x0: npt.ArrayLike | None,
             defects: list[str]) -> Given:
    """From arguments as in `solve`. Raises InputError with the defects that there are already, and its own."""
    table, own, _ = _arguments.split_terms(terms, defects)
    if table:
        defects.append("terms: holds a dict; those belong to the scene's key `terms`")
    start = None if x0 is None else _arguments.points(x0, "x0", defects)
    is_mapping = isinstance(scene, Mapping)
    if not is_mapping and not isinstance(scene, (str, os.PathLike)):
        defects.append(f"scene: is a {type(scene).__name__}; expected a path or a dict")
    if defects:
        raise InputError(*defects)
    text = _arguments.scene_text(scene) if isinstance(scene, Mapping) else None
    file = "scene" if isinstance(scene, Mapping) else os.fspath(scene)
    return Given(_core.Input(text=text, file=os.fsencode(file), vertices=None, triangles=None, regions=[],
                             region_names=[], start=start, terms=own))


def of_mesh(V: npt.ArrayLike, F: npt.ArrayLike, terms: Sequence[Any], fixed: Any, x0: npt.ArrayLike | None, regions: Any,
            scene: Mapping[str, Any] | None, defects: list[str]) -> Given:
    """From arguments as in `minimize`. Raises as `of_scene`."""
    table, own, places = _arguments.split_terms(terms, defects)
    vertices = _arguments.points(V, "V", defects)
    faces = _arguments.triangles(F, "F", len(vertices), defects) if vertices is not None else None
    numbers, names = _arguments.regions(regions, len(faces), defects) if faces is not None else ([], [])
    held = _arguments.supports(fixed, len(vertices), defects) if vertices is not None else []
    start = None if x0 is None else _arguments.points(x0, "x0", defects)
    if not table and not own and not defects:
        defects.append("terms: is empty; a membrane needs at least one term")
    others = dict(scene or {}) if scene is None or isinstance(scene, Mapping) else {}
    if scene is not None and not isinstance(scene, Mapping):
        defects.append(f"scene: is a {type(scene).__name__}; expected a dict")
    defects += [f"scene: holds {key!r}, which is an argument of its own" for key in ("mesh", "terms") if key in others]
    boundary = others.get("boundary", [])
    if not isinstance(boundary, (list, tuple)):
        defects.append(f"scene: boundary: is a {type(boundary).__name__}; expected a list")
    if defects:
        raise InputError(*defects)
    text = _arguments.scene_text({**others, "boundary": [*held, *boundary], "terms": table})
    return Given(_core.Input(text=text, file="scene", vertices=vertices, triangles=faces, regions=numbers,
                             region_names=names, start=start, terms=own), places)
