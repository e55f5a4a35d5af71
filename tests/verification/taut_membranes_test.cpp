// Rows B1 to B4 and B8 of the verification table: membranes under load against closed forms and an
// independent solution of the axisymmetric equations. Each is solved twice: cst_stvk by lbfgs, and
// cst_tension_field by newton, which must give the same answers, as all these membranes are taut.
#include "energy/load_dead.hpp"
#include "energy/load_pressure.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"
#include "support/sanitized.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

// What a membrane is made of and who solves for it.
struct Means {
  std::string name;
  SheetLaw material;
  std::string solver;
};

const Means kMeans[] = {{"cst_stvk by lbfgs", SheetLaw::StVK, "lbfgs"},
                        {"cst_tension_field by newton", SheetLaw::TensionField, "newton"}};

// Eh = 1, nu = 0.3.
Equilibrium find(const Means& means, const TriangleMesh& mesh, const Points& start, const FixedMask& fixed,
                 std::unique_ptr<EnergyTerm> load, double prestress = 0, double tolerance = 1e-9) {
  Equilibrium found = find_equilibrium(
      start, fixed,
      terms_of(sheet_term(means.material, mesh.vertices, mesh.triangles, {1, 0.3, prestress}),
               std::move(load)),
      tolerance, means.solver);
  EXPECT_EQ(found.result.status, Status::Converged) << means.name << ": " << found.result.message;
  return found;
}

// --- B1: square of side 1, tension 1, dead load p: w0 = 0.0736713 p -----------------------------------

double square_deflection(const Means& means, int n) {
  const double p = 1e-4;
  const TriangleMesh mesh = grid_mesh(n, n);
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  for (int k = 0; k <= n; ++k)
    for (const int node : {grid_node(n, k, 0), grid_node(n, k, n), grid_node(n, 0, k), grid_node(n, n, k)})
      fixed.col(node).setConstant(true);
  const Points load = frozen_pressure_forces(mesh.vertices, mesh.triangles, p);
  // The edge tension 1/n is 1e6 times the load of a node, and no measure of whether that load is balanced.
  const Equilibrium found =
      find(means, mesh, mesh.vertices, fixed,
           std::make_unique<LoadDead>("load", "load_pressure", load, mesh.vertices), 1, 1e-6);
  return found.x(2, grid_node(n, n / 2, n / 2)) / p;
}

// Series solution of Poisson's equation on the unit square.
double poisson_deflection() {
  double sum = 0;
  for (int m = 1; m < 400; m += 2)
    for (int n = 1; n < 400; n += 2)
      sum += std::sin(m * std::numbers::pi / 2) * std::sin(n * std::numbers::pi / 2) /
             (m * n * static_cast<double>(m * m + n * n));
  return 16 / std::pow(std::numbers::pi, 4) * sum;
}

// Grids of n, 2 n and 4 n cells.
void expect_second_order(const char* row, double (*deflection)(const Means&, int), double exact, int n) {
  for (const Means& means : kMeans) {
    SCOPED_TRACE(means.name);
    const double coarse = deflection(means, n) / exact - 1, middle = deflection(means, 2 * n) / exact - 1;
    EXPECT_GT(observed_order(coarse, middle), 1.9);
    if (is_sanitized()) continue;
    const double fine = deflection(means, 4 * n) / exact - 1;
    std::printf("%s %s: errors %.2e %.2e %.2e\n", row, means.name.c_str(), coarse, middle, fine);
    EXPECT_LT(std::abs(fine), 1e-3);
    EXPECT_GT(observed_order(middle, fine), 1.9);
  }
}

TEST(Square, B1SagsUnderASmallLoadLikePoissonsEquation) {
  const double exact = poisson_deflection();
  EXPECT_NEAR(exact, 0.0736713533, 1e-8);
  expect_second_order("B1", square_deflection, exact, 16);
}

// --- B1c: disc of radius 1, tension 1, dead load p: w0 = p/4 --------------------------------------------

