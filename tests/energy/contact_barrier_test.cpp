#include "energy/contact_barrier.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"
#include "energy/contact/pair_barrier.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/surface_tension.hpp"
#include "energy/objective.hpp"
#include "mesh/distance/intersections.hpp"
#include "support/meshes.hpp"
#include "support/sanitized.hpp"
#include "support/term_suite.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace coapt {
namespace {

constexpr double kGap = 0.5;

// Two triangles, at rest far apart; the second one is brought near the first in the state.
TermCase two_triangles(const std::string& label, const Eigen::Matrix3d& second) {
  TermCase c;
  c.label = label;
  Triangles triangles(3, 2);
  triangles << 0, 3, 1, 4, 2, 5;
  c.rest.resize(3, 6);
  c.rest << 0, 4, 0, 0, 4, 0, 0, 0, 4, 0, 0, 4, 0, 0, 0, 9, 9, 9;
  c.state = c.rest;
  c.state.rightCols(3) = second;
  c.reach = 0.02;
  c.far_away = 10;
  c.make = [rest = c.rest, triangles](const Frame& f) {
    ContactBarrierOptions options;
    options.gap = kGap * f.length;
    options.pressure = 1.3 * f.force / (f.length * f.length);
    return make_contact_barrier("contact", f.points(rest), f.triangles(triangles), options);
  };
  return c;
}

Eigen::Matrix3d corners(const Vec3& a, const Vec3& b, const Vec3& c) {
  Eigen::Matrix3d m;
  m << a, b, c;
  return m;
}

// One state for each place that the closest points can have.
std::vector<TermCase> distance_regimes() {
  return {
      two_triangles("point over a face", corners({1.1, 0.9, 0.22}, {1.3, 1.2, 4}, {1.7, 0.6, 4.2})),
      two_triangles("point beside an edge", corners({1.9, -0.15, 0.17}, {1.7, -3, 2}, {2.3, -3.1, 2.4})),
      two_triangles("point before a vertex", corners({-0.14, -0.11, 0.1}, {-3, -2, 1}, {-2, -3, 1.3})),
      two_triangles("edge across an edge", corners({2.1, -1.1, 0.31}, {1.8, 1.7, 0.05}, {2.3, -2, 4})),
      two_triangles("edges that are almost parallel",
                    corners({0.6, -0.2, 0.21}, {3.2, -0.23, 0.24}, {2, -3, 3})),
      two_triangles("several pairs at once", corners({0.9, 0.8, 0.3}, {1.9, 0.9, 0.25}, {1.2, 1.9, 0.35})),
  };
}

TEST(ContactBarrier, PassesTheSuiteWhereverTheClosestPointsLie) {
  for (const TermCase& c : distance_regimes()) EXPECT_EQ(examine_term(c), "");
}

TEST(ContactBarrier, IsSmoothWhereItBegins) {
  const BarrierValue at = barrier(1), before = barrier(1 - 1e-6);
  EXPECT_EQ(at.energy, 0);
  EXPECT_EQ(at.slope, 0);
  EXPECT_EQ(at.curvature, 0);
  EXPECT_NEAR(before.curvature, 0, 1e-5);
  EXPECT_LT(before.slope, 0);
}

TEST(ContactBarrier, GrowsWithoutBoundTowardsContact) {
  double last = 0;
  for (double s = 0.5; s > 1e-12; s *= 0.1) {
    EXPECT_GT(barrier(s).energy, last);
    last = barrier(s).energy;
  }
  EXPECT_GT(last, 25);  // -ln s
}

PairCorners random_corners(std::mt19937& engine, PairKind kind, double distance) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  PairCorners x;
  for (double& value : x.reshaped()) value = uniform(engine);
  // Push the first side away from the second until they are about as far apart as wanted.
  const ClosestPair closest = closest_points(kind, x);
  const Vec3 away = x * closest.weights;
  const int moved = kind == PairKind::PointTriangle ? 1 : 2;
  x.leftCols(moved).colwise() += (distance / closest.distance - 1) * away;
  return x;
}

BarrierRest rest_of(PairKind kind) { return {kind, 1, 1, kind == PairKind::EdgeEdge ? 0.05 : 0}; }

