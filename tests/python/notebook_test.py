"""What a notebook has of a result: pictures, tables, progress, and the shape for other packages."""
import base64
import contextlib
import io
import pickle
import re
import sys
import types

import numpy as np
import pytest
from matplotlib import image, pyplot
from matplotlib.collections import PolyCollection

import coapt
from meshes import ELASTIC, PRESSURE, ROOT, disc
from valves import followed, scene_file


@pytest.fixture(scope="module")
def dome():
    cables = {"type": "cable", "edges": "boundary", "tension": "1 mN"}
    return coapt.minimize(*disc(6), [ELASTIC, PRESSURE, cables], fixed="boundary")


@pytest.fixture(autouse=True)
def no_figures_left():
    yield
    pyplot.close("all")


def drawn(axes):
    return next(c for c in axes.collections if isinstance(c, PolyCollection))


def pixels(html):
    data = re.search(r'src="data:image/png;base64,([^"]+)"', html)[1]
    return image.imread(io.BytesIO(base64.b64decode(data)))


def test_a_shape_is_drawn_in_true_proportion_with_the_near_before_the_far(dome):
    axes = coapt.plot.shape(dome, color=None, view=(90, -90), lines=False)
    paths = drawn(axes).get_paths()
    assert len(paths) == len(dome.faces) and axes.get_aspect() == 1
    assert axes.dataLim.width == pytest.approx(20) and axes.dataLim.height == pytest.approx(20)  # a unit is a mm
    middles = np.array([path.vertices[:3].mean(axis=0) for path in paths])
    centres = dome.x[dome.faces].mean(axis=1)
    which = np.linalg.norm(middles[:, None] - centres[None, :, :2], axis=2).argmin(axis=1)
    assert middles == pytest.approx(centres[which, :2], abs=1e-12) and len(set(which)) == len(which)
    assert np.diff(centres[which, 2]).min() > -1e-9 and np.ptp(centres[:, 2]) > 1  # from above the highest comes last
    side = coapt.plot.shape(dome, color=None, view=(0, -90), lines=False)
    assert side.dataLim.height == pytest.approx(np.ptp(dome.x[:, 2]))


def test_colours_are_those_of_a_field_and_have_a_scale(dome):
    axes = coapt.plot.shape(dome, view=(90, -90), lines=False)
    bar = axes.figure.axes[1]
    assert bar.get_ylabel() == "greatest principal strain"
    strain = dome.fields["principal_strain"][:, 0]
    assert bar.get_ylim() == pytest.approx((strain.min(), strain.max()))
    own = coapt.plot.shape(dome, color=dome.x[:, 2], lines=False)
    assert own.figure.axes[1].get_ylim()[1] == pytest.approx(dome.x[dome.faces, 2].mean(axis=1).max())
    for color in ("displacement", "cauchy_stress", "von_mises_stress", np.arange(len(dome.faces))):
        assert len(coapt.plot.shape(dome, color=color).figure.axes) == 2
    with pytest.raises(coapt.InputError, match="color: is 'strain'; expected one of cauchy_stress, displacement"):
        coapt.plot.shape(dome, color="strain")
    with pytest.raises(coapt.InputError, match=r"color: has shape \(3,\); expected a number for each of 216 triangles or 127"):
        coapt.plot.shape(dome, color=[1, 2, 3])


def test_lines_are_in_front_of_what_is_behind_them():
    axes = coapt.plot.shape(coapt.solve(ROOT / "examples/03_catenary/scene.json"))
    assert len(drawn(axes).get_paths()) > 50 and axes.dataLim.height > 0
    result = coapt.solve(scene_file())
    axes = coapt.plot.shape(result, color="gap", view=(10, 0))
    assert len(drawn(axes).get_paths()) == len(result.faces) + 8 * len(result.lines)
    assert drawn(axes).get_facecolor()[:, 3].min() == 0  # lines; triangles without a gap are grey
    nothing = np.isnan(result.fields["gap"][result.faces].mean(axis=1)).sum()
    grey = np.ptp(drawn(axes).get_facecolor()[:, :3], axis=1) < 0.12
    assert nothing > 0 and (grey & (drawn(axes).get_facecolor()[:, 3] == 1)).sum() == nothing
    widths = drawn(axes).get_linewidth()
    assert (np.diff(np.flatnonzero(np.array(widths) > 1)) > 1).any()  # not all on top


