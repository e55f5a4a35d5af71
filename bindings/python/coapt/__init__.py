"""Coapt: closed, loaded equilibria of thin membranes (heart valves) by energy minimisation.

    import coapt
    result = coapt.solve("scene.json", tol=1e-8)      # a scene file, or its keys as a dict
    result.x, result.metrics["orifice_area_mm2"]

    result = coapt.minimize(V, F, [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"},
                                   {"type": "load_pressure", "value": "0.1 kPa"}], fixed="boundary")

    eq = coapt.Equilibrium("scene.json", ["chords.length"])           # warm solves, exact sensitivities
    eq.solve()
    area, slope = eq.value_and_grad(coapt.metrics.orifice_area(eq))

Lengths are mm, forces N, stresses MPa, energies mJ. Arrays of points have shape (n, 3).
"""
from . import _core, autograd, metrics, plot, symbolic
from ._adapters import add_installed as _add_installed
from ._api import minimize, solve
from ._core import Iterate
from ._documents import Branches, Certificate, Metrics
from ._energy import Energy, energy
from ._equilibrium import Equilibrium
from ._errors import InputError
from ._import import Imported, import_valve
from ._library import components, generate_mitral, licence, methods, scene_schema
from ._objective import LostBranchWarning, Objective, objective
from ._registration import Registration, register
from ._result import Result, Status
from ._terms import Term, check_term
from ._warm_solve import AnchorCheck, KinkWarning, LostBranch, Switch, WarmSolve

__version__ = _core.version()
_add_installed()
__all__ = ["AnchorCheck", "Branches", "Certificate", "Energy", "Equilibrium", "Imported", "InputError", "Iterate", "KinkWarning",
           "LostBranch", "LostBranchWarning", "Metrics", "Objective", "Registration", "Result", "Status", "Switch", "Term",
           "WarmSolve", "autograd", "check_term", "components", "energy", "generate_mitral", "import_valve", "licence", "methods",
           "metrics", "minimize", "objective", "plot", "register", "scene_schema", "solve", "symbolic"]


def __dir__() -> list[str]:
    return [*__all__, "__all__", "__doc__", "__file__", "__name__", "__path__", "__version__"]


def __getattr__(name: str) -> type[WarmSolve]:
    if name == "Settling":  # the former name, deprecated
        import warnings
        warnings.warn("coapt.Settling is now coapt.WarmSolve", DeprecationWarning, stacklevel=2)
        return WarmSolve
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
