"""What an `Equilibrium` needs to be made again elsewhere: its input, and where it stands."""
from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arguments, _inputs

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Source:
    """The input of an equilibrium, so kept that nothing the caller does to his own changes it."""
    terms: list[Any]
    options: dict[str, Any]  #: how it is followed
    scene: dict[str, Any] | str | None = None  #: a dict, or the whole path of a file
    mesh: tuple[Any, ...] | None = None  #: V, F, fixed, regions

    def given(self, x0: Array) -> _inputs.Given:
        """The same input with a start, (n, 3) [mm]."""
        if self.mesh is not None:
            V, F, fixed, regions = self.mesh
            return _inputs.of_mesh(V, F, self.terms, fixed, x0, regions, self.scene if isinstance(self.scene, dict) else None, [])
        assert self.scene is not None
        return _inputs.of_scene(self.scene, self.terms, x0, [])


@dataclass(frozen=True, eq=False)
class Place:
    """Where an equilibrium stands, or stood."""
    value: Array  #: all numbers
    x: Array  #: positions of all nodes, (n, 3) [mm]
    is_solved: bool = True


def kept_scene(scene: _inputs.Path | Mapping[str, Any]) -> dict[str, Any] | str:
    """A copy of a dict, in lists and texts; of a path the whole of it."""
    if isinstance(scene, Mapping):
        return kept_dict(scene)
    return os.path.abspath(os.fspath(scene))


def kept_dict(scene: Mapping[str, Any]) -> dict[str, Any]:
    copied: dict[str, Any] = json.loads(_arguments.scene_text(scene))
    return copied


def kept(values: Any) -> Any:
    """A copy of arrays and lists of the caller's."""
    return values if values is None or isinstance(values, str) else np.array(values)