TEST(ContactBarrier, HasAProjectedHessianThatBoundsTheExactOne) {
  std::mt19937 engine(5);
  int indefinite = 0, turned_down = 0;
  for (int sample = 0; sample < 4000; ++sample) {
    const PairKind kind = sample % 2 == 0 ? PairKind::PointTriangle : PairKind::EdgeEdge;
    PairCorners x = random_corners(engine, kind, 0.02 + 0.9 * (sample % 17) / 17.0);
    if (sample % 10 == 1) {  // almost parallel edges
      x.col(3) = x.col(2) + (x.col(1) - x.col(0)) + 0.01 * (x.col(3) - x.col(2));
      ++turned_down;
    }
    const ClosestPair closest = closest_points(kind, x);
    if (closest.distance >= 1 || closest.distance < 1e-3) continue;
    PairVector g;
    PairMatrix exact, projected;
    evaluate_barrier(rest_of(kind), x, closest, Projection::None, &g, &exact);
    evaluate_barrier(rest_of(kind), x, closest, Projection::PositiveSemidefinite, &g, &projected);
    const double size = exact.norm();
    const Eigen::SelfAdjointEigenSolver<PairMatrix> of_exact(exact), of_projected(projected),
        of_difference(projected - exact);
    EXPECT_GE(of_projected.eigenvalues()[0], -1e-12 * size);
    EXPECT_GE(of_difference.eigenvalues()[0], -1e-12 * size);
    EXPECT_LE(projected.norm(), 3 * size);
    if (of_exact.eigenvalues()[0] < -1e-6 * size) ++indefinite;
  }
  EXPECT_GT(indefinite, 1000);
  EXPECT_GT(turned_down, 100);
}

std::unique_ptr<EnergyTerm> barrier_of(const Points& rest, const Triangles& triangles, double gap) {
  ContactBarrierOptions options;
  options.gap = gap;
  options.pressure = 1;
  return make_contact_barrier("contact", rest, triangles, options);
}

TEST(ContactBarrier, LetsAMeshAtRestFeelNothingHoweverFineItIs) {
  const TriangleMesh sheet = grid_mesh(12, 9);
  const auto term = barrier_of(sheet.vertices, sheet.triangles, 1.0);  // ten times the edges
  const TermValues at_rest = evaluate_term(*term, sheet.vertices);
  EXPECT_EQ(at_rest.energy, 0);
  EXPECT_EQ(at_rest.gradient.norm(), 0);
  EXPECT_GT(term->counters().candidates, 0);
}

// Two sheets of different meshes one above the other: the pressure between them, and that it hardly depends
// on the mesh.
double pressure_between_sheets(int cells, double gap, double distance) {
  const TriangleMesh lower = grid_mesh(cells, cells), upper = grid_mesh(cells + 1, cells + 1);
  const int n = lower.vertex_count();
  Points rest(3, n + upper.vertex_count()), state = rest;
  rest << lower.vertices, upper.vertices.colwise() + Vec3(0, 0, 5);
  state << lower.vertices, upper.vertices.colwise() + Vec3(0, 0, distance);
  Triangles triangles(3, lower.triangle_count() + upper.triangle_count());
  triangles << lower.triangles, upper.triangles.array() + n;
  const auto term = barrier_of(rest, triangles, gap);
  const Points g = evaluate_term(*term, state).gradient;
  EXPECT_NEAR(g.row(2).sum(), 0, 1e-12 * g.norm());
  return g.row(2).leftCols(n).sum() / surface_area(lower.vertices, lower.triangles);
}

TEST(ContactBarrier, CarriesItsPressureBetweenSheetsOfAnyMesh) {
  const double coarse = pressure_between_sheets(8, 0.03, 0.02),
               fine = pressure_between_sheets(16, 0.015, 0.01);
  EXPECT_GT(coarse, 0.3);
  EXPECT_LT(coarse, 3);
  EXPECT_NEAR(fine, coarse, 0.15 * coarse);
}

TEST(ContactBarrier, StopsASheetBeforeItFallsThroughAnother) {
  const TriangleMesh sheet = grid_mesh(3, 3);
  const int n = sheet.vertex_count();
  Points x(3, 2 * n), d = Points::Zero(3, 2 * n);
  x << sheet.vertices, sheet.vertices.colwise() + Vec3(0.1, 0.05, 2);
  d.rightCols(n).row(2).setConstant(-50);
  Triangles triangles(3, 2 * sheet.triangle_count());
  triangles << sheet.triangles, sheet.triangles.array() + n;
  const auto term = barrier_of(x, triangles, 0.1);
  term->prepare(x);
  ASSERT_TRUE(term->limits_steps());
  const double step = term->step_limit(x, d, 1);
  EXPECT_LT(step, 2.0 / 50);        // before contact
  EXPECT_GT(step, 0.7 * 2.0 / 50);  // and not much too early
  EXPECT_EQ(term->step_limit(x, -d, 1), 1);
  EXPECT_EQ(term->step_limit(x, Points::Constant(3, 2 * n, 7), 1), 1);  // moving together
}

