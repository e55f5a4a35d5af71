#include "valve/fibre_field.hpp"

#include "core/error.hpp"
#include "mesh/shapes.hpp"
#include "valve/fibre_guides.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace coapt {
namespace {

constexpr double kPi = std::numbers::pi;

// A grid of n x m cells over (0, 1)^2, one diagonal each (the other way in every second cell where it
// alternates), bent into space; where `is_closed` the first coordinate is periodic. The triangles are
// oblique where `shear` is not zero.
TriangleMesh bent_grid(int n, int m, bool is_closed, const std::function<Vec3(double, double)>& place,
                       double shear = 0) {
  TriangleMesh mesh;
  const int columns = is_closed ? n : n + 1;
  mesh.vertices.resize(3, columns * (m + 1));
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i < columns; ++i)
      mesh.vertices.col(j * columns + i) = place((i + shear * j) / n, static_cast<double>(j) / m);
  mesh.triangles.resize(3, 2 * n * m);
  int t = 0;
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * columns + i, b = j * columns + (i + 1) % columns, c = b + columns, d = a + columns;
      mesh.triangles.col(t++) = Eigen::Vector3i(a, b, c);
      mesh.triangles.col(t++) = Eigen::Vector3i(a, c, d);
    }
  return mesh;
}

Vec3 centroid(const TriangleMesh& mesh, int t) {
  return (mesh.vertices.col(mesh.triangles(0, t)) + mesh.vertices.col(mesh.triangles(1, t)) +
          mesh.vertices.col(mesh.triangles(2, t))) /
         3;
}

// Angle between two fibres, without sign [rad].
double angle(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), std::abs(a.dot(b))); }

// Largest angle from the exact direction, as far as that lies in the plane of each triangle [rad].
double largest_error(const TriangleMesh& mesh, const FibreField& field,
                     const std::function<Vec3(const Vec3&)>& exact) {
  double worst = 0;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 normal = area_vector(mesh.vertices, mesh.triangles.col(t)).normalized(),
               d = exact(centroid(mesh, t));
    worst = std::max(worst, angle(field.directions.col(t), d - d.dot(normal) * normal));
  }
  return worst;
}

std::vector<FibreGuide> vectors_at_rims(const TriangleMesh& mesh,
                                        const std::function<Vec3(const Vec3&)>& direction) {
  std::vector<FibreGuide> guides;
  for (const auto& loop : boundary_loops(mesh.triangles))
    for (const int v : loop)
      guides.push_back({FibreGuide::Kind::AtVertex, v, v, direction(mesh.vertices.col(v))});
  return guides;
}

Vec3 around_z(const Vec3& x) { return Vec3(-x.y(), x.x(), 0).normalized(); }

void expect_sound(const TriangleMesh& mesh, const FibreField& field) {
  ASSERT_EQ(field.directions.cols(), mesh.triangle_count());
  ASSERT_EQ(field.anisotropy.size(), mesh.triangle_count());
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 normal = area_vector(mesh.vertices, mesh.triangles.col(t)).normalized();
    EXPECT_NEAR(field.directions.col(t).norm(), 1, 1e-12);
    EXPECT_NEAR(field.directions.col(t).dot(normal), 0, 1e-9);
    EXPECT_GE(field.anisotropy[t], 0);
    EXPECT_LE(field.anisotropy[t], 1);
  }
}

// Of a flat sheet with slivers, one direction at one vertex is that of all.
TEST(FibreFieldTest, IsConstantOnAFlatSheetOfSlivers) {
  std::mt19937 random(3);
  TriangleMesh mesh = bent_grid(
      6, 40, false, [](double s, double t) { return Vec3(20 * s, t, 0); }, 0.7);
  for (int v = 0; v < mesh.vertex_count(); ++v)
    mesh.vertices(1, v) += 0.004 * (static_cast<double>(random()) / 2147483648.0 - 1);
  const Eigen::Quaterniond turn = Eigen::Quaterniond(0.3, -0.5, 0.6, 0.2).normalized();
  mesh.vertices = turn.toRotationMatrix() * mesh.vertices;
  const Vec3 d = turn * Vec3(2, 3, 0);
  const FibreField field = fibre_field(mesh, {{FibreGuide::Kind::AtVertex, 100, 100, d}});
  expect_sound(mesh, field);
  EXPECT_LT(largest_error(mesh, field, [&](const Vec3&) { return d; }), 1e-7);
  EXPECT_GT(field.anisotropy.minCoeff(), 1 - 1e-7);
}

