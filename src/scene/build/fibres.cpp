#include "scene/build/fibres.hpp"

#include "core/error.hpp"
#include "formats/file_numbering.hpp"
#include "formats/json/read_points.hpp"
#include "scene/build/node_selection.hpp"
#include "valve/fibre_guides.hpp"

#include <algorithm>

namespace coapt {
namespace {

// The named set, or an empty one.
std::vector<int> set_of(const Model& model, const std::string& name) {
  const auto found = model.sets.find(name);
  return found == model.sets.end() ? std::vector<int>() : found->second;
}

std::vector<int> trigones_of(const Model& model, const std::vector<int>& annulus) {
  for (const char* name : {"trigones", "commissures"})
    if (model.sets.contains(name)) return set_of(model, name);
  return region_meetings(model.mesh, annulus);
}

// How the chords of all networks pull at the leaflets.
std::vector<FibrePull> pulls_of(const SceneGeometry& geometry) {
  const Points& X = geometry.model.X;
  std::vector<FibrePull> pulls;
  for (const auto& [path, placed] : geometry.networks)
    for (const Chord& chord : placed.network.chords)
      for (const auto& [end, other] : {std::pair(chord.from, chord.to), std::pair(chord.to, chord.from)})
        if (end.kind == ChordEnd::Kind::Leaflet)
          pulls.push_back(
              {end.index, X.col(placed.node(other)) - X.col(end.index), chord.area > 0 ? chord.area : 1});
  return pulls;
}

std::vector<FibreGuide> default_guides(const SceneFibres& fibres, const SceneGeometry& geometry) {
  const Model& model = geometry.model;
  const std::vector<int> annulus = set_of(model, "annulus");
  if (fibres.defaults == "none") return {};
  if (fibres.defaults == "boundary" || (fibres.defaults == "auto" && annulus.empty()))
    return boundary_guides(model.mesh);
  if (annulus.empty())
    throw InputError(fibres.where +
                     ".defaults: \"valve\" needs the node set \"annulus\"; name it in `sets` or in "
                     "the file of `mesh.sets`, or take \"boundary\"");
  return valve_guides(model.mesh, annulus, trigones_of(model, annulus), pulls_of(geometry));
}

// Along or across: the boundary edges that join two of the nodes, where there are none any edge that does.
std::vector<FibreGuide> edge_guides(const FibreEntry& entry, const std::vector<int>& nodes,
                                    const Model& model) {
  std::vector<bool> is_wanted(static_cast<size_t>(model.X.cols()), false);
  for (const int node : nodes) is_wanted[static_cast<size_t>(node)] = true;
  const auto kind = entry.direction.kind == SurfaceDirection::Kind::Along ? FibreGuide::Kind::Along
                                                                          : FibreGuide::Kind::Across;
  std::vector<FibreGuide> on_boundary, inside;
  for (const Edge& edge : edges(model.mesh.triangles))
    if (is_wanted[static_cast<size_t>(edge.a)] && is_wanted[static_cast<size_t>(edge.b)])
      (edge.triangles.size() == 1 ? on_boundary : inside).push_back({kind, edge.a, edge.b, Vec3::Zero()});
  std::vector<FibreGuide>& guides = on_boundary.empty() ? inside : on_boundary;
  if (guides.empty())
    throw InputError(entry.where +
                     ".nodes: no mesh edge joins two of these nodes, so that nothing is along or "
                     "across them; give more, or a vector as the direction");
  return guides;
}

void add_entry(const FibreEntry& entry, const Model& model, std::vector<FibreGuide>& guides) {
  const std::string where = entry.where + ".nodes";
  const std::vector<int> nodes = selected_nodes(entry.nodes, model, where);
  for (const int node : nodes)
    if (node >= model.mesh.vertex_count())
      throw InputError(where + ": node " + std::to_string(node) +
                       " is no vertex of the mesh; fibres lie in it");
  if (entry.direction.kind == SurfaceDirection::Kind::InSpace) {
    for (const int node : nodes)
      guides.push_back({FibreGuide::Kind::AtVertex, node, node, entry.direction.vector});
    return;
  }
  const std::vector<FibreGuide> more = edge_guides(entry, nodes, model);
  guides.insert(guides.end(), more.begin(), more.end());
}

FibreField field_of_scene(const SceneFibres& fibres, const SceneGeometry& geometry, Numbering numbering) {
  const Model& model = geometry.model;
  if (fibres.file)
    return in_surface(read_csv(fibres.file->string()), model.mesh, fibres.file->string(), numbering);
  std::vector<FibreGuide> guides = default_guides(fibres, geometry);
  std::vector<std::string> defects;
  for (const FibreEntry& entry : fibres.entries) try {
      add_entry(entry, model, guides);
    } catch (const InputError& error) {
      defects.insert(defects.end(), error.defects().begin(), error.defects().end());
    }
  if (!defects.empty()) throw InputError(defects);
  try {
    return fibre_field(model.mesh, guides, {fibres.joins_regions, numbering});
  } catch (const InputError& error) {
    throw error.within(fibres.where);
  }
}

// Each triangle's four parts have its fibre.
FibreField refined_uniformly(const FibreField& coarse) {
  FibreField fine;
  fine.directions.resize(3, 4 * coarse.directions.cols());
  for (Eigen::Index t = 0; t < coarse.directions.cols(); ++t)
    fine.directions.middleCols<4>(4 * t).colwise() = coarse.directions.col(t);
  fine.anisotropy = coarse.anisotropy.transpose().replicate(4, 1).reshaped();
  return fine;
}

// Solved for on the scene's own mesh alone, so that all meshes are of one material; kept where it was asked
// for.
const FibreField& field_here(const SceneFibres& fibres, const SceneGeometry& geometry, Numbering numbering) {
  std::optional<FibreField>& here = *geometry.fibres;
  if (here) return *here;
  if (geometry.finest == nullptr)
    here = field_of_scene(fibres, geometry, numbering);
  else if (geometry.is_refined)
    here = refined_uniformly(field_here(fibres, *geometry.coarser, numbering));
  else
    here = coarsened(field_here(fibres, *geometry.finest, numbering), geometry.finest->model.mesh,
                     geometry.model.mesh, kept_vertices(geometry));
  return *here;
}

void warn_of_isotropic(const FibreField& field, const SceneFibres& fibres, Model& model) {
  constexpr double kIsotropic = 0.01;
  const auto count = (field.anisotropy.array() < kIsotropic).count();
  if (count > 0)
    model.warnings.push_back(fibres.where + ": what is known of the fibres cancels out in " +
                             std::to_string(count) +
                             " triangles (anisotropy below 0.01): their direction is "
                             "arbitrary; `fibre_anisotropy` in closed.vtp shows where.");
}

}  // namespace

void find_fibres(const Scene& scene, const SceneGeometry& geometry, Model& model) {
  if (model.fibres.cols() > 0) return;
  SceneFibres fibres = scene.fibres.value_or(SceneFibres());
  if (!scene.fibres) fibres.where = scene.file.string() + ": fibres";
  const FibreField& field =
      field_here(fibres, geometry, scene.mesh ? file_numbering(scene.mesh->file) : Numbering());
  model.fibres = field.directions;
  model.fibre_anisotropy = field.anisotropy;
  warn_of_isotropic(field, fibres, model);
}

}  // namespace coapt
