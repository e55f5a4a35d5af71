"""What a solve gives back."""
from __future__ import annotations

import enum
import json
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core, _fields, _html
from ._documents import Branches, Certificate, Metrics

Array = npt.NDArray[np.float64]


class Status(enum.IntEnum):
    """Why a solve ended; `CONVERGED` (0) alone is success."""
    CONVERGED = 0
    ITERATION_LIMIT = 1
    TIME_LIMIT = 2
    STALLED = 3
    LINE_SEARCH_FAILED = 4
    NON_FINITE = 5
    CANCELLED = 6
    NO_EQUILIBRIUM = 7


class Result(dict[str, Any]):
    """A solved scene, shaped as the results of SciPy: a dict whose keys are attributes too.

    n nodes (the m_v vertices of the mesh first, then papillary tips and branch points of chords, then obstacles),
    m triangles, k chords and cables. Arrays look into the memory of the solver's result and keep it
    alive; `lines` and `fields["regime"]` are copies.
    """

    x: Array  #: positions of all nodes, (n, 3), in the coordinates of the input [mm]
    fun: float  #: potential energy [mJ]
    jac: Array  #: its gradient with the exact loads, (n, 3); zero at prescribed coordinates [N]
    nit: int  #: iterations
    nfev: int  #: evaluations of the energy, with or without derivatives
    njev: int  #: evaluations of the gradient, with or without Hessian
    nhev: int  #: evaluations of the Hessian
    success: bool  #: whether the residual, measured after the solver returned, is within the tolerance
    status: Status  #: why it ended
    message: str  #: one sentence
    history: npt.NDArray[Any]  #: every accepted iterate: fields iteration, round, energy [mJ], residual, step [mm],
    #: seconds [s], time [s], evaluations
    metrics: Metrics  #: figures of merit (docs/metrics.md); None where a scene does not define one
    certificate: Certificate  #: stability, balance of reactions, parts that are free to move
    residual: float  #: greatest out-of-balance force over the greatest load or reaction
    reactions: Array  #: forces of the supports on the body, (n, 3); loads on held nodes do not count [N]
    energies: dict[str, float]  #: of each term [mJ]
    vertex_count: int  #: m_v
    faces: npt.NDArray[np.int32]  #: corners of each triangle, (m, 3)
    lines: npt.NDArray[np.int32]  #: ends of each chord and cable, (k, 2)
    fields: dict[str, npt.NDArray[Any]]  #: displacement (n, 3) [mm], principal_strain (m, 2), principal_stress (m, 2)
    #: second Piola-Kirchhoff [MPa], cauchy_stress (m, 2) principal [MPa], von_mises_stress (m,) [MPa], first_piola_stress (m, 2) [MPa]
    #: where the scene asks for it, regime (m,) 0 slack, 1 wrinkled, 2 taut, gap (m_v,) [mm], is_contact (m_v,), reference_distance (m_v,) [mm],
    #: line_force (k,) [N], line_strain (k,), line_stress (k,) Cauchy [MPa], NaN for lines without; those that the scene has
    undetermined: npt.NDArray[np.int8]  #: of each node: 0 determined, 1 free by the certificate, 2 elsewhere in another equilibrium
    branches: Branches | None  #: other equilibria near by, where `branches` looked for them: `message`, `equilibria`
    #: (energy, stability, metrics of each, this one first), `others` (range of each metric over the others), `spread`
    #: (n,) greatest distance of each node from its place in them [mm]; else None
    warnings: list[str]  #: whole sentences
    doubts: list[str]  #: why a converged run is no plain result, clauses: the valve stands open, its stability is in doubt, ...
    headline: str  #: the first line that the command prints: `message`, and the doubts that it does not tell
    seconds: float  #: wall time of the solver [s]
    library_seconds: float  #: wall time of reading, building, solving and measuring [s]
    document: dict[str, Any]  #: all of result.json (schema/result.schema.json)

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"a result has no {name!r}; it has {', '.join(self)}") from None

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self]

    def __repr__(self) -> str:
        return (f"<coapt.Result: {self.headline}; energy {self.fun:.8g} mJ, {self.nit} iterations, "
                f"{self.x.shape[0]} nodes, {self.faces.shape[0]} triangles>")

    def _repr_html_(self) -> str:
        """For notebooks: warnings, a picture of the closed shape (by matplotlib) and the figures."""
        return _html.of_result(self)

    def field_arrays(self) -> _fields.Fields:
        """All fields in two dicts, ready for a file or another program: `of_nodes`, each (n, ...), and `of_cells`, each a
        pair of arrays, of the triangles (m, ...) and of the lines (k, ...). Where a field says nothing stands NaN, or -1 in
        whole numbers; true and false are 1 and 0."""
        return _fields.fields_of(self)

    def to_meshio(self) -> Any:
        """The closed shape as a `meshio.Mesh` [mm]: triangles, chords as lines, and all fields.

        Raises:
            ImportError: meshio is not installed (nothing else needs it).
        """
        return _fields.to_meshio(self)

    def to_pyvista(self) -> Any:
        """The closed shape as a `pyvista.PolyData` [mm]: triangles, chords as lines, and all fields. Cell data hold the
        lines first, then the triangles, as PyVista counts them.

        Raises:
            ImportError: PyVista is not installed (nothing else needs it).
        """
        return _fields.to_pyvista(self)


def result_of(solution: _core.Solution) -> Result:
    document: dict[str, Any] = json.loads(solution.document)
    values, gradients, hessians = solution.evaluations
    status = Status[document["status"].upper()]
    branches: dict[str, Any] | None = document.get("branches")
    if branches is not None:
        branches = {**branches, "spread": solution.branch_spread}
    return Result(
        x=solution.x, fun=document["energy_mj"], jac=solution.gradient, nit=document["iterations"],
        nfev=values + gradients + hessians, njev=gradients + hessians, nhev=hessians,
        success=status is Status.CONVERGED, status=status, message=document["message"], history=solution.history,
        metrics=document["metrics"], certificate=document["certificate"], residual=document["residual"],
        reactions=solution.reactions, energies={term["name"]: term["energy_mj"] for term in document["terms"]},
        vertex_count=document["mesh"]["vertices"], faces=solution.faces, lines=solution.lines, fields=solution.fields,
        undetermined=solution.undetermined, branches=branches, warnings=document["warnings"],
        doubts=document["doubts"], headline=document["headline"], seconds=document["time"]["wall_s"],
        library_seconds=solution.seconds, document=document)
