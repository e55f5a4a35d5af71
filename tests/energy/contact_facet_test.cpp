#include "energy/contact_facet.hpp"

#include "core/error.hpp"
#include "support/meshes.hpp"
#include "support/oracles.hpp"
#include "support/term_suite.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr double kRange = 0.6;

// Two sheets, one above the other and tilted, coarse enough that every pair is easily listed.
TriangleMesh two_sheets(double gap) {
  const TriangleMesh sheet = grid_mesh(1, 1);
  TriangleMesh both;
  both.vertices.resize(3, 8);
  both.vertices.leftCols(4) = sheet.vertices;
  both.vertices.rightCols(4) = sheet.vertices.colwise() + Vec3(0.13, 0.07, gap);
  both.triangles.resize(3, 4);
  both.triangles.leftCols(2) = sheet.triangles;
  both.triangles.rightCols(2) = sheet.triangles.array() + 4;
  return both;
}

ContactFacetOptions options(int exponent, int quadrature, int subdivision = 1) {
  ContactFacetOptions o;
  o.range = kRange;
  o.exponent = exponent;
  o.strength = 1.7;
  o.quadrature = quadrature;
  o.subdivision = subdivision;
  return o;
}

TermCase contact_case(const ContactFacetOptions& chosen) {
  const TriangleMesh mesh = two_sheets(2.0);  // at rest far apart
  TermCase c;
  c.label =
      "contact n=" + std::to_string(chosen.exponent) + " quadrature=" + std::to_string(chosen.quadrature);
  c.rest = mesh.vertices;
  c.state = shaken(two_sheets(0.3).vertices, 0.08, 21);
  c.has_hessian = chosen.exponent > 2;
  c.reach = 0.1;
  c.far_away = 10;
  c.make = [mesh, chosen](const Frame& f) {
    ContactFacetOptions scaled = chosen;
    scaled.range *= f.length;
    scaled.strength *= f.force / (f.length * f.length * f.length);
    return make_contact_facet("contact", f.points(mesh.vertices), f.triangles(mesh.triangles), scaled);
  };
  return c;
}

TEST(ContactFacet, PassesTheSuiteWithExponentThreeAndEveryQuadrature) {
  for (const int quadrature : {1, 3, 6}) EXPECT_EQ(examine_term(contact_case(options(3, quadrature))), "");
  EXPECT_EQ(examine_term(contact_case(options(3, 3, 2))), "");
}

TEST(ContactFacet, PassesTheSuiteWithTheSourcesExponentTwo) {
  for (const int quadrature : {1, 3}) EXPECT_EQ(examine_term(contact_case(options(2, quadrature))), "");
}

oracle::FacetRepulsion repulsion(const ContactFacetOptions& o) {
  oracle::FacetRepulsion f;
  const TriangleMesh mesh = two_sheets(2.0);
  f.X = mesh.vertices;
  f.triangles = mesh.triangles;
  f.pairs = {{0, 2}, {0, 3}, {1, 2}, {1, 3}};  // facets of one sheet touch each other and are left out
  if (o.quadrature == 1) {
    f.rule = {{Vec3::Constant(1.0 / 3), 1.0}};
  } else {
    for (int k = 0; k < 3; ++k) f.rule.push_back({Vec3::Constant(1.0 / 6) + 0.5 * Vec3::Unit(k), 1.0 / 3});
  }
  f.range = o.range;
  f.strength = o.strength;
  f.exponent = o.exponent;
  return f;
}

TEST(ContactFacet, AgreesWithAutomaticDifferentiation) {
  for (const int exponent : {2, 3, 5})
    for (const int quadrature : {1, 3}) {
      TermCase c = contact_case(options(exponent, quadrature));
      c.has_hessian = true;  // away from its kink the second derivative of n = 2 exists
      EXPECT_EQ(compare_with_autodiff(c, repulsion(options(exponent, quadrature))), "");
    }
}

// The list of candidates is a cache: a sheet that comes, goes and comes back finds the same contacts.
TEST(ContactFacet, CountsEachActivePairOnceWhereverTheSheetHasBeen) {
  const TermCase c = contact_case(options(3, 3));
  const auto direct = c.make({});
  evaluate_term(*direct, c.state);
  const auto wandering = c.make({});
  for (double gap = 3; gap > 0.31; gap -= 0.17) evaluate_term(*wandering, two_sheets(gap).vertices);
  evaluate_term(*wandering, c.state);
  EXPECT_EQ(direct->counters().elements, wandering->counters().elements);
  EXPECT_EQ(direct->counters().elements, 4);
  EXPECT_GT(wandering->counters().searches, 1);
  evaluate_term(*wandering, c.rest);
  EXPECT_EQ(wandering->counters().elements, 0);
}

TEST(ContactFacet, IsExactlyZeroOutOfRange) {
  const TermCase c = contact_case(options(3, 3));
  const TermValues far = evaluate_term(*c.make({}), two_sheets(kRange + 1e-9).vertices);
  EXPECT_EQ(far.energy, 0);
  EXPECT_EQ(far.gradient.norm(), 0);
  EXPECT_EQ(far.hessian.norm(), 0);
}

TEST(ContactFacet, StaysFiniteWhereSheetsCoincide) {
  TriangleMesh mesh = two_sheets(0);
  mesh.vertices.rightCols(4) = mesh.vertices.leftCols(4);
  const TermValues touching = evaluate_term(*contact_case(options(3, 3)).make({}), mesh.vertices);
  EXPECT_GT(touching.energy, 0);
  EXPECT_TRUE(touching.gradient.allFinite());
  EXPECT_TRUE(touching.hessian.allFinite());
}

