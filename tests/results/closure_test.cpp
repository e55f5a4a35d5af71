// Coaptation, orifice, tenting and prolapse of valves for which they are known.
#include "core/number_text.hpp"
#include "mesh/mesh_topology.hpp"
#include "mesh/shapes.hpp"
#include "results/detail/coaptation_height.hpp"
#include "results/metrics.hpp"
#include "results/result_surfaces.hpp"
#include "results/result_warnings.hpp"
#include "support/trough_valve.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace coapt {
namespace {

constexpr double kPi = std::numbers::pi;

// open: the shape that tells which side is up.
Model valve_model(TriangleMesh mesh, const std::vector<int>& annulus, double range) {
  Model model;
  model.X = mesh.vertices;
  model.mesh = std::move(mesh);
  model.sets["annulus"] = annulus;
  model.contact_range = range;
  model.objective = std::make_unique<Objective>(model.X, FixedMask::Constant(3, model.X.cols(), false),
                                                std::vector<std::unique_ptr<EnergyTerm>>{});
  return model;
}

Metrics measured(const Model& model, const Points& x) {
  return measure(model, model.objective->unknowns(x), compute_fields(model, x));
}

Model trough_model(const Trough& shape, double range = 0.3) {
  TroughValve valve = trough_valve(shape);
  return valve_model(std::move(valve.mesh), valve.annulus, range);
}

TEST(Closure, OfATroughHasTheLineHeightAndAreaOfItsGroove) {
  const Model model = trough_model({});
  const Metrics m = measured(model, model.X);
  EXPECT_NEAR(m.coaptation_length_mm.value(), 16, 0.1);
  EXPECT_NEAR(m.coaptation_height_mm.value(), 4, 0.1);
  EXPECT_NEAR(m.coaptation_area_mm2.value(), 64, 3.5);  // it parts at an angle: too little is counted
  EXPECT_NEAR(m.tenting_height_mm.value(), 3, 0.05);
  EXPECT_NEAR(m.tenting_volume_mm3.value(), 480, 6);
  EXPECT_EQ(m.prolapse_height_mm.value(), 0);
  ASSERT_EQ(m.closure->line.size(), 1u);
  for (const auto& p : m.closure->line[0].points.colwise()) {
    EXPECT_NEAR(p[0], 0, 0.1);
    EXPECT_NEAR(p[2], -3, 0.05);
  }
}

TEST(Closure, ClosesTheSlitBetweenLeafletsInContactAndNoWiderOne) {
  const Model near = trough_model({.gap = 0.2}, 0.3);
  const Metrics closed = measured(near, near.X);
  EXPECT_NEAR(closed.orifice_area_mm2.value(), 0.2 * 16, 1e-3);
  EXPECT_EQ(closed.regurgitant_area_mm2.value(), 0);
  const Model far = trough_model({.gap = 1}, 0.3);
  const Metrics open = measured(far, far.X);
  EXPECT_NEAR(open.orifice_area_mm2.value(), 16, 1e-3);
  EXPECT_NEAR(open.regurgitant_area_mm2.value(), 16, 0.5);
  EXPECT_EQ(open.coaptation_length_mm.value(), 0);
  EXPECT_EQ(open.contact_facets, 0);
  ASSERT_EQ(open.closure->orifices.size(), 1u);
  EXPECT_NEAR(open.closure->orifices[0].outline.area, 16, 0.01);
}

TEST(Closure, FollowsAGrooveThatInclinesWhereverTheValveLies) {
  Trough shape{.slope = 0.25};
  Model model = trough_model(shape);
  const double length = 16 * std::sqrt(1 + 0.0625);
  EXPECT_NEAR(measured(model, model.X).coaptation_length_mm.value(), length, 0.15);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Vec3(2, -1, 1).normalized()).toRotationMatrix();
  model.X = (turn * model.X).colwise() + Vec3(30, 200, -100);
  model.mesh.vertices = model.X;
  const Metrics m = measured(model, model.X);
  EXPECT_NEAR(m.coaptation_length_mm.value(), length, 0.15);
  EXPECT_NEAR(m.coaptation_height_mm.value(), 4 * std::cos(std::atan(0.25)), 0.15);  // across the line
  EXPECT_NEAR(m.tenting_volume_mm3.value(), 480, 6);
}