// Some nodes move, far or hardly, and sometimes all: a list of pairs that follows them says what one does
// that begins there, to the last bit, and finds no pair too few that limits a step.
TEST(ContactBarrier, SearchesAroundWhatHasMovedAsIfItBeganThere) {
  const TriangleMesh sheet = grid_mesh(8, 8);
  const int n = sheet.vertex_count();
  Points rest(3, 2 * n), x(3, 2 * n);
  rest << sheet.vertices, sheet.vertices.colwise() + Vec3(0, 0, 5);
  x << sheet.vertices, sheet.vertices.colwise() + Vec3(0.03, 0.02, 0.12);
  Triangles triangles(3, 2 * sheet.triangle_count());
  triangles << sheet.triangles, sheet.triangles.array() + n;
  const double gap = 0.08;
  const auto follows = barrier_of(rest, triangles, gap);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any_move = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  int active = 0, limited = 0, same_pairs = 0;
  for (int k = 0; k < 120; ++k) {
    const int count = k % 10 == 0 ? 2 * n : 5;
    const double reach = gap * std::pow(10.0, uniform(random) - 0.7);
    Points d = Points::Zero(3, 2 * n);
    for (int m = 0; m < count; ++m) d.col(count == 5 ? random() % (2 * n) : m) = reach * any_move();
    const auto begins = barrier_of(rest, triangles, gap);
    begins->prepare(x);
    const double step = follows->step_limit(x, d, 1);
    EXPECT_NEAR(step, begins->step_limit(x, d, 1), 0.03 * step);
    limited += step < 1;
    x += step * d;
    const bool is_changed = follows->prepare(x);
    begins->prepare(x);
    const TermValues a = evaluate_term(*follows, x), b = evaluate_term(*begins, x);
    EXPECT_EQ(a.energy, b.energy);
    EXPECT_EQ((a.gradient - b.gradient).norm(), 0);
    active += a.energy > 0;
    same_pairs += !is_changed;
  }
  EXPECT_GT(active, 80);
  EXPECT_GT(limited, 8);
  EXPECT_GT(same_pairs, 20);
}

// First or last among the terms, with more pairs than before or fewer.
TEST(ContactBarrier, HasItsPlaceInTheHessianWhateverPairsThereWere) {
  const TriangleMesh sheet = grid_mesh(6, 6);
  const int n = sheet.vertex_count();
  Points rest(3, 2 * n);
  rest << sheet.vertices, sheet.vertices.colwise() + Vec3(0, 0, 5);
  Triangles triangles(3, 2 * sheet.triangle_count());
  triangles << sheet.triangles, sheet.triangles.array() + n;
  const auto objective_of = [&](bool contact_first) {
    std::vector<std::unique_ptr<EnergyTerm>> terms;
    if (contact_first) terms.push_back(barrier_of(rest, triangles, 0.1));
    terms.push_back(std::make_unique<ElementTerm<SurfaceTension>>(
        "film", std::vector<int>(triangles.data(), triangles.data() + triangles.size()),
        std::vector<SurfaceTension::Rest>(static_cast<size_t>(triangles.cols()), {1})));
    if (!contact_first) terms.push_back(barrier_of(rest, triangles, 0.1));
    return Objective(rest, FixedMask::Constant(3, 2 * n, false), std::move(terms));
  };
  Objective first = objective_of(true), last = objective_of(false);
  for (const double height : {1.0, 0.09, 0.02, 0.09, 1.0, 0.05}) {
    Points x = rest;
    x.rightCols(n).row(2).setConstant(height);
    x.rightCols(n).row(0).array() += 0.3 * height;
    Objective anew = objective_of(true);
    Vector g;
    Eigen::SparseMatrix<double> a, b, c;
    const Vector q = anew.unknowns(x);
    first.hessian(q, g, a);
    last.hessian(q, g, b);
    anew.hessian(q, g, c);
    EXPECT_EQ((a - c).norm(), 0) << height;
    EXPECT_LT((b - c).norm(), 1e-14 * c.norm()) << height;
  }
}

TEST(ContactBarrier, BecomesStifferOnlyWhereItIsPressedTooHard) {
  const TriangleMesh sheet = grid_mesh(2, 2);
  const int n = sheet.vertex_count();
  Points rest(3, 2 * n), near(3, 2 * n), pressed(3, 2 * n);
  rest << sheet.vertices, sheet.vertices.colwise() + Vec3(0.1, 0.05, 2);
  near << sheet.vertices, sheet.vertices.colwise() + Vec3(0.1, 0.05, 0.05);
  pressed << sheet.vertices, sheet.vertices.colwise() + Vec3(0.1, 0.05, 0.0005);
  Triangles triangles(3, 2 * sheet.triangle_count());
  triangles << sheet.triangles, sheet.triangles.array() + n;
  const auto term = barrier_of(rest, triangles, 0.1);
  const double before = evaluate_term(*term, near).energy;
  EXPECT_FALSE(term->escalate_stiffness(rest));
  EXPECT_FALSE(term->escalate_stiffness(near));
  EXPECT_EQ(evaluate_term(*term, near).energy, before);
  EXPECT_TRUE(term->escalate_stiffness(pressed));
  EXPECT_GT(evaluate_term(*term, near).energy, 2 * before);
}

