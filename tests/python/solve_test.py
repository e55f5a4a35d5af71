"""Scenes from files and dicts, result folders, interrupts and threads."""
import json
import os
import signal
import threading
import time

import numpy as np
import pytest

import coapt
from meshes import ELASTIC, PRESSURE, ROOT, disc

DISC = ROOT / "examples/02_pressurised_disc"


def scene() -> dict:
    return {"mesh": {"file": DISC / "mesh.obj"}, "boundary": [{"nodes": "boundary", "fix": True}],
            "terms": [ELASTIC, PRESSURE], "solver": {"tolerance": np.float64(1e-8)}}


@pytest.fixture(scope="module")
def solved():
    return coapt.solve(DISC / "scene.json")


def test_looks_for_other_equilibria():
    # A shallow pyramid: at rest above its base, and turned inside out below.
    V = np.array([[-5.0, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0], [0, 0, 1]])
    F = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]], dtype=np.int32)
    terms = [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.5 mm"},
             {"type": "load_field", "nodes": [4], "force": "0.001 N", "direction": [0, 0, -1]}]
    alone = coapt.minimize(V, F, terms, fixed="boundary")
    assert alone.branches is None
    assert alone.undetermined.tolist() == [0, 0, 0, 0, 0]
    found = coapt.minimize(V, F, terms, fixed="boundary", branches=12, branch_kick=0.5)
    assert found.success
    assert found.branches["starts"] == 24
    assert len(found.branches["equilibria"]) == 2
    assert found.branches["spread"][4] == pytest.approx(found.branches["equilibria"][1]["greatest_distance_mm"])
    assert found.undetermined.tolist() == [0, 0, 0, 0, 2]
    assert found.x == pytest.approx(alone.x, abs=1e-12)
    for wrong in [{"branches": -1}, {"branches": True}, {"branches": 1, "branch_kick": 0}]:
        with pytest.raises(coapt.InputError, match="branch"):
            coapt.minimize(V, F, terms, fixed="boundary", **wrong)
    for wrong in [-1, True, 2.5, 100001]:
        with pytest.raises(coapt.InputError, match="damped_steps.*solves at once"):
            coapt.minimize(V, F, terms, fixed="boundary", damped_steps=wrong)
    damped = coapt.minimize(V, F, terms, fixed="boundary", damped_steps=4)
    assert damped.success and damped.document["damped_steps"] >= 4
    assert damped.x == pytest.approx(alone.x, abs=1e-8)


def test_a_file_a_dict_and_a_mesh_in_memory_give_the_same_bits(solved):
    assert solved.success
    by_dict = coapt.solve(scene())
    assert np.array_equal(by_dict.x, solved.x) and by_dict.fun == solved.fun
    lines = [line.split() for line in (DISC / "mesh.obj").read_text().splitlines()]
    V = np.array([line[1:4] for line in lines if line[:1] == ["v"]], dtype=float)
    F = np.array([[int(word.split("/")[0]) - 1 for word in line[1:4]] for line in lines if line[:1] == ["f"]])
    in_memory = coapt.minimize(V, F, [ELASTIC, PRESSURE], fixed="boundary", tol=1e-8)
    assert np.array_equal(in_memory.x, solved.x)


def test_stresses_as_papers_print_them(solved):
    fields = solved.fields
    s1, s2 = fields["cauchy_stress"].T
    assert np.all(s1 >= s2) and solved.metrics["max_cauchy_stress_kpa"] == pytest.approx(1000 * s1.max())
    assert np.allclose(fields["von_mises_stress"], np.sqrt(s1**2 - s1 * s2 + s2**2))
    assert solved.metrics["max_von_mises_stress_kpa"] == pytest.approx(1000 * fields["von_mises_stress"].max())
    assert "first_piola_stress" not in fields and "line_stress" not in fields
    # An isotropic law of constant volume: sigma = l^2 S, P = l S in each principal direction.
    asked = coapt.solve({**scene(), "output": {"first_piola_stress": True}}).fields
    stretch, second = 1 + asked["principal_strain"], asked["principal_stress"]
    assert np.allclose(asked["cauchy_stress"], stretch**2 * second) and np.allclose(asked["first_piola_stress"], stretch * second)


