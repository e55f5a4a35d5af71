// The verdict on stability where the tangent is not symmetric, what costs nothing, and that neither axes,
// units nor the order of nodes change a verdict.
#include "optim/stability/stability.hpp"

#include "energy/load_dead.hpp"
#include "energy/load_pressure.hpp"
#include "optim/stability/certificate.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"
#include "support/valve_scene.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

const StabilityOptions kAsked{make_eigen_factorisation};

// A dense tangent whose blocks are all coupled.
struct Tangent {
  explicit Tangent(const Eigen::MatrixXd& whole)
      : symmetric(0.5 * (whole + whole.transpose())), skew(0.5 * (whole - whole.transpose())) {}

  StabilityReport report(double zero = 1e-9, const StabilityOptions& options = kAsked) const {
    SparseMatrix lower(symmetric.rows(), symmetric.cols());
    for (int column = 0; column < symmetric.cols(); ++column)
      for (int row = 3 * (column / 3); row < symmetric.rows(); ++row)
        lower.insert(row, column) = symmetric(row, column);
    lower.makeCompressed();
    const SkewProduct product = [this](const Vector& v, Vector& out) { out += skew * v; };
    return classify_stability(lower, skew.isZero(1e-14) ? SkewProduct() : product,
                              std::vector<bool>(static_cast<size_t>(symmetric.rows()), false), zero, options);
  }
  double lowest() const {
    return Eigen::EigenSolver<Eigen::MatrixXd>(symmetric + skew).eigenvalues().real().minCoeff();
  }

  Eigen::MatrixXd symmetric, skew;
};

// 2 x 2 in the first two of `size` unknowns, the others of stiffness 1, 1.1, ..., all turned in space.
Tangent hidden(const Eigen::Matrix2d& upper_left, int size) {
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(size, size);
  for (int k = 0; k < size; ++k) whole(k, k) = 1 + 0.1 * k;
  whole.topLeftCorner<2, 2>() = upper_left;
  const Eigen::MatrixXd mixed = Eigen::MatrixXd::NullaryExpr(size, size, [](Eigen::Index i, Eigen::Index j) {
    return std::sin(1.0 + 3.1 * i + 7.3 * i * j + 0.7 * j);
  });
  const Eigen::MatrixXd turn = Eigen::HouseholderQR<Eigen::MatrixXd>(mixed).householderQ();
  return Tangent(turn * whole * turn.transpose());
}

// A follower load with two coordinates: the tangent [a, w; -w, b] has the eigenvalues (a+b)/2 +-
// sqrt(((a-b)/2)^2
// - w^2). Its symmetric part is diag(a, b), whatever w is.
Eigen::Matrix2d follower(double a, double b, double w) {
  Eigen::Matrix2d tangent;
  tangent << a, w, -w, b;
  return tangent;
}

class TwoCoordinates : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Sizes, TwoCoordinates, testing::Values(3, 60, 300));

TEST_P(TwoCoordinates, AreStableThoughTheSymmetricPartIsIndefinite) {
  const StabilityReport report = hidden(follower(-0.01, 0.2, 0.15), GetParam()).report();
  EXPECT_EQ(report.verdict, Stability::Stable);
  EXPECT_EQ(report.negative_modes, 1);
  EXPECT_EQ(report.unstable_modes, 0);
  EXPECT_NEAR(report.lowest.real(), 0.095, 1e-7);
  EXPECT_NEAR(std::abs(report.lowest.imag()), std::sqrt(0.15 * 0.15 - 0.105 * 0.105), 1e-7);
  EXPECT_EQ(report.descent.size(), 0);
}

