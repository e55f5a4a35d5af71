// The motion of masses: integrators against closed forms, and the solver that follows them to rest.
#include "optim/dynamic/dynamic.hpp"

#include "core/error.hpp"
#include "energy/load_dead.hpp"
#include "optim/dynamic/time_integrator.hpp"
#include "optim/dynamic/vertex_proximity.hpp"
#include "support/equilibrium.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

const DynamicOptions kUndamped{.adapts_steps = false, .relaxation_time = 0};

// Masses on cables, with all that an integrator needs.
struct Masses {
  Masses(const Points& X, const FixedMask& fixed, Terms terms, const Vector& of_nodes)
      : objective(X, fixed, std::move(terms)),
        monitor(objective, stop, observer),
        mass(objective.unknowns(of_nodes.transpose().replicate<3, 1>())),
        applied(Vector::Zero(mass.size())) {}

  std::unique_ptr<TimeIntegrator> integrator(TimeIntegration integration,
                                             DynamicOptions options = kUndamped) {
    return integration == TimeIntegration::BackwardDifferences
               ? make_backward_differences({objective, monitor, mass, applied}, options,
                                           make_eigen_factorisation)
               : make_semi_implicit_euler({objective, monitor, mass, applied}, options);
  }
  Motion start(const Vector& q, const Vector& v) {
    Motion at{q, v, 0, Vector(), 0};
    at.energy = monitor.gradient(at.q, at.g);
    return at;
  }
  double energy(const Motion& at) const { return at.energy + kinetic_energy(at, mass); }

  StopRule stop;
  Observer observer;
  Objective objective;
  Monitor monitor;
  Vector mass, applied;
};

std::unique_ptr<LoadDead> weights(const Points& X, const Vector& masses, double gravity) {
  Points forces = Points::Zero(3, X.cols());
  forces.row(2) = -gravity * masses.transpose();
  return std::make_unique<LoadDead>("weight", "load_field", forces, X);
}

// A mass of 2 on a cable of stiffness 50 and length 1 below a fixed point, with gravity 9.81.
struct Bob : Masses {
  explicit Bob(double stiffness = 50)
      : Masses(rest(), fixed_nodes(2, {0}),
               terms_of(cable_term(link(), stiffness, Vector::Ones(1)), weights(rest(), kMasses, 9.81)),
               kMasses) {}
  static Points rest() {
    Points ends = Points::Zero(3, 2);
    ends(2, 1) = -1;
    return ends;
  }
  static Segments link() { return Segments(Eigen::Vector2i(0, 1)); }
  inline static const Vector kMasses = Vector::Constant(2, 2.0);
};

// Where a motion of `count` equal steps from q, v leads to at time T.
Motion led_to(Masses& masses, TimeIntegration integration, const Vector& q, const Vector& v, double T,
              int count) {
  const auto integrator = masses.integrator(integration);
  Motion at = masses.start(q, v);
  for (int k = 0; k < count; ++k) EXPECT_TRUE(integrator->step(T / count, at));
  EXPECT_NEAR(at.time, T, 1e-12 * T * count);
  return at;
}

TEST(TimeIntegrators, FollowAnOscillationAtTheirOrder) {
  const double omega = std::sqrt(50 / 2.0), low = -1 - 2 * 9.81 / 50, amplitude = 0.2, T = 2;
  for (const auto& [integration, order] : {std::pair{TimeIntegration::BackwardDifferences, 2.0},
                                           std::pair{TimeIntegration::SemiImplicitEuler, 1.0}}) {
    std::vector<double> errors;
    for (const int count : {400, 800, 1600}) {
      Bob bob;
      const Motion at = led_to(bob, integration, Vec3(0, 0, low + amplitude), Vec3::Zero(), T, count);
      EXPECT_EQ(at.q.head<2>().norm(), 0);
      errors.push_back(std::abs(at.q[2] - low - amplitude * std::cos(omega * T)));
    }
    EXPECT_GT(observed_order(errors[0], errors[1]), order - 0.1);
    EXPECT_GT(observed_order(errors[1], errors[2]), order - 0.1);
    EXPECT_LT(errors[2], order == 2 ? 2e-4 : 2e-3);
  }
}

