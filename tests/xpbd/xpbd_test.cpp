// xpbd as a whole: weights against closed forms, contact, threads, and what the solver says.
#include "core/error.hpp"
#include "energy/load_dead.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"
#include "support/xpbd_bodies.hpp"
#include "xpbd/solver_xpbd.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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
  for (const double dt : {0.005, 0.002})
    EXPECT_NEAR(sag_of_weight(chain_body(rest, 10, stiffness), with_step(dt), mass) - 10, sag, 1e-6 * sag)
        << dt;
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

// Two sheets, the upper falling on the lower and tied to it node by node.
TEST(Xpbd, HasTheSameBitsOnTwoThreadsAsOnOne) {
  const TriangleMesh lower = grid_mesh(40, 40, 40, 40),
                     mesh = joined(lower, moved(lower, Vec3(0.1, 0.2, 0.6)));
  const int each = lower.vertex_count(), count = mesh.vertex_count();
  XpbdBody body = sheet_body(mesh, 3, 2, 0.1, 0.2);
  body.has_contact = true;
  for (int k = 0; k < each; ++k) {
    XpbdTether tether;
    tether.a = k;
    tether.b = each + k;
    tether.length = 0.3;
    tether.stiffness = 0.01;
    body.tethers.push_back(tether);
  }
  const FixedMask fixed = fixed_nodes(count, {0, 40});
  Points force = weights(count, 1e-6);
  force.leftCols(each).setZero();
  std::vector<Points> found;
  for (const int threads : {1, 2}) {
    XpbdOptions options = with_step(0.002);
    options.threads = threads;
    options.iterations = 3;
    XpbdSystem system(body, mesh.vertices, fixed, Vector::Constant(count, 1e-6), options);
    for (int step = 0; step < 8; ++step) system.step(force);
    found.push_back(system.positions());
    EXPECT_GT(system.contact()->active_count(), 5000U);  // enough that the threads share classes of contact
    double pushes = 0, pulls = 0;
    for (const double lambda : system.contact()->multipliers()) pushes = std::max(pushes, lambda);
    for (const double lambda : system.tethers().multipliers()) pulls = std::max(pulls, -lambda);
    EXPECT_GT(pushes, 0);
    EXPECT_GT(pulls, 0);
  }
  EXPECT_EQ(found[0], found[1]);
}

// Walczak et al. 2019: cords have no compliance (eq. 15), edges 1e-5 (table 1). One node hangs in a step of
// 5 ms by a link of each kind, with a share of 1: the multiplier settles at the weight, C = alpha weight.
TEST(Xpbd, HasCordsOfThePaperWithoutCompliance) {
  Points rest(3, 2);
  rest << 0, 0, 0, 0, 0, -10;
  for (const bool is_edge : {false, true}) {
    XpbdBody body = chain_body(rest, 10, 1);
    body.tethers[0].kind = is_edge ? TetherKind::Edge : TetherKind::Chord;
    XpbdOptions options = walczak_2019();
    options.paper.stretch = 1;
    options.damping = 0.05;
    XpbdSystem system(body, rest, fixed_nodes(2, {0}), Vector::Ones(2), options);
    Points force = Points::Zero(3, 2);
    force(2, 1) = -250;
    for (int step = 0; step < 3000; ++step) system.step(force);
    EXPECT_NEAR(-10 - system.positions()(2, 1), is_edge ? 1e-5 * 250 : 0, 1e-9) << is_edge;
  }
}

// A weight on a clip opens it by its compliance times the weight: 1/k by the material, alpha of cords by the
// paper, which closes clips without a length of their own (Walczak et al. 2019, section 3.8) and no others.
TEST(Xpbd, AClipOpensByItsCompliance) {
  Points rest(3, 2);
  rest << 0, 0, 0, 0, 0, -3.5;
  const double weight = 250, stiffness = 100, length = 3;
  const auto gap = [&](const XpbdOptions& options, bool is_clip) {
    XpbdBody body = chain_body(rest, length, stiffness);
    body.tethers[0].kind = TetherKind::Link;
    body.tethers[0].only_tension = false;
    body.tethers[0].is_clip = is_clip;
    XpbdSystem system(body, rest, fixed_nodes(2, {0}), Vector::Ones(2), options);
    Points force = Points::Zero(3, 2);
    force(2, 1) = -weight;
    for (int step = 0; step < 3000; ++step) system.step(force);
    return -system.positions()(2, 1);
  };
  XpbdOptions paper = walczak_2019();
  paper.damping = 0.05;
  EXPECT_NEAR(gap(with_step(0.005), true), length + weight / stiffness, 1e-6);
  EXPECT_NEAR(gap(paper, false), length, 1e-6);
  for (const double compliance : {0.0, 1e-4, 1e-3}) {
    paper.paper.tether_compliance = compliance;
    EXPECT_NEAR(gap(paper, true), compliance * weight, 1e-6) << compliance;
  }
}

