"""The package coapt-gpl, taken up where it is installed and this build has no CHOLMOD or CGAL of its own."""
from __future__ import annotations

import warnings

from . import _core


def add_installed() -> None:
    """Adds its factorisation and its checker; warns, and goes on without, where it cannot be loaded or is of another build."""
    present = {name for name, _, _, is_present in _core.components() if is_present}
    if present >= {"CHOLMOD", "CGAL"}:
        return
    try:
        import coapt_gpl
        _core.add_adapters(coapt_gpl.adapters())
    except (ImportError, ValueError) as error:
        if not (isinstance(error, ModuleNotFoundError) and error.name == "coapt_gpl"):
            warnings.warn(f"coapt-gpl is installed and not used: {error}", RuntimeWarning, stacklevel=3)
