// A scene's nodes, sets and supports on a coarser mesh than its own.
#pragma once

#include "mesh/remesh/coarsen.hpp"
#include "scene/build/scene_geometry.hpp"

namespace coapt {

// How to coarsen the scene's mesh: insertions of chords, nodes that terms name one by one and lines of cables
// stay; supports are thinned out among themselves.
CoarsenOptions coarsen_options(const Scene& scene, const SceneGeometry& finest);

// The geometry on a coarser mesh; kept: for each of its vertices the vertex of the scene's own mesh.
// The result refers to `finest`. Pre: coarsened with coarsen_options().
SceneGeometry coarsened(const SceneGeometry& finest, const TriangleMesh& coarse,
                        const std::vector<int>& kept);

}  // namespace coapt
