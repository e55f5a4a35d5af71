#include "linear/bordered_factor.hpp"
#include "linear/dense_front.hpp"
#include "linear/factorisation.hpp"
#include "linear/front_kernels.hpp"
#include "linear/last_factor.hpp"
#include "linear/node_ordering.hpp"
#include "linear/supernodes.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <set>

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

// A sheet of nodes with a few pairs across it, in any numbering.
NodeGraph sheet_graph(int side, unsigned seed) {
  const int count = side * side;
  std::mt19937 random(seed);
  std::vector<int> number(count);
  for (int k = 0; k < count; ++k) number[k] = k;
  std::shuffle(number.begin(), number.end(), random);
  std::vector<std::set<int>> later(count);
  const auto join = [&](int a, int b) {
    later[std::min(number[a], number[b])].insert(std::max(number[a], number[b]));
  };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const int k = i * side + j;
      join(k, k);
      if (j + 1 < side) join(k, k + 1);
      if (i + 1 < side) join(k, k + side);
      if (i + 1 < side && j + 1 < side) join(k, k + side + 1);
    }
  for (int k = 0; k < side; ++k) join(static_cast<int>(random() % count), static_cast<int>(random() % count));
  NodeGraph graph;
  for (const std::set<int>& rows : later) {
    graph.row.insert(graph.row.end(), rows.begin(), rows.end());
    graph.start.push_back(static_cast<int>(graph.row.size()));
  }
  return graph;
}

// The pattern of the factor in an order, entry by entry.
std::vector<std::set<int>> eliminated(const NodeGraph& graph, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
  std::vector<std::set<int>> below(order.size());
  for (int j = 0; j < graph.size(); ++j)
    for (int k = graph.start[j]; k < graph.start[j + 1]; ++k)
      if (graph.row[k] != j)
        below[std::min(place[j], place[graph.row[k]])].insert(std::max(place[j], place[graph.row[k]]));
  for (const std::set<int>& rows : below)
    if (!rows.empty())
      for (const int row : rows)
        if (row != *rows.begin()) below[*rows.begin()].insert(row);
  return below;
}

TEST(Supernodes, HoldEveryEntryOfTheFactorAndFewOthers) {
  for (const int side : {1, 2, 5, 12, 30}) {
    const NodeGraph graph = sheet_graph(side, 7);
    const Supernodes nodes = supernodes_of(graph, minimum_degree_order(graph));
    std::vector<int> sorted = nodes.order;
    std::sort(sorted.begin(), sorted.end());
    for (int k = 0; k < graph.size(); ++k) ASSERT_EQ(sorted[k], k);
    const std::vector<std::set<int>> below = eliminated(graph, nodes.order);
    double held = 0, wanted = 0;
    for (int s = 0; s < nodes.size(); ++s)
      for (int j = nodes.first[s]; j < nodes.first[s + 1]; ++j) {
        std::set<int> rows(nodes.rows.begin() + nodes.below[s], nodes.rows.begin() + nodes.below[s + 1]);
        for (int k = j + 1; k < nodes.first[s + 1]; ++k) rows.insert(k);
        EXPECT_TRUE(std::includes(rows.begin(), rows.end(), below[j].begin(), below[j].end()));
        held += 1 + static_cast<double>(rows.size());
        wanted += 1 + static_cast<double>(below[j].size());
      }
    EXPECT_LT(held, 1.6 * wanted) << side;
  }
}

TEST(Supernodes, ComeAfterTheirChildrenAndGiveEachRowItsPlace) {
  const NodeGraph graph = sheet_graph(30, 8);
  const Supernodes nodes = supernodes_of(graph, node_order(graph));
  int children = 0;
  for (int s = 0; s < nodes.size(); ++s) {
    for (int k = nodes.child_start[s]; k < nodes.child_start[s + 1]; ++k, ++children) {
      EXPECT_LT(nodes.child[k], s);
      EXPECT_EQ(nodes.parent[nodes.child[k]], s);
    }
    const int parent = nodes.parent[s];
    if (parent < 0) continue;
    for (int k = nodes.below[s]; k < nodes.below[s + 1]; ++k) {
      const int place = nodes.place[k];
      const int row = place < nodes.columns(parent)
                          ? nodes.first[parent] + place
                          : nodes.rows[nodes.below[parent] + place - nodes.columns(parent)];
      EXPECT_EQ(row, nodes.rows[k]);
    }
  }
  EXPECT_EQ(children,
            nodes.size() - static_cast<int>(std::count(nodes.parent.begin(), nodes.parent.end(), -1)));
}

