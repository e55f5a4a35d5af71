// What a result says beyond its residual: minimum, saddle or flat, free nodes, free parts, where a run that
// did not converge is farthest from equilibrium. Rows S8, S9 and S10 of the verification table.
#include "optim/stability/certificate.hpp"

#include "energy/element_term.hpp"
#include "energy/kernels/link.hpp"
#include "energy/kernels/surface_tension.hpp"
#include "energy/load_dead.hpp"
#include "energy/load_pressure.hpp"
#include "optim/solver.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace coapt {
namespace {

const StabilityOptions kAsked{make_eigen_factorisation};

Result solved(Objective& objective, const Vector& q, const std::string& solver, double tolerance = 1e-9,
              const StabilityOptions& asked = kAsked, int max_iterations = 100000) {
  StopRule stop;
  stop.tolerance = tolerance;
  stop.max_iterations = max_iterations;
  Problem problem{objective, q};
  problem.stability = asked;
  return solve(*built_in_solvers().at(solver)({}), problem, stop);
}

std::unique_ptr<EnergyTerm> weight(const Points& forces, const Points& X) {
  return std::make_unique<LoadDead>("weight", "load_field", forces, X);
}

Points forces_on(Eigen::Index node_count, const std::vector<int>& nodes, const Vec3& force) {
  Points forces = Points::Zero(3, node_count);
  for (const int node : nodes) forces.col(node) = force;
  return forces;
}

// A disc, held at its rim and blown up; further nodes and terms may be added.
struct Disc {
  TriangleMesh mesh = smooth_disc_mesh(8);
  Points start = mesh.vertices;
  std::vector<int> rim;

  Disc() {
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      const double r2 = start.col(v).squaredNorm();
      if (r2 > 1 - 1e-9)
        rim.push_back(v);
      else
        start(2, v) = 0.1 * (1 - r2);
    }
  }
  Terms terms(const Points& X) const {
    return terms_of(membrane_term(X, mesh.triangles, {1, 0.3, 0}),
                    make_follower_pressure("p", X, mesh.triangles, 0.01, fixed_nodes(X.cols(), rim)));
  }
  Objective objective() const {
    return Objective(start, fixed_nodes(start.cols(), rim), terms(mesh.vertices));
  }
};

TEST(Certificate, SaysOfAPressurisedDiscThatItIsAStrictMinimum) {
  const Disc disc;
  for (const std::string solver : {"newton", "lbfgs"}) {
    Objective objective = disc.objective();
    const Result result = solved(objective, objective.unknowns(disc.start), solver);
    ASSERT_EQ(result.status, Status::Converged) << result.message;
    const Certificate& certificate = result.certificate;
    EXPECT_TRUE(certificate.is_made && certificate.is_conservative);
    EXPECT_EQ(certificate.stability.verdict, Stability::StrictMinimum);
    EXPECT_GT(certificate.stability.pivot_ratio, 1e-8);
    EXPECT_LT(certificate.stability.pivot_ratio, 1);
    EXPECT_EQ(certificate.stability.loose_nodes, 0);
    EXPECT_EQ(certificate.stability.factorisations, 1);
    EXPECT_TRUE(certificate.free_parts.empty());
    EXPECT_FALSE(certificate.imbalance.has_value());
    EXPECT_LT(certificate.balance.force, 1e-10);
    EXPECT_EQ(certificate.residual, result.residual);
    EXPECT_GT(result.phase_s.at("certificate"), 0);
  }
}

TEST(Certificate, CostsNothingWhereItIsNotAskedFor) {
  const Disc disc;
  Objective objective = disc.objective();
  const Result result = solved(objective, objective.unknowns(disc.start), "lbfgs", 1e-9, {});
  EXPECT_FALSE(result.certificate.is_made);
  EXPECT_EQ(result.evaluations.hessian, 0);
  EXPECT_EQ(result.factorisations, 0);
}

