// What a factorisation promises, for each that the build has.
#include "linear/factorisation.hpp"

#include "energy/objective.hpp"
#include "support/sheets.hpp"
#include "valve/generators/mitral.hpp"

#ifdef COAPT_HAS_CHOLMOD
#include "optim/cholmod/cholmod_factorisation.hpp"
#endif

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <random>

namespace {

using namespace coapt;

struct Backend {
  std::string name;
  FactorisationFactory make;
};

void PrintTo(const Backend& backend, std::ostream* out) { *out << backend.name; }

std::vector<Backend> backends() {
  std::vector<Backend> all = {{"eigen", make_eigen_factorisation},
                              {"multifrontal", make_multifrontal_factorisation}};
#ifdef COAPT_HAS_CHOLMOD
  using Ordering = CholmodOptions::Ordering;
  all.push_back({"cholmod", [] { return make_cholmod_factorisation(); }});
  all.push_back({"cholmod_minimum_degree",
                 [] { return make_cholmod_factorisation({.ordering = Ordering::MinimumDegree}); }});
  all.push_back({"cholmod_nested_dissection",
                 [] { return make_cholmod_factorisation({.ordering = Ordering::NestedDissection}); }});
#endif
  return all;
}

// Tangent stiffness of a valve of StVK membrane in its open shape, stretched on all sides; the nodes of the
// annulus are prescribed, and of a few others one coordinate.
struct Stiffness {
  explicit Stiffness(int triangles, double stretch = 1.1) {
    MitralOptions options;
    options.preset = MitralPreset::Benchmark;
    options.triangles = triangles;
    const Valve valve = mitral_valve(options);
    const Points& X = valve.leaflets.vertices;
    const Triangles& t = valve.leaflets.triangles;
    FixedMask fixed = FixedMask::Constant(3, X.cols(), false);
    for (int node : valve.annulus) fixed.col(node).setConstant(true);
    for (int node = 7; node < X.cols(); node += 20) fixed(node % 3, node) = true;
    Objective objective(stretch * X, fixed, terms_of(sheet_term(SheetLaw::StVK, X, t, {0.8, 0.45, 0})));
    Vector g;
    objective.hessian(stretch * objective.unknowns(X), g, matrix);
  }

  void shift(double amount) {
    for (int k = 0; k < matrix.cols(); ++k) matrix.coeffRef(k, k) += amount;
  }

  Vector times(const Vector& x) const { return matrix.selfadjointView<Eigen::Lower>() * x; }

  SparseMatrix matrix;
};

Vector random_vector(Eigen::Index size) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  return Vector::NullaryExpr(size, [&] { return normal(generator); });
}

// One node; zeros are stored.
SparseMatrix block_matrix(const Eigen::Matrix3d& block) {
  SparseMatrix matrix(3, 3);
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) matrix.insert(row, column) = block(row, column);
  matrix.makeCompressed();
  return matrix;
}

class EachFactorisation : public testing::TestWithParam<Backend> {
 protected:
  std::unique_ptr<Factorisation> factor = GetParam().make();
};

TEST_P(EachFactorisation, SolvesToRoundOff) {
  Stiffness stiffness(2000);
  stiffness.shift(1e-3);
  const Vector expected = random_vector(stiffness.matrix.cols());
  const Vector b = stiffness.times(expected);
  factor->analyse(stiffness.matrix);
  ASSERT_TRUE(factor->factorise(stiffness.matrix));
  Vector x;
  factor->solve(b, x);
  EXPECT_LT((stiffness.times(x) - b).norm(), 1e-12 * b.norm());
  EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm());
}

TEST_P(EachFactorisation, SolvesInPlace) {
  Stiffness stiffness(300);
  Vector x = random_vector(stiffness.matrix.cols());
  const Vector b = x;
  factor->analyse(stiffness.matrix);
  ASSERT_TRUE(factor->factorise(stiffness.matrix));
  factor->solve(x, x);
  EXPECT_LT((stiffness.times(x) - b).norm(), 1e-11 * b.norm());
}