def test_a_result_shows_itself_with_its_picture(dome):
    html = dome._repr_html_()
    picture = pixels(html)
    assert picture.shape[0] > 200 and picture.shape[1] > 300
    background, ink = picture[0, 0], np.abs(picture - picture[0, 0]).max(axis=2) > 0.1
    assert background[:3].min() > 0.99 and 0.1 < ink.mean() < 0.9
    for text in (dome.message, f"{dome.fun:.6g} mJ", "strict minimum", "127 nodes, 216 triangles, 36 lines", "max displacement"):
        assert text in html
    assert not pyplot.get_fignums()


def test_warnings_come_first_and_texts_are_quoted(dome):
    told = coapt.Result(dome, warnings=["a < b & \"c\""], success=False)
    html = told._repr_html_()
    assert "NOT converged" in html and html.index("a &lt; b &amp;") < html.index("<img")


def test_a_valve_that_stands_open_is_not_shown_as_plainly_converged(tmp_path):
    file = coapt.generate_mitral(tmp_path, triangles=200, preset="benchmark")
    text = file.read_text()
    file.write_text(text.replace('"side": "front"', '"side": "back"'))
    assert file.read_text() != text
    wide = coapt.solve(file)
    assert wide.success and any("the valve stands open" in doubt for doubt in wide.doubts)
    for shown in (repr(wide), wide._repr_html_(), wide.headline):
        assert "the valve stands open" in shown
    assert "color:#8a5200" in wide._repr_html_()
    again = pickle.loads(pickle.dumps(wide))
    assert again.doubts == wide.doubts and again.headline == wide.headline


def test_a_plain_result_has_no_doubts(dome):
    assert dome.doubts == [] and dome.headline == dome.message and "color" not in dome._repr_html_().split("<img")[0]


def test_without_matplotlib_the_figures_are_there(dome, monkeypatch):
    for name in [name for name in sys.modules if name.split(".")[0] == "matplotlib"]:
        monkeypatch.setitem(sys.modules, name, None)
    html = dome._repr_html_()
    assert "python3-matplotlib" in html and "<img" not in html and "127 nodes" in html
    with pytest.raises(ImportError, match=r"coapt.plot needs the package matplotlib.*python3-matplotlib"):
        coapt.plot.shape(dome)


def test_an_equilibrium_shows_itself_too():
    eq = followed()
    html = eq._repr_html_()
    assert "chords.length" in html and "papillary.shift" in html and pixels(html).std() > 0.05
    assert repr(eq).startswith("<coapt.Equilibrium: ") and "leaflets.stiffness" in repr(eq)


class StandIn(types.ModuleType):
    """PyVista as far as the surface that is made of a result goes: counted cells, and data as long as these."""

    class PolyData:
        def __init__(self, points, faces=None, lines=None):
            self.points = np.asarray(points)
            self.faces, self.lines = self.read(faces, 3), self.read(lines, 2)
            self.point_data, self.cell_data = {}, {}

        @staticmethod
        def read(cells, width):
            if cells is None:
                return np.empty((0, width), int)
            assert cells.ndim == 1 and cells.dtype.kind == "i"
            rows = cells.reshape(-1, width + 1)
            assert (rows[:, 0] == width).all()
            return rows[:, 1:]