TEST_P(TwoCoordinates, DivergeWhereARealEigenvalueIsNegative) {
  const Tangent tangent = hidden(follower(-0.05, 0.2, 0.04), GetParam());
  const StabilityReport report = tangent.report();
  EXPECT_EQ(report.verdict, Stability::Divergence);
  EXPECT_EQ(report.unstable_modes, 1);
  const double exact = 0.075 - std::sqrt(0.125 * 0.125 - 0.04 * 0.04);
  EXPECT_NEAR(report.lowest.real(), exact, 1e-7);
  EXPECT_EQ(report.lowest.imag(), 0);
  ASSERT_EQ(report.descent.size(), GetParam());
  EXPECT_LT(((tangent.symmetric + tangent.skew) * report.descent - exact * report.descent).norm(), 1e-6);
}

TEST_P(TwoCoordinates, FlutterWhereAPairHasANegativeRealPart) {
  const StabilityReport report = hidden(follower(-0.05, 0.03, 0.2), GetParam()).report();
  EXPECT_EQ(report.verdict, Stability::Flutter);
  EXPECT_EQ(report.unstable_modes, 2);
  EXPECT_NEAR(report.lowest.real(), -0.01, 1e-7);
  EXPECT_NEAR(std::abs(report.lowest.imag()), std::sqrt(0.2 * 0.2 - 0.04 * 0.04), 1e-7);
  EXPECT_EQ(report.descent.size(), 0);
}

TEST_P(TwoCoordinates, PayNothingNewWhereTheSymmetricPartIsDefinite) {
  const StabilityReport report = hidden(follower(0.01, 0.2, 3), GetParam()).report();
  EXPECT_EQ(report.verdict, Stability::StrictMinimum);
  EXPECT_EQ(report.factorisations, 1);
  EXPECT_FALSE(report.is_tangent_checked);
}

TEST(Stability, OfAnEnergyIsThatOfItsHessian) {
  const StabilityReport report = hidden(follower(-0.01, 0.2, 0), 60).report();
  EXPECT_EQ(report.verdict, Stability::Saddle);
  EXPECT_EQ(report.negative_modes, 1);
  EXPECT_FALSE(report.is_tangent_checked);
}

// Nothing is said that was not found: more than 200 negative modes are not looked for.
TEST(Stability, IsLeftOpenWhereTheEigenvaluesCannotBeFound) {
  const int size = 300;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(size, size);
  for (int k = 0; k < size; ++k) whole(k, k) = k < 220 ? -0.001 * (k + 1) : k;
  whole.block<2, 2>(0, 0) = follower(-0.01, 0.2, 0.15);
  const StabilityReport report = Tangent(whole).report();
  EXPECT_EQ(report.verdict, Stability::NotDecided);
  EXPECT_FALSE(report.is_tangent_checked);
  EXPECT_EQ(report.descent.size(), 0);
  Certificate certificate;
  certificate.is_made = true;
  certificate.stability = report;
  EXPECT_FALSE(is_unstable(report.verdict));
  EXPECT_FALSE(stability_doubt(certificate).empty());
}

// Soft modes by the score around zero, pairs among them. Some of the lowest do not couple to the negative
// mode: they are found as two modes more are kept than are negative.
TEST(Stability, OfATangentWithManySoftModesMissesNone) {
  const int size = 300;
  for (const double lowest : {-0.002, 0.002}) {
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(size, size);
    for (int k = 0; k < size; ++k) whole(k, k) = 0.001 * (1 + k) + 1e-6 * k * k * k;
    for (int k = 0; k < 40; k += 2) {
      whole(k, k + 1) = 0.01;
      whole(k + 1, k) = -0.01;
    }
    // Symmetric part: -0.02 and 0.02 + 2 lowest; a pair with the real part `lowest`, far from the real axis.
    whole.block<2, 2>(40, 40) = follower(-0.02, 0.02 + 2 * lowest, 0.1);
    const Tangent tangent(whole);
    const StabilityReport report = tangent.report();
    EXPECT_EQ(report.verdict, lowest < 0 ? Stability::Flutter : Stability::Stable);
    EXPECT_NEAR(report.lowest.real(), std::min(tangent.lowest(), 1.0), 1e-7);
  }
}

