// Stress and strain as papers print them: of a balloon, of chords under a known force, and what is written.
#include "energy/element_term.hpp"
#include "energy/kernels/cable_law.hpp"
#include "energy/kernels/cst_isotropic.hpp"
#include "energy/kernels/cst_prestress.hpp"
#include "energy/load_pressure.hpp"
#include "mesh/shapes.hpp"
#include "results/metrics.hpp"
#include "results/result_surfaces.hpp"
#include "support/meshes.hpp"
#include "support/sheets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

Model model_of(const TriangleMesh& mesh) {
  Model model;
  model.X = mesh.vertices;
  model.mesh = mesh;
  model.objective = std::make_unique<Objective>(model.X, FixedMask::Constant(3, model.X.cols(), false),
                                                std::vector<std::unique_ptr<EnergyTerm>>{});
  return model;
}

template <typename Kernel>
MembranePatch patch_of(std::vector<typename Kernel::Rest> rest) {
  MembranePatch patch;
  for (size_t t = 0; t < rest.size(); ++t) patch.triangles.push_back(static_cast<int>(t));
  patch.state = [rest](int e, const CstVector& x) { return Kernel::state(rest[static_cast<size_t>(e)], x); };
  return patch;
}

std::vector<CstNeoHookean::Rest> neo_hookean(const TriangleMesh& mesh, double mu, double thickness) {
  std::vector<CstNeoHookean::Rest> rest;
  for (const auto& t : mesh.triangles.colwise())
    rest.push_back(CstNeoHookean::rest(mesh.vertices.col(t[0]), mesh.vertices.col(t[1]),
                                       mesh.vertices.col(t[2]), NeoHookeanLaw{{mu}, 0}, thickness));
  return rest;
}

std::vector<std::string> names_of(const std::vector<VtpArray>& arrays) {
  std::vector<std::string> names;
  for (const VtpArray& array : arrays) names.push_back(array.name);
  return names;
}

const VtpArray& array_named(const std::vector<VtpArray>& arrays, const std::string& name) {
  return *std::find_if(arrays.begin(), arrays.end(), [&](const VtpArray& a) { return a.name == name; });
}

bool has_array(const std::vector<VtpArray>& arrays, const std::string& name) {
  const auto names = names_of(arrays);
  return std::find(names.begin(), names.end(), name) != names.end();
}

// A balloon of radius R = 10 mm and thickness T = 0.2 mm, incompressible neo-Hookean with mu = 0.05 MPa, at
// the pressure that p = 2 mu T/R (1/l - 1/l^7) gives to a stretch l. In the closed state sigma = p r/(2 t)
// with the radius r = R l and the thickness t = T/l^2 there. Of a polyhedron in equilibrium the virtual work
// of p under a change of scale gives the mean over the volume of its material exactly: sum V (sigma1 +
// sigma2) = 3 p Vol.
TEST(CauchyStress, OfABalloonIsPressureTimesRadiusOverTwiceTheThickness) {
  constexpr double R = 10, T = 0.2, mu = 0.05, l = 1.25;
  const double p = 2 * mu * T / R * (1 / l - std::pow(l, -7));
  TriangleMesh mesh = sphere_mesh(3);
  mesh.vertices *= R;
  const FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  const auto rest = neo_hookean(mesh, mu, T);
  std::vector<int> nodes(mesh.triangles.data(), mesh.triangles.data() + mesh.triangles.size());
  Method method;
  method.tolerance = 1e-9;
  method.max_iterations = 1000;
  const Equilibrium found = find_equilibrium(
      1.02 * mesh.vertices, fixed,
      terms_of(std::make_unique<ElementTerm<CstNeoHookean>>("membrane", std::move(nodes), rest),
               make_follower_pressure("p", mesh.vertices, mesh.triangles, p, fixed)),
      method);
  ASSERT_EQ(found.result.status, Status::Converged) << found.result.message;

  Model model = model_of(mesh);
  model.membrane_patches = {patch_of<CstNeoHookean>(rest)};
  const Fields fields = compute_fields(model, found.x);
  const double stretch =
      std::sqrt(surface_area(found.x, mesh.triangles) / surface_area(model.X, mesh.triangles));
  const double r = R * stretch, t = T / (stretch * stretch);
  const double laplace = p * r / (2 * t);
  double work = 0, enclosed = 0;
  for (int k = 0; k < mesh.triangle_count(); ++k) {
    EXPECT_NEAR(fields.cauchy_stress(0, k) / laplace, 1, 0.05);  // facets of 1,280
    EXPECT_NEAR(fields.cauchy_stress(1, k) / laplace, 1, 0.05);
    const Eigen::Vector3i c = mesh.triangles.col(k);
    work += area_vector(model.X, c).norm() * T * fields.cauchy_stress.col(k).sum();
    enclosed += area_vector(found.x, c).dot(found.x.col(c[0])) / 3;
  }
  EXPECT_NEAR(work / (3 * p * enclosed), 1, 1e-6);
  EXPECT_NEAR(fields.cauchy_stress.mean() / laplace, 1, 0.02);
  // Equal both ways, s: von Mises sqrt(s^2 - s s + s^2) = s.
  EXPECT_NEAR(fields.von_mises_stress.mean() / laplace, 1, 0.02);

  const Metrics metrics = measure(model, model.objective->unknowns(found.x), fields);
  EXPECT_NEAR(metrics.max_cauchy_stress_kpa.value(), 1000 * fields.cauchy_stress.row(0).maxCoeff(), 1e-9);
  EXPECT_NEAR(metrics.max_von_mises_stress_kpa.value(), 1000 * fields.von_mises_stress.maxCoeff(), 1e-9);
  std::printf("balloon: stretch %.4f, Cauchy stress %.3f kPa, p r/(2 t) %.3f kPa\n", stretch,
              1000 * fields.cauchy_stress.mean(), 1000 * laplace);
}

