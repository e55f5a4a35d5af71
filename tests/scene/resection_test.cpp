#include "mesh/mesh_check.hpp"
#include "support/repaired_valve.hpp"

#include <algorithm>
#include <set>

namespace coapt {
namespace {

constexpr const char* kWedge =
    R"({"type": "resection", "leaflet": "posterior", "at": 0.5, "width": "9 mm", "depth": "7 mm", "stiffness": "50 N/mm"})";

TEST_F(RepairedValve, ResectionTakesTheAreaOfTheWedge) {
  const SceneGeometry before = geometry(scene()), after = geometry(scene(kWedge));
  const TriangleMesh& mesh = after.model.mesh;
  const double removed = surface_area(before.model.mesh.vertices, before.model.mesh.triangles) -
                         surface_area(mesh.vertices, mesh.triangles);
  EXPECT_NEAR(removed, 0.5 * 9 * 7, 8);  // a flat triangle; the leaflet is curved and the mesh coarse
  EXPECT_FALSE(has_error(check_mesh(mesh)));
  for (const MeshDefect& defect : check_mesh(mesh))
    EXPECT_EQ(defect.kind, MeshDefectKind::IsolatedVertex) << defect.message;
  // The free edge is one loop of vertices that are still there.
  const std::vector<int>& edge = after.model.sets.at("free_edge");
  std::set<int> used;
  for (const int v : mesh.triangles.reshaped()) used.insert(v);
  for (const int v : edge) EXPECT_TRUE(used.contains(v)) << v;
  for (const Chord& chord : network(after).chords)
    for (const ChordEnd& end : {chord.from, chord.to})
      EXPECT_TRUE(end.kind != ChordEnd::Kind::Leaflet || used.contains(end.index));
}

TEST_F(RepairedValve, TheSidesOfAResectionMeet) {
  const SceneGeometry laid = geometry(scene(kWedge));
  const auto& pairs = laid.links.at("resection");
  ASSERT_GE(pairs.size(), 2u);
  const RunReport found = solved(scene(kWedge));
  EXPECT_EQ(found.report.result.status, Status::Converged) << found.report.result.message;
  double widest = 0, left = 0;
  for (const auto& [a, b] : pairs) {
    widest = std::max(widest, (laid.model.X.col(a) - laid.model.X.col(b)).norm());
    left = std::max(left, (found.report.fields.x.col(a) - found.report.fields.x.col(b)).norm());
  }
  EXPECT_GT(widest, 6);
  EXPECT_LT(left, 0.1);
}

}  // namespace
}  // namespace coapt
