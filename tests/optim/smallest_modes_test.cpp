#include "optim/stability/smallest_modes.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace {

using namespace coapt;

// A chain of nodes with springs of stiffness 1 + k/10 between neighbours, the first held by another; every
// third coordinate of the fifth node is prescribed. lift is added to the diagonal.
SparseMatrix chain(int nodes, double hold, double lift) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * nodes, 3 * nodes);
  for (int k = 0; k + 1 < nodes; ++k)
    for (int c = 0; c < 3; ++c) {
      const int a = 3 * k + c, b = a + 3;
      const double stiffness = (1 + 0.1 * k) * (1 + 0.3 * c);
      dense(a, a) += stiffness;
      dense(b, b) += stiffness;
      dense(b, a) -= stiffness;
    }
  for (int c = 0; c < 3; ++c) dense(c, c) += hold;
  dense.diagonal().array() += lift;
  dense.row(14).setZero();
  dense.col(14).setZero();
  dense(14, 14) = 1;
  SparseMatrix lower(3 * nodes, 3 * nodes);
  for (int column = 0; column < 3 * nodes; ++column)
    for (int row = 3 * (column / 3); row < std::min(3 * nodes, 3 * (column / 3) + 6); ++row)
      lower.insert(row, column) = row >= column ? dense(row, column) : dense(column, row);
  lower.makeCompressed();
  return lower;
}

// All eigenvalues but that of the prescribed coordinate.
Vector dense_eigenvalues(const SparseMatrix& lower) {
  Eigen::MatrixXd dense = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
  dense(14, 14) = 1e9;
  const Vector all = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues();
  return all.head(all.size() - 1);
}

class SmallestModes : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_smallest_modes()) GTEST_SKIP() << "built without Spectra";
  }
  static void expect_those_of_dense(const SparseMatrix& lower, int count) {
    const auto modes = smallest_modes(lower, count, make_eigen_factorisation);
    ASSERT_TRUE(modes.has_value());
    EXPECT_TRUE(modes->has_converged);
    ASSERT_EQ(modes->values.size(), count);
    const Vector expected = dense_eigenvalues(lower);
    for (int k = 0; k < count; ++k) {
      EXPECT_NEAR(modes->values[k], expected[k], 1e-8) << k;
      const Vector v = modes->vectors.col(k);
      EXPECT_LT((lower.selfadjointView<Eigen::Lower>() * v - modes->values[k] * v).norm(), 1e-6);
      EXPECT_NEAR(v.norm(), 1, 1e-10);
    }
  }
};

TEST_F(SmallestModes, AreThoseOfTheDenseMatrix) { expect_those_of_dense(chain(40, 0.5, 0), 6); }

TEST_F(SmallestModes, AreZeroWhereABodyIsFree) {
  const SparseMatrix lower = chain(40, 0, 0);
  const auto modes = smallest_modes(lower, 4, make_eigen_factorisation);
  ASSERT_TRUE(modes.has_value() && modes->has_converged);
  EXPECT_NEAR(modes->values[0], 0, 1e-9);
  EXPECT_NEAR(modes->values[1], 0, 1e-9);  // the third direction is held by the prescribed coordinate
  EXPECT_GT(modes->values[2], 1e-4);
}

TEST_F(SmallestModes, AreTheMostNegativeOfASaddle) { expect_those_of_dense(chain(40, 0.5, -0.8), 5); }

TEST_F(SmallestModes, AreOneFewerThanTheUnknownsAtMost) {
  const SparseMatrix lower = chain(6, 0.5, 0);
  const auto modes = smallest_modes(lower, 100, make_eigen_factorisation);
  ASSERT_TRUE(modes.has_value());
  EXPECT_EQ(modes->values.size(), 16);
}

TEST_F(SmallestModes, OfAMatrixThatIsNotANumberAreRefused) {
  SparseMatrix lower = chain(6, 0.5, 0);
  lower.coeffRef(3, 3) = kNaN;
  EXPECT_FALSE(smallest_modes(lower, 2, make_eigen_factorisation).has_value());
}

}  // namespace