TEST(TimeIntegrators, KeepTheirOrderWhereTheMotionIsNotLinear) {
  // An elastic pendulum that swings and stretches, against itself with smaller steps.
  for (const auto& [integration, order] : {std::pair{TimeIntegration::BackwardDifferences, 2.0},
                                           std::pair{TimeIntegration::SemiImplicitEuler, 1.0}}) {
    std::vector<Vector> ends;
    for (const int count : {400, 800, 1600}) {
      Bob bob;
      ends.push_back(led_to(bob, integration, Vec3(1.0, 0.2, -0.9), Vec3(0, 0.7, 0), 1.5, count).q);
    }
    EXPECT_GT(observed_order((ends[0] - ends[1]).norm(), (ends[1] - ends[2]).norm()), order - 0.15);
  }
}

TEST(TimeIntegrators, KeepTheirBooksOfEnergy) {
  // 300 periods. Semi-implicit Euler is symplectic: its energy swings by an amount of order h and does not
  // drift. Backward differences lose energy, by an amount of order h^3 a step.
  const double period = 2 * std::numbers::pi / 5;
  std::vector<double> swings, losses;
  for (const int steps : {80, 160}) {
    Bob bob;
    const auto euler = bob.integrator(TimeIntegration::SemiImplicitEuler);
    Motion at = bob.start(Vec3(0, 0, -1.2), Vec3::Zero());
    const double first = bob.energy(at), scale = 0.5 * 50 * 0.192 * 0.192;
    double early = 0, late = 0;
    for (int k = 0; k < 300 * steps; ++k) {
      ASSERT_TRUE(euler->step(period / steps, at));
      double& swing = k < 10 * steps ? early : late;
      swing = std::max(swing, std::abs(bob.energy(at) - first) / scale);
    }
    EXPECT_LT(late, 1.05 * early);
    swings.push_back(late);

    Bob other;
    const auto differences = other.integrator(TimeIntegration::BackwardDifferences);
    at = other.start(Vec3(0, 0, -1.2), Vec3::Zero());
    for (int k = 0; k < 2 * steps; ++k) ASSERT_TRUE(differences->step(period / steps, at));
    losses.push_back((first - other.energy(at)) / scale);
    EXPECT_GT(losses.back(), 0);
  }
  EXPECT_LT(swings[0], 0.1);
  EXPECT_GT(observed_order(swings[0], swings[1]), 0.9);
  EXPECT_GT(observed_order(losses[0], losses[1]), 1.9);
}

TEST(TimeIntegrators, KeepTheMomentumOfAFreeBody) {
  const Points X = (Points(3, 3) << 0, 1, 0.5, 0, 0, 0.9, 0, 0, 0).finished();
  const Vector of_nodes = (Vector(3) << 1, 2, 3).finished();
  Segments links(2, 3);
  links << 0, 1, 2, 1, 2, 0;
  std::vector<double> turned;
  for (const auto integration : {TimeIntegration::SemiImplicitEuler, TimeIntegration::BackwardDifferences})
    for (const int count : {400, 800}) {
      Masses body(X, FixedMask::Constant(3, 3, false),
                  terms_of(cable_term(links, 30, Vector::Constant(3, 0.9))), of_nodes);
      const Vector v = (Vector(9) << 0.3, 0, 0.1, 0, 0.5, 0, -0.2, 0.1, 0.4).finished();
      const auto momenta = [&](const Motion& at) {
        std::pair<Vec3, Vec3> sum{Vec3::Zero(), Vec3::Zero()};
        for (int k = 0; k < 3; ++k) {
          const Vec3 p = of_nodes[k] * at.v.segment<3>(3 * k), x = at.q.segment<3>(3 * k);
          sum.first += p;
          sum.second += x.cross(p);
        }
        return sum;
      };
      const auto [linear, angular] = momenta(body.start(body.objective.unknowns(X), v));
      const auto [linear_after, angular_after] =
          momenta(led_to(body, integration, body.objective.unknowns(X), v, 2, count));
      EXPECT_LT((linear_after - linear).norm(), 1e-10 * linear.norm());
      if (integration == TimeIntegration::SemiImplicitEuler) {
        EXPECT_LT((angular_after - angular).norm(), 1e-12 * count * angular.norm());
      } else {
        turned.push_back((angular_after - angular).norm());
      }
    }
  EXPECT_GT(observed_order(turned[0], turned[1]), 1.8);
}