// The helix at 35 degrees: a straight line on the flat sheet. Interpolating the entries of M in space would
// bend it, as they have different wave numbers around the axis.
double helix_error(int n) {
  const double radius = 10, height = 30, pitch = 35 * kPi / 180;
  const TriangleMesh mesh = bent_grid(
      3 * n, n, true,
      [&](double s, double t) {
        return Vec3(radius * std::cos(2 * kPi * s), radius * std::sin(2 * kPi * s), height * t);
      },
      0.3);
  const auto helix = [&](const Vec3& x) {
    return Vec3(std::cos(pitch) * around_z(x) + std::sin(pitch) * Vec3(0, 0, 1));
  };
  const FibreField field = fibre_field(mesh, vectors_at_rims(mesh, helix));
  expect_sound(mesh, field);
  EXPECT_GT(field.anisotropy.minCoeff(), 0.999);
  return largest_error(mesh, field, helix);
}

TEST(FibreFieldTest, KeepsAHelixOnACylinder) {
  const double coarse = helix_error(8), fine = helix_error(16), finest = helix_error(32);
  EXPECT_LT(finest, 1e-3);
  EXPECT_GT(std::log2(coarse / fine), 1.8);
  EXPECT_GT(std::log2(fine / finest), 1.8);
}

TEST(FibreFieldTest, RunsAroundACylinderHeldAtOneRim) {
  const TriangleMesh mesh = bent_grid(24, 8, true, [](double s, double t) {
    return Vec3(10 * std::cos(2 * kPi * s), 10 * std::sin(2 * kPi * s), 30 * t);
  });
  std::vector<FibreGuide> guides;
  for (int i = 0; i < 24; ++i) guides.push_back({FibreGuide::Kind::Along, i, (i + 1) % 24, Vec3::Zero()});
  const FibreField field = fibre_field(mesh, guides);
  EXPECT_LT(largest_error(mesh, field, around_z), 1e-9);
  EXPECT_GT(field.anisotropy.minCoeff(), 1 - 1e-9);
}

// A cone cut off between two rims, with half the opening angle a. Rolled out it is a sector with the distance
// r from the tip; a tensor at a fixed angle to the generators has there the doubled angle u(r) exp(2 i psi),
// harmonic for u = a r^2 + b/r^2. With u = 1 at both rims: direction as at the rims, anisotropy u.
struct Cone {
  double slope = 0.6, inner = 5, outer = 20;  // sine of half the opening angle; distances from the tip
  TriangleMesh mesh(int n) const {
    return bent_grid(5 * n, n, true, [this](double s, double t) {
      const double r = inner + (outer - inner) * t, q = 2 * kPi * s;
      return Vec3(r * slope * std::cos(q), r * slope * std::sin(q), r * std::sqrt(1 - slope * slope));
    });
  }
  double u(double r) const {
    const double s = inner * inner, t = outer * outer;
    return (r * r + s * t / (r * r)) / (s + t);
  }
};

struct ConeErrors {
  double direction = 0, anisotropy = 0;
};

ConeErrors cone_errors(int n) {
  const Cone cone;
  const TriangleMesh mesh = cone.mesh(n);
  const double spiral = 0.7;
  const auto exact = [&](const Vec3& x) {
    return Vec3(std::cos(spiral) * around_z(x) + std::sin(spiral) * x.normalized());
  };
  const FibreField field = fibre_field(mesh, vectors_at_rims(mesh, exact));
  expect_sound(mesh, field);
  ConeErrors errors{largest_error(mesh, field, exact), 0};
  for (int t = 0; t < mesh.triangle_count(); ++t)
    errors.anisotropy =
        std::max(errors.anisotropy, std::abs(field.anisotropy[t] - cone.u(centroid(mesh, t).norm())));
  return errors;
}

