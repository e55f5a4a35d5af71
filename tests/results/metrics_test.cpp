#include "results/metrics.hpp"

#include "energy/element_term.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/kernels/cst_tension_field.hpp"
#include "formats/json/valve_json.hpp"
#include "mesh/distance/vertex_gaps.hpp"
#include "mesh/shapes.hpp"
#include "results/reference/reference_distance.hpp"
#include "results/result_warnings.hpp"
#include "support/sanitized.hpp"
#include "support/trough_valve.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <tuple>

namespace coapt {
namespace {

Model model_of(TriangleMesh mesh) {
  Model model;
  model.X = mesh.vertices;
  model.mesh = std::move(mesh);
  model.objective = std::make_unique<Objective>(model.X, FixedMask::Constant(3, model.X.cols(), false),
                                                std::vector<std::unique_ptr<EnergyTerm>>{});
  return model;
}

Metrics measure_at(const Model& model, const Points& x) {
  return measure(model, model.objective->unknowns(x), compute_fields(model, x));
}

// Two square plates of side 10 at a distance along z.
Model plates(double distance) {
  TriangleMesh mesh = square(10, 200), upper = mesh;
  upper.vertices.row(2).array() += distance;
  append(mesh, upper);
  return model_of(std::move(mesh));
}

// A flat ring, 40 sectors: vertices 0-39 inside (radius 4), 40-79 outside (radius 10); annulus outside.
Model ring() {
  constexpr int n = 40;
  TriangleMesh mesh;
  mesh.vertices = Points::Zero(3, 2 * n);
  mesh.triangles.resize(3, 2 * n);
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * k / n;
    mesh.vertices.col(k) << 4 * std::cos(angle), 4 * std::sin(angle), 0;
    mesh.vertices.col(n + k) << 10 * std::cos(angle), 10 * std::sin(angle), 0;
    const int next = (k + 1) % n;
    mesh.triangles.col(2 * k) << k, n + k, n + next;
    mesh.triangles.col(2 * k + 1) << k, n + next, next;
  }
  Model model = model_of(std::move(mesh));
  for (int k = 0; k < n; ++k) model.sets["annulus"].push_back(n + k);
  return model;
}

double polygon_area(int corners, double radius) {
  return 0.5 * corners * radius * radius * std::sin(2 * std::numbers::pi / corners);
}

TEST(VertexGaps, MeasureTheDistanceOfParallelPlates) {
  const Model model = plates(0.3);
  const Vector gaps = vertex_gaps(model.X, model.mesh.triangles, 5);
  EXPECT_NEAR(gaps.minCoeff(), 0.3, 1e-14);
  EXPECT_NEAR(gaps.maxCoeff(), 0.3, 1e-14);
}

TEST(VertexGaps, AreUndefinedBeyondReachAndWithinTwoRings) {
  const Model apart = plates(6);
  EXPECT_TRUE(vertex_gaps(apart.X, apart.mesh.triangles, 0.5).array().isNaN().all());
  const TriangleMesh two_triangles = square(1, 2);
  EXPECT_TRUE(vertex_gaps(two_triangles.vertices, two_triangles.triangles, 5).array().isNaN().all());
}

TEST(VertexGaps, DoNotTakeAFineSheetForItsOwnOpponent) {
  // Edges of 0.01 (0.02 under the sanitizers): two rings end far within the reach.
  const TriangleMesh fine = square(1, is_sanitized() ? 5000 : 20000);
  EXPECT_TRUE(vertex_gaps(fine.vertices, fine.triangles, 0.2).array().isNaN().all());
  TriangleMesh folded = fine;  // about x = 0.5, into a fold 0.06 wide
  for (auto p : folded.vertices.colwise())
    if (p[0] > 0.5) p = Vec3(p[0] < 0.56 ? 0.5 : 1.06 - p[0], p[1], std::min(p[0] - 0.5, 0.06));
  const Vector gaps = vertex_gaps(folded.vertices, folded.triangles, 0.2);
  for (Eigen::Index v = 0; v < gaps.size(); ++v)
    if (folded.vertices(0, v) > 0.1 && folded.vertices(0, v) < 0.3) {
      EXPECT_NEAR(gaps[v], 0.06, 1e-12) << v;
    }
}

TEST(Metrics, CountHalfTheContactingAreaAsCoaptation) {
  Model model = plates(0.3);
  model.contact_range = 0.5;
  const Metrics near = measure_at(model, model.X);
  EXPECT_EQ(near.contact_vertices, model.mesh.vertex_count());
  EXPECT_NEAR(near.coaptation_area_mm2.value(), 100, 1e-10);
  EXPECT_NEAR(near.smallest_gap_mm.value(), 0.3, 1e-14);
  EXPECT_EQ(near.intersections, 0);
  Model far = plates(0.6);
  far.contact_range = 0.5;
  EXPECT_EQ(measure_at(far, far.X).contact_vertices, 0);
  EXPECT_EQ(measure_at(far, far.X).coaptation_area_mm2.value(), 0);
}

// Within the contact distance near its hinge, in contact nowhere.
TEST(Metrics, SayThatAMeshDoesNotResolveTheCoaptationOfAWedge) {
  TriangleMesh mesh = square(10, 5000), upper = mesh;  // cells of 0.2
  upper.vertices.row(2) = 0.02 + 0.1 * (upper.vertices.row(0).array() - upper.vertices.row(0).minCoeff());
  append(mesh, upper);
  Model model = model_of(std::move(mesh));
  model.contact_range = 0.35;
  const Metrics metrics = measure_at(model, model.X);
  EXPECT_NEAR(metrics.near_coaptation_area_mm2, 33, 0.5);
  EXPECT_FALSE(metrics.coaptation_area_mm2.has_value());
  EXPECT_EQ(coaptation_remark(metrics).find("not resolved by this mesh: 3"), 0u)
      << coaptation_remark(metrics);
  Metrics known = metrics;
  known.coaptation_area_mm2 = 0.2 * known.near_coaptation_area_mm2;
  EXPECT_EQ(coaptation_remark(known).find("hardly resolved"), 0u) << coaptation_remark(known);
  known.coaptation_area_mm2 = 0.3 * known.near_coaptation_area_mm2;
  EXPECT_EQ(coaptation_remark(known), "");
  EXPECT_EQ(coaptation_remark({}), "") << "no leaflet is near another";
}

TEST(Metrics, MeasureTheHoleOfARingAsOrifice) {
  const Model model = ring();
  const Metrics metrics = measure_at(model, model.X);
  EXPECT_NEAR(metrics.annulus_area_mm2.value(), polygon_area(40, 10), 1e-3);
  EXPECT_NEAR(metrics.orifice_area_mm2.value(), polygon_area(40, 4), 1e-3);
  EXPECT_NEAR(metrics.orifice_area_percent.value(), 16, 1e-3);
}

TEST(Metrics, MeasureTheDepthOfAFunnelAsTenting) {
  Model model = ring();
  model.contact_range = 0.2;
  for (int k = 0; k < 40; ++k) model.X(2, k) = -3;  // the open leaflets hang to -z
  const Metrics metrics = measure_at(model, model.X);
  EXPECT_NEAR(metrics.tenting_height_mm.value(), 3, 0.3);  // a column is 0.57 wide
  Points bulged = model.X;
  for (int k = 0; k < 40; ++k) bulged(2, k) = 3;
  EXPECT_NEAR(measure_at(model, bulged).tenting_height_mm.value(), 0, 0.3);
}

TEST(Metrics, CountFacetsAndAreaWherePlatesOverlap) {
  TriangleMesh mesh = square(10, 5000), upper = mesh;  // cells of 0.2
  upper.vertices.row(0).array() += 4;
  upper.vertices.row(2).array() += 0.3;
  append(mesh, upper);
  Model model = model_of(std::move(mesh));
  model.contact_range = 0.35;  // reaches less than a cell beyond the overlap
  const Fields fields = compute_fields(model, model.X);
  const Metrics metrics = measure_at(model, model.X);
  EXPECT_EQ(metrics.contact_facets, 2 * 30 * 50 * 2);
  EXPECT_NEAR(metrics.coaptation_area_mm2.value(), 60, 0.8);  // 61.8 within the range
  for (size_t t = 0; t < 5000; ++t) {
    const Eigen::Vector3i corners = model.mesh.triangles.col(static_cast<Eigen::Index>(t));
    EXPECT_EQ(fields.is_contact_facet[t] != 0, model.X(0, corners).minCoeff() > 3.99) << t;
  }
}

TEST(Metrics, AreUndefinedWithoutAnnulusChordsAndContact) {
  const Model model = model_of(disc(5, 100));
  const Metrics metrics = measure_at(model, model.X);
  EXPECT_FALSE(metrics.orifice_area_mm2 || metrics.tenting_height_mm || metrics.coaptation_height_mm);
  EXPECT_FALSE(metrics.coaptation_area_mm2 || metrics.max_chord_force_n || metrics.slack_chords);
  EXPECT_FALSE(metrics.max_chord_strain || metrics.mean_chord_strain);
}

TEST(Metrics, CountFacetsThatPassThroughEachOther) {
  TriangleMesh mesh = square(10, 200), upright = square(10, 200);
  upright.vertices.row(2) = upright.vertices.row(1).array() - 5.03;
  upright.vertices.row(1).setConstant(5.01);
  append(mesh, upright);
  const Model model = model_of(std::move(mesh));
  EXPECT_GT(measure_at(model, model.X).intersections, 10);
}

// 93 % of the area stretched by a tenth, 5 % by a fifth, 2 % by a half: in facets of very unequal size, the
// small ones far more.
TEST(Metrics, WeighTheStrainsThatAShareOfTheAreaDoesNotExceed) {
  TriangleMesh mesh;
  std::vector<double> stretches;
  for (const auto& [area, triangles, stretch] :
       {std::tuple{0.93, 2, 1.1}, std::tuple{0.05, 200, 1.2}, std::tuple{0.02, 800, 1.5}}) {
    const TriangleMesh part = square(std::sqrt(area), triangles);
    append(mesh, part);
    stretches.resize(static_cast<size_t>(mesh.vertices.cols()), stretch);
  }
  const Model model = model_of(std::move(mesh));
  Points x = model.X;
  for (int node = 0; node < x.cols(); ++node) x(0, node) *= stretches[static_cast<size_t>(node)];
  const Metrics metrics = measure_at(model, x);
  EXPECT_NEAR(*metrics.max_principal_strain, 0.5, 1e-12);
  EXPECT_NEAR(*metrics.p99_principal_strain, 0.5, 1e-12);
  EXPECT_NEAR(*metrics.p95_principal_strain, 0.2, 1e-12);
}

// All triangles, E = 1000, nu = 0.3, h = 1.
template <typename Kernel>
MembranePatch membrane_patch(const Model& model) {
  MembranePatch patch;
  std::vector<typename Kernel::Rest> rest;
  for (int t = 0; t < model.mesh.triangle_count(); ++t) {
    const Eigen::Vector3i c = model.mesh.triangles.col(t);
    patch.triangles.push_back(t);
    rest.push_back(Kernel::rest(model.X.col(c[0]), model.X.col(c[1]), model.X.col(c[2]), 1000, 0.3, 1));
  }
  patch.state = [rest](int e, const CstVector& x) { return Kernel::state(rest[static_cast<size_t>(e)], x); };
  return patch;
}

TEST(Fields, GivePrincipalStretchAndStressOfABiaxialPatch) {
  Model model = model_of(square(1, 8));
  model.membrane_patches = {membrane_patch<CstStVK>(model)};
  Points x = model.X;
  x.row(0) *= 1.2;
  x.row(1) *= 1.1;
  const Fields fields = compute_fields(model, x);
  for (int t = 0; t < 8; ++t) {
    EXPECT_NEAR(fields.principal_strain(0, t), 0.2, 1e-14);
    EXPECT_NEAR(fields.principal_strain(1, t), 0.1, 1e-14);
    EXPECT_NEAR(fields.principal_stress(0, t), 331.648352 / 1.2, 1e-5);  // first Piola-Kirchhoff over stretch
    EXPECT_NEAR(fields.principal_stress(1, t), 206.703297 / 1.1, 1e-5);
  }
}

// A strip drawn out and free to wrinkle across, one triangle pair left at rest and one gone slack.
TEST(Fields, GiveTheRelaxedStressAndTheRegimeOfATensionField) {
  Model model = model_of(square(1, 8));
  model.membrane_patches = {membrane_patch<CstTensionField>(model)};
  const auto stretched = [&](double along, double across) {
    Points x = model.X;
    x.row(0) *= along;
    x.row(1) *= across;
    return x;
  };
  const struct {
    double along, across;
    MembraneRegime regime;
  } cases[] = {{1.2, 1.1, MembraneRegime::Taut},
               {1.2, 0.7, MembraneRegime::Wrinkled},
               {0.9, 0.8, MembraneRegime::Slack}};
  for (const auto& c : cases) {
    const Points x = stretched(c.along, c.across);
    const Fields fields = compute_fields(model, x);
    const Metrics metrics = measure_at(model, x);
    EXPECT_EQ(fields.regime, std::vector<MembraneRegime>(8, c.regime));
    EXPECT_NEAR(metrics.taut_area_mm2.value(), c.regime == MembraneRegime::Taut ? 1 : 0, 1e-12);
    EXPECT_NEAR(metrics.wrinkled_area_mm2.value(), c.regime == MembraneRegime::Wrinkled ? 1 : 0, 1e-12);
    EXPECT_NEAR(metrics.slack_area_mm2.value(), c.regime == MembraneRegime::Slack ? 1 : 0, 1e-12);
  }
  const Fields wrinkled = compute_fields(model, stretched(1.2, 0.7));
  EXPECT_NEAR(wrinkled.principal_stress(0, 3), 1000 * 0.5 * (1.44 - 1), 1e-10);
  EXPECT_NEAR(wrinkled.principal_stress(1, 3), 0, 1e-12);
  model.membrane_patches = {membrane_patch<CstStVK>(model)};
  EXPECT_LT(compute_fields(model, stretched(1.2, 0.7)).principal_stress(1, 3), -100);
}

TEST(Fields, GiveTheTensionOfTautAndSlackLines) {
  Model model;
  model.X.resize(3, 3);
  model.X << 0, 1, 3, 0, 0, 0, 0, 0, 0;
  model.lines = {{0, 1, 1, 0, "chords", 0}, {1, 2, 2, 0, "chords", 1}};
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  terms.push_back(std::make_unique<ElementTerm<Cable>>(
      "chords", std::vector<int>{0, 1, 1, 2}, std::vector<Cable::Rest>{{50, 1, 0, 0}, {50, 2, 0, 0}}));
  model.objective = std::make_unique<Objective>(model.X, FixedMask::Constant(3, 3, false), std::move(terms));
  Points x = model.X;
  x(0, 1) = 1.1;  // the first line grows by 0.1, the second shrinks
  const Metrics metrics = measure_at(model, x);
  EXPECT_NEAR(metrics.max_chord_force_n.value(), 5, 1e-12);
  EXPECT_EQ(metrics.slack_chords.value(), 1);
}

TEST(Metrics, GiveTheStrainOfTheLinesThatHaveARestLength) {
  Model model;
  model.X.resize(3, 5);
  model.X << 0, 1, 3, 4, 5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0;
  model.lines = {{0, 1, 1, 0, "chords", 0},
                 {1, 2, 2, 0, "chords", 1},
                 {2, 3, 1, 0, "chords", 2},
                 {3, 4, 0, 0, "pull", 0}};
  model.objective = std::make_unique<Objective>(model.X, FixedMask::Constant(3, 5, false),
                                                std::vector<std::unique_ptr<EnergyTerm>>{});
  Points x = model.X;
  EXPECT_EQ(measure_at(model, x).max_chord_strain.value(), 0);
  EXPECT_FALSE(measure_at(model, x).mean_chord_strain);
  x(0, 1) = 1.1;  // longer by 10 %, shorter by 35 %, longer by 60 %, and one that has no rest length
  x(0, 2) = 2.4;
  x(0, 4) = 9;
  EXPECT_NEAR(measure_at(model, x).max_chord_strain.value(), 0.6, 1e-12);
  EXPECT_NEAR(measure_at(model, x).mean_chord_strain.value(), 0.35, 1e-12);
  x = 0.5 * model.X;
  EXPECT_NEAR(measure_at(model, x).max_chord_strain.value(), -0.5, 1e-12);
  model.lines = {{3, 4, 0, 0, "pull", 0}};
  EXPECT_FALSE(measure_at(model, x).max_chord_strain);
}

TEST(ReferenceDistance, MeasuresAParallelSurfaceBothWaysAndVertexByVertex) {
  Model model = model_of(square(10, 200));
  model.closed_reference = model.mesh;
  model.closed_reference->vertices.row(2).array() += 0.5;
  Fields fields = compute_fields(model, model.X);
  const auto distance = compare_with_reference(model, fields);
  ASSERT_TRUE(distance && distance->same_vertex);
  EXPECT_NEAR(distance->to_reference.mean, 0.5, 1e-12);
  EXPECT_NEAR(distance->from_reference.max, 0.5, 1e-12);
  EXPECT_NEAR(distance->same_vertex->max, 0.5, 1e-12);
  EXPECT_NEAR(fields.reference_distance[3], 0.5, 1e-12);
}

TEST(ReferenceDistance, LeavesOutNodesThatCanMoveAtNoCost) {
  Model model = model_of(square(10, 200));
  model.closed_reference = model.mesh;
  model.closed_reference->vertices.row(2).array() += 0.5;
  const int loose = 20, beyond = model.mesh.vertex_count() + 3;  // a chord's junction is no vertex
  Points x = model.X;
  x(2, loose) += 7;
  Fields fields = compute_fields(model, x);
  EXPECT_NEAR(compare_with_reference(model, fields)->to_reference.max, 6.5, 1e-12);
  const auto distance = compare_with_reference(model, fields, {loose, beyond});
  EXPECT_EQ(distance->left_out, 1);
  for (const DistanceFigures& figures : {distance->to_reference, distance->from_reference}) {
    EXPECT_NEAR(figures.mean, 0.5, 1e-12);
    EXPECT_NEAR(figures.max, 0.5, 1e-12);
  }
  EXPECT_NEAR(distance->same_vertex->max, 0.5, 1e-12);
  EXPECT_NEAR(fields.reference_distance[loose], 6.5, 1e-12) << "the map shows every vertex";

  std::vector<int> all;
  for (int v = 0; v < model.mesh.vertex_count(); ++v) all.push_back(v);
  const auto nothing = compare_with_reference(model, fields, all);
  EXPECT_TRUE(std::isnan(nothing->to_reference.max) && std::isnan(nothing->from_reference.mean));
  EXPECT_TRUE(std::isnan(nothing->same_vertex->max));
}

TEST(ReferenceDistance, ComparesVerticesHoweverTheFacetsAreListed) {
  Model model = model_of(square(10, 200));
  model.closed_reference = model.mesh;
  model.closed_reference->vertices.row(2).array() += 0.5;
  Triangles& triangles = model.closed_reference->triangles;
  const Triangles listed = triangles;
  triangles = listed.rowwise().reverse();  // the last facet first
  triangles.row(0).swap(triangles.row(1));
  triangles.row(1).swap(triangles.row(2));  // each from its next corner on
  Fields fields = compute_fields(model, model.X);
  const auto turned = compare_with_reference(model, fields);
  ASSERT_TRUE(turned && turned->same_vertex);
  EXPECT_NEAR(turned->same_vertex->mean, 0.5, 1e-12);
  // Another facet, or a vertex more: another mesh.
  triangles = listed;
  triangles(0, 0) = listed(0, listed.cols() - 1);
  EXPECT_FALSE(compare_with_reference(model, fields)->same_vertex);
  triangles = listed;
  model.closed_reference->vertices.conservativeResize(3, model.X.cols() + 1);
  model.closed_reference->vertices.rightCols<1>().setZero();
  EXPECT_FALSE(compare_with_reference(model, fields)->same_vertex);
}

TEST(Metrics, AgreeWithThePublishedFiguresOfTheClosedTricuspidValve) {
  const std::filesystem::path file =
      std::filesystem::path(COAPT_SHARED_DIR) / "data/trivalve11-healthy/valve.json";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: data not found";
  const ValveFile valve = read_valve(file);
  Model model = model_of(valve.valve.leaflets);
  model.sets["annulus"] = valve.valve.annulus;
  model.contact_range = 0.3;  // twice the contact gap of that computation
  const Metrics metrics = measure_at(model, valve.valve.closed_reference->vertices);
  EXPECT_NEAR(metrics.annulus_area_mm2.value(), 711, 0.5);
  EXPECT_NEAR(metrics.orifice_area_mm2.value(), 0.26, 0.02);
  EXPECT_EQ(metrics.intersections, 56);
  EXPECT_NEAR(metrics.leaflet_area_closed_mm2 / metrics.leaflet_area_open_mm2, 1.295, 1e-3);
  EXPECT_NEAR(static_cast<double>(metrics.contact_vertices), 2729, 100);
  EXPECT_NEAR(metrics.max_displacement_mm, 18.29, 0.01);

  // The vertices that the data names, and ours.
  const Fields fields = compute_fields(model, valve.valve.closed_reference->vertices);
  std::ifstream stream(file);
  long both = 0, published = 0;
  const nlohmann::json published_valve = nlohmann::json::parse(stream);
  for (const int v : published_valve["reference_contact_vertices"]) {
    ++published;
    both += fields.is_contact[static_cast<size_t>(v)];
  }
  EXPECT_EQ(published, 2729);
  EXPECT_GT(static_cast<double>(both) / static_cast<double>(metrics.contact_vertices), 0.92);  // precision
  EXPECT_GT(static_cast<double>(both) / static_cast<double>(published), 0.89);                 // recall
  EXPECT_NEAR(metrics.coaptation_length_mm.value(), 96, 4);
  double outlined = 0;
  for (const Orifice& orifice : metrics.closure->orifices) outlined += orifice.outline.area;
  EXPECT_NEAR(outlined, 0.249, 0.12);  // what is narrower than a cell of 0.07 is not outlined
}

}  // namespace
}  // namespace coapt