TEST(Closure, ConvergesWithTheMesh) {
  const Model model = trough_model({.fineness = 3});
  const Metrics m = measured(model, model.X);
  EXPECT_NEAR(m.coaptation_length_mm.value(), 16, 0.05);
  EXPECT_NEAR(m.coaptation_area_mm2.value(), 64, 5.5);  // it parts at an angle: too little is counted
  EXPECT_NEAR(m.coaptation_height_mm.value(), 4, 0.05);
}

// Two sheets that rest on each other over 5 of 12, 10 wide, and then lift off with the square of the way, as
// membranes do. A barrier keeps them apart by 0.88 of its range, which shrinks with the mesh.
TEST(CoaptationArea, DoesNotDependOnTheDistanceThatContactKeeps) {
  for (const double range : {0.5, 0.25, 0.125}) {
    const double rest = 0.88 * range;
    const auto sheet = [&](double side) {
      return grid_sheet(static_cast<int>(std::lround(24 / range)), 20, [&, side](double u, double v) {
        const double way = std::max(0.0, 12 * u - 5);
        return Vec3(12 * u, 10 * v, side * (rest + 0.04 * way * way) / 2);
      });
    };
    TriangleMesh mesh = sheet(-1);
    append(mesh, sheet(1));
    Model model = valve_model(mesh, {}, range);
    model.sets.clear();
    const double within = 10 * (5 + std::sqrt(0.12 * range / 0.04));
    EXPECT_GT(within, 55);
    EXPECT_NEAR(measured(model, model.X).coaptation_area_mm2.value(), 50, 1) << range << ": not " << within;
  }
}

// Seen along the normal it is a ring with a hole of radius 4, whose rim stands in a plane that leans.
TEST(OrificeFilm, StandsInThePlaneOfItsRim) {
  for (const double lean : {0.0, 0.75}) {
    const TriangleMesh sheet = weld(grid_sheet(80, 12, [&](double u, double v) {
                                 const double radius = 4 + 6 * v, angle = u == 1 ? 0 : 2 * kPi * u;
                                 const double x = radius * std::cos(angle);
                                 return Vec3(x, radius * std::sin(angle), lean * x * (1 - v) * (1 - v));
                               })).mesh;
    std::vector<int> rim;
    for (int v = 0; v < sheet.vertex_count(); ++v)
      if (sheet.vertices.col(v).head<2>().norm() > 9.99) rim.push_back(v);
    std::sort(rim.begin(), rim.end(), [&](int a, int b) {
      const auto angle = [&](int v) { return std::atan2(sheet.vertices(1, v), sheet.vertices(0, v)); };
      return angle(a) < angle(b);
    });
    const Model model = valve_model(sheet, rim, 0.2);
    const Metrics m = measured(model, sheet.vertices);
    EXPECT_NEAR(m.regurgitant_area_mm2.value(), kPi * 16, 0.5);
    EXPECT_NEAR(m.orifice_film_area_mm2.value(), kPi * 16 * std::hypot(1, lean), 1) << lean;
  }
}

// Counted on a grid, which lies along the annulus and not along the axes of the file.
TEST(Orifice, HasOneAreaHoweverTheValveIsTurned) {
  Model model = trough_model({.gap = 1, .slope = 0.1}, 0.3);
  for (auto&& p : model.X.colwise()) p[0] *= p[0] > 0 ? 1.3 : 1;
  model.mesh.vertices = model.X;
  const Points X = model.X;
  const Metrics given = measured(model, model.X);
  for (const double angle : {0.3, 1.1, 2.5}) {
    model.X = Eigen::AngleAxisd(angle, Vec3(2, -1, 1).normalized()).toRotationMatrix() * X;
    model.mesh.vertices = model.X;
    const Metrics turned = measured(model, model.X);
    EXPECT_NEAR(turned.regurgitant_area_mm2.value(), given.regurgitant_area_mm2.value(), 1e-9) << angle;
    EXPECT_NEAR(turned.orifice_film_area_mm2.value(), given.orifice_film_area_mm2.value(), 1e-3) << angle;
  }
}