// At 200 % strain the true stress is nine times the second Piola-Kirchhoff stress, and three times the first.
TEST(CauchyStress, IsWrittenBesideTheSecondPiolaKirchhoffStressAndTheFirstOnRequest) {
  const TriangleMesh mesh = square(1, 8);
  Model model = model_of(mesh);
  const double mu = 0.1, l = 3;
  model.membrane_patches = {patch_of<CstNeoHookean>(neo_hookean(mesh, mu, 0.5))};
  Points x = mesh.vertices;
  x.row(0) *= l;
  x.row(1) /= std::sqrt(l);
  const double sigma = mu * (l * l - 1 / l);
  const VtpSurface plain = closed_surface(model, compute_fields(model, x));
  EXPECT_FALSE(has_array(plain.triangle_arrays, "first_piola_stress_1_kpa"));
  model.wants_first_piola = true;
  const Fields fields = compute_fields(model, x);
  const VtpSurface surface = closed_surface(model, fields);
  const auto value = [&](const std::string& name) {
    return array_named(surface.triangle_arrays, name).values(0, 3);
  };
  EXPECT_NEAR(value("cauchy_stress_1_kpa"), 1000 * sigma, 1e-9);
  EXPECT_NEAR(value("cauchy_stress_2_kpa"), 0, 1e-9);
  EXPECT_NEAR(value("von_mises_stress_kpa"), 1000 * sigma, 1e-9);  // uniaxial: the stress itself
  EXPECT_NEAR(value("first_piola_stress_1_kpa"), 1000 * sigma / l, 1e-9);
  EXPECT_NEAR(value("first_piola_stress_2_kpa"), 0, 1e-9);
  EXPECT_NEAR(value("principal_stress_1_mpa"), sigma / (l * l), 1e-12);
}

TEST(CauchyStress, VonMisesIsThatOfPlaneStress) {
  EXPECT_NEAR(von_mises({3, 1}), std::sqrt(9.0 - 3 + 1), 1e-14);
  EXPECT_NEAR(von_mises({1, -1}), std::sqrt(3.0), 1e-14);  // pure shear
  EXPECT_EQ(von_mises({-2, -2}), 2);
}

