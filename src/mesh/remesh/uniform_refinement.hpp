// Finer meshes: every triangle refined uniformly, 1:4.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <array>
#include <functional>
#include <vector>

namespace coapt {

// The four triangles that each becomes follow each other, the one in the middle last; orientation is kept.
// add_middle: makes the vertex between two others and returns its number; called once for each edge.
Triangles refined_uniformly(const Triangles& triangles, const std::function<int(int, int)>& add_middle);

// A mesh whose new vertices follow those it had, each in the middle of an edge.
struct FinerMesh {
  TriangleMesh mesh;                        // regions carried along
  std::vector<std::array<int, 2>> parents;  // of each new vertex: the ends of its edge, the smaller first
};
FinerMesh refined_uniformly(const TriangleMesh& mesh);

}  // namespace coapt