TEST(FibreFieldTest, FollowsTheRolledOutConeWithTheMesh) {
  const ConeErrors coarse = cone_errors(8), fine = cone_errors(16), finest = cone_errors(32);
  EXPECT_LT(finest.direction, 5e-3);
  EXPECT_LT(finest.anisotropy, 5e-3);
  EXPECT_GT(std::log2(coarse.direction / fine.direction), 1.5);
  EXPECT_GT(std::log2(fine.direction / finest.direction), 1.7);
  EXPECT_GT(std::log2(fine.anisotropy / finest.anisotropy), 1.7);
}

// Along the inner rim, across the outer one: u falls from 1 to -1 and passes zero once, where the fibre turns
// from circumferential to radial at once and is no fibre at all.
TEST(FibreFieldTest, TurnsWhereTheAnisotropyVanishes) {
  const Cone cone;
  const TriangleMesh mesh = cone.mesh(24);
  std::vector<FibreGuide> guides;
  for (FibreGuide guide : boundary_guides(mesh)) {
    const bool is_inner = mesh.vertices.col(guide.a).norm() < 10;
    guide.kind = is_inner ? FibreGuide::Kind::Along : FibreGuide::Kind::Across;
    guides.push_back(guide);
  }
  const FibreField field = fibre_field(mesh, guides);
  const double s = cone.inner * cone.inner, t = cone.outer * cone.outer;
  const auto u = [&](double r) { return (s * (t + s) / (r * r) - r * r * (t + s) / t) / (t - s * s / t); };
  ASSERT_NEAR(u(cone.inner), 1, 1e-12);
  ASSERT_NEAR(u(cone.outer), -1, 1e-12);
  int around = 0, radial = 0;
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    const Vec3 x = centroid(mesh, f);
    const double exact = u(x.norm());
    EXPECT_NEAR(field.anisotropy[f], std::abs(exact), 0.02);
    if (std::abs(exact) < 0.1) continue;
    (exact > 0 ? around : radial)++;
    EXPECT_LT(angle(field.directions.col(f), exact > 0 ? around_z(x) : x.normalized()), 0.03);
  }
  EXPECT_GT(around, 100);
  EXPECT_GT(radial, 100);
}

// Turned triangles, other numbers, another place: the same fibres.
TEST(FibreFieldTest, DoesNotDependOnOrientationNumberingOrFrame) {
  const Cone cone;
  const TriangleMesh mesh = cone.mesh(6);
  const std::vector<FibreGuide> guides =
      vectors_at_rims(mesh, [](const Vec3& x) { return Vec3(around_z(x) + Vec3(0, 0, 0.4)); });
  const FibreField field = fibre_field(mesh, guides);
  const Eigen::Matrix3d turn = Eigen::Quaterniond(0.9, 0.1, -0.7, 0.4).normalized().toRotationMatrix();
  TriangleMesh other = mesh;
  const int last = mesh.vertex_count() - 1, count = mesh.triangle_count();
  for (int v = 0; v <= last; ++v)
    other.vertices.col(last - v) = turn * mesh.vertices.col(v) + Vec3(100, -7, 3);
  for (int t = 0; t < count; ++t) {
    Eigen::Vector3i corners = last - mesh.triangles.col(t).array();
    if (t % 3 == 0) std::swap(corners[0], corners[1]);
    other.triangles.col(count - 1 - t) = corners;
  }
  std::vector<FibreGuide> moved;
  for (const FibreGuide& g : guides)
    moved.push_back({g.kind, last - g.a, last - g.b, -2 * (turn * g.direction)});
  const FibreField same = fibre_field(other, moved);
  for (int t = 0; t < count; ++t) {
    EXPECT_LT(angle(turn * field.directions.col(t), same.directions.col(count - 1 - t)), 1e-7);
    EXPECT_NEAR(field.anisotropy[t], same.anisotropy[count - 1 - t], 1e-9);
  }
}

