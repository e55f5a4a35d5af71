#include "tuning/tuned_scene.hpp"

#include "core/error.hpp"
#include "scene/file/scene_parameter.hpp"
#include "scene/terms/term_types.hpp"
#include "valve/leaflet_regions.hpp"

#include <algorithm>
#include <set>

namespace coapt {
namespace {

// Keys of a membrane law with the dimension of a modulus that have a value; none for other terms.
std::vector<std::string> moduli_of(const TermSpec& term) {
  std::vector<std::string> keys;
  if (!is_membrane(term) && kind_of(term) != TermKind::Spring) return keys;
  for (const KeySpec& key : type_of(term).spec.keys)
    if (key.kind == KeyKind::Quantity && key.dimension == kPressure && term.parameters.has(key.name))
      keys.push_back(key.name);
  return keys;
}

// Whether a factor on its moduli changes the term: not where it is held by its prestress alone.
bool is_tunable(const TermSpec& term) {
  const std::vector<std::string> keys = moduli_of(term);
  const bool has_values = term.parameters.has("triangle_values") || term.parameters.has("vertex_values");
  return std::any_of(keys.begin(), keys.end(),
                     [&](const std::string& key) { return has_values || term.parameters.number(key) != 0; });
}

void set_regions(TriangleMesh& mesh, const std::map<std::string, std::vector<int>>& sets,
                 const RegionTuningOptions& options, const Scene& scene) {
  if (options.regions == 0) {
    if (mesh.regions.empty())
      throw InputError(scene.file.string() +
                       ": mesh: has no regions of its own; ask for a number of regions");
    return;
  }
  const auto annulus = sets.find("annulus");
  if (annulus == sets.end() || annulus->second.size() < 3)
    throw InputError(scene.file.string() +
                     ": sets: no \"annulus\", an ordered loop of vertices, to split the "
                     "leaflets along; name one, or tune the regions of the mesh");
  try {
    LeafletRegions regions = leaflet_regions(mesh, annulus->second, options.regions, options.zones);
    mesh.regions = std::move(regions.of_triangle);
    mesh.region_names = std::move(regions.names);
  } catch (const InputError& error) {
    throw InputError(scene.file.string() + ": --regions: " + error.defects().front());
  }
}

// The new regions of a list of triangles.
std::set<int> regions_of(const std::vector<int>& triangles, const TriangleMesh& mesh) {
  std::set<int> regions;
  for (const int t : triangles) regions.insert(mesh.regions[static_cast<size_t>(t)]);
  return regions;
}

}  // namespace

TunedScene::TunedScene(const Scene& scene, SceneGeometry own, const RegionTuningOptions& options)
    : geometry(std::move(own)), split_(scene) {
  const TriangleMesh own_mesh = geometry.model.mesh;
  TriangleMesh& mesh = geometry.model.mesh;
  set_regions(mesh, geometry.model.sets, options, scene);
  split_.terms.clear();
  bool has_chords = false;
  for (const TermSpec& term : scene.terms) {
    has_chords = has_chords || is_elastic_cable(term);
    const bool is_tuned = is_tunable(term);
    if (!is_tuned && !term.parameters.has("region")) {
      if (options.tunes_chords && is_elastic_cable(term)) cables_.push_back(split_.terms.size());
      split_.terms.push_back(term);
      continue;
    }
    std::vector<std::string> names;
    for (const int region : regions_of(region_triangles(term.parameters, own_mesh), mesh)) {
      names.push_back(mesh.region_names[static_cast<size_t>(region)]);
      if (!is_tuned) continue;
      parts_.push_back({split_.terms.size(), static_cast<size_t>(region)});
      split_.terms.push_back(term);
      split_.terms.back().name += "/" + names.back();
      split_.terms.back().parameters.set("region", std::vector<std::string>{names.back()});
    }
    if (is_tuned) continue;
    split_.terms.push_back(term);
    split_.terms.back().parameters.set("region", names);
  }
  number_tuned_regions();
  std::vector<std::string> defects;
  if (!has_chords)
    defects.push_back(scene.file.string() + ": terms: no elastic cable; there are no chords to spare");
  if (parts_.empty())
    defects.push_back(scene.file.string() + ": terms: no membrane term gives a modulus that could be tuned");
  if (!defects.empty()) throw InputError(defects);
}

// Only regions that a tuned term covers have a factor, in the order of the mesh.
void TunedScene::number_tuned_regions() {
  factor_of_region_.assign(geometry.model.mesh.region_names.size(), std::nullopt);
  for (const Part& part : parts_) factor_of_region_[part.region] = 0;
  for (std::optional<size_t>& factor : factor_of_region_)
    if (factor) factor = region_count_++;
  for (Part& part : parts_) part.region = *factor_of_region_[part.region];
}

Scene TunedScene::scene(const Vector& factors) const {
  Scene scene = split_;
  for (const Part& part : parts_)
    for (const std::string& key : moduli_of(scene.terms[part.term]))
      scene.terms[part.term].parameters.scale(key, factors[static_cast<Eigen::Index>(part.region)]);
  for (size_t k = 0; k < cables_.size(); ++k)
    scene.terms[cables_[k]].parameters.scale("area_scale",
                                             factors[static_cast<Eigen::Index>(region_count_ + k)]);
  return scene;
}

std::vector<std::string> TunedScene::terms_of(Eigen::Index factor) const {
  const auto index = static_cast<size_t>(factor);
  if (!is_region(factor)) return {split_.terms[cables_[index - region_count_]].name};
  std::vector<std::string> names;
  for (const Part& part : parts_)
    if (part.region == index) names.push_back(split_.terms[part.term].name);
  return names;
}

void TunedScene::name_factors(const Vector& factors, std::vector<TunedFactor>& regions,
                              std::vector<TunedFactor>& chords) const {
  const TriangleMesh& mesh = geometry.model.mesh;
  for (size_t r = 0; r < mesh.region_names.size(); ++r) {
    const std::optional<size_t> factor = factor_of_region_[r];
    regions.push_back(
        {mesh.region_names[r],
         static_cast<int>(std::count(mesh.regions.begin(), mesh.regions.end(), static_cast<int>(r))),
         factor ? factors[static_cast<Eigen::Index>(*factor)] : 1, factor.has_value()});
  }
  for (size_t k = 0; k < cables_.size(); ++k)
    chords.push_back(
        {split_.terms[cables_[k]].name, 0, factors[static_cast<Eigen::Index>(region_count_ + k)]});
}

}  // namespace coapt
