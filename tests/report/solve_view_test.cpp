// What the 3-D view of a page shows at first, and tells of chords.
#include "report/solve_view.hpp"

#include "energy/kernels/cst_stvk.hpp"
#include "energy/objective.hpp"
#include "formats/json/json_text.hpp"
#include "mesh/shapes.hpp"
#include "support/trough_valve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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

// The rim of an orifice passes from one leaflet to another by a jump of its height.
TEST(SolveView, OutlinesAreDrawnSmoothWhereTheyAreSeenFromAbove) {
  const int count = 200;
  const Vec3 up = Vec3(1, 2, 2) / 3, across = Vec3(2, 1, -2) / 3, along = up.cross(across);
  Points corners(3, count);
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count, height = k < count / 2 ? 0 : k == 150 ? 5 : 3;
    corners.col(k) = 4 * std::cos(angle) * across + 2 * std::sin(angle) * along + height * up;
  }
  const Points smooth = smooth_outline(corners, up);
  const auto height = [&](int k) { return smooth.col(k % count).dot(up); };
  for (int k = 0; k < count; ++k) {
    EXPECT_LT((smooth.col(k) - corners.col(k) - (smooth.col(k) - corners.col(k)).dot(up) * up).norm(), 1e-12);
    EXPECT_LT(std::abs(height(k + 1) - height(k)), 0.25) << "no jump of 3 is left";
    EXPECT_GE(height(k), -1e-12);
    EXPECT_LE(height(k), 3.2);
  }
  EXPECT_NEAR(height(count / 4), 0, 1e-3) << "far from the jumps";
  EXPECT_NEAR(height(0), 1.5, 0.1);
}

// A page with sliders of that many nodes, and the JSON of its sliders.
nlohmann::json sliders_of(int nodes, size_t& bytes) {
  ShapeView view;
  view.states = {{"result", Points::Zero(3, nodes)}};
  const std::string without = shape_view_html(view).html;
  FirstOrder first{.tolerance_mm = 0.1, .candidates = 9};
  for (int k = 0; k < 8; ++k) {
    ParameterResponse& response = first.parameters.emplace_back();
    response.name = "parameter " + std::to_string(k);
    response.unit = "%";
    response.motion = Points::Zero(3, nodes);
    response.motion(k % 3, 5) = -0.25;
    response.ends = {CheckedEnd{-8, 0.05, {}},
                     CheckedEnd{10, 0.08, {{"orifice_area_mm2", "mm2", "", false, 7.5}}}};
  }
  view.first_order = first;
  const std::string html = shape_view_html(view).html, mark = "id=\"shape-data\">";
  bytes = html.size() - without.size();
  const size_t from = html.find(mark) + mark.size();
  return nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from)).at("sliders");
}

TEST(SolveView, SlidersTakeLessThan200kB) {
  if (!has_shape_view()) GTEST_SKIP() << "this build has no 3-D view";
  size_t bytes = 0;
  const nlohmann::json few = sliders_of(2000, bytes);
  EXPECT_LT(bytes, 200'000u);
  ASSERT_EQ(few["parameters"].size(), 8u);
  const nlohmann::json& first = few["parameters"][0];
  EXPECT_EQ(first["bytes"], 2);
  EXPECT_NEAR(first["step"], 0.25 / 32767, 1e-12);
  EXPECT_EQ(first["figures"]["orifice area"], nlohmann::json({nullptr, 7.5}));
  EXPECT_NEAR(first["errors"][1], 0.08 + 10 * std::sqrt(3.0) / 2 * 0.25 / 32767, 1e-6);
  EXPECT_EQ(first["motion"].get<std::string>().size(), 4u * 2000 * 3 * 2 / 3);
  EXPECT_NE(first["motion"].get<std::string>().find("AYA"), std::string::npos) << "-32767, as 01 80";
  const nlohmann::json more = sliders_of(5000, bytes);
  EXPECT_LT(bytes, 200'000u);
  ASSERT_EQ(more["parameters"].size(), 8u);
  EXPECT_EQ(more["parameters"][0]["bytes"], 1);
  EXPECT_EQ(sliders_of(20000, bytes)["parameters"].size(), 2u);
  EXPECT_EQ(most_sliders(20000), 2u);
  EXPECT_EQ(most_sliders(2000), 22u);
  EXPECT_EQ(most_sliders(50000), 0u);
  EXPECT_LT(bytes, 200'000u);
}

}  // namespace
}  // namespace coapt