TEST(TimeIntegrators, SwingAPendulumInItsPeriod) {
  // Amplitude 60 degrees: T = 4 sqrt(L/g) K(sin 30). The cable is stiff enough to count as a rod.
  const double angle = std::numbers::pi / 3;
  double a = 1,
         b = std::cos(angle / 2);  // K(k) = pi/2 over the arithmetic-geometric mean of 1 and sqrt(1-k^2)
  for (int k = 0; k < 10; ++k) std::tie(a, b) = std::pair{0.5 * (a + b), std::sqrt(a * b)};
  const double period = 2 * std::numbers::pi / a / std::sqrt(9.81);
  EXPECT_NEAR(period / (2 * std::numbers::pi / std::sqrt(9.81)), 1.0732, 1e-4);
  Bob bob(1e6);
  const auto integrator = bob.integrator(TimeIntegration::BackwardDifferences);
  Motion at = bob.start(Vec3(std::sin(angle), 0, -std::cos(angle)), Vec3::Zero());
  const double h = period / 2000;
  double last = 0, crossing = 0;
  for (int k = 0; k < 3000 && crossing == 0; ++k) {
    ASSERT_TRUE(integrator->step(h, at));
    if (last < 0 && at.q[0] >= 0) crossing = at.time - h * at.q[0] / (at.q[0] - last);
    last = at.q[0];
  }
  EXPECT_NEAR(crossing / (0.75 * period), 1, 1e-3);
}

TEST(TimeIntegrators, SwingAChainAtTheFrequencyOfBernoulli) {
  // Omega = j/2 sqrt(g/L), j = 2.404826 the first zero of J0, and the shape J0(j sqrt(s/L)), s from the free
  // end.
  const int links = 40;
  const double length = 1, gravity = 9.81, each = length / links;
  const double stiffness = 1e4;  // EA: the weights stretch it by 5e-4
  Points X = Points::Zero(3, links + 1);
  Segments segments(2, links);
  Vector masses = Vector::Constant(links + 1, each);
  masses[links] = each / 2;
  for (int k = links; k > 0; --k) {
    const double tension = gravity * masses.tail(links + 1 - k).sum();
    X.rightCols(links + 1 - k).row(2).array() -= each * (1 + tension / stiffness);
  }
  for (int k = 0; k < links; ++k) segments.col(k) << k, k + 1;
  const auto bessel = [](double z) { return std::cyl_bessel_j(0.0, z); };
  Points start = X;
  for (int k = 0; k <= links; ++k)
    start(0, k) = 1e-3 * bessel(2.404826 * std::sqrt(1 - static_cast<double>(k) / links));
  Masses chain(
      X, fixed_nodes(links + 1, {0}),
      terms_of(cable_term(segments, stiffness, Vector::Constant(links, each)), weights(X, masses, gravity)),
      masses);
  const auto integrator = chain.integrator(TimeIntegration::BackwardDifferences);
  Motion at = chain.start(chain.objective.unknowns(start), Vector::Zero(3 * links));
  const double quarter = 0.5 * std::numbers::pi / (0.5 * 2.404826 * std::sqrt(gravity / length)),
               h = quarter / 500;
  double last = 1, crossing = 0;
  for (int k = 0; k < 1000 && crossing == 0; ++k) {
    ASSERT_TRUE(integrator->step(h, at));
    const double x = at.q[3 * (links - 1)];
    if (x <= 0) crossing = at.time + h * x / (last - x);
    last = x;
  }
  EXPECT_NEAR(crossing / quarter, 1, 5e-3);
}

TEST(TimeIntegrators, DragSlowsAMassByAFactorEInItsTime) {
  const Points X = (Points(3, 2) << 0, 1, 0, 0, 0, 0).finished();
  for (const auto integration : {TimeIntegration::SemiImplicitEuler, TimeIntegration::BackwardDifferences}) {
    Masses body(X, FixedMask::Constant(3, 2, false),
                terms_of(cable_term(Segments(Eigen::Vector2i(0, 1)), 1, Vector::Constant(1, 2.0))),
                Vector::Ones(2));
    DynamicOptions options = kUndamped;
    options.relaxation_time = 0.5;
    const auto integrator = body.integrator(integration, options);
    Motion at = body.start(body.objective.unknowns(X), Vector::Constant(6, 1.0));
    for (int k = 0; k < 1000; ++k) ASSERT_TRUE(integrator->step(5e-4, at));
    EXPECT_NEAR(at.v[0], std::exp(-1), 5e-4);
  }
}