TEST(FibreFieldTest, SolvesAMoebiusStrip) {
  TriangleMesh mesh = bent_grid(40, 4, true, [](double s, double t) {
    const double q = 2 * kPi * s, w = 3 * (t - 0.5);
    return Vec3((10 + w * std::cos(q / 2)) * std::cos(q), (10 + w * std::cos(q / 2)) * std::sin(q),
                w * std::sin(q / 2));
  });
  for (int k = 0; k < mesh.triangle_count(); ++k)  // the last column of cells joins the first upside down
    for (int c = 0; c < 3; ++c) {
      const int v = mesh.triangles(c, k);
      if ((k / 2) % 40 == 39 && v % 40 == 0) mesh.triangles(c, k) = (4 - v / 40) * 40;
    }
  const FibreField field = fibre_field(mesh, boundary_guides(mesh));
  expect_sound(mesh, field);
  EXPECT_GT(field.anisotropy.minCoeff(), 0.9);
  for (int t = 0; t < mesh.triangle_count(); ++t)
    EXPECT_LT(angle(field.directions.col(t), around_z(centroid(mesh, t))), 0.35);
}

TriangleMesh two_leaflets() {
  TriangleMesh mesh = bent_grid(8, 4, false, [](double s, double t) { return Vec3(2 * s, t, 0); });
  mesh.region_names = {"left", "right"};
  for (int t = 0; t < mesh.triangle_count(); ++t) mesh.regions.push_back(centroid(mesh, t).x() < 1 ? 0 : 1);
  return mesh;
}

TEST(FibreFieldTest, KeepsRegionsApartUnlessTheyAreJoined) {
  const TriangleMesh mesh = two_leaflets();
  const std::vector<FibreGuide> guides{{FibreGuide::Kind::AtVertex, 0, 0, Vec3(1, 0, 0)},
                                       {FibreGuide::Kind::AtVertex, 8, 8, Vec3(0, 1, 0)}};
  const FibreField apart = fibre_field(mesh, guides),
                   joined = fibre_field(mesh, guides, {.joins_regions = true});
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 d = mesh.regions[static_cast<size_t>(t)] == 0 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    EXPECT_LT(angle(apart.directions.col(t), d), 1e-9);
  }
  EXPECT_GT(apart.anisotropy.minCoeff(), 1 - 1e-9);
  EXPECT_LT(joined.anisotropy.minCoeff(), 0.2);
}

TEST(FibreFieldTest, NamesEveryDefect) {
  const TriangleMesh mesh = two_leaflets();
  const auto defects = [](const auto& call) -> std::vector<std::string> {
    try {
      call();
    } catch (const InputError& error) {
      return error.defects();
    }
    return {};
  };
  const auto of = [&](const std::vector<FibreGuide>& guides) {
    return defects([&] { fibre_field(mesh, guides); });
  };
  using Kind = FibreGuide::Kind;
  const auto several = of({{Kind::AtVertex, 3, 3, Vec3(0, 0, 1)},
                           {Kind::AtVertex, 4, 4, Vec3::Zero()},
                           {Kind::AtVertex, 999, 999, Vec3(1, 0, 0)},
                           {Kind::Along, 0, 44, Vec3::Zero()}});
  ASSERT_EQ(several.size(), 4u);
  EXPECT_EQ(std::count_if(
                several.begin(), several.end(),
                [](const std::string& defect) { return defect.starts_with("fibre direction at vertex 4:"); }),
            1);
  const auto from_one = defects([&] {
    fibre_field(mesh, {{Kind::AtVertex, 4, 4, Vec3::Zero()}, {Kind::Along, 0, 44, Vec3::Zero()}},
                {.numbering = {1}});
  });
  ASSERT_EQ(from_one.size(), 2u);
  EXPECT_EQ(from_one[0].find("fibre direction between vertices 1 and 45, counted from 1:"), 0u)
      << from_one[0];
  EXPECT_EQ(from_one[1].find("fibre direction at vertex 5, counted from 1:"), 0u) << from_one[1];
  const auto unreached = of({{Kind::AtVertex, 0, 0, Vec3(1, 0, 0)}});
  ASSERT_EQ(unreached.size(), 1u);
  EXPECT_NE(unreached[0].find("region \"right\""), std::string::npos);
  TriangleMesh flat = mesh;
  flat.vertices.col(10) = 0.5 * (flat.vertices.col(0) + flat.vertices.col(9));
  flat.vertices.col(0) = flat.vertices.col(10);
  EXPECT_FALSE(defects([&] { fibre_field(flat, boundary_guides(flat)); }).empty());
  EXPECT_EQ(of({{Kind::AtVertex, 3, 3, Vec3(0, 0, 1)}, {Kind::AtVertex, 3, 3, Vec3(1, 0, 0)}}).size(), 1u)
      << "a later vector at the same vertex counts, so that only the right leaflet lacks one";
}

