"""Energies of the caller's own beside those of the library."""
import numpy as np
import pytest
import scipy.sparse

import coapt
from meshes import ELASTIC, PRESSURE, disc, edges, square


class Springs(coapt.Term):
    """Half a stiffness times the square of the elongation of each edge."""

    def __init__(self, x, triangles, stiffness=0.05):
        self.elements, self.stiffness = edges(triangles), stiffness
        self.rest = 0.9 * self.state(x)[1]

    def state(self, x):
        along = x[self.elements[:, 1]] - x[self.elements[:, 0]]
        length = np.linalg.norm(along, axis=1)
        return along / length[:, None], length

    def value(self, x):
        return 0.5 * self.stiffness * ((self.state(x)[1] - self.rest) ** 2).sum()

    def gradient(self, x):
        unit, length = self.state(x)
        pull = self.stiffness * (length - self.rest)[:, None] * unit
        gradient = np.zeros_like(x)
        np.add.at(gradient, self.elements[:, 1], pull)
        np.subtract.at(gradient, self.elements[:, 0], pull)
        return gradient

    def hessian(self, x):
        unit, length = self.state(x)
        outer = unit[:, :, None] * unit[:, None, :]
        tension = (1 - self.rest / length)[:, None, None]
        block = self.stiffness * (tension * np.eye(3) + (1 - tension) * outer)
        return np.block([[block, -block], [-block, block]])


class SparseSprings(Springs):
    elements = None

    def hessian(self, x):
        blocks = super().hessian(x)
        dof = (3 * self.elements[:, :, None] + np.arange(3)).reshape(len(blocks), 6)
        rows, columns = np.repeat(dof, 6, axis=1), np.tile(dof, (1, 6))
        return scipy.sparse.coo_matrix((blocks.ravel(), (rows.ravel(), columns.ravel())), shape=(x.size, x.size))


class Weight(coapt.Term):
    role = "load"

    def __init__(self, force):
        self.force = force  # on each node, downward [N]

    def value(self, x):
        return self.force * x[:, 2].sum()

    def gradient(self, x):
        return np.broadcast_to([0, 0, self.force], x.shape)

    def hessian(self, x):
        return scipy.sparse.csr_matrix((x.size, x.size))


@pytest.fixture(scope="module")
def hung():
    V, F = square(5)
    return V, F, coapt.minimize(V, F, [Springs(V, F), Weight(0.001)], fixed="boundary", tol=1e-10)


def test_springs_in_python_find_the_same_shape_with_every_kind_of_hessian(hung):
    V, F, dense = hung
    assert dense.success and dense.x[:, 2].min() < -0.1
    assert dense.certificate["stability"] == "strict_minimum"
    sparse = coapt.minimize(V, F, [SparseSprings(V, F), Weight(0.001)], fixed="boundary", tol=1e-10)
    assert sparse.success and abs(sparse.nit - dense.nit) <= 2
    none = Springs(V, F)
    none.hessian = None
    first_order = coapt.minimize(V, F, [none, Weight(0.001)], fixed="boundary", tol=1e-10, method="lbfgs")
    assert first_order.success
    for other in (sparse, first_order):
        assert np.abs(other.x - dense.x).max() < 1e-8


def test_a_load_in_python_is_that_of_the_library(hung):
    V, F, _ = hung
    scene = {"type": "load_field", "direction": [0, 0, -1], "force": "0.01 N", "nodes": "all"}
    ours = coapt.minimize(V, F, [ELASTIC, scene], fixed="boundary", tol=1e-10)
    mine = coapt.minimize(V, F, [ELASTIC, Weight(0.01)], fixed="boundary", tol=1e-10)
    assert ours.success and mine.success and ours.x[:, 2].min() < -0.1
    assert np.abs(mine.x - ours.x).max() < 1e-8
    assert mine.energies["Weight"] == pytest.approx(0.01 * mine.x[:, 2].sum(), rel=1e-9)


def test_terms_stand_beside_those_of_a_scene_far_from_the_origin():
    V, F = disc(4)
    far = V + [1e4, -2e4, 3e4]

    class Floor(coapt.Term):  # an elastic foundation under the rest shape, in the coordinates of the input
        role = "contact"

        def value(self, x):
            return 0.5e-3 * ((x - far) ** 2).sum()

        def gradient(self, x):
            return 1e-3 * (x - far)

        def hessian(self, x):
            return 1e-3 * scipy.sparse.eye(x.size)

    free = coapt.minimize(far, F, [ELASTIC, PRESSURE], fixed="boundary", tol=1e-9)
    held = coapt.minimize(far, F, [ELASTIC, Floor(), PRESSURE], fixed="boundary", tol=1e-9)
    assert free.success and held.success
    assert 0.1 < held.x[0, 2] - 3e4 < 0.9 * (free.x[0, 2] - 3e4)
    assert held.energies["Floor"] == pytest.approx(0.5e-3 * ((held.x - far) ** 2).sum(), rel=1e-6)