def test_chords_have_stress_and_strain():
    chain = coapt.solve(ROOT / "examples/03_catenary/scene.json")  # cross-section 10 mm2
    # Of constant volume: the force over A/l. No membrane: no other stress.
    fields = chain.fields
    assert np.allclose(fields["line_stress"], fields["line_force"] / 10 * (1 + fields["line_strain"]))
    assert chain.metrics["max_chord_stress_kpa"] == pytest.approx(1000 * fields["line_stress"].max())
    assert chain.metrics["max_cauchy_stress_kpa"] is None and "cauchy_stress" not in fields
    hem = {"type": "cable", "edges": "boundary", "tension": "1 mN"}
    pull = coapt.minimize(*disc(4), [ELASTIC, PRESSURE, hem], fixed="boundary").fields
    assert np.isnan(pull["line_stress"]).all() and np.isnan(pull["line_strain"]).all() and (pull["line_force"] > 0).all()


def test_arguments_win_over_the_scene():
    result = coapt.solve(scene(), method="lbfgs", tol=1e-3, modes=2)
    assert result.document["solver"]["type"] == "lbfgs" and result.document["solver"]["tolerance"] == 1e-3
    assert 1e-8 < result.residual <= 1e-3
    assert result.history.dtype.names == ("iteration", "round", "energy", "residual", "step", "seconds", "time",
                                          "evaluations")
    if coapt.components()["Spectra"]:
        assert len(result.certificate["smallest_eigenvalues"]) == 2


def test_writes_a_result_folder_only_where_one_is_asked_for(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    coapt.solve(scene())
    assert not list(tmp_path.iterdir())
    result = coapt.solve(scene(), folder=tmp_path / "out", report=False)
    assert {"result.json", "closed.vtp", "trace.csv"} <= {path.name for path in (tmp_path / "out").iterdir()}
    assert json.loads((tmp_path / "out/result.json").read_text())["energy_mj"] == result.fun


def test_every_defect_of_a_scene_is_said_in_one_pass(tmp_path):
    bad = scene()
    bad["terms"][0] = {**ELASTIC, "yuong": "1 MPa", "poisson": 0.7}
    with pytest.raises(coapt.InputError) as caught:
        coapt.solve(bad)
    assert len(caught.value.defects) == 2
    assert "scene: terms[0].yuong: unknown key" in str(caught.value) and "terms[0].poisson" in str(caught.value)
    for wrong, piece in ((tmp_path / "none.json", "none.json"), (7, "scene: is a int"), ({"name": {1}}, "holds a set"),
                         ({"terms": [], "mesh": 3}, "mesh")):
        with pytest.raises(coapt.InputError, match=piece):
            coapt.solve(wrong)
    with pytest.raises(coapt.InputError, match="belong to the scene"):
        coapt.solve(scene(), terms=[ELASTIC])


def slow(seconds: float, **more) -> coapt.Result:
    """Runs until its time limit: no machine reaches this tolerance."""
    return coapt.minimize(*disc(30), [ELASTIC, PRESSURE], fixed="boundary", tol=1e-300, method="lbfgs",
                          max_seconds=seconds, **more)


def test_ctrl_c_ends_a_run_at_once():
    start = time.monotonic()
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        slow(30)
    timer.join()
    assert time.monotonic() - start < 15


def test_ctrl_c_while_sliders_are_made_ends_the_run_with_its_files(tmp_path):
    coapt.generate_mitral(tmp_path, triangles=2500)
    page, stop = tmp_path / "out" / "report.html", threading.Event()

    def interrupt():
        while not page.exists() and not stop.is_set():  # at first without them
            time.sleep(0.005)
        os.kill(os.getpid(), signal.SIGINT)

    watcher = threading.Thread(target=interrupt)
    watcher.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            coapt.solve(tmp_path / "scene.json", folder=tmp_path / "out")
    finally:
        stop.set()
        watcher.join()
    assert page.read_text().endswith("</html>\n")
    assert json.loads((tmp_path / "out" / "result.json").read_text())["converged"]


def test_other_threads_run_during_a_solve():
    results = []
    threads = [threading.Thread(target=lambda: results.append(slow(0.5))) for _ in range(2)]
    for thread in threads:
        thread.start()
    ticks, start = 0, time.monotonic()
    while any(thread.is_alive() for thread in threads):
        ticks += 1
        time.sleep(0.01)
    assert ticks >= 5
    both = results[0].history, results[1].history
    count = min(map(len, both))
    assert count > 1 and np.array_equal(both[0]["energy"][:count], both[1]["energy"][:count])


def test_says_what_it_is():
    assert {"newton", "lbfgs", "bfgs"} <= set(coapt.methods())
    assert "BSD-3-Clause" in coapt.licence() and coapt.__version__.count(".") == 2
    assert coapt.scene_schema()["properties"]["terms"]
