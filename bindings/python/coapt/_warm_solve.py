"""What a warm solve says of itself: how it ended, its branch, and the elements whose law has changed."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

from ._result import Status


@dataclass(frozen=True)
class LostBranch:
    """The shape is on another branch of equilibria than before: it did not come back when the change was undone."""
    distance: float  #: of the shape that came back from the one before, greatest of a node [mm]
    jump: float  #: of the new shape from the linear prediction, likewise [mm]
    negative_before: int  #: negative eigenvalues of the symmetric part of the tangent
    negative_after: int


@dataclass(frozen=True)
class AnchorCheck:
    """The present parameters and those of the anchor by two ways: step by step, as they were solved, and all at once.
    Where the shapes differ, steps that each looked harmless have led to another branch of equilibria."""
    status: Status  #: CONVERGED: both ways could be gone at once
    is_same_branch: bool  #: False also where nothing could be compared
    back: float  #: of the anchor's shape from where undoing all changes at once leads, greatest of a held node [mm]
    here: float  #: of the present shape from where all changes at once lead from the anchor, likewise [mm]
    travel: float  #: of the present shape from the anchor's, likewise [mm]
    message: str  #: one sentence


def anchor_check(found: dict[str, Any] | None) -> AnchorCheck | None:
    """Of what the compiled module says of a check, None where it made none; empties `found`."""
    if found is None:
        return None
    return AnchorCheck(status=Status[found.pop("status").upper()], **found)


class Switch(NamedTuple):
    """An element whose law changes between two shapes."""
    term: str
    element: int  #: of the term; of a contact its first node or facet
    before: str  #: "slack", "rounded", "taut", "wrinkled"; "apart", "point on face", ...; of facets "within range"
    after: str
    is_kink: bool = True  #: derivatives jump there; False: it is rounded, or a contact that begins smoothly


class KinkWarning(RuntimeWarning):
    """The shape stands where an element changes its law: its derivatives hold on one side at best."""


@dataclass(frozen=True)
class WarmSolve:
    """How a solve for the present parameters ended."""
    success: bool  #: whether the residual, with the exact loads, is within the tolerance
    status: Status  #: why it ended
    message: str  #: one sentence
    residual: float  #: greatest out-of-balance force over the greatest load or reaction
    iterations: int  #: Newton steps after the prediction, or those of the whole method
    seconds: float  #: wall time, the check of the branch included [s]
    is_quick: bool = False  #: False: the whole method was called
    predicted: float = 0.0  #: greatest displacement of a node by the linear prediction [mm]
    travel: float = 0.0  #: greatest displacement of a node [mm]
    jump: float = 0.0  #: greatest distance of a node from the linear prediction [mm]
    lost_branch: LostBranch | None = None
    anchor: AnchorCheck | None = None  #: where it was time for one: every 20 warm steps
    #: what has another state than in the shape solved before: on the way between the two derivatives may have kinks
    switched: Sequence[Switch] = ()

    def __repr__(self) -> str:
        """Switches are counted: there may be hundreds."""
        parts = [f"{field.name}={getattr(self, field.name)!r}" for field in fields(self) if field.name != "switched"]
        return f"WarmSolve({', '.join(parts)}, switched=<{len(self.switched)} of Switch>)"


def warm_solve(found: dict[str, Any]) -> WarmSolve:
    """Of what the compiled module says of a solve; empties `found`."""
    status = Status[found.pop("status").upper()]
    lost = found.pop("lost_branch", None)
    anchor = anchor_check(found.pop("anchor", None))
    switched = [Switch(*each) for each in found.pop("switched", [])]
    return WarmSolve(success=status is Status.CONVERGED, status=status,
                    lost_branch=None if lost is None else LostBranch(**lost), anchor=anchor, switched=switched, **found)
