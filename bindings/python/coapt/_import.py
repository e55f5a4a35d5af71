"""Valves of other programs, made into scenes (docs/formats.md)."""
from __future__ import annotations

import os
import pathlib
from typing import NamedTuple

from . import _core
from ._errors import InputError

Path = str | os.PathLike[str]


class Imported(NamedTuple):
    """What an import wrote, and what it has to say."""
    scene: pathlib.Path  #: the scene file, for `solve` and `Equilibrium`
    warnings: list[str]  #: whole sentences: what was repaired, left out, or is doubtful


def import_valve(file: Path, folder: Path, *, annulus_closed: Path | None = None, papillary: Path | None = None,
                 papillary_closed: Path | None = None, pressure: str | None = None, young: str | None = None,
                 chord_young: str | None = None, contact: str | None = None, model: str | None = None,
                 repair: bool = True, any_size: bool = False) -> Imported:
    """Makes a folder with a scene of a valve JSON, an Abaqus or FEBio model, or a mesh with curves of 3D Slicer, as
    `coapt import` does.

    Args:
        file: the valve; of a mesh (.obj .ply .stl .off .vtp) the vertices are mm.
        folder: another one than that of the file; it is made where it does not exist, files of that name are replaced.
        annulus_closed: closed curve (.mrk.json) to which the annulus moves. The annulus is the rim of the mesh nearest to
            it, else the longest.
        papillary: points (.mrk.json), papillary tips for a valve without chords; chords tie them to the free edge.
        papillary_closed: points (.mrk.json) to which the tips move, in their order.
        pressure: such as "100 mmHg"; default: the file's, else 120 mmHg.
        young: linear leaflets of this modulus ("1 MPa") in the place of the laws of the file.
        chord_young: linear chords of this modulus ("40 MPa") in the place of the laws of the file.
        contact: "none", "barrier" or "facet"; default: barrier, or none where a model has none.
        model: tissue, chords, load or method of a published model, by its name (docs/papers).
        repair: whether slivers of the mesh are taken out.
        any_size: take a valve of a size, thickness or pressure that no heart has.

    Raises:
        InputError: a file that cannot be read, an option that is not known, a valve that cannot be solved; it has all
            defects of one pass.
    """
    defects = [f"{name}: is a {type(value).__name__}; expected a path"
               for name, value in (("file", file), ("folder", folder), ("annulus_closed", annulus_closed),
                                   ("papillary", papillary), ("papillary_closed", papillary_closed))
               if not isinstance(value, (str, os.PathLike)) and (value is not None or name in ("file", "folder"))]
    defects += [f"{name}: is a {type(value).__name__}; expected a text such as \"{example}\""
                for name, value, example in (("pressure", pressure, "120 mmHg"), ("young", young, "1 MPa"),
                                             ("chord_young", chord_young, "40 MPa"), ("contact", contact, "barrier"),
                                             ("model", model, "hammer-2011"))
                if value is not None and not isinstance(value, str)]
    if not defects and pathlib.Path(file).resolve().parent == pathlib.Path(folder).resolve():
        defects.append(f"folder: {os.fspath(folder)} is the folder of {os.fspath(file)}, which would be written over; choose "
                       "another one")
    if defects:
        raise InputError(*defects)
    warnings = _core.import_valve(
        file=os.fsencode(file), folder=os.fsencode(folder), annulus_closed=os.fsencode(annulus_closed or ""),
        papillary=os.fsencode(papillary or ""), papillary_closed=os.fsencode(papillary_closed or ""),
        pressure=pressure or "", young=young or "", chord_young=chord_young or "", contact=contact or "",
        model=model or "", repairs=bool(repair), takes_any_size=bool(any_size))
    return Imported(pathlib.Path(folder) / "scene.json", warnings)
