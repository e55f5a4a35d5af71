// Row H3 of the verification table: what is followed in time comes to rest where the energy is least; and
// masses that meet something never pass through it.
#include "energy/contact_barrier.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/surface_tension.hpp"
#include "energy/load_dead.hpp"
#include "support/contact_scene.hpp"
#include "support/disc_scene.hpp"
#include "support/sanitized.hpp"
#include "support/valve_scene.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

namespace coapt {
namespace {

double box(const Points& x) { return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff(); }

struct Scene {
  std::string name;
  Points start;
  FixedMask fixed;
  std::function<Terms()> terms;
  Vector masses;
  double time_step;
};

// A soap film between two rings, from the cylinder (row D2).
Scene film() {
  const int around = 24, rows = 10;
  Points X(3, around * (rows + 1));
  Triangles triangles(3, 2 * around * rows);
  std::vector<int> rings;
  for (int j = 0, t = 0; j <= rows; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      const int a = i + around * j, b = (i + 1) % around + around * j;
      X.col(a) = Vec3(std::cos(angle), std::sin(angle), 0.08 * j);
      if (j == 0 || j == rows) rings.push_back(a);
      if (j == rows) continue;
      triangles.col(t++) << a, b, b + around;
      triangles.col(t++) << a, b + around, a + around;
    }
  const auto terms = [triangles] {
    return terms_of(std::make_unique<ElementTerm<SurfaceTension>>(
        "film", triangle_nodes(triangles),
        std::vector<SurfaceTension::Rest>(static_cast<size_t>(triangles.cols()), {1.0})));
  };
  return {"film", X, fixed_nodes(X.cols(), rings), terms, nodal_areas(X, triangles), 0.05};
}

// A clamped disc under pressure (row B2).
Scene disc() {
  DiscScene scene{disc_mesh(8)};
  return {"disc",
          scene.mesh.vertices,
          scene.fixed(),
          [scene] { return scene.terms(); },
          nodal_areas(scene.mesh.vertices, scene.mesh.triangles),
          0.5};
}

// A chain between two points (row C3).
Scene chain() {
  const int n = 20;
  Points X = Points::Zero(3, n + 1), weights = Points::Zero(3, n + 1);
  Segments links(2, n);
  for (int k = 0; k <= n; ++k) X(0, k) = static_cast<double>(k) / n;
  for (int k = 0; k < n; ++k) links.col(k) << k, k + 1;
  weights.row(2).segment(1, n - 1).setConstant(-1);
  const auto terms = [=] {
    return terms_of(cable_term(links, 1e3, Vector::Constant(n, 0.06)),
                    std::make_unique<LoadDead>("weight", "load_field", weights, X));
  };
  return {"chain", X, fixed_nodes(n + 1, {0, n}), terms, Vector::Ones(n + 1), 0.05};
}

TEST(StaticAgainstDynamic, H3ComesToRestWhereTheEnergyIsLeast) {
  for (const Scene& scene : {film(), disc(), chain()}) {
    Method method{.solver = "newton", .tolerance = 1e-9};
    const Equilibrium newton = find_equilibrium(scene.start, scene.fixed, scene.terms(), method);
    ASSERT_EQ(newton.result.status, Status::Converged) << scene.name << newton.result.message;
    method.solver = "dynamic";
    method.masses = [&] { return scene.masses; };
    method.dynamic.time_step = scene.time_step;
    method.dynamic.relaxation_time = 5 * scene.time_step;
    const Equilibrium dynamic = find_equilibrium(scene.start, scene.fixed, scene.terms(), method);
    ASSERT_EQ(dynamic.result.status, Status::Converged) << scene.name << dynamic.result.message;
    const double distance = (newton.x - dynamic.x).colwise().norm().maxCoeff() / box(newton.x);
    std::printf("H3 %s: %.1e of the size apart; newton %d iterations, %.3f s, dynamic %d steps, %.3f s\n",
                scene.name.c_str(), distance, newton.result.iterations, newton.result.wall_s,
                dynamic.result.iterations, dynamic.result.wall_s);
    EXPECT_LT(distance, 1e-6) << scene.name;
    EXPECT_LT(dynamic.result.residual, 1e-9);
  }
}

TEST(StaticAgainstDynamic, TheValveClosesInTimeAsWithoutIt) {
  const ValveScene scene({});
  Method method = scene.method(1e-9);
  const Equilibrium newton = find_equilibrium(scene.X, scene.fixed, scene.terms(), method);
  ASSERT_EQ(newton.result.status, Status::Converged) << newton.result.message;
  method.solver = "dynamic";
  method.masses = [&] {
    Vector masses = 1e-9 * nodal_areas(scene.X, scene.triangles);
    return Vector(masses.cwiseMax(0.01 * masses.mean()));
  };
  const Equilibrium dynamic = find_equilibrium(scene.X, scene.fixed, scene.terms(), method);
  ASSERT_EQ(dynamic.result.status, Status::Converged) << dynamic.result.message;
  const std::vector<int> held = scene.held_nodes(newton.x);
  const double distance = (newton.x - dynamic.x)(Eigen::all, held).colwise().norm().maxCoeff();
  std::printf("valve: %.1e mm apart; newton %d iterations, %.3f s, dynamic %d steps, %.3f s\n", distance,
              newton.result.iterations, newton.result.wall_s, dynamic.result.iterations,
              dynamic.result.wall_s);
  EXPECT_LT(distance, 1e-6 * box(newton.x));
}

// A sheet that falls on a spike and hangs over it, judged at every step.
TEST(StaticAgainstDynamic, MassesNeverPassThroughAnObstacle) {
  for (const auto integration : {TimeIntegration::BackwardDifferences, TimeIntegration::SemiImplicitEuler}) {
    const bool is_explicit = integration == TimeIntegration::SemiImplicitEuler;
    const int n = is_explicit ? 6 : 10;
    const TriangleMesh sheet = moved(grid_mesh(n, n), {0, 0, 0.1}),
                       foot = spike(Vec3(0.53, 0.47, 0.05), 0.5, 0.2), both = joined(sheet, foot);
    FixedMask fixed = FixedMask::Constant(3, both.vertex_count(), false);
    fixed.rightCols(foot.vertex_count()).setConstant(true);
    for (const int corner : {0, n, n * (n + 1), (n + 1) * (n + 1) - 1}) fixed.col(corner).setConstant(true);
    Vector areas = Vector::Zero(both.vertex_count());
    areas.head(sheet.vertex_count()) = nodal_areas(sheet.vertices, sheet.triangles);
    ContactBarrierOptions options;
    options.gap = 0.02;
    options.pressure = 0.1;
    options.obstacles = both.triangles.rightCols(foot.triangle_count());
    Terms terms = terms_of(
        tension_field_term(both.vertices, sheet.triangles, {}),
        bending_term(both.vertices, sheet.triangles, 1e-4),
        make_contact_barrier("contact", both.vertices, sheet.triangles, options),
        std::make_unique<LoadDead>("load", "load_field", area_forces(areas, {0, 0, -0.05}), both.vertices));
    Method method{.solver = "dynamic", .tolerance = is_explicit ? 1e-3 : 1e-8, .max_iterations = 20000};
    method.masses = [&] { return Vector(areas.cwiseMax(0.1 * areas.maxCoeff())); };
    method.dynamic.integration = integration;
    method.dynamic.time_step = 0.1;
    method.dynamic.relaxation_time = 1;
    const Judged judged =
        solve_judged(both.vertices, fixed, std::move(terms), both.triangles, sheet.triangle_count(), method);
    EXPECT_EQ(judged.intersections, 0);
    EXPECT_EQ(judged.found.result.status, Status::Converged) << judged.found.result.message;
    std::printf("sheet on a spike: %ld steps judged, %.2f s\n", judged.iterates, judged.found.result.wall_s);
    double contact = 0;
    for (const TermReport& term : judged.found.result.terms)
      if (term.name == "contact") contact = term.greatest_force;
    EXPECT_GT(contact, 0);
  }
}

}  // namespace
}  // namespace coapt
