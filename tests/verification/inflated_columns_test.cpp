// Rows B2, B2f and B4 of the verification table again, for what they say beyond the height: stretch at the
// centre, volume, a law linear in the stretches, Fichter's theory of moderate rotations; radius, tension and
// angle of the inflated strip. By newton with relaxed membranes.
#include "energy/load_pressure.hpp"
#include "support/sanitized.hpp"
#include "support/sheets.hpp"
#include "support/tissue_laws.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace coapt {
namespace {

// --- B2: clamped disc, Eh = a = 1, nu = 0.3, follower pressure q ------------------------------------------

struct Bubble {
  double height, volume, centre_stretch;
};

// The law of row B2 that is linear in the stretches (Biot): a bilinear one that never gets to its knee.
enum class ColumnLaw { StVK, Biot };

Bubble inflated_disc(ColumnLaw law, int n, double q) {
  const TriangleMesh mesh = smooth_disc_mesh(n);
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  Points start = mesh.vertices;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double r2 = mesh.vertices.col(v).squaredNorm();
    if (r2 > 1 - 1e-9)
      fixed.col(v).setConstant(true);
    else
      start(2, v) = 0.5 * std::cbrt(q) * (1 - r2);
  }
  std::unique_ptr<EnergyTerm> sheet =
      law == ColumnLaw::StVK
          ? tension_field_term(mesh.vertices, mesh.triangles, {1, 0.3, 0})
          : tissue_term(mesh, BilinearLaw{1, 0.3, {0, 10, 0}}, 1, Points::Zero(3, mesh.triangle_count()));
  const Equilibrium found = find_equilibrium(
      start, fixed,
      terms_of(std::move(sheet), make_follower_pressure("p", mesh.vertices, mesh.triangles, q, fixed)),
      {.tolerance = 1e-9});
  EXPECT_EQ(found.result.status, Status::Converged) << found.result.message;
  const int centre = grid_node(n, n / 2, n / 2);
  Bubble bubble{found.x(2, centre), 0, 0};
  double area = 0, rest = 0;  // of the triangles at the centre
  for (const auto& t : mesh.triangles.colwise()) {
    bubble.volume += found.x.col(t[0]).dot(found.x.col(t[1]).cross(found.x.col(t[2]))) / 6;
    if ((t.array() != centre).all()) continue;
    area += area_vector(found.x, t).norm();
    rest += area_vector(mesh.vertices, t).norm();
  }
  bubble.centre_stretch = std::sqrt(area / rest);
  return bubble;
}

// From meshes of n, 2n and 4n cells, free of h^2 and h^4.
double extrapolated(double coarse, double middle, double fine) {
  const double a = middle + (middle - coarse) / 3, b = fine + (fine - middle) / 3;
  return b + (b - a) / 15;
}

Bubble extrapolated(const Bubble& coarse, const Bubble& middle, const Bubble& fine) {
  return {extrapolated(coarse.height, middle.height, fine.height),
          extrapolated(coarse.volume, middle.volume, fine.volume),
          extrapolated(coarse.centre_stretch, middle.centre_stretch, fine.centre_stretch)};
}

struct BubbleCase {
  double q;
  Bubble exact;  // rows B2_0.001, B2_0.01 and B2_0.1
  double biot_height;
};

class InflatedDisc : public testing::TestWithParam<BubbleCase> {};

TEST_P(InflatedDisc, B2HasTheVolumeAndTheStretchOfTheExactSolution) {
  const auto& [q, exact, biot_height] = GetParam();
  const Bubble coarse = inflated_disc(ColumnLaw::StVK, 8, q), middle = inflated_disc(ColumnLaw::StVK, 16, q);
  EXPECT_GT(observed_order(coarse.volume - exact.volume, middle.volume - exact.volume), 1.9);
  EXPECT_GT(observed_order(coarse.centre_stretch - exact.centre_stretch,
                           middle.centre_stretch - exact.centre_stretch),
            1.9);
  if (is_sanitized()) return;
  const Bubble usual = inflated_disc(ColumnLaw::StVK, 22, q), fine = inflated_disc(ColumnLaw::StVK, 32, q),
               answer = extrapolated(coarse, middle, fine);
  std::printf("B2 q=%.0e: errors of volume %.2e, of stretch %.2e; extrapolated %.2e, %.2e\n", q,
              usual.volume / exact.volume - 1, usual.centre_stretch / exact.centre_stretch - 1,
              answer.volume / exact.volume - 1, answer.centre_stretch / exact.centre_stretch - 1);
  // The polygon inscribed in the rim is part of what is missing: 3e-3, where the row has 2e-3 for the height.
  EXPECT_NEAR(usual.volume / exact.volume, 1, 3e-3);
  EXPECT_NEAR(usual.centre_stretch / exact.centre_stretch, 1, 2e-3);
  EXPECT_NEAR(answer.volume / exact.volume, 1, 1e-5);
  EXPECT_NEAR(answer.centre_stretch / exact.centre_stretch, 1, 1e-5);
}