// Hundreds as soft as the eigenvalue that decides, which do not couple to the negative mode: the lowest is
// one of the two modes that are kept beside it.
TEST(Stability, OfATangentWithHundredsOfSoftModesIsDecided) {
  const int size = 300;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(size, size);
  for (int k = 0; k < size; ++k) whole(k, k) = 0.0012 + 2e-6 * k;
  // Symmetric part: -0.001 and 1, of which the coupling makes a positive pair.
  whole.block<2, 2>(0, 0) = follower(-0.001, 1, 0.06);
  const Tangent tangent(whole);
  const StabilityReport report = tangent.report();
  EXPECT_EQ(report.verdict, Stability::Stable);
  EXPECT_NEAR(report.lowest.real(), tangent.lowest(), 1e-9);
}

// --- What costs nothing -----------------------------------------------------------------------------------

TEST(FreeDirections, AreThoseThatNeitherResistNorCouple) {
  Eigen::MatrixXd whole = 100 * Eigen::MatrixXd::Identity(9, 9);
  // The second block resists along one slanted axis alone, stiffly, and the third not at all.
  const Vec3 axis = Vec3(1, 2, -2) / 3;
  whole.block<3, 3>(3, 3) = 1e4 * axis * axis.transpose();
  whole.block<3, 3>(6, 6).setZero();
  const SparseMatrix lower = [&] {
    SparseMatrix matrix(9, 9);
    for (int c = 0; c < 9; ++c)
      for (int r = 3 * (c / 3); r < 9; ++r) matrix.insert(r, c) = whole(r, c);
    matrix.makeCompressed();
    return matrix;
  }();
  std::vector<bool> is_prescribed(9, false);
  auto found = free_directions(lower, {}, is_prescribed, 1e-9);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].block, 1);
  ASSERT_EQ(found[0].axes.cols(), 2);
  EXPECT_LT((axis.transpose() * found[0].axes).norm(), 1e-12);
  EXPECT_EQ(found[1].block, 2);
  EXPECT_EQ(found[1].axes.cols(), 3);

  is_prescribed[7] = true;  // the middle coordinate of the third block
  found = free_directions(lower, {}, is_prescribed, 1e-9);
  EXPECT_EQ(found[1].axes.cols(), 2);
  EXPECT_LT(found[1].axes.row(1).norm(), 1e-15);

  // A follower load that couples the third block to the first.
  const SkewProduct skew = [](const Vector& v, Vector& product) {
    product[0] += v[6];
    product[6] -= v[0];
  };
  is_prescribed[7] = false;
  found = free_directions(lower, skew, is_prescribed, 1e-9);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[1].axes.cols(), 2);
}

TEST(FreeDirections, AreLeftOutOfTheVerdictAndListed) {
  Eigen::MatrixXd whole = Eigen::MatrixXd::Identity(60, 60);
  whole.block<3, 3>(30, 30).setZero();
  whole.block<3, 3>(33, 33) = Vec3(1, 1, 0) * Vec3(1, 1, 0).transpose();
  const StabilityReport report = Tangent(whole).report();
  EXPECT_EQ(report.verdict, Stability::StrictMinimum);
  EXPECT_EQ(report.loose_nodes, 1);
  EXPECT_EQ(report.free_directions, 5);
  EXPECT_EQ(report.free_blocks, (std::vector<int>{10, 11}));
}

// Two blocks that hold each other and nothing else: each resists, both together do not.
TEST(FreeDirections, OfSeveralNodesTogetherAreZeroModesAndListed) {
  Eigen::MatrixXd whole = Eigen::MatrixXd::Identity(60, 60);
  whole.block<6, 6>(30, 30) << Eigen::Matrix3d::Identity(), -Eigen::Matrix3d::Identity(),
      -Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity();
  const StabilityReport report = Tangent(whole).report();
  EXPECT_EQ(report.verdict, Stability::Flat);
  EXPECT_EQ(report.zero_modes, 3);
  EXPECT_EQ(report.free_directions, 0);
  EXPECT_EQ(report.free_blocks, (std::vector<int>{10, 11}));
}

