// The lowest modes of a symmetric matrix, and with its skew part the eigenvalues that decide on stability,
// against dense methods.
#include "linear/lowest_eigenvalues.hpp"

#include "linear/krylov_basis.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

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

TEST(KrylovBasis, HoldsOrthonormalVectorsThatSpanWhatWasAppended) {
  std::mt19937 random(1);
  const Eigen::MatrixXd first = random_matrix(50, 4, random), second = random_matrix(50, 300, random);
  KrylovBasis basis(50);
  basis.append(first);
  EXPECT_EQ(basis.count(), 4);
  basis.append(1e-9 * first + 1e-14 * random_matrix(50, 4, random));  // all but dependent
  EXPECT_EQ(basis.count(), 8);
  EXPECT_EQ(basis.last().cols(), 4);
  Eigen::MatrixXd dependent = random_matrix(50, 4, random);
  dependent.col(1) = dependent.col(0) + 1e-9 * dependent.col(2);  // on the others of its own block
  dependent.col(3).setZero();
  basis.append(dependent);
  EXPECT_EQ(basis.count(), 11);
  EXPECT_LT((basis.vectors().transpose() * basis.vectors() - Eigen::MatrixXd::Identity(11, 11)).norm(),
            1e-13);
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

// A large sparse tangent whose eigenvalues are known: groups of coordinates that W couples among themselves
// alone, some with negative eigenvalues of K, all mixed.
struct Groups {
  static constexpr int kSize = 30, kCount = 20, kCoupled = 4, kUnknowns = kSize * kCount;

  // greatest: of the entries of W, in magnitudes of the lowest eigenvalues of K.
  Groups(double greatest, std::mt19937& random) : skew(kUnknowns, kUnknowns) {
    std::uniform_real_distribution<double> uniform;
    std::vector<int> place(kUnknowns);
    std::iota(place.begin(), place.end(), 0);
    std::shuffle(place.begin(), place.end(), random);
    std::vector<Eigen::Triplet<double>> entries;
    lower.resize(kUnknowns, kUnknowns);
    lower.reserve(Eigen::VectorXi::Constant(kUnknowns, 3));
    for (int column = 0; column < kUnknowns; ++column)
      for (int row = 3 * (column / 3); row < 3 * (column / 3) + 3; ++row) lower.insert(row, column) = 0;
    for (int group = 0; group < kCount; ++group) {
      Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(kSize, kSize);
      for (int k = 0; k < kSize; ++k)
        whole(k, k) = k == 0 && group < kCoupled ? -0.001 * (0.2 + uniform(random))
                                                 : std::pow(10.0, 5 * uniform(random) - 4.5);
      const bool flutters = group == 1 && random() % 2 == 0;  // unless the others prevent it
      if (flutters) whole(1, 1) = 1e-4;
      for (int k = 0; k < kSize; ++k)
        lower.coeffRef(place[kSize * group + k], place[kSize * group + k]) = whole(k, k);
      if (group < kCoupled) {
        const Eigen::MatrixXd part = random_matrix(kSize, kSize, random);
        for (int i = 0; i < kSize; ++i)
          for (int j = 0; j < kSize; ++j) {
            const bool couples_the_two = flutters && i == 0 && j == 1;
            if (i == j || (uniform(random) > 0.2 && !couples_the_two)) continue;
            const double entry = 0.001 * greatest * (couples_the_two ? 10 : part(i, j));
            whole(i, j) += entry;
            whole(j, i) -= entry;
            entries.emplace_back(place[kSize * group + i], place[kSize * group + j], entry);
            entries.emplace_back(place[kSize * group + j], place[kSize * group + i], -entry);
          }
      }
      const Eigen::VectorXcd values = whole.eigenvalues();
      unstable += static_cast<int>((values.real().array() < -kZero).count());
      lowest = std::min(lowest, values.real().minCoeff());
    }
    skew.setFromTriplets(entries.begin(), entries.end());
    lower.makeCompressed();
  }

  SparseMatrix lower, skew;
  int unstable = 0;
  double lowest = kInfinity;
};

// The skew part takes negative eigenvalues away, moves others off the axis, and makes some that flutter, also
// far from the axis. What is found stays far from the whole space.
TEST(LowestEigenvalues, AreAsManyUnstableOnesAsThereAre) {
  int stable = 0, unstable = 0, flutter = 0, greatest_space = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const Groups groups(std::pow(10.0, static_cast<double>(seed % 5) / 2 - 0.5), random);
    const SkewProduct product = [&](const Vector& v, Vector& out) { out += groups.skew * v; };
    const auto factor = make_multifrontal_factorisation();
    factor->analyse(groups.lower);
    const Vector start = Vector::Ones(Groups::kUnknowns);
    Eigen::MatrixXd starts(Groups::kUnknowns, 2);
    for (Eigen::Index k = 0; k < starts.rows(); ++k)
      starts.row(k) << 1 + 0.5 * std::sin(1.7 * k * k), 1 + 0.5 * std::sin(1.7 * k * k + 2);
    const LowestModes modes = lowest_modes(groups.lower, kZero, 0.01, starts, *factor);
    ASSERT_TRUE(modes.is_complete) << "seed " << seed;
    EXPECT_EQ((modes.values.array() < 0).count(), Groups::kCoupled);
    const LowestEigenvalues found =
        lowest_eigenvalues(groups.lower, product, start, modes, kZero, std::make_shared<ThreadTeam>());
    ASSERT_TRUE(found.is_complete) << "seed " << seed;
    EXPECT_EQ((found.values.real().array() < -kZero).count(), groups.unstable) << "seed " << seed;
    if (groups.unstable > 0) {
      EXPECT_NEAR(found.values[0].real(), groups.lowest, 10 * kZero) << "seed " << seed;
    }
    greatest_space = std::max({greatest_space, modes.krylov_vectors, found.krylov_vectors});
    ++(groups.unstable > 0 ? unstable : stable);
    flutter += groups.unstable > 0 && found.values[0].imag() != 0;
  }
  std::printf("%d stable, %d unstable, %d of them complex; up to %d vectors of %d\n", stable, unstable,
              flutter, greatest_space, Groups::kUnknowns);
  EXPECT_GE(stable, 20);
  EXPECT_GE(unstable, 20);
  EXPECT_GE(flutter, 5);
  EXPECT_LT(greatest_space, 500);
}

// Only those are counted that the space has come to; a factor that fails leaves nothing.
TEST(LowestEigenvalues, AreNotGuessed) {
  std::mt19937 random(1);
  const Groups groups(3, random);
  LowestModes modes;
  modes.shift = 1e-9;  // with which K is not positive definite
  modes.values = Eigen::VectorXd::Constant(1, -0.001);
  modes.vectors = Eigen::MatrixXd::Identity(Groups::kUnknowns, 1);
  const SkewProduct nothing_finite = [](const Vector& v, Vector& out) { out += kNaN * v; };
  const LowestEigenvalues found =
      lowest_eigenvalues(groups.lower, nothing_finite, Vector::Ones(Groups::kUnknowns), modes, kZero,
                         std::make_shared<ThreadTeam>());
  EXPECT_FALSE(found.is_complete);
  EXPECT_EQ(found.values.size(), 0);
}

}  // namespace
}  // namespace coapt
