#include "mesh/remesh/uniform_refinement.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace coapt {

Triangles refined_uniformly(const Triangles& triangles, const std::function<int(int, int)>& add_middle) {
  std::map<std::pair<int, int>, int> middle;
  const auto middle_of = [&](int a, int b) {
    const auto [where, is_new] = middle.try_emplace(std::minmax(a, b));
    if (is_new) where->second = add_middle(a, b);
    return where->second;
  };
  Triangles fine(3, 4 * triangles.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Eigen::Vector3i c = triangles.col(t);
    const int ab = middle_of(c[0], c[1]), bc = middle_of(c[1], c[2]), ca = middle_of(c[2], c[0]);
    fine.middleCols<4>(4 * t) << c[0], c[1], c[2], ab, ab, bc, ca, bc, ca, ab, bc, ca;
  }
  return fine;
}

FinerMesh refined_uniformly(const TriangleMesh& mesh) {
  FinerMesh finer;
  finer.mesh.triangles = refined_uniformly(mesh.triangles, [&](int a, int b) {
    finer.parents.push_back({std::min(a, b), std::max(a, b)});
    return mesh.vertex_count() + static_cast<int>(finer.parents.size()) - 1;
  });
  finer.mesh.region_names = mesh.region_names;
  for (const int region : mesh.regions) finer.mesh.regions.insert(finer.mesh.regions.end(), 4, region);
  Points& x = finer.mesh.vertices;
  x.resize(3, mesh.vertex_count() + static_cast<Eigen::Index>(finer.parents.size()));
  x.leftCols(mesh.vertex_count()) = mesh.vertices;
  for (size_t k = 0; k < finer.parents.size(); ++k)
    x.col(mesh.vertex_count() + static_cast<Eigen::Index>(k)) =
        0.5 * (mesh.vertices.col(finer.parents[k][0]) + mesh.vertices.col(finer.parents[k][1]));
  return finer;
}

}  // namespace coapt