TEST_P(InflatedDisc, B2OfALawLinearInTheStretchesMatchesTheTableToo) {
  const auto& [q, exact, biot_height] = GetParam();
  const Bubble coarse = inflated_disc(ColumnLaw::Biot, 8, q), middle = inflated_disc(ColumnLaw::Biot, 16, q);
  EXPECT_GT(observed_order(coarse.height - biot_height, middle.height - biot_height), 1.9);
  if (is_sanitized()) return;
  const double usual = inflated_disc(ColumnLaw::Biot, 22, q).height,
               answer =
                   extrapolated(coarse.height, middle.height, inflated_disc(ColumnLaw::Biot, 32, q).height);
  std::printf("B2 q=%.0e, linear in the stretches: error of height %.2e, extrapolated %.2e\n", q,
              usual / biot_height - 1, answer / biot_height - 1);
  EXPECT_NEAR(usual / biot_height, 1, 2e-3);
  EXPECT_NEAR(answer / biot_height, 1, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(
    Loads, InflatedDisc,
    testing::Values(BubbleCase{1e-3, {0.0654043749, 0.107326061, 1.00302559}, 0.0655041037},
                    BubbleCase{1e-2, {0.14138457, 0.233564857, 1.01417597}, 0.142404296},
                    BubbleCase{1e-1, {0.309515382, 0.527859169, 1.06857583}, 0.320922998}),
    [](const auto& instance) { return "Q" + std::to_string(std::lround(-std::log10(instance.param.q))); });

// Fichter's equations are those of moderate rotations: 0.1 to 0.7 % from the exact geometry, says the row.
// The stress at the centre is compared per length at rest: l (l^2 - 1) / (2 (1 - nu)).
TEST(FichtersDisc, B2fIsFichtersToWithinTheErrorOfHisTheory) {
  struct Fichter {
    double q, height, stress;
  };
  for (const Fichter& row :
       {Fichter{1e-3, 0.0653083475, 0.00433748345}, Fichter{1e-2, 0.140421553, 0.0205806046}}) {
    const Bubble found =
        extrapolated(inflated_disc(ColumnLaw::StVK, 4, row.q), inflated_disc(ColumnLaw::StVK, 8, row.q),
                     inflated_disc(ColumnLaw::StVK, 16, row.q));
    const double l = found.centre_stretch, stress = l * (l * l - 1) / (2 * 0.7);
    std::printf("B2f q=%.0e: height %.2e, stress %.2e from Fichter's\n", row.q, found.height / row.height - 1,
                stress / row.stress - 1);
    EXPECT_NEAR(found.height / row.height, 1, 7e-3);
    EXPECT_NEAR(stress / row.stress, 1, 7e-3);
    EXPECT_GT(found.height, row.height);  // exact rotations leave the pressure more to lift
  }
}

// --- B4: long strip as a cylinder, edges at distance 1, Eh = 1, nu = 0.3
// ------------------------------------

struct Cylinder {
  double radius, tension, half_angle;
};

struct StripCase {
  double rest_width, p;
  Cylinder exact;  // rows B4_1.0_0.001, B4_1.0_0.01 and B4_1.2_0.01
};

double circumradius(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b - a).norm() * (c - b).norm() * (a - c).norm() / (2 * (b - a).cross(c - a).norm());
}

// Tension and angle are those of the support's force on the edge; half a facet's pressure is part of it,
// which turns it from the facet's direction into that of the arc.
Cylinder inflated_strip(const StripCase& strip, int n) {
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
      start(2, grid_node(n, i, j)) = strip.exact.half_angle * s * (1 - s);
      if (i == 0 || i == n) fixed.col(grid_node(n, i, j)).setConstant(true);
    }
  Objective objective(start, fixed,
                      terms_of(tension_field_term(mesh.vertices, mesh.triangles, {1, 0.3, 0}),
                               make_follower_pressure("p", start, mesh.triangles, strip.p, fixed)));
  const Result result = solve(*built_in_solvers().at("newton")({}),
                              {objective, objective.unknowns(start), {}, {}}, {.tolerance = 1e-9});
  EXPECT_EQ(result.status, Status::Converged) << result.message;
  const Points x = objective.positions(result.q), reactions = objective.reactions(result.q);
  Cylinder found{0, 0, 0};
  Vec3 pull = Vec3::Zero();
  for (int j = 0; j <= rows; ++j) {
    found.radius += circumradius(x.col(grid_node(n, n / 4, j)), x.col(grid_node(n, n / 2, j)),
                                 x.col(grid_node(n, 3 * n / 4, j))) /
                    (rows + 1);
    pull += reactions.col(grid_node(n, 0, j));
  }
  found.tension = std::hypot(pull[0], pull[2]) / height;
  found.half_angle = std::atan2(-pull[2], -pull[0]);
  return found;
}

TEST(InflatedStrip, B4HasTheRadiusTheTensionAndTheAngleOfTheClosedForm) {
  for (const StripCase& strip : {StripCase{1.0, 1e-3, {3.59383629, 0.00359383629, 0.139579882}},
                                 StripCase{1.0, 1e-2, {1.69574395, 0.0169574395, 0.299304644}},
                                 StripCase{1.2, 1e-2, {0.579512836, 0.00579512836, 1.0407698}}}) {
    const Cylinder coarse = inflated_strip(strip, 16), middle = inflated_strip(strip, 32),
                   fine = inflated_strip(strip, 64);
    for (const auto& [name, figure] :
         {std::pair{"radius", &Cylinder::radius}, std::pair{"tension", &Cylinder::tension},
          std::pair{"half angle", &Cylinder::half_angle}}) {
      const double exact = strip.exact.*figure;
      std::printf("B4 %.1f %.0e, %s: errors %.2e %.2e %.2e\n", strip.rest_width, strip.p, name,
                  coarse.*figure / exact - 1, middle.*figure / exact - 1, fine.*figure / exact - 1);
      EXPECT_NEAR(fine.*figure / exact, 1, 1e-3) << name;
      EXPECT_GT(observed_order(middle.*figure - exact, fine.*figure - exact), 1.9) << name;
    }
  }
}

}  // namespace
}  // namespace coapt