TEST(Certificate, TakesJunctionsOfSlackChordsOut) {
  const Disc disc;
  const auto n = static_cast<int>(disc.start.cols());
  Points start(3, n + 3);  // two points far below, and a junction between them and the disc's centre
  start.leftCols(n) = disc.start;
  start.col(n) = Vec3(-0.2, 0, -1);
  start.col(n + 1) = Vec3(0.2, 0, -1);
  start.col(n + 2) = Vec3(0, 0, -0.5);
  Segments chords(2, 3);
  chords << n, n + 1, n + 2, n + 2, n + 2, 40;
  std::vector<int> held = disc.rim;
  held.push_back(n);
  held.push_back(n + 1);
  Terms terms = disc.terms(start);
  Points X = start;
  X.leftCols(n) = disc.mesh.vertices;
  terms = disc.terms(X);
  terms.push_back(cable_term(chords, 10, Vector::Constant(3, 5)));
  Objective objective(start, fixed_nodes(n + 3, held), std::move(terms));
  const Result result = solved(objective, objective.unknowns(start), "newton");
  ASSERT_EQ(result.status, Status::Converged) << result.message;
  EXPECT_EQ(result.certificate.stability.loose_nodes, 1);
  EXPECT_EQ(result.certificate.stability.verdict, Stability::StrictMinimum);
  EXPECT_EQ(result.certificate.stability.free_directions, 3);
  EXPECT_EQ(result.certificate.free_nodes, std::vector<int>{n + 2});
  EXPECT_TRUE(stability_doubt(result.certificate).empty());
  EXPECT_NE(summary(result.certificate).find("1 free node"), std::string::npos);
}

TEST(Certificate, CountsTheSixMotionsOfAFloatingBalloon) {
  const TriangleMesh mesh = sphere_mesh(2);
  const FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  Objective objective(1.05 * mesh.vertices, fixed,
                      terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, 0.3, 0}),
                               make_follower_pressure("p", mesh.vertices, mesh.triangles, 0.3, fixed)));
  const Result result = solved(objective, objective.unknowns(1.05 * mesh.vertices), "newton");
  ASSERT_EQ(result.status, Status::Converged) << result.message;
  EXPECT_EQ(result.certificate.stability.verdict, Stability::Flat);
  EXPECT_EQ(result.certificate.stability.zero_modes, 6);
  EXPECT_EQ(result.certificate.stability.negative_modes, 0);
  EXPECT_EQ(static_cast<int>(result.certificate.free_nodes.size()), mesh.vertex_count());
  EXPECT_TRUE(stability_doubt(result.certificate).empty());
  ASSERT_EQ(result.certificate.free_parts.size(), 1u);
  EXPECT_EQ(result.certificate.free_parts[0].free_motions, 6);
  EXPECT_EQ(result.certificate.free_parts[0].node_count, mesh.vertex_count());
}

// A strip of a membrane that resists compression, its ends pushed together: it stays flat by symmetry alone.
struct PushedStrip {
  TriangleMesh mesh = grid_mesh(10, 2, 1, 0.2);
  Points start = mesh.vertices;
  std::vector<int> ends;

  PushedStrip() {
    start.row(0) *= 0.95;
    for (int v = 0; v < mesh.vertex_count(); ++v)
      if (mesh.vertices(0, v) < 1e-9 || mesh.vertices(0, v) > 1 - 1e-9) ends.push_back(v);
  }
  Objective objective() const {
    return Objective(start, fixed_nodes(start.cols(), ends),
                     terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, 0.3, 0})));
  }
};

TEST(Certificate, CountsTheNegativeModesOfASaddle) {
  const PushedStrip strip;
  Objective objective = strip.objective();
  const Result result = solved(objective, objective.unknowns(strip.start), "lbfgs", 1e-9, {});
  ASSERT_EQ(result.status, Status::Converged) << result.message;
  const Certificate certificate = certify(objective, result.q, 1e-9, kAsked);
  Vector g;
  SparseMatrix h;
  objective.hessian(result.q, g, h);
  const Eigen::MatrixXd dense = Eigen::MatrixXd(h).selfadjointView<Eigen::Lower>();
  const Vector values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues();
  const auto negative = static_cast<int>((values.array() < -1e-10).count());
  EXPECT_GT(negative, 5);
  EXPECT_EQ(certificate.stability.verdict, Stability::Saddle);
  EXPECT_EQ(certificate.stability.negative_modes, negative);
  EXPECT_EQ(certificate.stability.zero_modes, 0);
  const Vector& mode = certificate.stability.descent;
  ASSERT_EQ(mode.size(), result.q.size());
  EXPECT_LT(mode.dot(dense * mode), 0.5 * values[0]);
}

