// xpbd as a whole: weights and chains against closed forms, contact, threads, and what the solver says.
#include "core/error.hpp"
#include "energy/load_dead.hpp"
#include "optim/xpbd/solver_xpbd.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"
#include "support/xpbd_bodies.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace coapt {
namespace {

constexpr double kGravity = 9810;  // [mm/s^2]

XpbdOptions with_step(double seconds) {
  XpbdOptions options;
  options.time_step = seconds;
  return options;
}

Points weights(Eigen::Index count, double mass) {
  Points force = Points::Zero(3, count);
  force.row(2).setConstant(-mass * kGravity);
  return force;
}

// Where a mass of 2e-6 t comes to rest below node 0.
double sag_of_weight(const XpbdBody& body, const XpbdOptions& options, double mass) {
  XpbdSystem system(body, body.rest, fixed_nodes(2, {0}), Vector::Constant(2, mass), options);
  for (int step = 0; step < 2000; ++step) system.step(weights(2, mass));
  EXPECT_LT(system.largest_move(), 1e-12);
  return -system.positions()(2, 1);
}

TEST(Xpbd, AHangingWeightSagsByItsWeightTimesTheCompliance) {
  Points rest(3, 2);
  rest << 0, 0, 0, 0, 0, -10;
  const double mass = 2e-6, stiffness = 0.05;
  const double sag = mass * kGravity / stiffness;
  ASSERT_NEAR(sag, 0.3924, 1e-12);
  std::vector<double> found;
  for (const int iterations : {2, 20, 200}) {
    XpbdOptions options = with_step(0.005);
    options.iterations = iterations;
    found.push_back(sag_of_weight(chain_body(rest, 10, stiffness), options, mass) - 10);
    EXPECT_NEAR(found.back(), sag, 1e-6 * sag);
    EXPECT_NEAR(found.back(), found.front(), 1e-9 * sag);
  }
  const XpbdOptions options = with_step(0.002);
  EXPECT_NEAR(sag_of_weight(chain_body(rest, 10, stiffness), options, mass) - 10, sag, 1e-6 * sag);
}

// Row C1 of the verification table by the law itself: t = 2, rho = 0.5, r = 1, weight 3, length 1.25.
TEST(Xpbd, ALineOfAnyLawCarriesAWeightAtItsClosedForm) {
  Points rest(3, 2);
  rest << 0, 0, 0, 0, 0, -1;
  XpbdBody body = chain_body(rest, 1, 0);
  body.tethers[0].law = [](double l) {
    const double u = std::max(l - 1, 0.0) / 0.5;
    return AxialLaw{2 * u * u * u, 12 * u * u, 48 * u};
  };
  for (const int iterations : {10, 20}) {
    XpbdOptions options = with_step(0.005);
    options.iterations = iterations;
    EXPECT_NEAR(sag_of_weight(body, options, 3 / kGravity), 1.25, 1e-6) << iterations;
  }
  body.tethers[0].law = [](double l) { return AxialLaw{4 * l, 4, 0}; };  // constant, more than the weight
  XpbdSystem system(body, body.rest, fixed_nodes(2, {0}), Vector::Constant(2, 3 / kGravity),
                    with_step(0.005));
  for (int step = 0; step < 5; ++step) system.step(weights(2, 3 / kGravity));
  EXPECT_GT(system.positions()(2, 1), -1);
}

// A chain of `links` elastic links of length L and stiffness k between ends 1 apart on one level, the weight
// 1 on each node within: by its horizontal force H, which the span decides.
struct HangingChain {
  int links;
  double length, stiffness, horizontal = 1;