TEST_P(EachFactorisation, LeavesUnitRowsAlone) {
  Stiffness stiffness(300);
  factor->analyse(stiffness.matrix);
  ASSERT_TRUE(factor->factorise(stiffness.matrix));
  Vector b = random_vector(stiffness.matrix.cols()), x;
  factor->solve(b, x);
  int unit_rows = 0;
  for (int k = 0; k < b.size(); ++k) {
    if (stiffness.times(Vector::Unit(b.size(), k)) != Vector::Unit(b.size(), k)) continue;
    ++unit_rows;
    EXPECT_DOUBLE_EQ(x[k], b[k]);
  }
  EXPECT_GT(unit_rows, 5);
}

TEST_P(EachFactorisation, RefusesAnIndefiniteMatrixAndWorksAfterwards) {
  Stiffness stiffness(600), indefinite = stiffness;
  indefinite.shift(-0.05);
  factor->analyse(stiffness.matrix);
  const Vector b = random_vector(stiffness.matrix.cols());
  Vector first, again;
  ASSERT_TRUE(factor->factorise(stiffness.matrix));
  factor->solve(b, first);
  for (int repeat = 0; repeat < 3; ++repeat) {
    EXPECT_FALSE(factor->factorise(indefinite.matrix));
    ASSERT_TRUE(factor->factorise(stiffness.matrix));
    factor->solve(b, again);
    EXPECT_EQ(first, again);
  }
}

TEST_P(EachFactorisation, RefusesTheFirstMatrixAndTakesTheSecond) {
  Stiffness stiffness(600), indefinite = stiffness;
  indefinite.shift(-0.05);
  factor->analyse(stiffness.matrix);
  EXPECT_FALSE(factor->factorise(indefinite.matrix));
  EXPECT_TRUE(factor->factorise(stiffness.matrix));
}

TEST_P(EachFactorisation, RefusesNumbersThatAreNone) {
  Stiffness stiffness(300);
  factor->analyse(stiffness.matrix);
  for (double wrong : {kNaN, kInfinity}) {
    Stiffness spoilt = stiffness;
    spoilt.matrix.coeffRef(60, 60) = wrong;
    EXPECT_FALSE(factor->factorise(spoilt.matrix)) << wrong;
  }
  EXPECT_TRUE(factor->factorise(stiffness.matrix));
}

TEST_P(EachFactorisation, AnswersTheSameBitsEveryTime) {
  Stiffness stiffness(2000);
  factor->analyse(stiffness.matrix);
  const Vector b = random_vector(stiffness.matrix.cols());
  Vector first, x;
  for (int repeat = 0; repeat < 20; ++repeat) {
    Stiffness other = stiffness;
    other.shift(0.01 * (repeat % 4));
    ASSERT_TRUE(factor->factorise(other.matrix));
    factor->solve(b, x);
    if (repeat == 0) first = x;
    if (repeat % 4 == 0) {
      EXPECT_EQ(x, first) << repeat;
    }
  }
}

TEST_P(EachFactorisation, CountsTheSignsOfTheEigenvalues) {
  Stiffness stiffness(200, 0.9);  // compressed: indefinite
  factor->analyse(stiffness.matrix);
  const Eigen::MatrixXd dense = Eigen::MatrixXd(stiffness.matrix).selfadjointView<Eigen::Lower>();
  const Vector eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues();
  const auto negative = (eigenvalues.array() < 0).count();
  ASSERT_GT(negative, 0);
  ASSERT_GT(eigenvalues.cwiseAbs().minCoeff(), 1e-9);
  const Inertia inertia = factor->inertia(stiffness.matrix);
  EXPECT_EQ(inertia.negative, negative);
  EXPECT_EQ(inertia.zero, 0);
  EXPECT_EQ(inertia.positive, dense.cols() - negative);

  Stiffness definite(200);
  const Inertia positive = factor->inertia(definite.matrix);
  EXPECT_EQ(positive.negative, 0);
  EXPECT_EQ(positive.positive, dense.cols());
}