// VERIFICATION 1.3: two parallel sheets feel 2 pi C delta s (1-s)^n, greatest at s = 1/(n+1).
TEST(ContactFacet, CapacityIsTheGreatestPressureOfTwoParallelSheets) {
  for (const int n : {2, 3}) {
    const double s = 1.0 / (n + 1);
    EXPECT_NEAR(contact_facet_capacity(1.4, 0.7, n),
                2 * std::numbers::pi * 1.4 * 0.7 * s * std::pow(1 - s, n), 1e-14);
    EXPECT_NEAR(contact_facet_capacity(contact_facet_strength(3.0, 0.7, n, 1.5), 0.7, n), 4.5, 1e-13);
  }
  EXPECT_NEAR(contact_facet_capacity(1, 1, 2), 0.93084, 1e-5);
}

TEST(ContactFacet, CarriesThatPressureBetweenWideSheets) {
  // A small sheet over the middle of one that reaches beyond the range on all sides.
  const double range = 0.3, side = 0.2;
  const TriangleMesh wide = grid_mesh(8, 8), narrow = grid_mesh(2, 2, side, side);
  TriangleMesh both;
  both.vertices.resize(3, wide.vertex_count() + narrow.vertex_count());
  both.vertices << wide.vertices, narrow.vertices.colwise() + Vec3(0.4, 0.4, range / 4);
  both.triangles.resize(3, wide.triangle_count() + narrow.triangle_count());
  both.triangles << wide.triangles, narrow.triangles.array() + wide.vertex_count();
  ContactFacetOptions o = options(3, 6, 2);
  o.range = range;
  const auto term = make_contact_facet("c", both.vertices, both.triangles, o);
  term->prepare(both.vertices);
  Points g = Points::Zero(3, both.vertices.cols());
  Sink sink(g.data());
  term->evaluate(both.vertices, sink);
  const double pressure = -g.row(2).tail(narrow.vertex_count()).sum() / (side * side);
  const double capacity = contact_facet_capacity(o.strength, range, 3);
  EXPECT_NEAR(pressure / capacity, 1, 1e-2);
}

TEST(ContactFacet, RefusesEveryOptionThatIsOutOfRangeAtOnce) {
  ContactFacetOptions bad;
  bad.range = -1;
  bad.exponent = 1;
  bad.strength = kNaN;
  bad.quadrature = 4;
  bad.subdivision = 0;
  const TriangleMesh mesh = two_sheets(1);
  try {
    make_contact_facet("c", mesh.vertices, mesh.triangles, bad);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.defects().size(), 5u);
  }
}

// --- F3: the double integral itself -----------------------------------------------------------------
struct FacetPair {
  const char* name;
  Eigen::Matrix3d second;  // corners of the second facet; the first is (0,0,0), (1,0,0), (0,1,0)
  double range, energy;
};

std::vector<FacetPair> facet_pairs() {
  Eigen::Matrix3d first;
  first << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(0.5, Vec3::UnitX()).toRotationMatrix();
  const auto shifted = [&](const Eigen::Matrix3d& m, const Vec3& by) -> Eigen::Matrix3d {
    return m.colwise() + by;
  };
  return {{"parallel at 0.5", shifted(first, Vec3(0, 0, 0.5)), 10, 0.21761729},
          {"parallel at 0.1", shifted(first, Vec3(0, 0, 0.1)), 10, 0.229026138},
          {"tilted", shifted(tilt * first, Vec3(0.2, 0.1, 0.3)), 10, 0.217895628},
          {"cut off", shifted(first, Vec3(0, 0, 0.1)), 0.6, 0.0460922104}};
}

double facet_energy(const FacetPair& pair, int quadrature, int subdivision) {
  Points X(3, 6);
  X.leftCols(3) << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  X.rightCols(3) = pair.second;
  Triangles triangles(3, 2);
  triangles << 0, 3, 1, 4, 2, 5;
  ContactFacetOptions o;
  o.range = pair.range;
  o.exponent = 2;
  o.strength = 1;
  o.quadrature = quadrature;
  o.subdivision = subdivision;
  const auto term = make_contact_facet("c", X, triangles, o);
  term->prepare(X);
  Sink sink;
  return term->evaluate(X, sink);
}

TEST(ContactFacet, F3IntegratesFacetPairsToSixDigitsWithRefinedQuadrature) {
  for (const FacetPair& pair : facet_pairs())
    EXPECT_NEAR(facet_energy(pair, 6, 32) / pair.energy, 1, 1e-6) << pair.name;
}

TEST(ContactFacet, F3RecordsTheErrorOfTheProductionRule) {
  const double bound[] = {2e-3, 1e-2, 2e-3,
                          0.5};  // three points a facet; the cut-off is shorter than an edge
  int k = 0;
  for (const FacetPair& pair : facet_pairs()) {
    const double error = facet_energy(pair, 3, 1) / pair.energy - 1;
    RecordProperty(std::string("relative error, ") + pair.name, std::to_string(error));
    std::printf("F3 %-16s three points: %+.2e  six points: %+.2e\n", pair.name, error,
                facet_energy(pair, 6, 1) / pair.energy - 1);
    EXPECT_LT(std::abs(error), bound[k++]) << pair.name;
  }
}

}  // namespace
}  // namespace coapt
