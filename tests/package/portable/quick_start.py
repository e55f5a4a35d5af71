"""Closes the valve of the quick start by the installed module; fails unless it is an equilibrium that is closed.

    quick_start.py
"""
import tempfile

import coapt

with tempfile.TemporaryDirectory() as folder:
    result = coapt.solve(coapt.generate_mitral(folder + "/mitral", triangles=2500))
    print(coapt.__file__, result)
    if not result.success or result.metrics["orifice_area_mm2"] > 1:
        raise SystemExit("the valve is not closed")