// --- The same state told otherwise ------------------------------------------------------------------------

// All that a certificate counts.
struct Verdict {
  Stability stability;
  int negative, unstable, zero, free;
  std::vector<int> free_nodes;
  bool operator==(const Verdict&) const = default;
};

// The verdict on positions of the scene's own frame, judged in another; node numbers are given back in its
// own.
Verdict verdict_in(const Frame& frame, const ValveScene& scene, const Points& x) {
  Objective objective(frame.points(x), scene.fixed_in(frame), scene.terms(frame));
  const Certificate certificate =
      certify(objective, objective.unknowns(frame.points(x)), 1e-8, {make_multifrontal_factorisation});
  std::vector<int> own(static_cast<size_t>(x.cols()));
  for (int node = 0; node < x.cols(); ++node) own[static_cast<size_t>(frame.node(node))] = node;
  const StabilityReport& report = certificate.stability;
  Verdict verdict{report.verdict,    report.negative_modes,  report.unstable_modes,
                  report.zero_modes, report.free_directions, {}};
  for (const int node : certificate.free_nodes) verdict.free_nodes.push_back(own[static_cast<size_t>(node)]);
  std::sort(verdict.free_nodes.begin(), verdict.free_nodes.end());
  return verdict;
}

// A sound valve, one whose leaflets are so soft that the symmetric part of its tangent is indefinite, and one
// with slack chords.
class Frames : public testing::TestWithParam<ValveOptions> {};
INSTANTIATE_TEST_SUITE_P(Valves, Frames,
                         testing::Values(ValveOptions{}, ValveOptions{.triangles = 200, .young = 0.05},
                                         ValveOptions{.triangles = 200, .seed = 3}));

TEST_P(Frames, ChangeNoVerdict) {
  const ValveScene scene(GetParam());
  const Equilibrium found = scene.solve_in({}, 1e-9);
  ASSERT_EQ(found.result.status, Status::Converged) << found.result.message;
  const Verdict own = verdict_in({}, scene, found.x);
  std::printf("%s: %d negative, %d unstable, %d zero, %d free directions, %zu free nodes\n",
              std::string(stability_name(own.stability)).c_str(), own.negative, own.unstable, own.zero,
              own.free, own.free_nodes.size());
  EXPECT_NE(own.stability, Stability::NotKnown);
  EXPECT_FALSE(is_unstable(own.stability));
  EXPECT_EQ(verdict_in(rotated_frame(), scene, found.x), own);
  EXPECT_EQ(verdict_in(scaled_frame(1e-3, 1), scene, found.x), own);  // m, N, Pa
  EXPECT_EQ(verdict_in(renumbered_frame(static_cast<int>(scene.X.cols())), scene, found.x), own);
  EXPECT_EQ(verdict_in(moved_frame(1000), scene, found.x), own);
}

// Solved anew, by another method too: how many chords are at their onset to the last digit may differ, the
// verdict does not.
TEST_P(Frames, AndSolversFindTheSameVerdict) {
  const ValveScene scene(GetParam());
  const Stability own = verdict_in({}, scene, scene.solve_in({}, 1e-9).x).stability;
  EXPECT_EQ(verdict_in({}, scene, scene.solve_in(rotated_frame(), 1e-9).x).stability, own);
  Method lbfgs = scene.method(1e-9);
  lbfgs.solver = "lbfgs";
  lbfgs.max_iterations = 20000;
  const Equilibrium found = find_equilibrium(scene.X, scene.fixed, scene.terms(), lbfgs);
  ASSERT_EQ(found.result.status, Status::Converged) << found.result.message;
  EXPECT_EQ(verdict_in({}, scene, found.x).stability, own);
}

TEST(Stability, IsNotJudgedOfAStateThatIsNoEquilibrium) {
  const ValveScene scene({.triangles = 200});
  Objective objective(scene.X, scene.fixed, scene.terms());
  const Certificate certificate =
      certify(objective, objective.unknowns(scene.X), 1e-8, {make_multifrontal_factorisation});
  EXPECT_GT(certificate.residual, 1e-8);
  EXPECT_EQ(certificate.stability.verdict, Stability::NotKnown);
  EXPECT_TRUE(certificate.imbalance.has_value());
}