TEST(Closure, GivesEachLeafletItsShare) {
  const Model model = trough_model({});
  const Metrics m = measured(model, model.X);
  ASSERT_EQ(m.closure->leaflets.size(), 2u);
  double contact = 0, volume = 0;
  long vertices = 0, facets = 0;
  for (const LeafletMetrics& leaflet : m.closure->leaflets) {
    EXPECT_NEAR(leaflet.coaptation_length_mm, 16, 0.1) << leaflet.name;
    EXPECT_NEAR(leaflet.coaptation_height_mm, 4, 0.1) << leaflet.name;
    EXPECT_NEAR(leaflet.tenting_volume_mm3, 240, 6) << leaflet.name;
    contact += leaflet.contact_area_mm2.value();
    volume += leaflet.tenting_volume_mm3;
    vertices += leaflet.contact_vertices;
    facets += leaflet.contact_facets;
  }
  EXPECT_EQ(m.closure->leaflets[0].name, "anterior");
  EXPECT_NEAR(contact, 2 * m.coaptation_area_mm2.value(), 1e-9);
  EXPECT_NEAR(volume, m.tenting_volume_mm3.value(), 1e-9);
  EXPECT_EQ(vertices, m.contact_vertices);
  EXPECT_EQ(facets, m.contact_facets);
}

TEST(Closure, WritesItsLineAndOutlinesWithOneValueForEachStretch) {
  Model model = trough_model({});
  model.origin = Vec3(5, 0, 0);
  const Metrics m = measured(model, model.X);
  const VtpSurface line = coaptation_line(model, *m.closure), orifice = orifice_outlines(model, *m.closure);
  EXPECT_EQ(line.lines.cols(), line.vertices.cols() - 1);
  EXPECT_NEAR(line.vertices.row(0).mean(), 5, 0.05);
  ASSERT_EQ(line.line_arrays.size(), 4u);
  EXPECT_TRUE((line.line_arrays[1].values.array() == 0).all());
  EXPECT_TRUE((line.line_arrays[2].values.array() == 1).all());
  EXPECT_NEAR(line.line_arrays[3].values.mean(), 4, 0.1);
  EXPECT_EQ(orifice.lines.cols(), orifice.vertices.cols());
}

const HealthyCriterion& criterion(const Metrics& m, const std::string& name) {
  for (const HealthyCriterion& each : m.healthy_closure)
    if (each.name == name) return each;
  throw std::runtime_error("no criterion " + name);
}

TEST(HealthyClosure, AsksForTwoThirdsOfTheDiameterUnderTheAnteriorLeaflet) {
  Model model = trough_model({});
  const Metrics half = measured(model, model.X);
  EXPECT_NEAR(criterion(half, "anterior_share").value, 0.5, 0.02);
  EXPECT_FALSE(criterion(half, "anterior_share").is_met());
  EXPECT_NEAR(criterion(half, "coaptation_height_mm").value, half.coaptation_height_mm.value(), 1e-12);
  EXPECT_TRUE(criterion(half, "coaptation_height_mm").is_met());
  for (auto&& p : model.X.colwise())  // the posterior half is half as deep, the anterior one 2/3 of all
    if (p[0] > 0.1) p[0] = 0.1 + 0.5 * (p[0] - 0.1);
  model.mesh.vertices = model.X;
  const Metrics healthy = measured(model, model.X);
  EXPECT_NEAR(criterion(healthy, "anterior_share").value, 2.0 / 3, 0.02);
  EXPECT_TRUE(criterion(healthy, "anterior_share").is_met());
}