TEST(NodeOrdering, NestedDissectionOrMinimumDegreeIsAPermutationWithLittleFill) {
  const NodeGraph graph = sheet_graph(60, 9);
  std::vector<int> natural(graph.size());
  for (int k = 0; k < graph.size(); ++k) natural[k] = k;
  const auto fill = [&](const std::vector<int>& order) {
    const Supernodes nodes = supernodes_of(graph, order);
    double size = 0;
    for (int s = 0; s < nodes.size(); ++s)
      size += nodes.columns(s) * (nodes.columns(s) + nodes.rows_below(s));
    return size;
  };
  EXPECT_LT(fill(node_order(graph)), 0.2 * fill(natural));
  EXPECT_LT(fill(minimum_degree_order(graph)), 0.2 * fill(natural));
}

TEST(NodeOrdering, TheLastOrderIsThatOfTheGraphWhicheverCameBefore) {
  const NodeGraph graph = sheet_graph(40, 9), other = sheet_graph(41, 9);
  LastOrder last;
  EXPECT_EQ(last.of(graph), node_order(graph));
  const int* kept = last.of(graph).data();
  EXPECT_EQ(last.of(graph).data(), kept);
  EXPECT_EQ(last.of(other), node_order(other));
  EXPECT_EQ(last.of(graph), node_order(graph));
}

TEST(NodeOrdering, APartDoesNotTakeThePlaceOfTheWhole) {
  const NodeGraph graph = sheet_graph(40, 9), part = sheet_graph(20, 9);
  LastOrder last;
  const int* kept = last.of(graph).data();
  EXPECT_EQ(last.of(part), node_order(part));
  EXPECT_EQ(last.of(graph).data(), kept);
}