TEST(Certificate, CountsNoModesBeyondTheSizeThatItMayTake) {
  const PushedStrip strip;
  Objective objective = strip.objective();
  const Result result = solved(objective, objective.unknowns(strip.start), "lbfgs", 1e-9, {});
  StabilityOptions options = kAsked;
  options.most_unknowns = 10;
  const Certificate certificate = certify(objective, result.q, 1e-9, options);
  EXPECT_EQ(certificate.stability.verdict, Stability::Saddle);
  EXPECT_EQ(certificate.stability.negative_modes, -1);
  EXPECT_NE(stability_doubt(certificate).find("saddle"), std::string::npos);
}

class Solvers : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Table, Solvers, testing::Values("newton", "lbfgs"),
                         [](const auto& instance) { return instance.param; });

TEST_P(Solvers, S9LeavesASaddleForAMinimum) {
  const PushedStrip strip;
  Objective objective = strip.objective(), flat = strip.objective();
  const Vector start = objective.unknowns(strip.start);
  const Result stayed = solved(flat, start, GetParam(), 1e-9, {});
  const Result result = solved(objective, start, GetParam());
  ASSERT_EQ(result.status, Status::Converged) << result.message;
  EXPECT_NE(result.certificate.stability.verdict, Stability::Saddle) << summary(result.certificate);
  EXPECT_LT(result.energy, 0.5 * stayed.energy);
  EXPECT_FALSE(result.certificate.is_balance_clear);  // buckled: neither loads nor reactions are left
  EXPECT_EQ(summary(result.certificate).find("reactions"), std::string::npos);
  EXPECT_GT(objective.positions(result.q).row(2).cwiseAbs().maxCoeff(), 0.01);
  std::printf("S9 %s: %d iterations, %s, %s\n", GetParam().c_str(), result.iterations, result.message.c_str(),
              summary(result.certificate).c_str());
}

// Two links in a row, too long for their supports, and a small force across: at the saddle they bend a
// little against it. Whatever sign a mode has, the force says where they snap to.
TEST_P(Solvers, LeavesASaddleToTheSideOnWhichTheEnergyFallsMore) {
  constexpr double kLength = 1.2;
  for (const double force : {0.02, -0.02}) {
    double y = 0;  // of the saddle
    for (int k = 0; k < 50; ++k) y = force / (2 - 2 * kLength / std::hypot(1, y));
    Points x(3, 3);
    x << -1, 0, 1, 0, y, 0, 0, 0, 0;
    FixedMask fixed = FixedMask::Constant(3, 3, true);
    fixed(1, 1) = false;
    Points forces = Points::Zero(3, 3);
    forces(1, 1) = force;
    std::vector<std::unique_ptr<EnergyTerm>> terms;
    terms.push_back(std::make_unique<ElementTerm<Link>>("links", std::vector<int>{0, 1, 1, 2},
                                                        std::vector<Link::Rest>{{1, kLength}, {1, kLength}}));
    terms.push_back(std::make_unique<LoadDead>("across", "load_field", forces, x));
    Objective objective(x, fixed, std::move(terms));
    const Result result = solved(objective, objective.unknowns(x), GetParam());
    ASSERT_EQ(result.status, Status::Converged) << result.message;
    EXPECT_NE(result.message.find("a saddle was left"), std::string::npos) << result.message;
    EXPECT_GT(objective.positions(result.q)(1, 1) * force, 0);
  }
}