TEST(HealthyClosure, EstimatesTheRegurgitantVolumeWhereThePressureIsKnown) {
  Model model = trough_model({.gap = 1}, 0.3);
  EXPECT_EQ(measured(model, model.X).healthy_closure.size(), 3u);
  model.applied_pressure = 0.016;  // 5.5 m/s
  const Metrics open = measured(model, model.X);
  const HealthyCriterion& volume = criterion(open, "regurgitant_volume_ml");
  EXPECT_NEAR(volume.value, open.regurgitant_area_mm2.value() * std::sqrt(2 * 16000 / 1060.0) * 0.3, 1e-9);
  EXPECT_GT(volume.value, 20);
  EXPECT_FALSE(volume.is_met());
  EXPECT_EQ(range_in_words(volume), "at most 5 ml");
  EXPECT_EQ(figure_in_words(volume), "regurgitant volume " + number_text(volume.value, 2) + " ml");
  Model closed = trough_model({.gap = 0.2}, 0.3);
  closed.applied_pressure = 0.016;
  EXPECT_TRUE(criterion(measured(closed, closed.X), "regurgitant_volume_ml").is_met());
}

// The bound is two deviations above the mean of Rausch et al. 2011.
TEST(HealthyClosure, JudgesTheStrainOfTheLeafletsByWhatWasMeasuredInVivo) {
  for (const double strain : {0.1, 0.22, 0.23, 0.43}) {
    const std::vector<HealthyCriterion> criteria = healthy_criteria({0.67, 4, 0, 0.016, strain});
    const HealthyCriterion& judged = criteria.back();
    EXPECT_EQ(judged.name, "p99_principal_strain");
    EXPECT_NEAR(judged.highest.value(), 0.224, 1e-12);
    EXPECT_NE(judged.source.find("Rausch et al. 2011"), std::string::npos);
    EXPECT_EQ(range_in_words(judged), "at most 0.22");
    EXPECT_EQ(judged.is_met(), strain < 0.224);
    Report report;
    report.result.status = Status::Converged;
    report.metrics.healthy_closure = criteria;
    EXPECT_EQ(doubts(report).empty(), strain < 0.224) << strain;
    EXPECT_EQ(headline(report).is_in_doubt, strain > 0.224) << strain;
  }
  EXPECT_EQ(strain_doubt(healthy_criteria({0.67, 4, 0, 0.016, 0.43})),
            "1 % of the leaflets strained above 43 % (in vivo: peaks of 13 +- 4.7 %, Rausch 2011)");
  EXPECT_EQ(healthy_criteria({0.67, 4, 0, 0.016}).size(), 3u) << "a scene whose strain is not known";
}

TEST(HealthyClosure, IsAskedOfMitralValvesAlone) {
  Model model = trough_model({});
  ASSERT_FALSE(measured(model, model.X).healthy_closure.empty());
  model.mesh.region_names = {"anterior", "posterior", "septal"};
  EXPECT_TRUE(measured(model, model.X).healthy_closure.empty());
  model.mesh.region_names = {"left", "right"};
  EXPECT_TRUE(measured(model, model.X).healthy_closure.empty());
}

// A disc of radius 10 bulged by a height; its rim is the annulus.
struct Bulge {
  TriangleMesh mesh;
  std::vector<int> rim;
};
Bulge bulge(double height) {
  Bulge result{disc(10, 4000), {}};
  result.rim = boundary_loops(result.mesh.triangles).at(0);
  const auto square = result.mesh.vertices.colwise().squaredNorm();
  result.mesh.vertices.row(2) = (height * (1 - square.array() / 100)).matrix();
  return result;
}

TEST(Closure, TellsADomeAboveTheAnnulusFromOneBelow) {
  const Bulge below = bulge(-4), above = bulge(2.5);
  const Model model = valve_model(below.mesh, below.rim, 0.2);
  const Metrics hanging = measured(model, below.mesh.vertices);
  EXPECT_NEAR(hanging.tenting_volume_mm3.value(), kPi * 100 * 4 / 2, 0.01 * kPi * 200);
  EXPECT_NEAR(hanging.tenting_height_mm.value(), 4, 1e-2);
  EXPECT_EQ(hanging.prolapse_height_mm.value(), 0);
  EXPECT_NEAR(hanging.orifice_area_mm2.value(), 0, 1e-3);
  const Metrics prolapsed = measured(model, above.mesh.vertices);
  EXPECT_NEAR(prolapsed.prolapse_height_mm.value(), 2.5, 1e-2);
  EXPECT_NEAR(prolapsed.tenting_volume_mm3.value(), 0, 0.1);
}