TEST(FibreFieldTest, TakesDirectionsOfTriangles) {
  const TriangleMesh mesh = two_leaflets();
  Points directions = Points::Zero(3, mesh.triangle_count());
  directions.row(0).setConstant(3);
  directions.row(2).setConstant(4);
  const FibreField field = in_surface(directions, mesh, "fibres.csv");
  EXPECT_LT(largest_error(mesh, field, [](const Vec3&) { return Vec3(1, 0, 0); }), 1e-12);
  EXPECT_EQ(field.anisotropy.minCoeff(), 1);
  directions.col(5) = Vec3(0, 0, 2);
  directions.col(7).setZero();
  try {
    in_surface(directions, mesh, "fibres.csv");
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.defects().size(), 2u);
    EXPECT_NE(error.defects()[0].find("fibres.csv: the direction of triangle 5 is normal"),
              std::string::npos);
  }
  EXPECT_THROW(in_surface(Points(3, 2), mesh, "fibres.csv"), InputError);
}

// x = A X + c: a fibre becomes A d.
TEST(FibreFieldTest, IsCarriedByTheDeformation) {
  const TriangleMesh mesh = two_leaflets();
  const FibreField field = fibre_field(mesh, boundary_guides(mesh));
  Eigen::Matrix3d A;
  A << 1.2, 0.4, 0, -0.1, 0.8, 0.3, 0.5, 0.2, 1;
  const Points x = (A * mesh.vertices).colwise() + Vec3(1, 2, 3);
  const Points now = carried(field.directions, mesh.triangles, mesh.vertices, x);
  for (int t = 0; t < mesh.triangle_count(); ++t)
    EXPECT_LT((now.col(t) - (A * field.directions.col(t)).normalized()).norm(), 1e-12);
}

TEST(FibreGuidesTest, AreRadialAtTheTrigonesAndFollowTheRimsElsewhere) {
  const int n = 100;
  const TriangleMesh mesh = bent_grid(n, 10, true, [](double s, double t) {
    return Vec3((10 - 4 * t) * std::cos(2 * kPi * s), (10 - 4 * t) * std::sin(2 * kPi * s), -10 * t);
  });
  std::vector<int> annulus;
  for (int i = 0; i < n; ++i) annulus.push_back(i);
  const int inside = 5 * n + 25;
  const std::vector<FibrePull> pulls{{inside, Vec3(0, 0, -8), 1}, {10 * n + 3, Vec3(0, 0, -8), 1}};
  const std::vector<FibreGuide> guides = valve_guides(mesh, annulus, {0, 50}, pulls);
  int across = 0, along = 0, vectors = 0, free_edge = 0;
  for (const FibreGuide& guide : guides) {
    if (guide.kind == FibreGuide::Kind::AtVertex) {
      ++vectors;
      EXPECT_EQ(guide.a, inside);
    } else if (guide.a >= 10 * n) {
      ++free_edge;
    } else {
      ++(guide.kind == FibreGuide::Kind::Across ? across : along);
    }
  }
  EXPECT_EQ(across, 12);  // 3 % of 100 equal edges, on both sides of two trigones
  EXPECT_EQ(along, 100 - 32);
  EXPECT_EQ(free_edge, n);
  EXPECT_EQ(vectors, 1);
  const FibreField field = fibre_field(mesh, guides);
  const auto of_cell = [&](int i, int j) { return Vec3(field.directions.col(2 * (j * n + i))); };
  EXPECT_LT(angle(of_cell(25, 0), around_z(centroid(mesh, 50))), 0.05);
  EXPECT_LT(angle(of_cell(25, 9), around_z(centroid(mesh, 2 * (9 * n + 25)))), 0.05);
  EXPECT_GT(angle(of_cell(0, 0), around_z(centroid(mesh, 0))), 1.2);
  EXPECT_THROW(valve_guides(mesh, annulus, {7 * n}, {}), InputError);
}

}  // namespace
}  // namespace coapt