// Contact keeps h from vertices that no clip holds nearer.
TEST(Xpbd, ContactDoesNotOpenAClip) {
  const TriangleMesh plate = grid_mesh(2, 2, 6, 6),
                     mesh = joined(plate, moved(grid_mesh(3, 3, 4, 4), Vec3(1, 1, 2)));
  const int held = plate.vertex_count(), count = mesh.vertex_count(), middle = 4;
  std::vector<int> fixed(held);
  for (int k = 0; k < held; ++k) fixed[k] = k;
  XpbdBody body = sheet_body(mesh, 1, 1, 0.01);
  body.has_contact = true;
  XpbdTether clip;
  clip.a = middle;
  clip.b = held;
  for (int k = held; k < count; ++k)
    if ((mesh.vertices.col(k) - mesh.vertices.col(middle)).norm() <
        (mesh.vertices.col(clip.b) - mesh.vertices.col(middle)).norm())
      clip.b = k;
  clip.stiffness = 1;
  body.tethers.push_back(clip);
  for (const auto kind : {TetherKind::Chord, TetherKind::Link}) {
    body.tethers[0].kind = kind;
    XpbdOptions options = walczak_2019();
    options.damping = 0.1;
    body.tethers[0].is_clip = true;
    XpbdSystem system(body, mesh.vertices, fixed_nodes(count, fixed), Vector::Ones(count), options);
    for (int step = 0; step < 2000; ++step) system.step(Points::Zero(3, count));
    const double gap = (system.positions().col(clip.a) - system.positions().col(clip.b)).norm();
    EXPECT_GT(system.contact()->active_count(), 0U);
    if (kind == TetherKind::Link)
      EXPECT_LT(gap, 1e-3);
    else
      EXPECT_GT(gap, 0.9 * options.thickness);
  }
}

// Two triangles on edge that cross with their edges alone.
TEST(Xpbd, KeepsEdgesApartUnlessVerticesAloneAreMeant) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 6);
  mesh.vertices << -2, 2, 0, 0, 0, 0, 0, 0, 0, -2, 2, 0, 0, 0, -9, 0.3, 0.3, 9;
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 3, 1, 4, 2, 5;
  XpbdBody body = sheet_body(mesh, 1, 0, 0);
  body.rest.rightCols(3).row(2).array() += 5;
  body.has_contact = true;
  for (const auto features : {XpbdContactFeatures::VerticesAndEdges, XpbdContactFeatures::Vertices}) {
    XpbdOptions options = with_step(0.001);
    options.features = features;
    XpbdSystem system(body, mesh.vertices, none_fixed(6), Vector::Ones(6), options);
    system.step(Points::Zero(3, 6));
    EXPECT_EQ(system.contact()->active_count(), features == XpbdContactFeatures::Vertices ? 0U : 1U);
  }
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
    editable(options.xpbd) = with_step(0.005);
    options.masses = [] { return Vector(Vector::Constant(2, 2e-6)); };
    options.xpbd_body = [rest = X] { return std::make_shared<const XpbdBody>(chain_body(rest, 10, 0.05)); };
    return options;
  }

  Result run(const SolverOptions& options, double tolerance = 1e-6, const Observer& observer = {}) const {
    const auto objective = this->objective();
    StopRule stop;
    stop.tolerance = tolerance;
    return solve(*make_xpbd(options), {*objective, objective->unknowns(X)}, stop, observer);
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

  editable(options.xpbd).steps = 3;
  const Result cut = weight.run(options);
  EXPECT_EQ(cut.status, Status::Stalled);
  EXPECT_NE(cut.message.find("still moving after 3 steps"), std::string::npos) << cut.message;
}

// Swinging a little, it rests by the mean move that is asked for, long before no node moves any more.
TEST(SolverXpbd, RestsByTheMeanMoveThatIsAskedFor) {
  const Weight weight;
  SolverOptions options = weight.options();
  options.xpbd_body = [rest = weight.X] {
    return std::make_shared<const XpbdBody>(chain_body(rest, 10, 0.06));
  };
  const Result whole = weight.run(options, 1e-9);
  editable(options.xpbd).rest_move = 1e-3;
  const Result early = weight.run(options, 1e-9);
  EXPECT_NE(early.message.find("at rest after"), std::string::npos) << early.message;
  EXPECT_GT(early.iterations, 50);
  EXPECT_LT(early.iterations, whole.iterations);
}

TEST(SolverXpbd, RunsTwiceToTheSameBits) {
  const Weight weight;
  const Result first = weight.run(weight.options()), second = weight.run(weight.options());
  EXPECT_EQ(first.q, second.q);
  EXPECT_EQ(first.trace.size(), second.trace.size());
}

// Once for the closing that goes before, and once for itself.
TEST(SolverXpbd, TurnsTheForcesRoundInDiastole) {
  const Weight weight;
  SolverOptions options = weight.options();
  editable(options.xpbd).phase = HeartPhase::Diastole;
  editable(options.xpbd).steps = 20;
  const Result result = weight.run(options);
  double lowest = 0;
  weight.run(options, 1e-6, [&](const Iteration&, const Vector& q) {
    lowest = std::min(lowest, q[2]);
    return true;
  });
  EXPECT_LT(lowest, -10.3);
  EXPECT_GT(result.q[2], -9.9);
  EXPECT_NE(result.message.find("of opening"), std::string::npos) << result.message;
  EXPECT_EQ(result.iterations, 39);  // the first of a round is its start
}