TEST(Closure, DoesNotTakeASaddleShapedAnnulusForProlapse) {
  Bulge flat = bulge(-4);
  const Model model = valve_model(flat.mesh, flat.rim, 0.2);
  Points saddle = flat.mesh.vertices;
  saddle.row(2) = 0.03 * (saddle.row(0).array().square() - saddle.row(1).array().square());
  const Metrics m = measured(model, saddle);  // up to 3 above the annulus plane
  EXPECT_NEAR(m.prolapse_height_mm.value(), 0, 0.01);
  EXPECT_LT(m.tenting_volume_mm3.value(), 0.02 * kPi * 100 * 3);
}

TEST(Closure, CountsAnOpenFunnelDownToItsRimAsTented) {
  const WeldedMesh welded = weld(grid_sheet(80, 6, [](double u, double v) {
    const double radius = 4 + 6 * v, angle = u == 1 ? 0 : 2 * kPi * u;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), -3 * (1 - v));
  }));
  const TriangleMesh& funnel = welded.mesh;
  std::vector<int> rim;
  for (int k = 0; k < 80; ++k) rim.push_back(welded.new_index[static_cast<size_t>(6 * 81 + k)]);
  const Model model = valve_model(funnel, rim, 0.2);
  const Metrics m = measured(model, funnel.vertices);
  EXPECT_NEAR(m.tenting_volume_mm3.value(), kPi * 3 / 3 * (100 + 40 + 16), 0.01 * kPi * 156);
  EXPECT_NEAR(m.regurgitant_area_mm2.value(), kPi * 16, 0.01 * kPi * 16);
  EXPECT_NEAR(m.tenting_height_mm.value(), 3, 0.05);
  EXPECT_TRUE(m.closure->line.empty());
}

TEST(Closure, FindsTheFoldOfOneLeafletAsALineOfItsOwn) {
  // One sheet, no regions: it dips into a fold 0.2 wide and 5 deep along y.
  const TriangleMesh sheet = grid_sheet(120, 40, [](double u, double v) {
    const double s = 30 * u - 15, way = std::abs(s), sign = s < 0 ? -1 : 1;
    if (way < 5) return Vec3(sign * std::min(0.1, way), 16 * v - 8, -6 + way);
    return Vec3(sign * (0.1 + 0.995 * (way - 5)), 16 * v - 8, -1 + 0.1 * (way - 5));
  });
  const Model model = valve_model(sheet, {0, 120, 120 + 40 * 121, 40 * 121}, 0.3);
  const Metrics m = measured(model, sheet.vertices);
  EXPECT_NEAR(m.coaptation_length_mm.value(), 16, 0.2);
  EXPECT_TRUE(m.closure->leaflets.empty());
  EXPECT_NEAR(m.coaptation_height_mm.value(), 4.5, 0.6);  // two rings around the bottom are neighbours
}

TEST(Closure, CostsNothingWithoutAnnulusAndContact) {
  Model model = valve_model(disc(5, 100), {}, 0);
  model.sets.clear();
  const Fields fields = compute_fields(model, model.X);
  EXPECT_EQ(fields.gap.size(), 0);
  EXPECT_TRUE(fields.is_contact.empty() && fields.is_contact_facet.empty());
  EXPECT_FALSE(measured(model, model.X).closure);
}

TEST(CoaptationHeight, IsMeasuredAcrossTheLineAndEndsWithIt) {
  Seam seam;
  seam.points.resize(3, 2);
  seam.points << 0, 10, 0, 0, 0, 0;
  seam.triangles = {{0, 1}};
  const std::vector<Station> places = stations({seam}, 1);
  ASSERT_EQ(places.size(), 10u);
  EXPECT_NEAR((places[3].point - Vec3(3.5, 0, 0)).norm(), 0, 1e-12);
  const std::vector<double> heights = heights_at(places, {{3.4, 0, -2}, {3.6, 1, -1}, {14, 0, -7}}, 1);
  EXPECT_NEAR(heights[3], 2, 1e-12);
  EXPECT_TRUE(std::isnan(heights[9]));
  EXPECT_NEAR(ninth_decile(heights), 2, 1e-12);
  EXPECT_EQ(ninth_decile({}), 0);
}

}  // namespace
}  // namespace coapt