double prestressed_disc_deflection(const Means& means, int n) {
  const double p = 1e-4;
  const TriangleMesh mesh = smooth_disc_mesh(n);
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  for (int v = 0; v < mesh.vertex_count(); ++v)
    fixed.col(v).setConstant(mesh.vertices.col(v).norm() > 1 - 1e-9);
  const Points load = frozen_pressure_forces(mesh.vertices, mesh.triangles, p);
  const Equilibrium found =
      find(means, mesh, mesh.vertices, fixed,
           std::make_unique<LoadDead>("load", "load_pressure", load, mesh.vertices), 1, 1e-6);
  return found.x(2, grid_node(n, n / 2, n / 2)) / p;
}

TEST(PrestressedDisc, B1cSagsToAParaboloid) {
  expect_second_order("B1c", prestressed_disc_deflection, 0.25, 8);
}

// --- B2: clamped disc, exact geometry -------------------------------------------------------------------

double disc_deflection(const Means& means, int n, double q, bool is_follower) {
  const TriangleMesh mesh = smooth_disc_mesh(n);
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  Points start = mesh.vertices;  // slightly bulged: the flat disc has no stiffness
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double r2 = mesh.vertices.col(v).squaredNorm();
    if (r2 > 1 - 1e-9)
      fixed.col(v).setConstant(true);
    else
      start(2, v) = 0.5 * std::cbrt(q) * (1 - r2);
  }
  std::unique_ptr<EnergyTerm> load;
  if (is_follower)
    load = make_follower_pressure("p", mesh.vertices, mesh.triangles, q, fixed);
  else
    load = std::make_unique<LoadDead>(
        "p", "load_pressure", frozen_pressure_forces(mesh.vertices, mesh.triangles, q), mesh.vertices);
  const Equilibrium found = find(means, mesh, start, fixed, std::move(load));
  return found.x(2, grid_node(n, n / 2, n / 2));
}

struct DiscCase {
  double q;
  bool is_follower;
  double deflection;  // by shooting, relative tolerance 1e-11
};

class Disc : public testing::TestWithParam<DiscCase> {};