TEST(Certificate, BeginsTheMessageWithADoubtThatRemains) {
  const PushedStrip strip;
  Objective objective = strip.objective();
  StabilityOptions stays = kAsked;
  stays.finds_descent = false;
  const Result result = solved(objective, objective.unknowns(strip.start), "lbfgs", 1e-9, stays);
  ASSERT_EQ(result.status, Status::Converged) << result.message;
  EXPECT_TRUE(result.message.starts_with("converged, but its stability is in doubt (a saddle of the energy"))
      << result.message;
}

TEST(Certificate, NamesTheNodeAndTheTermFarthestFromEquilibrium) {
  const Disc disc;
  Terms terms = disc.terms(disc.mesh.vertices);
  const int loaded = 40;
  terms.push_back(weight(forces_on(disc.start.cols(), {loaded}, Vec3(0, 0, -5)), disc.mesh.vertices));
  Objective objective(disc.start, fixed_nodes(disc.start.cols(), disc.rim), std::move(terms));
  const Result result = solved(objective, objective.unknowns(disc.start), "newton", 1e-9, kAsked, 0);
  EXPECT_EQ(result.status, Status::IterationLimit);
  const Certificate& certificate = result.certificate;
  ASSERT_TRUE(certificate.imbalance.has_value());
  EXPECT_EQ(certificate.imbalance->node, loaded);
  EXPECT_EQ(certificate.imbalance->term, "weight");
  EXPECT_NEAR(certificate.imbalance->force, 5, 0.1);
  EXPECT_NEAR(certificate.imbalance->share, 5, 0.1);
  EXPECT_EQ(certificate.imbalance->position, Vec3(disc.start.col(loaded)));
  EXPECT_EQ(certificate.stability.verdict, Stability::NotKnown);
}

// --- S8: nothing to do ------------------------------------------------------------------------------------

struct Rope {  // three nodes in a row, two links
  Points X{{0, 1, 2}, {0, 0, 0}, {0, 0, 0}};
  Segments links{{0, 1}, {1, 2}};

  Objective objective(const std::vector<int>& held, double rest_length, double force) const {
    return Objective(X, fixed_nodes(3, held),
                     terms_of(cable_term(links, 10, Vector::Constant(2, rest_length)),
                              weight(forces_on(3, {1}, Vec3(0, 0, -force)), X)));
  }
};

TEST_P(Solvers, S8SayAtOnceThatNothingIsToBeDone) {
  const Rope rope;
  struct Case {
    const char* what;
    std::vector<int> held;
    double rest_length, force;
    const char* said;
    Stability verdict;
  };
  for (const Case& c :
       {Case{"fully slack", {0, 2}, 1.5, 0, "no force acts", Stability::NothingToCheck},
        Case{"zero load", {0, 2}, 0.9, 0, "equilibrium already", Stability::StrictMinimum},
        Case{"all fixed", {0, 1, 2}, 0.9, 1, "no coordinate is free", Stability::NothingToCheck},
        Case{"all fixed and slack", {0, 1, 2}, 1.5, 0, "no coordinate is free", Stability::NothingToCheck}}) {
    Objective objective = rope.objective(c.held, c.rest_length, c.force);
    const Result result = solved(objective, objective.unknowns(rope.X), GetParam());
    EXPECT_EQ(result.status, Status::Converged) << c.what << ": " << result.message;
    EXPECT_EQ(result.iterations, 0) << c.what;
    EXPECT_NE(result.message.find(c.said), std::string::npos) << c.what << ": " << result.message;
    EXPECT_EQ(result.certificate.stability.verdict, c.verdict) << c.what;
  }
}

TEST_P(Solvers, S8SolveForOneFreeNode) {
  const Rope rope;
  Objective objective = rope.objective({0, 2}, 0.9, 1);
  const Result result = solved(objective, objective.unknowns(rope.X), GetParam());
  EXPECT_EQ(result.status, Status::Converged) << result.message;
  EXPECT_LT(result.iterations, 30);
  EXPECT_EQ(result.certificate.stability.verdict, Stability::StrictMinimum);
}

