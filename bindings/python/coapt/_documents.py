"""Types of what result.json holds (schema/result.schema.json), for editors and type checkers. At run time they are dicts."""
from __future__ import annotations

from typing import Literal, TypedDict

import numpy as np
import numpy.typing as npt

Stability = Literal["not_known", "strict_minimum", "stable", "flat", "saddle", "divergence", "flutter", "not_decided",
                    "nothing_to_judge"]


class Metrics(TypedDict):
    """Figures of merit of a closed shape (docs/metrics.md); None where a scene does not define one."""
    intersections: int | None  #: pairs of facets without a common vertex, one or both of the mesh, that touch or pass
    #: through each other
    orifice_area_mm2: float | None  #: area of the annulus opening, seen along its normal, left uncovered [mm2]
    annulus_area_mm2: float | None  #: area of the annulus opening, seen along its normal [mm2]
    orifice_area_percent: float | None  #: orifice area over annulus area [%]
    regurgitant_area_mm2: float | None  #: of the orifice, what is wider than the contact distance [mm2]
    orifice_film_area_mm2: float | None  #: of the least surface that closes the same from rim to rim [mm2]
    coaptation_area_mm2: float | None  #: half the area of the leaflets that is in contact [mm2]
    coaptation_length_mm: float | None  #: length of the coaptation line [mm]
    coaptation_height_mm: float | None  #: extent of contact below and across the coaptation line: 90th percentile
    #: along it [mm]
    tenting_height_mm: float | None  #: depth of the coaptation line below the annulus plane: 90th percentile along it
    #: [mm]
    tenting_volume_mm3: float | None  #: between the leaflets, seen from the atrium, and the annulus surface above [mm3]
    prolapse_height_mm: float | None  #: greatest height of the leaflets above every straight line across the annulus
    #: [mm]
    leaflet_area_open_mm2: float | None  #: area of the reference mesh [mm2]
    leaflet_area_closed_mm2: float | None  #: area of the closed mesh [mm2]
    leaflet_area_change_mm2: float | None  #: area of the closed mesh less that of the reference mesh [mm2]
    taut_area_mm2: float | None  #: reference area of the membrane in tension both ways [mm2]
    wrinkled_area_mm2: float | None  #: reference area of the membrane in tension one way [mm2]
    slack_area_mm2: float | None  #: reference area of the membrane without tension [mm2]
    max_principal_strain: float | None  #: greatest principal engineering strain, stretch - 1
    p95_principal_strain: float | None  #: the same, not exceeded on 95 % of the area
    p99_principal_strain: float | None  #: the same, not exceeded on 99 % of the area
    max_cauchy_stress_kpa: float | None  #: greatest principal Cauchy stress of the membrane [kPa]
    max_von_mises_stress_kpa: float | None  #: greatest von Mises stress in the plane of the membrane [kPa]
    max_chord_force_n: float | None  #: greatest tension of a chord or cable [N]
    max_chord_stress_kpa: float | None  #: greatest Cauchy stress of a chord or cable of known cross-section [kPa]
    max_chord_strain: float | None  #: greatest strain of a chord or cable, length over rest length - 1
    mean_chord_strain: float | None  #: mean strain of the chords and cables longer than at rest
    max_yield_ratio: float | None  #: greatest elongation of a leaflet's fibres over that at which they yield
    max_chord_yield_ratio: float | None  #: greatest strain of a chord over that at which its fibres yield
    yielded_facets: int | None  #: facets whose fibres are beyond their yield
    yielded_chords: int | None  #: chords whose fibres are beyond their yield
    force_balance: float | None  #: resultant of loads and reactions over the sum of their magnitudes
    moment_balance: float | None  #: the same for moments about the centre of the nodes
    contact_vertices: int | None  #: vertices in contact
    contact_facets: int | None  #: facets with all three vertices in contact
    smallest_gap_mm: float | None  #: smallest distance of a vertex from a facet beyond its neighbourhood [mm]
    slack_chords: int | None  #: chords and cables without tension
    max_displacement_mm: float | None  #: greatest displacement of a node [mm]


