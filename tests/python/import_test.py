"""coapt.import_valve: valves of other programs."""
import json

import pytest

import coapt
from valves import scene_file


def test_a_mesh_with_curves_becomes_a_scene_that_closes(tmp_path):
    scene = scene_file(300)
    valve = json.loads((scene.parent / "valve.json").read_text())
    for name, kind in (("annulus_closed", "ClosedCurve"), ("papillary", "Fiducial")):
        (tmp_path / f"{name}.mrk.json").write_text(json.dumps({"markups": [{
            "type": kind, "coordinateSystem": "LPS", "controlPoints": [{"position": p} for p in valve[name]]}]}))
    made, warnings = coapt.import_valve(
        scene.parent / "leaflets.obj", tmp_path / "scene", annulus_closed=tmp_path / "annulus_closed.mrk.json",
        papillary=tmp_path / "papillary.mrk.json", pressure="80 mmHg", young="0.8 MPa", chord_young="30 MPa", contact="facet")
    assert made == tmp_path / "scene/scene.json" and any("24 were made from the papillary tips" in text for text in warnings)
    text = made.read_text()
    assert all(part in text for part in ('"80 mmHg"', '"0.8 MPa"', '"30 MPa"', '"contact_facet"'))
    result = coapt.solve(made)
    assert result.success and result.metrics["annulus_area_mm2"] > 3 * result.metrics["orifice_area_mm2"]
    assert len(result.lines) == 24


def test_what_is_doubtful_is_among_the_warnings(tmp_path):
    given = json.loads((scene_file().parent / "valve.json").read_text())
    (tmp_path / "leaflets.obj").write_bytes((scene_file().parent / "leaflets.obj").read_bytes())
    warnings = {}
    for name, area in (("as it is", given["chords"][0]["area"]), ("thick", 400)):
        given["chords"][0]["area"] = area
        (tmp_path / "valve.json").write_text(json.dumps(given))
        warnings[name] = coapt.import_valve(tmp_path / "valve.json", tmp_path / "scene", any_size=True).warnings
    assert len(warnings["thick"]) == len(warnings["as it is"]) + 1, warnings
    assert any("400" in text for text in warnings["thick"]), warnings
    with pytest.raises(coapt.InputError, match="400"):
        coapt.import_valve(tmp_path / "valve.json", tmp_path / "scene")


@pytest.mark.parametrize("options, words", [
    ({"pressure": 120}, "pressure: is a int; expected a text"),
    ({"annulus_closed": 3}, "annulus_closed: is a int; expected a path"),
    ({"contact": "glue"}, "none, barrier, facet"), ({"model": "nobody-1900"}, "nobody-1900"),
    ({"papillary": "not/there.mrk.json"}, "not/there.mrk.json"), ({"folder": None}, "folder: is a NoneType")])
def test_wrong_arguments_are_named(tmp_path, options, words):
    with pytest.raises(coapt.InputError, match=words):
        coapt.import_valve(**{"file": scene_file().parent / "leaflets.obj", "folder": tmp_path} | options)


def test_nothing_is_written_over_what_was_read():
    before = scene_file().read_bytes()
    with pytest.raises(coapt.InputError, match="is the folder of"):
        coapt.import_valve(scene_file().parent / "valve.json", scene_file().parent)
    assert scene_file().read_bytes() == before
