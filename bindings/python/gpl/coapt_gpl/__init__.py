"""CHOLMOD's factorisation and CGAL's checker of intersections for the module coapt, which takes them when it is imported.

There is nothing to call here. `coapt.licence()` then says that the whole is under the GPL.
"""
from ._adapters import adapters

__all__ = ["adapters"]