TEST_P(EachFactorisation, SaysNothingBeyondAVanishingPivot) {
  const SparseMatrix matrix = block_matrix(Vec3(1, 0, -1).asDiagonal());
  factor->analyse(matrix);
  const Inertia inertia = factor->inertia(matrix);
  EXPECT_EQ(inertia.positive, 1);
  EXPECT_EQ(inertia.zero, 2);
}

TEST_P(EachFactorisation, PivotRatioIsThatOfTheFactor) {
  const SparseMatrix matrix = block_matrix(Vec3(4, 0.01, 100).asDiagonal());
  factor->analyse(matrix);
  ASSERT_TRUE(factor->factorise(matrix));
  EXPECT_DOUBLE_EQ(factor->pivot_ratio(), 1e-4);
  Stiffness stiffness(200);
  factor->analyse(stiffness.matrix);
  ASSERT_TRUE(factor->factorise(stiffness.matrix));
  const Eigen::MatrixXd dense = Eigen::MatrixXd(stiffness.matrix).selfadjointView<Eigen::Lower>();
  const Vector eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues();
  EXPECT_GE(factor->pivot_ratio(), eigenvalues.minCoeff() / eigenvalues.maxCoeff());
  EXPECT_LE(factor->pivot_ratio(), 1);
}

TEST_P(EachFactorisation, TakesTheEmptyMatrixAndASingleNode) {
  const SparseMatrix empty(0, 0);
  factor->analyse(empty);
  EXPECT_TRUE(factor->factorise(empty));
  Vector x;
  factor->solve(Vector(0), x);
  EXPECT_EQ(x.size(), 0);
  EXPECT_EQ(factor->inertia(empty).positive, 0);

  Eigen::Matrix3d block;
  block << 4, 1, 0, 1, 3, 1, 0, 1, 2;
  const SparseMatrix single = block_matrix(block);
  factor->analyse(single);
  ASSERT_TRUE(factor->factorise(single));
  factor->solve(Vec3(1, 2, 3), x);
  EXPECT_LT((block * x - Vec3(1, 2, 3)).norm(), 1e-14);
}

TEST_P(EachFactorisation, ReadsTheLowerTriangleOnly) {
  Stiffness stiffness(300), spoilt = stiffness;
  for (int column = 0; column < spoilt.matrix.cols(); ++column)
    for (SparseMatrix::InnerIterator entry(spoilt.matrix, column); entry; ++entry)
      if (entry.row() < column) entry.valueRef() = 1e9;
  factor->analyse(stiffness.matrix);
  const Vector b = random_vector(stiffness.matrix.cols());
  Vector x, y;
  ASSERT_TRUE(factor->factorise(stiffness.matrix));
  factor->solve(b, x);
  ASSERT_TRUE(factor->factorise(spoilt.matrix));
  factor->solve(b, y);
  EXPECT_EQ(x, y);
}

TEST_P(EachFactorisation, RefusesAPatternThatIsNotOfNodes) {
  SparseMatrix odd(4, 4), sparse(3, 3);
  odd.setIdentity();
  sparse.setIdentity();
  EXPECT_ANY_THROW(factor->analyse(odd));
  EXPECT_ANY_THROW(factor->analyse(sparse));
}

INSTANTIATE_TEST_SUITE_P(Backends, EachFactorisation, testing::ValuesIn(backends()),
                         [](const auto& backend) { return backend.param.name; });

#ifdef COAPT_HAS_CHOLMOD
// Linked with Ceres, whose own BLAS is another.
TEST(Cholmod, TakesItsKernelsFromOpenBlas) { EXPECT_EQ(blas_library().substr(0, 11), "libopenblas"); }

TEST(Cholmod, AgreesWithEigenOnTheInertia) {
  Stiffness stiffness(3000, 0.95);
  const auto eigen = make_eigen_factorisation(), cholmod = make_cholmod_factorisation();
  eigen->analyse(stiffness.matrix);
  cholmod->analyse(stiffness.matrix);
  EXPECT_EQ(eigen->inertia(stiffness.matrix).negative, cholmod->inertia(stiffness.matrix).negative);
}
#endif

}  // namespace
