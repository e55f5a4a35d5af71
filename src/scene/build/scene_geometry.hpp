// Nodes, sets and supports of a scene, before it has terms.
#pragma once

#include "scene/build/prescribed_motion.hpp"
#include "scene/terms/term_types.hpp"
#include "valve/fibre_field.hpp"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace coapt {

struct SceneGeometry {
  Model model;                                    // without terms, objective and motion
  std::map<std::string, PlacedNetwork> networks;  // by path
  Prescribed prescribed;
  std::vector<std::string> defects;  // of sets and supports: to be said together with those of the terms

  // Where the mesh is a coarser one of a cascade: the geometry of the mesh that it was made from, the
  // scene's own or a finer one, and the node here of each node there (-1: it is gone). On a finer mesh: that
  // of the scene's own.
  const SceneGeometry* finest = nullptr;
  std::vector<int> number = {};

  // The fibres of this mesh once they were asked for, for those made from it too.
  std::shared_ptr<std::optional<FibreField>> fibres = std::make_shared<std::optional<FibreField>>();

  // On a mesh that is finer than the scene's own, on which nodes are selected anew: the next coarser one,
  // whose triangles were cut into four, and the ends of the edges that the vertices added here halve.
  bool is_refined = false;
  const SceneGeometry* coarser = nullptr;
  std::vector<std::array<int, 2>> parents = {};

  std::map<std::string, std::vector<std::array<int, 2>>> links = {};  // as in BuildContext
  std::map<std::string, Vector> patches = {};  // likewise; of the scene's own mesh alone
};

// Reads the scene's files, checks the mesh and numbers the nodes. Throws InputError with all defects of
// these.
SceneGeometry scene_geometry(const Scene& scene);

// The nodes that a selection means on the scene's own mesh, those that are gone left out; on a refined mesh
// those that it means there, listed nodes excepted.
std::vector<int> selected_nodes(const NodeSelection& selection, const SceneGeometry& geometry,
                                const std::string& where);

// How many nodes of the scene's own mesh there are for each that is left here, of a selection or of all mesh
// vertices.
double multiplicity(const NodeSelection* selection, const SceneGeometry& geometry, const std::string& where);

// The geometry of the scene's own mesh.
const SceneGeometry& finest_geometry(const SceneGeometry& geometry);

// On a coarser mesh: the vertex of the mesh that it was made from, of each vertex here.
std::vector<int> kept_vertices(const SceneGeometry& geometry);

// The scene's own mesh, and values given on its vertices or triangles (one entry each) on those here. A
// coarser mesh keeps the values of its vertices, and its triangles take the mean over their corners of the
// mean over the triangles that met there. On a finer mesh triangles have the value of the one that they are
// part of, new vertices the mean of the ends of their edge.
const TriangleMesh& scene_mesh(const SceneGeometry& geometry);
Vector at_vertices(const Vector& values, const SceneGeometry& geometry);
Vector on_triangles(const Vector& values, const SceneGeometry& geometry);

}  // namespace coapt
