// Scenes of a program that has in memory what files and the table of terms say otherwise: a mesh, an energy
// of its own, a shape to start from. The Python module is made of this.
#pragma once

#include "scene/build/model.hpp"
#include "scene/file/scene.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace coapt {

// What messages call a mesh that no file holds.
inline constexpr const char* kMeshInMemory = "mesh in memory";

// Makes terms that no scene names, once the nodes of the model are known: their numbers, their reference
// positions X relative to `origin` [mm]. Throws InputError.
using GivenTerms = std::function<std::vector<std::unique_ptr<EnergyTerm>>(const Model& model)>;

struct Given {
  std::optional<TriangleMesh> mesh = {};  // [mm]; empty: the scene's file
  GivenTerms terms = {};
  bool has_hessians = true;  // of all given terms; otherwise the result gets no certificate
  // 3 x node_count, in the coordinates of the input [mm]; the supports stand where their motion ends. Looked
  // at where it is. Empty: the scene's own start.
  std::optional<Eigen::Map<const Points>> start = {};
  std::function<Observer(const Model& model)> observer =
      {};  // asked for once, instead of RunOptions::observer
};

// As parse_scene(), of a scene without the key `mesh`, whose mesh will be given.
Scene parse_scene_around_mesh(const std::string& text, const std::filesystem::path& path);

}  // namespace coapt