// --- Leaving a divergence ---------------------------------------------------------------------------------

// A strip with its ends pushed together, flat between a follower pressure and a dead load that balances it:
// an equilibrium that its unsymmetric tangent says diverges.
struct LoadedStrip {
  static constexpr double kPressure = 1e-4;
  TriangleMesh mesh = grid_mesh(20, 4, 1, 0.2);
  Points start = mesh.vertices;
  std::vector<int> ends;

  LoadedStrip() {
    start.row(0) *= 0.97;
    for (int v = 0; v < mesh.vertex_count(); ++v)
      if (mesh.vertices(0, v) < 1e-9 || mesh.vertices(0, v) > 1 - 1e-9) ends.push_back(v);
  }
  FixedMask fixed() const { return fixed_nodes(start.cols(), ends); }
  // flat: its positions.
  Objective objective(const Points& flat) const {
    Terms terms = terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, 0.3, 0}),
                           make_follower_pressure("p", mesh.vertices, mesh.triangles, kPressure, fixed()));
    terms.push_back(bending_term(mesh.vertices, mesh.triangles, 1e-4));
    Points balance = Points::Zero(3, flat.cols());
    for (int t = 0; t < mesh.triangles.cols(); ++t) {
      const auto corners = mesh.triangles.col(t);
      const Vec3 normal = Vec3(flat.col(corners[1]) - flat.col(corners[0]))
                              .cross(flat.col(corners[2]) - flat.col(corners[0]));
      for (const int node : corners) balance.col(node) -= kPressure / 6 * normal;
    }
    terms.push_back(std::make_unique<LoadDead>("weight", "load_field", balance, mesh.vertices));
    Objective objective(mesh.vertices, fixed(), std::move(terms));  // at rest: nothing is a prestress
    objective.prescribe(flat);
    return objective;
  }
  // Compressed in its plane, without any load.
  Points flat() const {
    Terms terms = terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, 0.3, 0}));
    terms.push_back(bending_term(mesh.vertices, mesh.triangles, 1e-4));
    Objective objective(start, fixed(), std::move(terms));
    StopRule stop;
    stop.tolerance = 1e-12;
    return objective.positions(
        solve(*built_in_solvers().at("lbfgs")({}), {objective, objective.unknowns(start)}, stop).q);
  }
};

class Leaving : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Solvers, Leaving, testing::Values("newton", "lbfgs"),
                         [](const auto& instance) { return instance.param; });

TEST_P(Leaving, ADivergenceEndsInAStableState) {
  const LoadedStrip strip;
  const Points flat = strip.flat();
  Objective objective = strip.objective(flat);
  const Vector start = objective.unknowns(flat);
  const Certificate before = certify(objective, start, 1e-7, kAsked);
  EXPECT_FALSE(before.is_conservative);
  EXPECT_EQ(before.stability.verdict, Stability::Divergence) << summary(before);
  EXPECT_FALSE(stability_doubt(before).empty());

  StopRule stop;
  stop.tolerance = 1e-7;
  Problem problem{objective, start};
  problem.stability = kAsked;
  const Result result = solve(*built_in_solvers().at(GetParam())({}), problem, stop);
  ASSERT_EQ(result.status, Status::Converged) << result.message;
  std::printf("%s: %d iterations, %s, %s\n", GetParam().c_str(), result.iterations, result.message.c_str(),
              summary(result.certificate).c_str());
  EXPECT_FALSE(is_unstable(result.certificate.stability.verdict));
  EXPECT_TRUE(stability_doubt(result.certificate).empty());
  EXPECT_GT(objective.positions(result.q).row(2).cwiseAbs().maxCoeff(), 0.05);
}

}  // namespace
}  // namespace coapt