class Eigenvalue(TypedDict):
    """Of a tangent that is not symmetric [N/mm]."""
    real: float
    imaginary: float


class FreePart(TypedDict):
    """A connected part that is not held in every way."""
    node: int  #: its first node
    nodes: int  #: how many
    free_motions: int  #: rigid motions that its supports do not prevent


class Imbalance(TypedDict):
    """Where the out-of-balance force is largest."""
    node: int
    position_mm: list[float | None]
    force_n: float | None
    term: str
    share_n: float | None


class _CertificateOfEvery(TypedDict):
    summary: str  #: all of it in one sentence
    stability: Stability  #: by the signs of the eigenvalues of the exact Hessian or, where a load has no potential,
    #: of the real parts of those of the tangent
    conservative: bool  #: all loads have a potential; else the Hessian is the symmetric part of the tangent
    smallest_pivot_ratio: float | None  #: of the Cholesky factor of a strict minimum, smallest over largest
    doubt: str | None  #: why a converged state may not be stable; null: it is, or was not checked
    zero_modes: int | None  #: zero-energy modes, free directions of single nodes left out
    negative_modes: int | None  #: modes along which the energy falls, or the work of the symmetric part of the tangent
    unstable_modes: int | None  #: eigenvalues with a negative real part that were found of a tangent that is not
    #: symmetric; null: it did not have to be looked at
    lowest_eigenvalue: Eigenvalue | None  #: of that tangent, the lowest real part of those that were found [N/mm]
    free_directions: int | None  #: directions in which single nodes can be moved at no cost, left out of the judgement
    loose_nodes: int | None  #: nodes that can be moved at no cost in every direction
    free_nodes: list[int]  #: nodes whose place is not determined: they can be moved, alone or with others, at no cost
    smallest_eigenvalues: list[float]  #: ascending, where they were asked for [N/mm]
    free_parts: list[FreePart]  #: connected parts that are not held in every way
    force_balance: float | None  #: resultant of loads and reactions over the sum of their magnitudes
    moment_balance: float | None  #: the same for moments


class Certificate(_CertificateOfEvery, total=False):
    """What is known of a state beyond its residual (docs/metrics.md)."""
    imbalance: Imbalance  #: of a run that did not converge


class OtherEquilibrium(TypedDict):
    """One of the equilibria near by."""
    found: int  #: by how many perturbed starts
    energy_mj: float | None  #: potential energy [mJ]
    stability: Stability  #: as in the certificate
    residual: float | None  #: largest out-of-balance nodal force over the largest load or reaction
    greatest_distance_mm: float | None  #: of a node from the first equilibrium [mm]
    mean_distance_mm: float | None  #: of the nodes from the first equilibrium [mm]
    left_out_nodes: int  #: without a part in both: one of the two equilibria leaves them free
    metrics: Metrics  #: what was measured on the closed shape; null where not defined for the scene


class Range(TypedDict):
    """Of a metric."""
    lowest: float | None
    highest: float | None


class Branches(TypedDict):
    """Other equilibria near by, where `branches` looked for them."""
    message: str  #: the outcome in one sentence
    starts: int  #: perturbed starts that were made
    starts_along_path: int  #: of them, from the scene's own start along its whole path
    not_converged: int  #: of all
    first_failure: str  #: message of the first that did not converge; else empty
    kick_mm: float | None  #: greatest move of a node of a start [mm]
    least_moved_share: float | None  #: of the starts: length of all moves that contact admitted, over that wanted
    tolerance_mm: float | None  #: nodes of distinct equilibria are farther apart somewhere [mm]
    greatest_return_mm: float | None  #: greatest distance of a node of the starts that came back to the first [mm]
    equilibria: list[OtherEquilibrium]  #: distinct, the one of this result first
    others: dict[str, Range]  #: range of each metric over the other equilibria
    spread: npt.NDArray[np.float64]  #: (n,) greatest distance of each node from its place in them [mm]
