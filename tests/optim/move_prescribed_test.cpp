// Where prescribed nodes can go, with a spike in the way of the sheet that they hold.
#include "optim/move_prescribed.hpp"

#include "energy/contact_barrier.hpp"
#include "support/contact_scene.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace coapt {
namespace {

constexpr int kCells = 8;

// A unit square whose rim goes down, 0.1 above the tip of a spike.
struct SheetOverSpike {
  explicit SheetOverSpike(const Vec3& tip)
      : sheet(moved(grid_mesh(kCells, kCells), {0, 0, 0.1})),
        both(joined(sheet, spike(tip, 0.05, 0.2))),
        fixed(FixedMask::Constant(3, both.vertex_count(), false)) {
    fixed.rightCols(both.vertex_count() - sheet.vertex_count()).setConstant(true);
    for (const std::vector<int>& loop : boundary_loops(sheet.triangles))
      for (const int v : loop) rim.push_back(v);
    for (const int v : rim) fixed.col(v).setConstant(true);
    ContactBarrierOptions options;
    options.gap = 0.02;
    options.pressure = 0.1;
    options.obstacles = both.triangles.rightCols(both.triangle_count() - sheet.triangle_count());
    objective.emplace(both.vertices, fixed,
                      terms_of(tension_field_term(both.vertices, sheet.triangles, {}),
                               make_contact_barrier("contact", both.vertices, sheet.triangles, options)));
  }

  // Lowers the rim by `depth`.
  Move lowered(double depth, Vector& q) {
    MotionPath motion;
    motion.positions = [&](double t) {
      Points x = both.vertices;
      for (const int v : rim) x(2, v) -= depth * t;
      return x;
    };
    return move_prescribed(motion, 0, 1, *objective, q);
  }

  TriangleMesh sheet, both;
  FixedMask fixed;
  std::vector<int> rim;
  std::optional<Objective> objective;
};

TEST(MovePrescribed, CarriesFreeNodesAlong) {
  SheetOverSpike scene({0.53, 0.47, 0});
  Vector q = scene.objective->unknowns(scene.both.vertices);
  const Move move = scene.lowered(0.05, q);
  EXPECT_EQ(move.reached, 1);
  const Points x = scene.objective->positions(q);
  for (int v = 0; v < scene.sheet.vertex_count(); ++v) EXPECT_NEAR(x(2, v), 0.05, 1e-8) << v;
}

TEST(MovePrescribed, EndsWhereThePrescribedNodesThemselvesCollide) {
  SheetOverSpike scene({0, 0.47, 0});  // under the rim
  Vector q = scene.objective->unknowns(scene.both.vertices);
  const Move move = scene.lowered(0.15, q);
  EXPECT_GT(move.reached, 0.2);
  EXPECT_LT(move.reached, 0.1 / 0.15);
  EXPECT_FALSE(move.is_overloaded);
}

}  // namespace
}  // namespace coapt
