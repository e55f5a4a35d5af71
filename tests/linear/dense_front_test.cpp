// Dense fronts: the Schur complement that elimination leaves, whatever vectors and threads do it.
#include "linear/dense_front.hpp"

#include "core/types.hpp"
#include "linear/front_kernels.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

namespace coapt {
namespace {

struct FilledFront {
  FilledFront(int column_count, int row_count, unsigned seed) : columns(column_count), below(row_count) {
    const int size = columns + below;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    matrix = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
    matrix = (matrix + matrix.transpose()).eval();
    const int stride = DenseFront::stride(size);
    panel.assign(static_cast<size_t>(stride) * static_cast<size_t>(columns), 0.0);
    update.assign(static_cast<size_t>(DenseFront::stride(below)) * static_cast<size_t>(below), kNaN);
  }

  DenseFront front() {
    for (int j = 0; j < columns; ++j)
      for (int i = j; i < columns + below; ++i)
        panel[static_cast<size_t>(j) * static_cast<size_t>(DenseFront::stride(columns + below)) +
              static_cast<size_t>(i)] = matrix(i, j);
    return {columns, below, panel.data(), update.data()};
  }

  // What elimination leaves of the rows below, and the greatest difference of the update from it.
  double error_of_update() const {
    const auto a = matrix.topLeftCorner(columns, columns);
    const auto b = matrix.bottomLeftCorner(below, columns);
    const Eigen::MatrixXd exact = -b * a.fullPivLu().solve(b.transpose());
    double error = 0;
    for (int j = 0; j < below; ++j)
      for (int i = j; i < below; ++i) {
        const auto at =
            static_cast<size_t>(j) * static_cast<size_t>(DenseFront::stride(below)) + static_cast<size_t>(i);
        error = std::max(error, std::abs(update[at] - exact(i, j)));
      }
    return error;
  }

