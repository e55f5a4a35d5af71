// What keeps xpbd from passing through anything, and the forces of the heart.
#include "mesh/triangle_mesh.hpp"
#include "support/contact_scene.hpp"
#include "support/meshes.hpp"
#include "support/xpbd_bodies.hpp"
#include "xpbd/heart_forces.hpp"
#include "xpbd/separating_planes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace coapt {
namespace {

// A sheet close above a smaller plate.
struct SheetOnPlate {
  TriangleMesh plate = moved(grid_mesh(2, 2, 2, 2), Vec3(2, 2, 0)),
               mesh = joined(plate, moved(grid_mesh(6, 6, 6, 6), Vec3(0.13, 0.07, 0.02)));
  XpbdBody body;
  int first = plate.vertex_count();  // node of the sheet

  SheetOnPlate() {
    body.rest = mesh.vertices;
    body.rest.rightCols(mesh.vertex_count() - first).row(2).array() += 5;  // apart at rest
    body.triangles = mesh.triangles;
  }

  bool is_over_plate(int node, double margin) const {
    const Vec3 x = mesh.vertices.col(node);
    return x[0] > 2 - margin && x[0] < 4 + margin && x[1] > 2 - margin && x[1] < 4 + margin;
  }
};

TEST(SeparatingPlanes, HoldNodesWhereTheyWouldPassAndNowhereElse) {
  const SheetOnPlate scene;
  const Points& x = scene.mesh.vertices;
  Points d = Points::Zero(3, x.cols());
  d.rightCols(x.cols() - scene.first).colwise() = Vec3(0.03, 0, -0.1);
  const Points wanted = d;
  SeparatingPlanes planes(scene.body, 0.05);
  ASSERT_GT(planes.longest_move(), 0.11);
  const int changed = planes.admit(x, Points::Ones(3, x.cols()), d);
  EXPECT_GT(changed, 0);
  int free = 0;
  for (int node = scene.first; node < x.cols(); ++node) {
    if (scene.is_over_plate(node, 0)) {
      EXPECT_GE(x(2, node) + d(2, node), 0.005 - 1e-12);  // a tenth of the thickness
      EXPECT_LT(x(2, node) + d(2, node), 0.006);          // and no more
      EXPECT_NEAR(d(0, node), 0.03, 1e-9);                // along the plate it slides
    } else if (!scene.is_over_plate(node, 1.5)) {
      EXPECT_EQ(d.col(node), wanted.col(node));
      ++free;
    }
  }
  EXPECT_GT(free, 10);
}

TEST(SeparatingPlanes, ShortenWhatIsPrescribedAndDoNotBendIt) {
  const SheetOnPlate scene;
  const Points& x = scene.mesh.vertices;
  Points d = Points::Zero(3, x.cols());
  d.rightCols(x.cols() - scene.first).colwise() = Vec3(0.03, 0, -0.1);
  SeparatingPlanes planes(scene.body, 0.05);
  planes.admit(x, Points::Zero(3, x.cols()), d);
  for (int node = scene.first; node < x.cols(); ++node) {
    EXPECT_NEAR(d(0, node), -0.3 * d(2, node), 1e-15);
    if (scene.is_over_plate(node, 0)) {
      EXPECT_GT(d(2, node), -0.016);
    }
  }
}

// Crumpled by forces without sense, two sheets never meet themselves or each other.
TEST(SeparatingPlanes, LetNothingThroughWhateverTheMoves) {
  const TriangleMesh mesh = joined(grid_mesh(6, 6, 6, 6), moved(grid_mesh(6, 6, 6, 6), Vec3(0.3, 0.2, 0.4)));
  XpbdBody body;
  body.rest = mesh.vertices;
  body.triangles = mesh.triangles;
  SeparatingPlanes planes(body, 0.3);
  Points x = mesh.vertices;
  const Points w = Points::Ones(3, x.cols());
  const Vec3 middle = x.rowwise().mean();
  int changed = 0;
  for (unsigned step = 0; step < 150; ++step) {
    Points d = 0.3 * random_points(x.cols(), step);
    d -= 0.05 * (x.colwise() - middle);  // towards the middle
    changed += planes.admit(x, w, d);
    x += d;
    ASSERT_EQ(judged_intersections(x, mesh.triangles, mesh.triangle_count()), 0) << "in step " << step;
  }
  EXPECT_GT(changed, 2000);
  EXPECT_LT((x.colwise() - middle).colwise().norm().mean(), 3);  // of 4 at the start
}

// --- Forces of the heart ----------------------------------------------------------------------------------

// An open cone below its annulus, radius 10 at z = 0 and 6 at z = -10.
struct Cone {
  static constexpr int kAround = 90;
  XpbdBody body;

  explicit Cone(bool is_turned) {
    body.rest.resize(3, 3 * kAround);
    body.triangles.resize(3, 4 * kAround);
    int t = 0;
    for (int ring = 0; ring < 3; ++ring)
      for (int k = 0; k < kAround; ++k) {
        const double angle = 2 * M_PI * k / kAround, r = 10 - 2 * ring;
        body.rest.col(ring * kAround + k) = Vec3(r * std::cos(angle), r * std::sin(angle), -5 * ring);
        if (ring == 0) body.annulus.push_back(k);
        if (ring == 2) continue;
        const int a = ring * kAround + k, b = ring * kAround + (k + 1) % kAround, c = a + kAround,
                  e = b + kAround;
        body.triangles.col(t++) << a, b, c;
        body.triangles.col(t++) << b, e, c;
      }
    if (is_turned) {
      body.triangles.row(0).swap(body.triangles.row(1));
      std::reverse(body.annulus.begin(), body.annulus.end());
    }
  }
};

// Walczak et al. 2019, eq. 16-19: f0 = w, f1 = (w . n) n, f2 = p n, and no other. At the node (8, 0, -5),
// whatever the sense of the triangles and of the annulus.
TEST(HeartForces, HaveDirectionSizeAndSignByThePhase) {
  const XpbdPaper paper;
  ASSERT_EQ(paper.flow, 50);
  ASSERT_EQ(paper.pressure, 100);
  const Vec3 inward = Vec3(-1, 0, 0.4) / std::sqrt(1.16), flow(0, 0, 50),  // to the atrium
      against_surface = flow.dot(inward) * inward, pressure = 100 * inward, to_axis(-30, 0, 0);
  for (const bool is_turned : {false, true}) {
    const Cone cone(is_turned);
    const int node = Cone::kAround;
    const auto force = [&](double w, double p, double radial, HeartPhase phase) {
      const XpbdPaper weights{.flow = w, .pressure = p, .radial = radial};
      return Vec3(heart_forces(cone.body, cone.body.rest, weights, phase).col(node));
    };
    for (const auto& [phase, sign] : {std::pair{HeartPhase::Systole, 1}, {HeartPhase::Diastole, -1}}) {
      EXPECT_LT((force(paper.flow, 0, 0, phase) - sign * (flow + against_surface)).norm(), 0.5);
      EXPECT_LT((force(0, paper.pressure, 0, phase) - sign * pressure).norm(), 1);
      EXPECT_LT((force(0, 0, 30, phase) - sign * to_axis).norm(), 1e-9);
      EXPECT_LT((heart_forces(cone.body, cone.body.rest, paper, phase).col(node) -
                 sign * (flow + against_surface + pressure))
                    .norm(),
                1);
    }
  }
}

}  // namespace
}  // namespace coapt