// Through the equilibrium at full speed: the force vanishes there, the velocity does not.
TEST(SolverXpbd, IsNotConvergedWhileItMoves) {
  const Weight weight;
  SolverOptions options = weight.options();
  editable(options.xpbd) = with_step(5e-5);
  editable(options.xpbd).damping = 0;
  const Result whole = weight.run(options, 1e-9);
  // Of the first swing.
  const auto end = whole.trace.begin() + 400;
  const auto least = std::min_element(whole.trace.begin(), end, [](const Iteration& a, const Iteration& b) {
    return a.residual < b.residual;
  });
  ASSERT_LT(least->residual, 0.01);
  const double tolerance = 1.2 * least->residual;
  editable(options.xpbd).steps = least->iteration;
  const Result out_of_steps = weight.run(options, tolerance);
  EXPECT_EQ(out_of_steps.residual, least->residual);
  EXPECT_EQ(out_of_steps.status, Status::Stalled) << out_of_steps.message;

  editable(options.xpbd).steps = 2000;
  const auto objective = weight.objective();
  StopRule stop;
  stop.tolerance = tolerance;
  stop.max_iterations = least->iteration;
  const Result limited = solve(*make_xpbd(options), {*objective, objective->unknowns(weight.X)}, stop);
  EXPECT_EQ(limited.status, Status::IterationLimit) << limited.message;
}

// A third node, prescribed, goes its way with time.
TEST(SolverXpbd, TakesThePrescribedMotionStepByStepAndBackInDiastole) {
  Points X(3, 3);
  X << 0, 1, 2, 0, 0, 0, 0, 0, 0;
  Segments links(2, 2);
  links << 0, 1, 1, 2;
  SolverOptions options;
  editable(options.xpbd) = with_step(0.005);
  editable(options.xpbd).steps = 400;
  editable(options.xpbd).motion_time = 0.5;  // 100 steps
  options.masses = [] { return Vector(Vector::Constant(3, 1e-6)); };
  options.xpbd_body = [&] { return std::make_shared<const XpbdBody>(chain_body(X, 1, 0.05)); };
  const MotionPath motion{1, [&](double t) {
                            Points x = X;
                            x(0, 2) += t;
                            x(1, 2) += 3 * t * t;
                            return x;
                          }};
  for (const HeartPhase phase : {HeartPhase::Systole, HeartPhase::Diastole}) {
    editable(options.xpbd).phase = phase;
    Objective objective(X, fixed_nodes(3, {0, 2}), terms_of(cable_term(links, 0.05, Vector::Ones(2))));
    std::vector<Vec3> places;
    StopRule stop;
    const Result result = solve(*make_xpbd(options), {objective, objective.unknowns(X), motion}, stop,
                                [&](const Iteration&, const Vector& q) {
                                  places.push_back(objective.positions(q).col(2));
                                  return true;
                                });
    ASSERT_GT(places.size(), 100U);
    EXPECT_EQ(places[0], X.col(2));
    EXPECT_NEAR((places[50] - Vec3(2.5, 0.75, 0)).norm(), 0, 1e-12);
    EXPECT_EQ(places[100], Vec3(3, 3, 0));
    const bool opens = phase == HeartPhase::Diastole;
    if (!opens) {
      EXPECT_EQ(result.status, Status::Converged) << result.message;
    }
    EXPECT_EQ(places.back(), opens ? Vec3(2, 0, 0) : Vec3(3, 3, 0));
    EXPECT_GT(places.size(), opens ? 200U : 100U);
    const Points end = objective.positions(result.q);
    EXPECT_EQ(end.col(2), places.back());
    if (!opens) {
      EXPECT_NEAR((end.col(1) - Vec3(1.5, 1.5, 0)).norm(), 0, 1e-4);
    }
  }
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
  editable(bad.xpbd) = {.time_step = -1,
                        .iterations = 0,
                        .steps = 0,
                        .motion_time = 0,
                        .damping = 1.5,
                        .thickness = -1,
                        .rest_move = -1};
  editable(bad.xpbd).threads = 0;
  editable(bad.xpbd).motion_time = kNaN;
  editable(bad.xpbd).paper.stretch = 2;
  editable(bad.xpbd).paper.flow = -1;
  editable(bad.xpbd).paper.tether_compliance = -1;
  editable(bad.xpbd).paper.radial = kNaN;
  const std::string all = refusal(bad);
  for (const char* key :
       {"time_step", "iterations", "steps", "damping", "thickness", "threads", "motion_time", "rest_move",
        "paper.stretch", "paper.flow", "paper.tether_compliance", "paper.radial"})
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
  editable(no_annulus.xpbd).forces = XpbdForces::Paper;
  EXPECT_NE(refusal(no_annulus).find("annulus"), std::string::npos);
  SolverOptions no_pressure = good;
  editable(no_pressure.xpbd).stiffness = XpbdStiffness::Paper;
  EXPECT_NE(refusal(no_pressure).find("no pressure"), std::string::npos);
}

}  // namespace
}  // namespace coapt