  double vertical(int link) const { return 0.5 * (links - 1) - link; }
  double tension(int link) const { return std::hypot(horizontal, vertical(link)); }
  double stretched(int link) const { return length + tension(link) / stiffness; }
  double span() const {
    double sum = 0;
    for (int k = 0; k < links; ++k) sum += stretched(k) * horizontal / tension(k);
    return sum;
  }
  double sag() const {
    double sum = 0;
    for (int k = 0; k < links / 2; ++k) sum += stretched(k) * vertical(k) / tension(k);
    return sum;
  }
};

HangingChain hanging_chain(int links, double length, double stiffness) {
  HangingChain chain{links, length, stiffness};
  double low = 1e-6, high = 1e6;
  for (int k = 0; k < 200; ++k) {
    chain.horizontal = std::sqrt(low * high);
    (chain.span() < 1 ? low : high) = chain.horizontal;
  }
  return chain;
}

// Row C3b of the verification table is the limit of stiff links.
TEST(Xpbd, AChainHangsAsItsClosedFormSays) {
  const int n = 20;
  EXPECT_NEAR(hanging_chain(n, 0.06, 1e10).sag(), 0.292721475, 1e-7);
  EXPECT_NEAR(hanging_chain(n, 0.06, 1e10).horizontal, 7.81995341, 1e-6);
  const HangingChain chain = hanging_chain(n, 0.06, 2000);
  Points start(3, n + 1);
  for (int k = 0; k <= n; ++k) {
    const double s = static_cast<double>(k) / n;
    start.col(k) = Vec3(s, 0, -1.2 * s * (1 - s));
  }
  XpbdOptions options = with_step(0.01);
  options.damping = 0.03;
  XpbdSystem system(chain_body(start, 0.06, 2000), start, fixed_nodes(n + 1, {0, n}), Vector::Ones(n + 1),
                    options);
  Points force = Points::Zero(3, n + 1);
  force.row(2).setConstant(-1);
  for (int step = 0; step < 2000; ++step) system.step(force);
  EXPECT_LT(system.largest_move(), 1e-9);
  EXPECT_NEAR(-system.positions()(2, n / 2), chain.sag(), 1e-4 * chain.sag());
  // The multipliers are the tensions.
  const double dt2 = 0.01 * 0.01;
  double largest = 0;
  for (const double lambda : system.tethers().multipliers()) largest = std::max(largest, -lambda / dt2);
  EXPECT_NEAR(largest, chain.tension(0), 1e-3 * chain.tension(0));
}

TEST(Xpbd, InternalConstraintsMoveNoCentreOfMass) {
  const TriangleMesh mesh = grid_mesh(5, 4);
  XpbdBody body = sheet_body(mesh, 3, 2, 0.1, 0.5);
  XpbdTether tether;
  tether.b = mesh.vertex_count() - 1;
  tether.length = 0.5;
  tether.stiffness = 4;
  body.tethers.push_back(tether);
  const Points start = mesh.vertices + 0.2 * random_points(mesh.vertex_count(), 3);
  const Vector masses = (random_points(mesh.vertex_count(), 4).row(0).array() + 2).matrix();
  XpbdOptions options = with_step(0.005);
  options.damping = 0;
  options.iterations = 7;
  XpbdSystem system(body, start, none_fixed(mesh.vertex_count()), masses, options);
  const Points nothing = Points::Zero(3, mesh.vertex_count());
  for (int step = 0; step < 50; ++step) {
    system.step(nothing);
    EXPECT_LT(((system.positions() - start) * masses).norm(), 1e-12);
  }
  EXPECT_GT((system.positions() - start).norm(), 0.1);
  EXPECT_TRUE(system.positions().allFinite());
}

TEST(Xpbd, HasTheSameBitsOnTwoThreadsAsOnOne) {
  const TriangleMesh mesh = grid_mesh(72, 72, 20, 20);
  const XpbdBody body = sheet_body(mesh, 3, 2, 0.1, 0.2);
  const FixedMask fixed = fixed_nodes(mesh.vertex_count(), {0, 72});
  const Points force = weights(mesh.vertex_count(), 1e-7);
  std::vector<Points> found;
  for (const int threads : {1, 2}) {
    XpbdOptions options = with_step(0.005);
    options.threads = threads;
    options.iterations = 3;
    XpbdSystem system(body, mesh.vertices, fixed, Vector::Constant(mesh.vertex_count(), 1e-7), options);
    for (int step = 0; step < 5; ++step) system.step(force);
    found.push_back(system.positions());
  }
  EXPECT_EQ(found[0], found[1]);
  EXPECT_GT((found[0] - mesh.vertices).norm(), 1e-3);
}

// A small sheet falls on a fixed plate and stays h above it.
TEST(Xpbd, ContactKeepsItsThickness) {
  const TriangleMesh plate = grid_mesh(2, 2, 6, 6),
                     mesh = joined(plate, moved(grid_mesh(3, 3, 2, 2), Vec3(1.9, 2.1, 1.5)));
  const int held = plate.vertex_count(), count = mesh.vertex_count();
  XpbdBody body = sheet_body(mesh, 1, 1, 0.01);
  body.has_contact = true;
  std::vector<int> fixed(held);
  for (int k = 0; k < held; ++k) fixed[k] = k;
  const double mass = 1e-6;
  const XpbdOptions options = with_step(0.001);
  XpbdSystem system(body, mesh.vertices, fixed_nodes(count, fixed), Vector::Constant(count, mass), options);
  for (int step = 0; step < 400; ++step) system.step(weights(count, mass));
  const Points fallen = system.positions().rightCols(count - held);
  EXPECT_NEAR(fallen.row(2).minCoeff(), options.thickness, 1e-3);
  EXPECT_NEAR(fallen.row(2).maxCoeff(), options.thickness, 1e-3);
  EXPECT_EQ(system.positions().leftCols(held), plate.vertices);
  EXPECT_GT(system.contact()->active_count(), 0U);
  EXPECT_LT(system.contact()->search_count(), 400);
}

TEST(Xpbd, KeepsPrescribedCoordinates) {
  Points rest(3, 2);
  rest << 0, 3, 0, 4, 0, 0;
  FixedMask fixed = fixed_nodes(2, {0});
  fixed(0, 1) = true;
  const double mass = 1e-2;
  XpbdSystem system(chain_body(rest, 5, 1), rest, fixed, Vector::Constant(2, mass), with_step(0.005));
  Points force = Points::Zero(3, 2);
  force(0, 1) = 7;
  force(1, 1) = 0.5;
  for (int step = 0; step < 1000; ++step) system.step(force);
  EXPECT_EQ(system.positions()(0, 1), 3);
  EXPECT_EQ(system.positions().col(0), rest.col(0));
  const double l = std::hypot(3, system.positions()(1, 1));
  EXPECT_NEAR((l - 5) * system.positions()(1, 1) / l, 0.5, 1e-3);
}

// --- The solver -------------------------------------------------------------------------------------------

struct Weight {
  Weight() : X(3, 2) { X << 0, 0, 0, 0, 0, -10; }