// Positive definite, with the pattern of the graph.
SparseMatrix matrix_of(const NodeGraph& graph, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < graph.size(); ++j)
    for (int k = graph.start[j]; k < graph.start[j + 1]; ++k)
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
          entries.emplace_back(3 * graph.row[k] + r, 3 * j + c,
                               graph.row[k] == j && r == c ? 40 : normal(random));
  SparseMatrix matrix(3 * graph.size(), 3 * graph.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

TEST(Multifrontal, MemoryGoesFromOneToTheNextAndLeavesTheBitsOfNew) {
  const auto last = std::make_shared<LastFactor>();
  const auto solved = [](const SparseMatrix& lower, const std::shared_ptr<LastFactor>& shared) {
    const auto factor = make_multifrontal_factorisation();
    if (shared) factor->share(shared);
    factor->analyse(lower);
    EXPECT_TRUE(!shared || !shared->factor) << "not in use";
    Vector x;
    EXPECT_TRUE(factor->factorise(lower));
    factor->solve(Vector::LinSpaced(lower.cols(), -1, 2), x);
    return x;
  };
  const MultifrontalFactor* memory = nullptr;
  for (const int side : {40, 41, 40, 12}) {
    const SparseMatrix lower = matrix_of(sheet_graph(side, 9), 15);
    EXPECT_EQ(solved(lower, last), solved(lower, nullptr)) << "side " << side;
    ASSERT_NE(last->factor, nullptr);
    EXPECT_TRUE(!memory || last->factor.get() == memory);
    memory = last->factor.get();
  }
}

TEST(Multifrontal, APatternThatFollowsAnotherIsOrderedBriefly) {
  const NodeGraph first = sheet_graph(40, 9), second = sheet_graph(40, 14);
  if (minimum_degree_order(second) == node_order(second)) GTEST_SKIP() << "this build has no METIS";
  EXPECT_EQ(brief_order(second), minimum_degree_order(second));
  const auto last = std::make_shared<LastFactor>();
  last->order.of(first);
  const auto order_after = [&](const std::vector<NodeGraph>& graphs) {
    {
      const auto factor = make_multifrontal_factorisation();
      factor->share(last);
      for (const NodeGraph& graph : graphs) factor->analyse(matrix_of(graph, 15));
    }
    return last->factor->nodes().order;
  };
  EXPECT_EQ(order_after({first, second}), supernodes_of(second, minimum_degree_order(second)).order);
  EXPECT_EQ(order_after({second}), supernodes_of(second, node_order(second)).order);
}

TEST(Multifrontal, ThreadsLeaveTheBitsOfOne) {
  const NodeGraph graph = sheet_graph(70, 14);
  const SparseMatrix lower = matrix_of(graph, 15);
  SparseMatrix indefinite = lower;
  for (int k = 0; k < 3 * graph.size(); k += 50) indefinite.coeffRef(k, k) = -40;
  const Vector b = Vector::LinSpaced(lower.cols(), -1, 2);
  Vector expected;
  Inertia signs;
  for (const int threads : {1, 2, 3, 8}) {
    const auto factor = make_multifrontal_factorisation();
    factor->use_threads(std::make_shared<ThreadTeam>(threads));
    factor->analyse(lower);
    Vector x;
    for (int again = 0; again < 5; ++again) {
      ASSERT_TRUE(factor->factorise(lower));
      factor->solve(b, x);
      if (expected.size() == 0) expected = x;
      EXPECT_EQ(x, expected) << threads << " threads";
      EXPECT_FALSE(factor->factorise(indefinite));
    }
    const Inertia counted = factor->inertia(indefinite);
    if (threads == 1) signs = counted;
    EXPECT_EQ(counted.negative, signs.negative);
    EXPECT_EQ(counted.positive, signs.positive);
  }
  EXPECT_LT((lower.selfadjointView<Eigen::Lower>() * expected - b).norm(), 1e-12 * b.norm());
  EXPECT_GT(signs.negative, 100);
}

TEST(BorderedFactor, SolvesWithASkewPartOfItsBorder) {
  const NodeGraph graph = sheet_graph(20, 10);
  const SparseMatrix lower = matrix_of(graph, 11);
  // Apart from each other, in pieces, and one that nothing else couples to them.
  for (const std::vector<int>& border :
       {std::vector<int>{3}, {0, 7, 8, 9, 100, 250, 399}, std::vector<int>{}}) {
    const auto count = static_cast<int>(border.size());
    std::srand(1);
    Eigen::MatrixXd skew = Eigen::MatrixXd::Random(3 * count, 3 * count) * 30;
    skew = (skew - skew.transpose()).eval();
    Eigen::MatrixXd whole = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
    for (int a = 0; a < count; ++a)
      for (int b = 0; b < count; ++b)
        whole.block<3, 3>(3 * border[a], 3 * border[b]) += skew.block<3, 3>(3 * a, 3 * b);
    BorderedFactor factor;
    factor.analyse(lower, border);
    ASSERT_TRUE(factor.factorise(lower, skew));
    const Vector b = Vector::Random(lower.cols());
    Vector x;
    factor.solve(b, x);
    EXPECT_LT((whole * x - b).norm(), 1e-12 * b.norm());
    EXPECT_EQ(factor.negative_eigenvalues(), 0);
    Vector transposed;
    factor.solve_transposed(b, transposed);
    EXPECT_LT((whole.transpose() * transposed - b).norm(), 1e-12 * b.norm());
    if (count > 0) {
      EXPECT_GT((lower.selfadjointView<Eigen::Lower>() * x - b).norm(), 0.01 * b.norm());
    }
  }
}

TEST(BorderedFactor, RefusesWhatIsNotPositiveDefiniteOutsideItsBorder) {
  const NodeGraph graph = sheet_graph(6, 12);
  SparseMatrix lower = matrix_of(graph, 13);
  lower.coeffRef(15, 15) = -40;  // of node 5
  BorderedFactor factor;
  factor.analyse(lower, {1});
  EXPECT_FALSE(factor.factorise(lower, Eigen::MatrixXd::Zero(3, 3)));
  factor.analyse(lower, {5});
  EXPECT_TRUE(factor.factorise(lower, Eigen::MatrixXd::Zero(3, 3)));
  EXPECT_EQ(factor.negative_eigenvalues(), 1);
}

}  // namespace
}  // namespace coapt