TEST_P(Disc, B2MatchesTheExactAxisymmetricSolution) {
  const auto [q, is_follower, exact] = GetParam();
  for (const Means& means : kMeans) {
    SCOPED_TRACE(means.name);
    const auto deflection = [&](int n) { return disc_deflection(means, n, q, is_follower); };
    const double coarse = deflection(4), middle = deflection(8), fine = deflection(16);
    EXPECT_GT(observed_order(middle - exact, fine - exact), 1.9);
    if (is_sanitized()) continue;
    EXPECT_LT(std::abs(deflection(22) / exact - 1), 2e-3);  // 1,936 triangles
    const double finest = deflection(32);
    const auto extrapolated = [](double h2, double h, double factor) { return h + (h - h2) / (factor - 1); };
    const double a = extrapolated(coarse, middle, 4), b = extrapolated(middle, fine, 4),
                 c = extrapolated(fine, finest, 4);  // free of h^2
    const double answer = extrapolated(extrapolated(a, b, 16), extrapolated(b, c, 16), 64);
    std::printf("B2 %s q=%.0e, %s: errors %.2e %.2e %.2e, extrapolated %.2e\n",
                is_follower ? "follower" : "dead", q, means.name.c_str(), middle / exact - 1,
                fine / exact - 1, finest / exact - 1, answer / exact - 1);
    EXPECT_GT(observed_order(fine - exact, finest - exact), 1.9);
    EXPECT_LT(std::abs(answer / exact - 1), 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(Loads, Disc,
                         testing::Values(DiscCase{1e-3, true, 0.0654043749}, DiscCase{1e-2, true, 0.14138457},
                                         DiscCase{1e-1, true, 0.309515382},
                                         DiscCase{1e-3, false, 0.0653380478},
                                         DiscCase{1e-2, false, 0.140728587},
                                         DiscCase{1e-1, false, 0.303176046}),
                         [](const auto& instance) {
                           return std::string(instance.param.is_follower ? "Follower" : "Dead") +
                                  std::to_string(std::lround(-std::log10(instance.param.q)));
                         });

// --- B3: sphere under internal pressure -----------------------------------------------------------------

// The reference is a relation between pressure, stretch and energy. An inscribed polyhedron is smaller than
// its sphere, so at a given pressure its stretch, and more so its energy, come out low; what the row asks is
// the pressure and the energy at the stretch that is there.
double sphere_pressure(double stretch) { return (stretch - 1 / stretch) / 0.7; }

double sphere_energy(double stretch) {
  const double strain = 0.5 * (stretch * stretch - 1);
  return strain * strain / 0.7;
}

struct Sphere {
  double stretch, energy_per_area;
};

Sphere inflated_sphere(const Means& means, int subdivisions, double stretch) {
  const double p = sphere_pressure(stretch);  // Eh = R = 1, nu = 0.3
  const TriangleMesh mesh = sphere_mesh(subdivisions);
  const FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  const Equilibrium found = find(means, mesh, 1.05 * mesh.vertices, fixed,
                                 make_follower_pressure("p", mesh.vertices, mesh.triangles, p, fixed));
  const double rest = surface_area(mesh.vertices, mesh.triangles);
  double energy = 0;
  for (const TermReport& term : found.result.terms)
    if (term.name == "membrane") energy = term.energy;
  return {std::sqrt(surface_area(found.x, mesh.triangles) / rest), energy / rest};
}

void expect_closed_form_stretch(const Means& means) {
  for (const double stretch : {1.02, 1.1, 1.3}) {
    const Sphere coarse = inflated_sphere(means, 1, stretch), middle = inflated_sphere(means, 2, stretch);
    EXPECT_GT(observed_order(coarse.stretch - stretch, middle.stretch - stretch), 1.9) << stretch;
    if (is_sanitized()) continue;
    const Sphere fine = inflated_sphere(means, 3, stretch);  // 1,280 faces
    const double at_given_pressure = fine.energy_per_area / sphere_energy(stretch) - 1;
    std::printf("B3 %.2f, %s: errors of stretch %.2e %.2e %.2e, of energy at the given pressure %.2e\n",
                stretch, means.name.c_str(), coarse.stretch / stretch - 1, middle.stretch / stretch - 1,
                fine.stretch / stretch - 1, at_given_pressure);
    EXPECT_LT(std::abs(fine.stretch / stretch - 1), 5e-3) << stretch;
    EXPECT_LT(std::abs(sphere_pressure(fine.stretch) / sphere_pressure(stretch) - 1), 5e-3) << stretch;
    EXPECT_LT(std::abs(fine.energy_per_area / sphere_energy(fine.stretch) - 1), 5e-3) << stretch;
    EXPECT_LT(std::abs(at_given_pressure), 1e-2) << stretch;
    EXPECT_GT(observed_order(middle.stretch - stretch, fine.stretch - stretch), 1.9) << stretch;
    EXPECT_GT(observed_order(middle.energy_per_area - sphere_energy(stretch),
                             fine.energy_per_area - sphere_energy(stretch)),
              1.9)
        << stretch;
  }
}

TEST(Sphere, B3InflatesToTheClosedFormStretch) {
  for (const Means& means : kMeans) {
    SCOPED_TRACE(means.name);
    expect_closed_form_stretch(means);
  }
}

// --- B4: long strip as a cylinder -------------------------------------------------------------------------

struct Strip {
  double rest_width, p, sag;
};

// Free edges y = 0 and y = height move within their planes: pressure needs the exact follower model there.
double strip_sag(const Means& means, int n, const Strip& strip) {
  const int rows = 2;
  const double height = rows * strip.rest_width / n;
  const TriangleMesh mesh = grid_mesh(n, rows, strip.rest_width, height);
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  fixed.row(1).setConstant(true);
  Points start = mesh.vertices;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= n; ++i) {
      const double s = static_cast<double>(i) / n;
      start(0, grid_node(n, i, j)) = s;
      start(2, grid_node(n, i, j)) = 4 * strip.sag * 0.9 * s * (1 - s);
      if (i == 0 || i == n) fixed.col(grid_node(n, i, j)).setConstant(true);
    }
  const Equilibrium found =
      find(means, mesh, start, fixed, make_follower_pressure("p", start, mesh.triangles, strip.p, fixed));
  double sag = 0;
  for (int j = 0; j <= rows; ++j) sag += found.x(2, grid_node(n, n / 2, j)) / (rows + 1);
  return sag;
}

void expect_closed_form_bulge(const Means& means) {
  for (const Strip& strip :
       {Strip{1.0, 1e-3, 0.0349517345}, Strip{1.0, 1e-2, 0.0753898085}, Strip{1.2, 1e-2, 0.286536511}}) {
    const double coarse = strip_sag(means, 16, strip), middle = strip_sag(means, 32, strip);
    EXPECT_GT(observed_order(coarse - strip.sag, middle - strip.sag), 1.9);
    if (is_sanitized()) continue;
    const double fine = strip_sag(means, 64, strip);
    std::printf("B4 %.1f %.0e, %s: errors %.2e %.2e %.2e\n", strip.rest_width, strip.p, means.name.c_str(),
                coarse / strip.sag - 1, middle / strip.sag - 1, fine / strip.sag - 1);
    EXPECT_LT(std::abs(fine / strip.sag - 1), 1e-3);
    EXPECT_GT(observed_order(middle - strip.sag, fine - strip.sag), 1.9);
  }
}

TEST(Strip, B4BulgesIntoTheClosedFormCylinder) {
  for (const Means& means : kMeans) {
    SCOPED_TRACE(means.name);
    expect_closed_form_bulge(means);
  }
}

// --- B8: a force at the centre of a disc -----------------------------------------------------------------

// Deflections over that of the closed form at the centre (Schwerin 1929). Both laws by newton.
struct PointLoad {
  double centre = 0;
  double greatest_error = 0;  // of the shape 1 - r^(2/3), r from 0.1 to 1
};

PointLoad point_load(SheetLaw material, int n) {
  constexpr double force = 1e-6;  // over E h times the radius
  TriangleMesh mesh = smooth_disc_mesh(n);
  // Finer where the slope has no bound.
  for (int v = 0; v < mesh.vertex_count(); ++v) mesh.vertices.col(v) *= mesh.vertices.col(v).squaredNorm();
  const double deflection = std::cbrt(3 / std::numbers::pi * force);
  const auto shape = [](double r) { return 1 - std::cbrt(r * r); };
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  Points start = mesh.vertices, load = Points::Zero(3, mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double r = mesh.vertices.col(v).norm();
    if (r > 1 - 1e-9) fixed.col(v).setConstant(true);
    start(2, v) = 0.8 * deflection * (1 - r);
  }
  const int centre = grid_node(n, n / 2, n / 2);
  load(2, centre) = force;
  const Equilibrium found =
      find_equilibrium(start, fixed,
                       terms_of(sheet_term(material, mesh.vertices, mesh.triangles, {1, 1.0 / 3, 0}),
                                std::make_unique<LoadDead>("load", "load_field", load, mesh.vertices)),
                       1e-9, "newton");
  EXPECT_EQ(found.result.status, Status::Converged) << found.result.message;
  PointLoad answer{found.x(2, centre) / deflection, 0};
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double r = mesh.vertices.col(v).norm(), error = found.x(2, v) / deflection - shape(r);
    if (r > 0.1) answer.greatest_error = std::max(answer.greatest_error, std::abs(error));
  }
  return answer;
}

TEST(PointLoadOnADisc, B8DeflectsAsSchwerinsClosedForm) {
  for (const SheetLaw material : {SheetLaw::StVK, SheetLaw::TensionField}) {
    const PointLoad coarse = point_load(material, 16), fine = point_load(material, 32);
    EXPECT_NEAR(fine.centre, 1, 0.01);
    EXPECT_LT(std::abs(fine.centre - 1), 0.5 * std::abs(coarse.centre - 1));
    EXPECT_LT(fine.greatest_error, 2e-3);
    EXPECT_LT(fine.greatest_error, 0.5 * coarse.greatest_error);
  }
}

}  // namespace
}  // namespace coapt
