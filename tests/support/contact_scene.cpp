#include "support/contact_scene.hpp"

#include "energy/contact_barrier.hpp"
#include "energy/load_dead.hpp"
#include "mesh/distance/intersections.hpp"

#include <algorithm>

namespace coapt {

long judged_intersections(const Points& x, const Triangles& facets, Eigen::Index membrane_count) {
  const auto pairs = intersecting_pairs(x, facets);
  return std::count_if(pairs.begin(), pairs.end(),
                       [&](const std::array<int, 2>& pair) { return pair[0] < membrane_count; });
}

Judged solve_judged(const Points& start, const FixedMask& fixed, Terms terms, const Triangles& facets,
                    Eigen::Index membrane_count, Method method) {
  Judged judged;
  method.watch = [&](const Points& x) {
    ++judged.iterates;
    judged.intersections = std::max(judged.intersections, judged_intersections(x, facets, membrane_count));
  };
  judged.found = find_equilibrium(start, fixed, std::move(terms), method);
  return judged;
}

Triangles ContactScene::facets() const { return joined(sheet, obstacle).triangles; }
Points ContactScene::start() const { return joined(sheet, obstacle).vertices; }

Judged ContactScene::solve(const std::string& solver, double tolerance) const {
  const Points X = start();
  const int n = sheet.vertex_count();
  FixedMask fixed = FixedMask::Constant(3, X.cols(), false);
  fixed.rightCols(obstacle.vertex_count()).setConstant(true);
  for (const int node : held) fixed.col(node).setConstant(true);

  Vector areas = Vector::Zero(X.cols());
  areas.head(n) = nodal_areas(sheet.vertices, sheet.triangles);
  Terms terms =
      terms_of(tension_field_term(X, sheet.triangles, {}), bending_term(X, sheet.triangles, bending));
  if (gap > 0) {
    ContactBarrierOptions options;
    options.gap = gap;
    options.pressure = traction.norm() > 0 ? 5 * traction.norm() : 1e-2;
    options.obstacles = facets().rightCols(obstacle.triangle_count());
    terms.push_back(make_contact_barrier("contact", X, sheet.triangles, options));
  }
  if (traction.norm() > 0)
    terms.push_back(std::make_unique<LoadDead>("load", "load_field", area_forces(areas, traction), X));

  Method method;
  method.solver = solver;
  method.tolerance = tolerance;
  method.max_iterations = 3000;
  if (motion) {
    method.motion.steps = motion_steps;
    method.motion.positions = [this, X](double t) { return motion(t, X); };
  }
  return solve_judged(X, fixed, std::move(terms), facets(), sheet.triangle_count(), method);
}

TriangleMesh spike(const Vec3& apex, double height, double half_width) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 5);
  mesh.vertices << apex, apex + Vec3(-half_width, -half_width, -height),
      apex + Vec3(half_width, -half_width, -height), apex + Vec3(half_width, half_width, -height),
      apex + Vec3(-half_width, half_width, -height);
  mesh.triangles.resize(3, 4);
  mesh.triangles << 0, 0, 0, 0, 1, 2, 3, 4, 2, 3, 4, 1;
  return mesh;
}

std::vector<int> rim_of(const TriangleMesh& mesh) {
  std::vector<int> rim;
  for (const auto& loop : boundary_loops(mesh.triangles)) rim.insert(rim.end(), loop.begin(), loop.end());
  return rim;
}

}  // namespace coapt