// Hammer et al. 2008, eq. 5: -b v with one b, the mean mass over the relaxation time, so that light masses
// are slowed down faster.
TEST(SemiImplicitEuler, HasADragThatIsTheSameForAllMasses) {
  const Points X = (Points(3, 2) << 0, 1, 0, 0, 0, 0).finished();
  Masses body(X, FixedMask::Constant(3, 2, false),
              terms_of(cable_term(Segments(Eigen::Vector2i(0, 1)), 1, Vector::Constant(1, 9.0))),
              (Vector(2) << 1, 3).finished());
  DynamicOptions options = kUndamped;
  options.relaxation_time = 0.5;
  options.drag = Drag::Equal;
  const auto integrator = body.integrator(TimeIntegration::SemiImplicitEuler, options);
  Motion at = body.start(body.objective.unknowns(X), Vector::Constant(6, 1.0));
  for (int k = 0; k < 1000; ++k) ASSERT_TRUE(integrator->step(2.5e-4, at));
  const double b = 2 / options.relaxation_time, t = 0.25;
  EXPECT_NEAR(at.v[0], std::exp(-b * t / 1), 5e-4);
  EXPECT_NEAR(at.v[3], std::exp(-b * t / 3), 5e-4);
}

TEST(SemiImplicitEuler, KnowsItsLongestStableStep) {
  // Twice the limit explodes, the step that it proposes does not; for one spring the bound is exact.
  Bob bob;
  const auto integrator = bob.integrator(TimeIntegration::SemiImplicitEuler);
  Motion at = bob.start(Vec3(0, 0, -1.2), Vec3::Zero());
  const double h = integrator->next_step(1, at), exact = 2 / std::sqrt(50 / 2.0);
  EXPECT_LT(h, exact);
  EXPECT_GT(h, 0.7 * exact);
  for (int k = 0; k < 500; ++k) ASSERT_TRUE(integrator->step(h, at));
  EXPECT_LT(std::abs(at.q[2]), 2);
}

// --- the solver --------------------------------------------------------------------------------------------

struct Hung {
  Points X = Points::Zero(3, 11);
  Segments links{2, 10};
  Vector masses = Vector::Constant(11, 0.1);
  Hung() {
    for (int k = 0; k <= 10; ++k) X(0, k) = 0.1 * k;
    for (int k = 0; k < 10; ++k) links.col(k) << k, k + 1;
  }
  Objective objective() const {
    return Objective(X, fixed_nodes(11, {0, 10}),
                     terms_of(cable_term(links, 100, Vector::Constant(10, 0.12)), weights(X, masses, 9.81)));
  }
  Result solved(DynamicOptions options, double tolerance = 1e-9) const {
    Objective hung = objective();
    SolverOptions all;
    all.dynamic = options;
    all.masses = [this] { return masses; };
    StopRule stop;
    stop.tolerance = tolerance;
    stop.max_iterations = 200000;
    return solve(*make_dynamic(all), {hung, hung.unknowns(X)}, stop);
  }
};