def test_pyvista_gets_the_shape_with_its_fields(dome, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", StandIn("pyvista"))
    mesh = dome.to_pyvista()
    assert np.array_equal(mesh.points, dome.x)
    assert np.array_equal(mesh.faces, dome.faces) and np.array_equal(mesh.lines, dome.lines)
    assert len(mesh.faces) == 216 and len(mesh.lines) == 36
    assert np.array_equal(mesh.point_data["displacement"], dome.fields["displacement"])
    for name, values in mesh.cell_data.items():  # lines first, as VTK counts
        assert len(values) == 36 + 216, name
    assert np.array_equal(mesh.cell_data["cauchy_stress"][36:], dome.fields["cauchy_stress"])
    assert np.isnan(mesh.cell_data["cauchy_stress"][:36]).all()
    assert np.array_equal(mesh.cell_data["line_force"][:36], dome.fields["line_force"])
    chain = coapt.solve(ROOT / "examples/03_catenary/scene.json").to_pyvista()
    assert not len(chain.faces) and len(chain.cell_data["line_force"]) == len(chain.lines) > 0


def test_the_real_pyvista_takes_it(dome):
    pytest.importorskip("pyvista", reason="PyVista is not installed: to_pyvista() is tested with a stand-in alone")
    mesh = dome.to_pyvista()
    assert mesh.n_cells == 252 and np.array_equal(mesh.regular_faces, dome.faces)
    triangles = mesh.extract_cells(np.arange(36, 252))
    assert np.array_equal(triangles.cell_data["cauchy_stress"], dome.fields["cauchy_stress"])


def test_nothing_but_to_pyvista_needs_pyvista(dome, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match=r"to_pyvista\(\) needs the package pyvista"):
        dome.to_pyvista()


class Bar:
    made = []

    def __init__(self, **settings):
        self.n, self.texts, self.is_open, self.settings = 0, [], True, settings
        Bar.made.append(self)

    def update(self, steps):
        self.n += steps

    def set_postfix_str(self, text, refresh=True):
        self.texts.append(text)

    def close(self):
        self.is_open = False


@pytest.fixture
def bars(monkeypatch):
    module = types.ModuleType("tqdm.auto")
    module.tqdm = Bar
    monkeypatch.setitem(sys.modules, "tqdm.auto", module)
    Bar.made = []
    return Bar.made


def test_progress_follows_the_iterates_beside_a_callback(bars):
    seen = []
    result = coapt.minimize(*disc(4), [ELASTIC, PRESSURE], fixed="boundary", progress=True,
                            callback=lambda at: seen.append(at.residual))
    (bar,) = bars
    assert bar.n == len(bar.texts) == len(seen) > 3 and not bar.is_open
    assert bar.texts[-1] == f"residual {seen[-1]:.1e}" and result.success
    assert not coapt.minimize(*disc(4), [ELASTIC, PRESSURE], fixed="boundary", progress=True, callback=lambda at: False).success


def test_progress_ends_with_what_a_callback_raises(bars):
    def fail(at):
        raise ArithmeticError("mine")

    with pytest.raises(ArithmeticError, match="mine"):
        coapt.solve(scene_file(), progress=True, callback=fail)
    assert not bars[0].is_open


def test_progress_is_silent_unless_asked_for_and_without_tqdm(bars, monkeypatch):
    coapt.minimize(*disc(2), [ELASTIC, PRESSURE], fixed="boundary")
    assert not bars
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with contextlib.redirect_stderr(io.StringIO()) as told:
        assert coapt.minimize(*disc(2), [ELASTIC, PRESSURE], fixed="boundary", progress=True).success
    assert told.getvalue() == ""


def test_the_bar_of_tqdm_is_written(capfd):
    pytest.importorskip("tqdm", reason="python3-tqdm is not installed: progress is tested with a stand-in alone")
    coapt.minimize(*disc(4), [ELASTIC, PRESSURE], fixed="boundary", progress=True)
    told = capfd.readouterr()
    assert "coapt: " in told.err and "residual " in told.err and told.out == ""
