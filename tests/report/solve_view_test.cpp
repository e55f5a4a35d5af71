// What the 3-D view of a page shows at first, and tells of chords.
#include "report/solve_view.hpp"

#include "energy/kernels/cst_stvk.hpp"
#include "energy/objective.hpp"
#include "mesh/shapes.hpp"
#include "support/trough_valve.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace coapt {
namespace {

// Two plates in contact, so that there are gaps.
Model plates(bool has_stress, double thickness = 0.5) {
  TriangleMesh mesh = square(10, 200), upper = mesh;
  upper.vertices.row(2).array() += 0.3;
  append(mesh, upper);
  Model model;
  model.X = mesh.vertices;
  model.mesh = mesh;
  model.contact_range = 0.5;
  model.objective = std::make_unique<Objective>(model.X, FixedMask::Constant(3, model.X.cols(), false),
                                                std::vector<std::unique_ptr<EnergyTerm>>{});
  if (!has_stress) return model;
  std::vector<CstStVK::Rest> rest;
  MembranePatch patch;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::Vector3i c = mesh.triangles.col(t);
    rest.push_back(CstStVK::rest(mesh.vertices.col(c[0]), mesh.vertices.col(c[1]), mesh.vertices.col(c[2]), 2,
                                 0.3, thickness, 0.1));
    patch.triangles.push_back(t);
  }
  patch.state = [rest](int e, const CstVector& x) { return CstStVK::state(rest[static_cast<size_t>(e)], x); };
  model.membrane_patches = {patch};
  return model;
}

bool has_field(const std::vector<ViewField>& all, const std::string& title) {
  return std::any_of(all.begin(), all.end(), [&](const ViewField& f) { return f.title == title; });
}

TEST(SolveView, OpensOnTheCauchyStress) {
  Model model = plates(true);
  const std::vector<ViewField> all = view_fields(model, compute_fields(model, 1.1 * model.X));
  ASSERT_TRUE(has_field(all, "Gap to the nearest other facet"));
  EXPECT_EQ(all.front().title, "Greater principal Cauchy stress");
  EXPECT_EQ(all.front().unit, "kPa");
  // Biaxial, J = 1: sigma = l^2 S with S = E/(1 - nu) (l^2 - 1)/2 + s/h.
  const double l = 1.1, S = 2 / 0.7 * 0.5 * (l * l - 1) + 0.1 / 0.5;
  EXPECT_NEAR(all.front().values.front()[7], 1000 * l * l * S, 1e-8);
  EXPECT_FALSE(has_field(all, "Greater first Piola-Kirchhoff stress"));
  model.wants_first_piola = true;
  EXPECT_TRUE(
      has_field(view_fields(model, compute_fields(model, model.X)), "Greater first Piola-Kirchhoff stress"));
}

TEST(SolveView, OpensOnTheStrainWhereThereIsNoStress) {
  for (const Model& model : {plates(false), plates(true, 0)}) {  // no membrane, or one without a thickness
    const std::vector<ViewField> all = view_fields(model, compute_fields(model, 1.1 * model.X));
    ASSERT_TRUE(has_field(all, "Gap to the nearest other facet"));
    EXPECT_EQ(all.front().title, "Greater principal strain");
    EXPECT_FALSE(has_field(all, "Von Mises stress"));
  }
}

TEST(SolveView, TellsStressAndStrainOfChords) {
  Model model = plates(true);
  model.lines = {{0, 250, 0.2, 0.5, "chords", 0}};
  Report report;
  report.fields = compute_fields(model, model.X);
  const ShapeView view = solved_view(model, report);
  ASSERT_EQ(view.line_values.size(), 2u);
  EXPECT_EQ(view.line_values[0].title, "strain");
  EXPECT_EQ(view.line_values[1].title, "Cauchy stress");
  EXPECT_EQ(view.line_values[1].unit, "kPa");
}

}  // namespace
}  // namespace coapt