TEST(Dynamic, ComesToRestAtTheEquilibriumOfNewton) {
  const Hung hung;
  Objective objective = hung.objective();
  StopRule stop;
  stop.tolerance = 1e-11;
  const Result newton =
      solve(*built_in_solvers().at("newton")({}), {objective, objective.unknowns(hung.X)}, stop);
  ASSERT_EQ(newton.status, Status::Converged) << newton.message;
  DynamicOptions plain{.time_step = 1e-2, .relaxation_time = 0.2};
  DynamicOptions kinetic = plain, iterative = plain, constant = plain, euler = plain, euler_kinetic = plain;
  kinetic.has_kinetic_damping = true;
  kinetic.relaxation_time = 0;
  iterative.uses_conjugate_gradients = true;
  constant.adapts_steps = false;
  euler.integration = TimeIntegration::SemiImplicitEuler;
  euler_kinetic = euler;
  euler_kinetic.has_kinetic_damping = true;
  euler_kinetic.relaxation_time = 0;
  int index = 0;
  for (const DynamicOptions& options : {plain, kinetic, iterative, constant, euler, euler_kinetic}) {
    const Result result = hung.solved(options);
    ++index;
    ASSERT_EQ(result.status, Status::Converged)
        << index << ": " << result.message << " after " << result.iterations;
    EXPECT_LT((result.q - newton.q).cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_NEAR(result.energy, newton.energy, 1e-9);
    ASSERT_FALSE(result.trace.empty());
    EXPECT_GT(result.trace.back().time, 0.1);
    for (size_t k = 1; k < result.trace.size(); ++k)
      ASSERT_GT(result.trace[k].time, result.trace[k - 1].time);
  }
}

TEST(Dynamic, IsNotConvergedWhileItMoves) {
  // Through the equilibrium at full speed: the force vanishes there, the velocity does not.
  SolverOptions options;
  options.dynamic = {.time_step = 1e-3, .adapts_steps = false, .relaxation_time = 0};
  options.masses = [] { return Bob::kMasses; };
  StopRule stop;
  stop.tolerance = 1e-2;
  stop.max_iterations = 900;
  const auto swing = [&] {
    Bob bob;
    return solve(*make_dynamic(options), {bob.objective, bob.objective.unknowns(Bob::rest())}, stop);
  };
  const std::vector<Iteration> trace = swing().trace;
  const auto least = std::min_element(trace.begin(), trace.end(), [](const Iteration& a, const Iteration& b) {
    return a.residual < b.residual;
  });
  ASSERT_LT(least->residual, stop.tolerance);
  stop.max_iterations = least->iteration;  // wanted to end there, with no force and all the speed
  const Result result = swing();
  EXPECT_EQ(result.status, Status::IterationLimit) << result.message;
}

// --- collisions of the sources -----------------------------------------------------------------------------

// A triangle with a vertex of another one above its middle.
struct Near {
  Points x{3, 6};
  Triangles triangles{3, 2};
  Vector mass = (Vector(6) << 1, 2, 3, 0.5, 1, 1).finished();
  VertexProximity proximity;
  explicit Near(double height, double distance = 0.1)
      : x((Points(3, 6) << 0, 1, 0, 0.3, 0.3, 0.4, 0, 0, 1, 0.3, 0.4, 0.4, 0, 0, 0, height, 5, 5).finished()),
        triangles((Triangles(3, 2) << 0, 3, 1, 4, 2, 5).finished()),
        proximity(far_apart(), triangles, distance) {}
  Points far_apart() const {
    Points rest = x;
    rest.rightCols(3).row(2).array() += 10;
    return rest;
  }
};

TEST(VertexProximity, StopsWhatApproachesAndKeepsTheMomentum) {
  Near near(0.05);
  ASSERT_EQ(near.proximity.find(near.x), 1);
  Points v = Points::Zero(3, 6);
  v.col(3) = Vec3(0.4, 0, -2);
  v.col(0) = Vec3(0, 0.3, 1);
  const Vec3 momentum = v * near.mass;
  near.proximity.stop_approach(v, near.mass);
  EXPECT_LT((v * near.mass - momentum).norm(), 1e-14);
  const double below =
      0.4 * v(2, 0) + 0.3 * v(2, 1) + 0.3 * v(2, 2);  // barycentric coordinates of (0.3, 0.3)
  EXPECT_NEAR(v(2, 3), below, 1e-14);
  EXPECT_EQ(v(0, 3), 0.4);
  // What has stopped or goes away is left alone.
  const Points again = v;
  near.proximity.stop_approach(v, near.mass);
  EXPECT_LT((v - again).norm(), 1e-14);
  v.col(3) = Vec3(0, 0, 5);
  near.proximity.stop_approach(v, near.mass);
  EXPECT_EQ(v(2, 3), 5);
  // What is prescribed does not yield.
  near.mass.head(3).setConstant(kInfinity);
  v.setZero();
  v(2, 3) = -1;
  near.proximity.stop_approach(v, near.mass);
  EXPECT_EQ(v(2, 3), 0);
  EXPECT_EQ(v.leftCols(3).norm(), 0);
}

TEST(VertexProximity, BalancesWhatPresses) {
  Near near(0.05);
  near.proximity.find(near.x);
  Points force = Points::Zero(3, 6);
  force.col(3) = Vec3(1, 2, -3);
  const Points balancing = near.proximity.balancing_forces(force);
  EXPECT_LT((balancing.col(3) - Vec3(0, 0, 3)).norm(), 1e-14);
  EXPECT_LT(balancing.rowwise().sum().norm(), 1e-14);
  force(2, 3) = 1;  // pulled away
  EXPECT_EQ(near.proximity.balancing_forces(force).norm(), 0);
}

TEST(VertexProximity, FindsNothingThatIsFarOrWasNearAtRest) {
  Near far(0.2);
  EXPECT_EQ(far.proximity.find(far.x), 0);
  Near near(0.05);
  VertexProximity at_rest(near.x, near.triangles, 0.1);
  EXPECT_EQ(at_rest.find(near.x), 0);
}

TEST(Dynamic, ComesToRestOnCollisionsAndSaysThatTheyAreNoPartOfTheEnergy) {
  // A triangle on a long leash falls on a fixed, greater one.
  const Points X =
      (Points(3, 7) << 0, 4, 0, 1, 1.5, 1, 1, 0, 0, 4, 1, 1, 1.5, 1, 0, 0, 0, 0.5, 0.5, 0.5, 2).finished();
  const Triangles triangles = (Triangles(3, 2) << 0, 3, 1, 4, 2, 5).finished();
  Segments links(2, 6);
  links << 3, 4, 5, 3, 4, 5, 4, 5, 3, 6, 6, 6;
  const Vector lengths = (Vector(6) << 0.4, 0.4, 0.4, 5, 5, 5).finished();
  const Vector masses = Vector::Constant(7, 0.1);
  Points forces = Points::Zero(3, 7);
  forces.middleCols(3, 3).row(2).setConstant(-1);
  for (const Collisions collisions : {Collisions::Inelastic, Collisions::Balanced}) {
    Objective objective(X, fixed_nodes(7, {0, 1, 2, 6}),
                        terms_of(cable_term(links, 10, lengths),
                                 std::make_unique<LoadDead>("weight", "load_field", forces, X)));
    SolverOptions options;
    options.dynamic = {.time_step = 5e-3, .longest_step = 2e-2, .relaxation_time = 0.1};
    options.dynamic.collisions = collisions;
    options.dynamic.collision_distance = 0.1;
    options.masses = [&] { return masses; };
    options.surface = [&] { return TriangleMesh{X, triangles, {}, {}}; };
    StopRule stop;
    stop.max_iterations = 5000;
    const Result result = solve(*make_dynamic(options), {objective, objective.unknowns(X)}, stop);
    const Points x = objective.positions(result.q);
    const double highest = x.middleCols(3, 3).row(2).maxCoeff(),
                 lowest = x.middleCols(3, 3).row(2).minCoeff();
    if (collisions == Collisions::Balanced) {
      EXPECT_EQ(result.status, Status::Stalled) << result.message;
      EXPECT_GT(result.residual, 0.1);
      EXPECT_LT(highest, 0.1);
      EXPECT_GT(lowest, 0);
    } else {  // velocities alone do not hold what goes on pressing: it falls through, to the end of its leash
      EXPECT_LT(highest, -2);
    }
  }
}

TEST(Dynamic, RefusesWhatHasNoMeaning) {
  SolverOptions options;
  EXPECT_THROW(make_dynamic(options), InputError);
  options.masses = [] { return Vector(Vector::Zero(3)); };
  EXPECT_THROW(make_dynamic(options), InputError);
  options.masses = [] { return Vector(Vector::Ones(3)); };
  EXPECT_NO_THROW(make_dynamic(options));
  options.dynamic.time_step = 0;
  EXPECT_THROW(make_dynamic(options), InputError);
  options.dynamic.time_step = kNaN;
  EXPECT_THROW(make_dynamic(options), InputError);
  options.dynamic.time_step = 1;
  options.dynamic.collisions = Collisions::Inelastic;
  EXPECT_THROW(make_dynamic(options), InputError);
}

}  // namespace
}  // namespace coapt