  int columns, below;
  Eigen::MatrixXd matrix;
  std::vector<double> panel, update;
};

// Every remainder of the widths and heights that the panels are cut into.
std::vector<std::pair<int, int>> shapes() {
  std::vector<std::pair<int, int>> all;
  for (int columns = 3; columns <= 45; columns += 3)
    for (int below : {0, 3, 6, 9, 12, 15, 18, 21, 24, 63}) all.emplace_back(columns, below);
  for (int columns : {48, 51, 54, 57, 60, 93, 96, 99, 108})
    for (int below : {0, 3, 6, 9, 30}) all.emplace_back(columns, below);
  return all;
}

TEST(DenseFront, CholeskyLeavesTheSchurComplement) {
  for (const auto& [columns, below] : shapes()) {
    FilledFront filled(columns, below, 1);
    filled.matrix.diagonal().array() += 60;
    const Eigen::MatrixXd factor = filled.matrix.llt().matrixL();
    ASSERT_TRUE(eliminate_positive_definite(filled.front())) << columns << " " << below;
    double error = 0;
    for (int j = 0; j < columns; ++j)
      for (int i = j; i < columns + below; ++i)
        error = std::max(error,
                         std::abs(filled.panel[static_cast<size_t>(j) *
                                                   static_cast<size_t>(DenseFront::stride(columns + below)) +
                                               static_cast<size_t>(i)] -
                                  factor(i, j)));
    EXPECT_LT(error, 1e-12) << columns << " " << below;
    EXPECT_LT(filled.error_of_update(), 1e-11) << columns << " " << below;
  }
}

void expect_same_numbers(const FilledFront& a, const FilledFront& b) {
  const int size = a.columns + a.below;
  const auto compare = [&](const std::vector<double>& ours, const std::vector<double>& theirs, int columns,
                           int height) {
    for (int j = 0; j < columns; ++j)
      for (int i = j; i < height; ++i) {
        const auto at =
            static_cast<size_t>(j) * static_cast<size_t>(DenseFront::stride(height)) + static_cast<size_t>(i);
        ASSERT_EQ(ours[at], theirs[at]) << a.columns << " " << a.below << ": " << i << " " << j;
      }
  };
  compare(a.panel, b.panel, a.columns, size);
  compare(a.update, b.update, a.below, a.below);
}

#ifdef COAPT_WIDE
COAPT_WIDE bool eliminate_by_fours(const DenseFront& front) { return positive_definite<Quad>(front); }
COAPT_WIDEST bool eliminate_by_eights(const DenseFront& front) { return positive_definite<Octet>(front); }

TEST(DenseFront, VectorsOfEightLeaveTheNumbersOfVectorsOfFour) {
  if (!is_widest()) GTEST_SKIP() << "this processor has no vectors of eight";
  for (const auto& [columns, below] : shapes()) {
    FilledFront four(columns, below, 7), eight(columns, below, 7);
    four.matrix.diagonal().array() += 60;
    eight.matrix.diagonal().array() += 60;
    ASSERT_TRUE(eliminate_by_fours(four.front()));
    ASSERT_TRUE(eliminate_by_eights(eight.front()));
    expect_same_numbers(eight, four);
  }
}
#endif

// Wide and high enough to be shared, with every remainder of a share's rows and columns.
TEST(DenseFront, ThreadsLeaveTheNumbersOfOne) {
  for (const auto& [columns, below] : {std::pair{240, 0}, {243, 60}, {96, 333}, {195, 249}, {150, 306}}) {
    FilledFront one(columns, below, 5);
    one.matrix.diagonal().array() += 1000;
    ASSERT_TRUE(eliminate_positive_definite(one.front()));
    for (const int threads : {2, 3}) {
      ThreadTeam team(threads);
      FilledFront several(columns, below, 5);
      several.matrix.diagonal().array() += 1000;
      ASSERT_TRUE(eliminate_positive_definite(several.front(), &team));
      expect_same_numbers(several, one);
    }
    EXPECT_LT(one.error_of_update(), 1e-10);
  }
}

TEST(DenseFront, AnIndefiniteOneIsRefusedByCholeskyAndCountedByItsSigns) {
  std::vector<double> work;
  int counted = 0;
  for (const auto& [columns, below] : shapes()) {
    FilledFront filled(columns, below, 2);
    filled.matrix.diagonal().array() += 1;
    const Eigen::MatrixXd top = filled.matrix.topLeftCorner(columns, columns);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(top);
    const auto negative = (spectrum.eigenvalues().array() < 0).count();
    if (negative == 0) continue;
    ++counted;
    EXPECT_FALSE(eliminate_positive_definite(filled.front())) << columns << " " << below;
    int minus = 0, plus = 0;
    ASSERT_TRUE(eliminate_indefinite(filled.front(), work, minus, plus)) << columns << " " << below;
    EXPECT_EQ(minus, negative) << columns << " " << below;
    EXPECT_EQ(minus + plus, columns);
  }
  EXPECT_GT(counted, 100);
}

TEST(DenseFront, SignsLeaveTheSameSchurComplement) {
  std::vector<double> work;
  for (const auto& [columns, below] : shapes()) {
    FilledFront filled(columns, below, 3);
    filled.matrix.diagonal().head(columns).array() += 60;
    filled.matrix.diagonal().head(columns / 3).array() -= 120;
    int minus = 0, plus = 0;
    ASSERT_TRUE(eliminate_indefinite(filled.front(), work, minus, plus));
    EXPECT_LT(filled.error_of_update(), 1e-9) << columns << " " << below;
  }
}

TEST(DenseFront, AVanishingPivotOrOneThatIsNoNumberIsRefused) {
  std::vector<double> work;
  for (const double bad : {0.0, kNaN, -kNaN}) {
    FilledFront filled(15, 6, 4);
    filled.matrix.diagonal().array() += 60;
    filled.matrix.row(13).setZero();
    filled.matrix.col(13).setZero();
    filled.matrix(13, 13) = bad;
    int minus = 0, plus = 0;
    EXPECT_FALSE(eliminate_positive_definite(filled.front()));
    EXPECT_FALSE(eliminate_indefinite(filled.front(), work, minus, plus));
  }
}

}  // namespace
}  // namespace coapt