  std::unique_ptr<Objective> objective() const {
    Points force = Points::Zero(3, 2);
    force(2, 1) = -0.02;
    Segments link(2, 1);
    link << 0, 1;
    return std::make_unique<Objective>(
        X, fixed_nodes(2, {0}),
        terms_of(cable_term(link, 0.5, Vector::Constant(1, 10)),
                 std::make_unique<LoadDead>("weight", "load_field", force, X)));
  }

  SolverOptions options() const {
    SolverOptions options;
    options.xpbd = with_step(0.005);
    options.masses = [] { return Vector(Vector::Constant(2, 2e-6)); };
    options.xpbd_body = [rest = X] { return std::make_shared<const XpbdBody>(chain_body(rest, 10, 0.05)); };
    return options;
  }

  Result run(const SolverOptions& options, double tolerance = 1e-6) const {
    const auto objective = this->objective();
    StopRule stop;
    stop.tolerance = tolerance;
    return solve(*built_in_solvers().at("xpbd")(options), {*objective, objective->unknowns(X)}, stop);
  }

  Points X;
};

TEST(SolverXpbd, ConvergesByTheResidualOfTheSceneWhereItsConstraintsAreTheEnergies) {
  const Weight weight;
  const Result result = weight.run(weight.options());
  EXPECT_EQ(result.status, Status::Converged) << result.message;
  EXPECT_LE(result.residual, 1e-6);
  EXPECT_NEAR(result.q[2], -10.4, 1e-5);
  EXPECT_GT(result.trace.back().time, 0);
  EXPECT_NEAR(result.trace.back().time, 0.005 * result.iterations, 1e-9);
}

TEST(SolverXpbd, SaysThatItIsAtRestWhereTheResidualIsNotReached) {
  const Weight weight;
  SolverOptions options = weight.options();
  options.xpbd_body = [rest = weight.X] {
    return std::make_shared<const XpbdBody>(chain_body(rest, 10, 0.06));  // not the scene's stiffness
  };
  const Result result = weight.run(options);
  EXPECT_EQ(result.status, Status::Stalled);
  EXPECT_NEAR(result.residual, 0.2 / 1.2, 0.05);
  EXPECT_NE(result.message.find("at rest after"), std::string::npos) << result.message;
  EXPECT_NEAR(result.q[2], -10 - 0.02 / 0.06, 1e-4);

  options.xpbd.steps = 3;
  const Result cut = weight.run(options);
  EXPECT_EQ(cut.status, Status::Stalled);
  EXPECT_NE(cut.message.find("still moving after 3 steps"), std::string::npos) << cut.message;
}

TEST(SolverXpbd, RunsTwiceToTheSameBits) {
  const Weight weight;
  const Result first = weight.run(weight.options()), second = weight.run(weight.options());
  EXPECT_EQ(first.q, second.q);
  EXPECT_EQ(first.trace.size(), second.trace.size());
}

TEST(SolverXpbd, TurnsTheForcesRoundInDiastole) {
  const Weight weight;
  SolverOptions options = weight.options();
  options.xpbd.phase = HeartPhase::Diastole;
  options.xpbd.steps = 20;
  EXPECT_GT(weight.run(options).q[2], -10);
}

std::string refusal(const SolverOptions& options) {
  try {
    Weight().run(options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SolverXpbd, RefusesWhatItCannotUse) {
  const SolverOptions good = Weight().options();
  SolverOptions bad = good;
  bad.xpbd = {.time_step = -1, .iterations = 0, .steps = 0, .damping = 1.5, .thickness = -1};
  bad.xpbd.threads = 0;
  const std::string all = refusal(bad);
  for (const char* key : {"time_step", "iterations", "steps", "damping", "thickness", "threads"})
    EXPECT_NE(all.find(std::string("solver \"xpbd\": ") + key + ": "), std::string::npos) << key;

  SolverOptions no_body = good;
  no_body.xpbd_body = {};
  EXPECT_NE(refusal(no_body).find("needs the constraints"), std::string::npos);
  SolverOptions no_masses = good;
  no_masses.masses = {};
  EXPECT_NE(refusal(no_masses).find("needs the masses"), std::string::npos);
  SolverOptions few_masses = good;
  few_masses.masses = [] { return Vector(Vector::Ones(1)); };
  EXPECT_NE(refusal(few_masses).find("one positive mass for each of 2 nodes"), std::string::npos);
  SolverOptions no_annulus = good;
  no_annulus.xpbd.forces = XpbdForces::Paper;
  EXPECT_NE(refusal(no_annulus).find("annulus"), std::string::npos);
  SolverOptions no_pressure = good;
  no_pressure.xpbd.stiffness = XpbdStiffness::Paper;
  EXPECT_NE(refusal(no_pressure).find("no pressure"), std::string::npos);
}

}  // namespace
}  // namespace coapt
