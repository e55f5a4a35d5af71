// The lowest modes of a symmetric matrix, and with its skew part the eigenvalues that decide on stability,
// against dense methods.
#include "linear/lowest_eigenvalues.hpp"

#include "linear/krylov_basis.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace coapt {
namespace {

constexpr double kZero = 1e-6;

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

// K with given eigenvalues, all of its blocks full.
struct Symmetric {
  Symmetric(const Eigen::VectorXd& values, std::mt19937& random) {
    const Eigen::Index size = values.size();
    const Eigen::MatrixXd turn =
        Eigen::HouseholderQR<Eigen::MatrixXd>(random_matrix(size, size, random)).householderQ();
    whole = turn * values.asDiagonal() * turn.transpose();
    whole = (0.5 * (whole + whole.transpose())).eval();
    lower.resize(size, size);
    for (int column = 0; column < size; ++column)
      for (int row = 3 * (column / 3); row < size; ++row) lower.insert(row, column) = whole(row, column);
    lower.makeCompressed();
    factor->analyse(lower);
  }

  LowestModes modes(double shift) const {
    Eigen::MatrixXd starts(lower.cols(), 2);
    for (Eigen::Index k = 0; k < starts.rows(); ++k)
      starts.row(k) << 1 + 0.5 * std::sin(1.7 * k * k), 1 + 0.5 * std::sin(1.7 * k * k + 2);
    return lowest_modes(lower, kZero, shift, starts, *factor);
  }

  // The lowest eigenvalue on what is orthogonal to some vectors.
  double lowest_beside(const Eigen::MatrixXd& vectors) const {
    const Eigen::MatrixXd all = Eigen::HouseholderQR<Eigen::MatrixXd>(vectors).householderQ();
    const auto others = all.rightCols(all.cols() - vectors.cols());
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(others.transpose() * whole * others)
        .eigenvalues()[0];
  }

  Eigen::MatrixXd whole;
  SparseMatrix lower;
  std::unique_ptr<Factorisation> factor = make_multifrontal_factorisation();
};

// Some negative eigenvalues, many soft ones and some stiff ones.
Eigen::VectorXd many_soft(int negative, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform;
  Eigen::VectorXd values(300);
  for (int k = 0; k < values.size(); ++k)
    values[k] = k < negative ? -0.002 * uniform(random) - 1e-4 : std::pow(10.0, 5 * uniform(random) - 3);
  return values;
}

// Between the coordinates of every eighteenth node.
Eigen::MatrixXd skew_on_few_nodes(Eigen::Index size, double greatest, std::mt19937& random) {
  std::vector<Eigen::Index> coupled;
  for (Eigen::Index k = 0; k < size; ++k)
    if (k / 3 % 18 == 0) coupled.push_back(k);
  const auto count = static_cast<Eigen::Index>(coupled.size());
  const Eigen::MatrixXd part = random_matrix(count, count, random);
  Eigen::MatrixXd skew = Eigen::MatrixXd::Zero(size, size);
  skew(coupled, coupled) = greatest * (part - part.transpose());
  return skew;
}

TEST(KrylovBasis, HoldsOrthonormalVectorsThatSpanWhatWasAppended) {
  std::mt19937 random(1);
  const Eigen::MatrixXd first = random_matrix(50, 4, random), second = random_matrix(50, 300, random);
  KrylovBasis basis(50);
  basis.append(first);
  EXPECT_EQ(basis.count(), 4);
  basis.append(1e-9 * first + 1e-14 * random_matrix(50, 4, random));  // all but dependent
  EXPECT_EQ(basis.last().cols(), basis.count() - 4);
  basis.append(first * random_matrix(4, 3, random));
  EXPECT_EQ(basis.last().cols(), 0);
  basis.append(second);  // of more than 50 vectors, no more than 50 are independent
  ASSERT_EQ(basis.count(), 50);
  EXPECT_LT((basis.vectors().transpose() * basis.vectors() - Eigen::MatrixXd::Identity(50, 50)).norm(),
            1e-12);
}

class LowestModesOf : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Negative, LowestModesOf, testing::Values(1, 2, 5, 11, 24));

TEST_P(LowestModesOf, AMatrixLeaveNothingNegativeBeside) {
  std::mt19937 random(static_cast<unsigned>(GetParam()));
  const Eigen::VectorXd values = many_soft(GetParam(), random);
  const Symmetric matrix(values, random);
  for (const double shift : {0.0025, 0.02}) {  // of which the second is replaced by a smaller one
    const LowestModes modes = matrix.modes(shift);
    ASSERT_TRUE(modes.is_complete);
    EXPECT_EQ((modes.values.array() < 0).count(), GetParam());
    EXPECT_NEAR(modes.values[0], values.head(GetParam()).minCoeff(), 1e-6);
    EXPECT_LE(modes.shift, 3 * std::abs(modes.values[0]) + 1e-12);
    const auto negative = modes.vectors.leftCols(GetParam());
    EXPECT_GE(matrix.lowest_beside(negative), -1e-12);
    EXPECT_GE(matrix.lowest_beside(modes.vectors), -1e-12);
  }
}

// Blocks of two begin with two vectors: they see two modes of an eigenvalue, and others by new starts.
TEST(LowestModes, OfRepeatedEigenvaluesAreAllFound) {
  std::mt19937 random(3);
  Eigen::VectorXd values = Eigen::VectorXd::Ones(300);
  values.head(7) << -0.01, -0.01, -0.01, -0.01, -0.01, -0.002, -0.002;
  const Symmetric matrix(values, random);
  const LowestModes modes = matrix.modes(0.02);
  ASSERT_TRUE(modes.is_complete);
  EXPECT_EQ((modes.values.array() < 0).count(), 7);
  EXPECT_GE(matrix.lowest_beside(modes.vectors.leftCols(7)), -1e-12);
}

// The skew part takes negative eigenvalues away and moves others off the axis.
TEST(LowestEigenvalues, CountAsManyUnstableOnesAsADenseMethod) {
  int stable = 0, unstable = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const Symmetric matrix(many_soft(1 + static_cast<int>(seed % 3), random), random);
    const double greatest = std::pow(10.0, static_cast<double>(seed % 5) - 2.5);
    const Eigen::MatrixXd skew = skew_on_few_nodes(300, greatest, random);
    const SkewProduct product = [&](const Vector& v, Vector& out) { out += skew * v; };
    const LowestModes modes = matrix.modes(0.0025);
    ASSERT_TRUE(modes.is_complete);
    const LowestEigenvalues found = lowest_eigenvalues(matrix.lower, product, Vector::Ones(300), modes, kZero,
                                                       std::make_shared<ThreadTeam>());
    ASSERT_TRUE(found.is_complete) << "seed " << seed;
    const Eigen::VectorXcd exact = (matrix.whole + skew).eigenvalues();
    const auto count = [](const Eigen::VectorXcd& values) {
      return (values.real().array() < -kZero).count();
    };
    EXPECT_EQ(count(found.values), count(exact)) << "seed " << seed;
    EXPECT_NEAR(found.values[0].real(), exact.real().minCoeff(), 10 * kZero) << "seed " << seed;
    ++(count(exact) > 0 ? unstable : stable);
  }
  EXPECT_GE(stable, 5);
  EXPECT_GE(unstable, 5);
}

}  // namespace
}  // namespace coapt