// --- S10: no equilibrium ----------------------------------------------------------------------------------

void expect_named(const Result& result, const std::string& said) {
  EXPECT_EQ(result.status, Status::NoEquilibrium) << result.message;
  EXPECT_LE(result.iterations, 1000);
  EXPECT_NE(result.message.find(said), std::string::npos) << result.message;
  EXPECT_TRUE(result.q.allFinite());
  std::printf("S10: %d iterations, %s\n", result.iterations, result.message.c_str());
}

TEST_P(Solvers, S10NameAPartThatNothingHolds) {
  Points X(3, 5);
  X << 0, 1, 2, 5, 6, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0;
  Segments links(2, 3);
  links << 0, 1, 3, 1, 2, 4;
  Objective objective(X, fixed_nodes(5, {0, 2}),
                      terms_of(cable_term(links, 10, Vector::Constant(3, 0.9)),
                               weight(forces_on(5, {1, 4}, Vec3(0, 0, -1)), X)));
  const Result result = solved(objective, objective.unknowns(X), GetParam());
  expect_named(result, "the part with node 3 (2 nodes) is held by nothing");
  ASSERT_EQ(result.certificate.free_parts.size(), 1u);
  EXPECT_EQ(result.certificate.free_parts[0].free_motions, 5);  // a line has no turn about itself
}

TEST_P(Solvers, S10NameABalloonThatFalls) {
  const TriangleMesh mesh = sphere_mesh(1);
  const FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  const Points gravity = area_forces(nodal_areas(mesh.vertices, mesh.triangles), Vec3(0, 0, -0.01));
  Objective objective(mesh.vertices, fixed,
                      terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, 0.3, 0}),
                               make_follower_pressure("p", mesh.vertices, mesh.triangles, 0.3, fixed),
                               weight(gravity, mesh.vertices)));
  const Result result = solved(objective, objective.unknowns(mesh.vertices), GetParam());
  expect_named(result, "is held by nothing: it can move in 6 ways");
  EXPECT_EQ(result.iterations, 0);
}

TEST_P(Solvers, S10NameAnOpenMembraneThatPressureDrivesAway) {
  const TriangleMesh mesh = smooth_disc_mesh(4);
  const FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  Objective objective(mesh.vertices, fixed,
                      terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, 0.3, 0}),
                               make_follower_pressure("p", mesh.vertices, mesh.triangles, 0.01, fixed)));
  const Result result = solved(objective, objective.unknowns(mesh.vertices), GetParam());
  expect_named(result, "is held by nothing: it can move in 6 ways");
}

// A soap film between two rings of radius 1, which has an equilibrium up to a distance of 1.3255.
Objective film(double distance, Points& start) {
  const int around = 24, along = 12;
  start.resize(3, around * (along + 1));
  std::vector<int> corners, rings;
  for (int j = 0; j <= along; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      const int node = i + around * j, next = (i + 1) % around + around * j;
      start.col(node) =
          Vec3(std::cos(angle), std::sin(angle), distance * (static_cast<double>(j) / along - 0.5));
      if (j == 0 || j == along) rings.push_back(node);
      if (j < along)
        corners.insert(corners.end(), {node, next, node + around, next, next + around, node + around});
    }
  const std::vector<SurfaceTension::Rest> rest(corners.size() / 3, {1});
  return Objective(start, fixed_nodes(start.cols(), rings),
                   terms_of(std::make_unique<ElementTerm<SurfaceTension>>("film", corners, rest)));
}

TEST_P(Solvers, S10NameASoapFilmBetweenRingsTooFarApart) {
  Points start;
  Objective near = film(1.2, start);
  const Result held = solved(near, near.unknowns(start), GetParam(), 1e-6);
  EXPECT_EQ(held.status, Status::Converged) << held.message;
  std::printf("film: %d, %s\n", held.iterations, summary(held.certificate).c_str());
  Objective far = film(1.6, start);
  expect_named(solved(far, far.unknowns(start), GetParam(), 1e-6), "pinches off");
}

}  // namespace
}  // namespace coapt
