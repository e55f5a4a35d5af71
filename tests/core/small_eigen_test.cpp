#include "core/small_eigen.hpp"

#include "core/random_source.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>

namespace coapt {
namespace {

// Of random rank and size, entries above the diagonal spoilt: they are not to be read.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> random_symmetric(RandomSource& random) {
  Eigen::Matrix<double, kSize, kSize> result = Eigen::Matrix<double, kSize, kSize>::Zero();
  const int rank = 1 + static_cast<int>(random.below(kSize));
  for (int k = 0; k < rank; ++k) {
    Eigen::Vector<double, kSize> v;
    for (double& entry : v) entry = 2 * random.unit() - 1;
    result += (2 * random.unit() - 1) * v * v.transpose();
  }
  result.template triangularView<Eigen::StrictlyUpper>().setConstant(7);
  return result;
}

template <int kSize>
void expect_the_same_bits() {
  using Matrix = Eigen::Matrix<double, kSize, kSize>;
  RandomSource random(kSize);
  for (int k = 0; k < 500; ++k) {
    const Matrix a = random_symmetric<kSize>(random);
    const Eigen::SelfAdjointEigenSolver<Matrix> own(a);
    const SmallEigen shared = small_eigen(a);
    ASSERT_EQ(shared.vectors, own.eigenvectors()) << a;
    ASSERT_EQ(shared.values, own.eigenvalues()) << a;
    const Eigen::SelfAdjointEigenSolver<Matrix> values_alone(a, Eigen::EigenvaluesOnly);
    ASSERT_EQ(small_eigenvalues(a), values_alone.eigenvalues()) << a;
  }
}

TEST(SmallEigenTest, GivesTheBitsOfASolverOfEvenSize) { expect_the_same_bits<6>(); }

// Columns that start off the alignment of the processor's vectors.
TEST(SmallEigenTest, GivesTheBitsOfASolverOfOddSize) {
  expect_the_same_bits<7>();
  expect_the_same_bits<9>();
}

TEST(SmallEigenTest, TakesASingleRow) {
  const SmallEigen one = small_eigen(SmallMatrix::Constant(1, 1, -2.0));
  EXPECT_EQ(one.values[0], -2);
  EXPECT_EQ(std::abs(one.vectors(0, 0)), 1);
}

}  // namespace
}  // namespace coapt
