"""A result for other packages: the fields of its vertices, triangles and lines, for meshio and PyVista."""
from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ._result import Result

_AT_VERTICES = {"gap", "is_contact", "reference_distance"}
_AT_LINES = {"line_force", "line_strain", "line_stress"}
Values = npt.NDArray[Any]


@dataclass(frozen=True)
class Fields:
    """Each field by its name; NaN (-1 in whole numbers) where it says nothing."""
    of_nodes: dict[str, Values]  #: (n, ...)
    of_cells: dict[str, tuple[Values, Values]]  #: of the triangles (m, ...), and of the lines (k, ...)


def fields_of(result: Result) -> Fields:
    """Of all nodes, and of the triangles and lines."""
    of_nodes: dict[str, Values] = {}
    of_cells: dict[str, tuple[Values, Values]] = {}
    for name, given in result.fields.items():
        values = given.astype(np.uint8) if given.dtype == bool else given
        if name == "displacement":
            of_nodes[name] = values
        elif name in _AT_VERTICES:
            padding = np.full(result.x.shape[0] - result.vertex_count, np.nan if values.dtype.kind == "f" else 0)
            of_nodes[name] = np.concatenate([values, padding.astype(values.dtype)])
        elif name in _AT_LINES:
            of_cells[name] = np.full(len(result.faces), np.nan), values
        else:
            rest = np.full((len(result.lines), *values.shape[1:]), np.nan if values.dtype.kind == "f" else -1)
            of_cells[name] = values, rest.astype(values.dtype)
    return Fields(of_nodes, of_cells)


def imported(package: str, wanted_by: str, remedy: str) -> Any:
    """An optional package. Raises ImportError that says what wants it."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        raise ImportError(f"{wanted_by} needs the package {package} ({remedy})") from error


def to_meshio(result: Result) -> Any:
    meshio = imported("meshio", "to_meshio()", "Debian: python3-meshio")
    fields = fields_of(result)
    blocks = [("triangle", result.faces), ("line", result.lines)]
    used = [k for k, (_, cells) in enumerate(blocks) if len(cells)]
    return meshio.Mesh(result.x, [blocks[k] for k in used], point_data=fields.of_nodes,
                       cell_data={name: [both[k] for k in used] for name, both in fields.of_cells.items()})


def to_pyvista(result: Result) -> Any:
    pyvista = imported("pyvista", "to_pyvista()", "PyPI: pyvista; it is no package of Debian 12")
    # A PolyData counts its cells lines first, whatever the order in which they are given.
    mesh = pyvista.PolyData(result.x, faces=_counted(result.faces), lines=_counted(result.lines))
    fields = fields_of(result)
    for name, values in fields.of_nodes.items():
        mesh.point_data[name] = values
    for name, (of_faces, of_lines) in fields.of_cells.items():
        mesh.cell_data[name] = np.concatenate([of_lines, of_faces])
    return mesh


def _counted(cells: npt.NDArray[np.int32]) -> npt.NDArray[np.int64] | None:
    """Each cell after the number of its nodes, in a row; None for no cells."""
    if len(cells) == 0:
        return None
    return np.insert(cells.astype(np.int64), 0, cells.shape[1], axis=1).ravel()