TEST(ContactBarrier, IsInfiniteOnContactAndNeverNegative) {
  const TermCase c = two_triangles("touching", corners({1, 1, 0}, {1, 1, 4}, {2, 1, 4}));
  const auto term = c.make({});
  term->prepare(c.state);
  Sink sink;
  EXPECT_EQ(term->evaluate(c.state, sink), kInfinity);
}

TEST(ContactBarrier, LeavesOutThePairsThatItIsToldTo) {
  const TermCase c = distance_regimes().front();
  Triangles triangles(3, 2);
  triangles << 0, 3, 1, 4, 2, 5;
  ContactBarrierOptions options;
  options.gap = kGap;
  options.pressure = 1;
  options.excluded = {{1, 0}};
  const auto term = make_contact_barrier("contact", c.rest, triangles, options);
  EXPECT_EQ(evaluate_term(*term, c.state).energy, 0);
}

TEST(ContactBarrier, MeetsObstaclesThatDoNotMeetEachOther) {
  const TermCase c = distance_regimes().front();
  Triangles first(3, 1), second(3, 1), none(3, 0), both(3, 2);
  first << 0, 1, 2;
  second << 3, 4, 5;
  both << first, second;
  ContactBarrierOptions options;
  options.gap = kGap;
  options.pressure = 1;
  options.obstacles = second;
  const auto against = make_contact_barrier("contact", c.rest, first, options);
  EXPECT_GT(evaluate_term(*against, c.state).energy, 0);
  options.obstacles = both;
  const auto obstacles_alone = make_contact_barrier("contact", c.rest, none, options);
  EXPECT_EQ(evaluate_term(*obstacles_alone, c.state).energy, 0);
}

// Two sheets of n x n cells each, the upper one a bowl that comes within the gap around its middle only; the
// share of the surface that does so is the same for every n.
struct SearchCost {
  long triangles, candidates, active;
  double search_s;
};
SearchCost cost_of_search(int cells) {
  const double edge = 1.0 / cells, gap = 0.5 * edge;
  const TriangleMesh sheet = grid_mesh(cells, cells);
  const int n = sheet.vertex_count();
  Points rest(3, 2 * n), state(3, 2 * n);
  rest << sheet.vertices, sheet.vertices.colwise() + Vec3(0, 0, 5);
  state << sheet.vertices, sheet.vertices.colwise() + Vec3(0.3 * edge, 0.2 * edge, 0.7 * gap);
  for (int v = n; v < 2 * n; ++v)
    state(2, v) += 20 * edge * (state.col(v).head<2>() - Eigen::Vector2d(0.5, 0.5)).squaredNorm();
  Triangles triangles(3, 2 * sheet.triangle_count());
  triangles << sheet.triangles, sheet.triangles.array() + n;
  const auto term = barrier_of(rest, triangles, gap);
  const double start = cpu_seconds();
  term->prepare(state);
  const double search_s = cpu_seconds() - start;
  Sink sink;
  EXPECT_GT(term->evaluate(state, sink), 0);
  return {triangles.cols(), term->counters().candidates, term->counters().elements, search_s};
}

TEST(Nightly, SearchesAMillionTrianglesInTimeAndMemoryThatGrowLinearly) {
  if (is_sanitized()) return;
  const SearchCost quarter = cost_of_search(250), whole = cost_of_search(500);
  std::printf("%ld triangles: %ld candidates, %ld in contact, %.2f s; %ld triangles: %ld, %ld, %.2f s\n",
              quarter.triangles, quarter.candidates, quarter.active, quarter.search_s, whole.triangles,
              whole.candidates, whole.active, whole.search_s);
  EXPECT_EQ(whole.triangles, 1000000);
  EXPECT_GT(whole.active, 100000);
  EXPECT_LT(whole.candidates, 20 * whole.triangles);
  EXPECT_LT(whole.candidates, 4.5 * static_cast<double>(quarter.candidates));
  EXPECT_LT(whole.search_s, 7 * quarter.search_s);
}

TEST(ContactBarrier, NamesTheOptionThatIsOutOfRange) {
  Triangles triangles(3, 0);
  try {
    make_contact_barrier("contact", Points(3, 0), triangles, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.defects().size(), 2u);
    EXPECT_NE(std::string(error.what()).find("gap must be positive"), std::string::npos);
  }
}

}  // namespace
}  // namespace coapt