def test_the_check_of_derivatives_knows_right_from_wrong():
    V, F = square(3)
    x = V * 1.1 + np.sin(np.arange(V.size)).reshape(V.shape) / 10
    for term in (Springs(V, F), SparseSprings(V, F)):
        report = coapt.check_term(term, x)
        assert report["passed"] and report["gradient_norm"] > 0 and report["hessian_slope"] > 2.9, report
    wrong = Springs(V, F)
    wrong.gradient = lambda x: 1.001 * Springs.gradient(wrong, x)
    assert not coapt.check_term(wrong, x)["passed"]
    wrong = Springs(V, F)
    wrong.hessian = lambda x: 1.001 * Springs.hessian(wrong, x)
    report = coapt.check_term(wrong, x)
    assert not report["passed"] and report["gradient_error"] < 1e-7
    wrong.hessian = None
    assert coapt.check_term(wrong, x)["passed"]


def test_projected_blocks_have_no_negative_eigenvalue():
    V, F = square(3)
    blocks = Springs(V, F).hessian(0.5 * V)  # compressed: indefinite
    from coapt._terms import projected
    assert np.linalg.eigvalsh(blocks).min() < -1e-3
    assert np.linalg.eigvalsh(projected(blocks)).min() > -1e-15


def test_what_a_term_raises_reaches_the_caller():
    V, F = square(3)
    error = ArithmeticError("mine")
    for method in ("value", "gradient", "hessian"):
        term = Springs(V, F)

        def fail(x):
            raise error
        setattr(term, method, fail)
        with pytest.raises(ArithmeticError) as caught:
            coapt.minimize(V, F, [term, PRESSURE], fixed="boundary")
        assert caught.value is error


def test_a_term_without_hessian_is_refused_where_one_is_needed():
    V, F = square(3)
    term = Springs(V, F)
    term.hessian = None
    with pytest.raises(coapt.InputError, match='"Springs": has no hessian.*"lbfgs"'):
        coapt.minimize(V, F, [term, PRESSURE], fixed="boundary", method="newton")


@pytest.mark.parametrize(("name", "value", "piece"), [
    ("gradient", lambda x: x.T, r"gradient\(\) returned shape \(3, 16\).*expected numbers of shape \(16, 3\)"),
    ("gradient", lambda x: x.astype(str), "gradient\\(\\) returned shape .* of <U"),
    ("value", lambda x: x, "value\\(\\) returned a ndarray; expected a number"),
    ("hessian", lambda x: np.zeros((1, 6, 6)), r"hessian\(\) returned shape \(1, 6, 6\).*a block for each element"),
    ("hessian", lambda x: scipy.sparse.eye(4), r"hessian\(\) returned a matrix of shape \(4, 4\).*\(48, 48\)"),
    ("elements", [[0, 99]], "elements: node 99 does not exist"),
    ("elements", [0.5], "elements: expected integers"),
    ("role", "pull", "role: is 'pull'"),
])
def test_wrong_shapes_name_the_term_and_what_was_expected(name, value, piece):
    V, F = square(3)
    term = Springs(V, F)
    setattr(term, name, value)
    with pytest.raises(coapt.InputError, match=piece):
        coapt.minimize(V, F, [term, PRESSURE], fixed="boundary")


def test_defects_of_scene_terms_keep_their_number_among_others():
    V, F = square(3)
    with pytest.raises(coapt.InputError, match=r"terms\[1\]\.yuong"):
        coapt.minimize(V, F, [Springs(V, F), {**ELASTIC, "yuong": "1 MPa"}, PRESSURE], fixed="boundary")
    with pytest.raises(coapt.InputError, match="Springs.*another term has this name"):
        coapt.minimize(V, F, [Springs(V, F), Springs(V, F), PRESSURE], fixed="boundary")


def test_kept_positions_do_not_change_under_the_caller():
    V, F = square(3)
    kept = []

    class Keeper(Springs):
        def value(self, x):
            kept.append((x, x.copy()))
            return super().value(x)

    coapt.minimize(V, F, [Keeper(V, F), PRESSURE], fixed="boundary")
    assert len(kept) > 3 and all(np.array_equal(*pair) for pair in kept)
    with pytest.raises(ValueError, match="read-only"):
        kept[0][0][0] = 1