// Prestress without a thickness has line forces and no stress.
TEST(CauchyStress, IsLeftOutWithoutAThickness) {
  const TriangleMesh mesh = square(1, 8);
  Model model = model_of(mesh);
  const auto rest = [&](double thickness) {
    std::vector<CstPrestress::Rest> all;
    for (const auto& t : mesh.triangles.colwise())
      all.push_back(CstPrestress::rest(mesh.vertices.col(t[0]), mesh.vertices.col(t[1]),
                                       mesh.vertices.col(t[2]), Vec3::UnitX(), 3, 1, thickness));
    return all;
  };
  model.membrane_patches = {patch_of<CstPrestress>(rest(0))};
  const Fields without = compute_fields(model, model.X);
  EXPECT_EQ(without.cauchy_stress.cols(), 0);
  EXPECT_FALSE(has_array(closed_surface(model, without).triangle_arrays, "cauchy_stress_1_kpa"));
  EXPECT_FALSE(measure(model, model.objective->unknowns(model.X), without).max_cauchy_stress_kpa);
  model.membrane_patches = {patch_of<CstPrestress>(rest(0.5))};
  EXPECT_NEAR(compute_fields(model, model.X).cauchy_stress(0, 0), 6, 1e-12);
}

// A chord of cross-section A0 = 0.5 mm2 at rest that carries F = 2 N: its law is linear with E = 20 MPa, so
// it is stretched by l = 1 + F/(E A0) = 1.2. Of constant volume it thins to A0/l, and the true stress is
// sigma = F/A = F l/A0 = 4.8 MPa. Beside it one of unknown cross-section and one without a rest length.
TEST(ChordStress, IsTheForceOverTheThinnedCrossSection) {
  constexpr double F = 2, A0 = 0.5, E = 20, r = 3, l = 1 + F / (E * A0);
  Model model;
  model.X = Points::Zero(3, 4);
  model.X.row(0) << 0, r, 5, 7;
  model.lines = {{0, 1, r, A0, "chord", 0}, {1, 2, 2, 0, "other", 0}, {2, 3, 0, 0, "pull", 0}};
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  terms.push_back(std::make_unique<ElementTerm<CableBilinear>>(
      "chord", std::vector<int>{0, 1},
      std::vector<CableBilinear::Rest>{CableBilinear::rest(r, A0, 0, BilinearLine{E, {}})}));
  model.objective = std::make_unique<Objective>(model.X, FixedMask::Constant(3, 4, false), std::move(terms));
  Points x = model.X;
  x(0, 1) = r * l;
  x(0, 2) = r * l + 2.5;
  const Fields fields = compute_fields(model, x);
  EXPECT_NEAR(fields.line_force[0], F, 1e-12);
  EXPECT_NEAR(fields.line_stress[0], F * l / A0, 1e-12);
  EXPECT_NEAR(fields.line_strain[0], l - 1, 1e-14);
  EXPECT_NEAR(fields.line_strain[1], 0.25, 1e-12);
  EXPECT_TRUE(std::isnan(fields.line_stress[1]) && std::isnan(fields.line_stress[2]));
  EXPECT_TRUE(std::isnan(fields.line_strain[2]));

  const VtpSurface surface = closed_surface(model, fields);
  const auto row = [&](const std::string& name) { return array_named(surface.line_arrays, name).values; };
  EXPECT_NEAR(row("line_cauchy_stress_kpa")(0, 0), 1000 * F * l / A0, 1e-9);
  EXPECT_EQ(row("line_cauchy_stress_kpa")(0, 1), -1) << "no cross-section: left out";
  EXPECT_NEAR(row("line_strain")(0, 0), l - 1, 1e-14);
  EXPECT_EQ(row("line_strain")(0, 2), -1) << "no rest length: left out";
  const Metrics metrics = measure(model, model.objective->unknowns(x), fields);
  EXPECT_NEAR(metrics.max_chord_stress_kpa.value(), 1000 * F * l / A0, 1e-9);
  EXPECT_NEAR(metrics.max_chord_strain.value(), 0.25, 1e-12);

  // Where no cross-section is known at all there is no array and no figure.
  model.lines[0].area = 0;
  const Fields unknown = compute_fields(model, x);
  EXPECT_EQ(names_of(closed_surface(model, unknown).line_arrays),
            (std::vector<std::string>{"line_force_n", "line_strain"}));
  EXPECT_FALSE(measure(model, model.objective->unknowns(x), unknown).max_chord_stress_kpa);
}

}  // namespace
}  // namespace coapt
