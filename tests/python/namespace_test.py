"""The package shows what is public, and its types are those of result.json."""
import json
import subprocess
import sys
import types
import typing

import pytest

import coapt
from coapt import _documents
from meshes import ROOT

SCHEMA = json.loads((ROOT / "schema/result.schema.json").read_text())["properties"]


def test_dir_shows_public_names_alone():
    names = [name for name in dir(coapt) if not name.startswith("__")]
    assert sorted(names) == sorted(coapt.__all__) and all(getattr(coapt, name) is not None for name in names)
    assert {"solve", "minimize", "Equilibrium", "energy", "plot", "metrics", "autograd", "symbolic"} <= set(names)


def test_nothing_public_stands_beside_them():
    others = {name for name, value in vars(coapt).items() if not name.startswith("_")} - set(coapt.__all__)
    assert others == set()
    for module in (coapt.plot, coapt.metrics, coapt.autograd, coapt.symbolic):
        assert isinstance(module, types.ModuleType) and set(module.__all__) <= set(vars(module))


def test_each_public_name_has_documentation():
    for name in coapt.__all__:
        assert (getattr(coapt, name).__doc__ or "").strip(), name


def test_to_import_it_loads_no_optional_package():
    done = subprocess.run([sys.executable, "-c", "import sys, coapt; print([name for name in ('matplotlib', 'sympy', 'meshio', "
                           "'pyvista', 'tqdm', 'torch', 'scipy') if name in sys.modules])"], capture_output=True, text=True)
    assert done.stdout == "[]\n", done.stdout + done.stderr


def of_schema(property_of):
    """Python's type of a simple property; None for lists and objects."""
    names = property_of.get("type")
    names = names if isinstance(names, list) else [names]
    known = {"integer": int, "number": float, "string": str, "boolean": bool, "null": type(None)}
    return {known[name] for name in names} if set(names) <= known.keys() else None


@pytest.mark.parametrize(("typed", "schema", "more"), [
    ("Metrics", SCHEMA["metrics"], set()),
    ("Certificate", SCHEMA["certificate"], set()),
    ("Branches", SCHEMA["branches"], {"spread"}),
    ("OtherEquilibrium", SCHEMA["branches"]["properties"]["equilibria"]["items"], set()),
    ("Imbalance", SCHEMA["certificate"]["properties"]["imbalance"], set()),
    ("FreePart", SCHEMA["certificate"]["properties"]["free_parts"]["items"], set()),
    ("Range", SCHEMA["branches"]["properties"]["others"]["additionalProperties"], set()),
])
def test_types_are_those_of_the_schema(typed, schema, more):
    kind = getattr(_documents, typed)
    assert set(schema["properties"]) == set(kind.__annotations__) - more
    assert kind.__required_keys__ - more == set(schema["required"])
    hints = typing.get_type_hints(kind)
    for name, property_of in schema["properties"].items():
        wanted = of_schema(property_of)
        if wanted is not None:
            assert set(typing.get_args(hints[name]) or (hints[name],)) == wanted, name
        if name == "stability":
            assert set(typing.get_args(hints[name])) == set(property_of["enum"])
