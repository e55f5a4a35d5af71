#include "exchange/repair.hpp"

#include "core/error.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/distance/separate.hpp"
#include "scene/build/scene_geometry.hpp"
#include "scene/file/scene.hpp"

#include <algorithm>
#include <iterator>

namespace coapt {
namespace {

constexpr double kGapPerEdge = 0.1;

// `folder/name.word.extension`.
std::filesystem::path beside(std::filesystem::path path, const std::string& word,
                             const std::string& extension) {
  return path.replace_filename(path.stem().string() + "." + word + extension);
}

FacetPairs excluded_pairs(const Parameters& contact, int facet_count) {
  return contact.has("exclude") ? read_facet_pairs(contact.text("exclude"), facet_count) : FacetPairs{};
}

void write_exclusion(const std::filesystem::path& path, const FacetPairs& excluded, const FacetPairs& more) {
  FacetPairs all;
  std::set_union(excluded.begin(), excluded.end(), more.begin(), more.end(), std::back_inserter(all));
  write_facet_pairs(path.string(), all);
}

// The mesh of the model with other vertices, in the frame and unit of its file.
TriangleMesh as_in_file(const Model& model, const Points& x, double scale) {
  TriangleMesh mesh = model.mesh;
  mesh.vertices = (x.leftCols(mesh.vertex_count()).colwise() + model.origin) / scale;
  return mesh;
}

}  // namespace

RepairReport repair(const std::filesystem::path& scene_file, RepairMethod method,
                    const std::optional<std::filesystem::path>& output) {
  const Scene scene = load_scene(scene_file);
  RepairReport report;
  const auto contact = std::find_if(scene.terms.begin(), scene.terms.end(), is_barrier);
  if (contact == scene.terms.end() || !scene.mesh) return report;
  const SceneGeometry geometry = scene_geometry(scene);
  const Model& model = geometry.model;
  const Triangles facets = all_facets(model);
  SeparationOptions options;
  options.membrane_count = model.mesh.triangle_count();
  options.excluded = excluded_pairs(contact->parameters, static_cast<int>(facets.cols()));
  const FacetPairs pairs = pairs_to_separate(model.X, facets, options.membrane_count, options.excluded);
  report.pairs = static_cast<int>(pairs.size());
  report.outcome = pairs.empty() ? RepairOutcome::NothingToRepair : RepairOutcome::Repaired;
  if (pairs.empty()) return report;

  if (method == RepairMethod::Exclude) {
    report.file = output.value_or(beside(scene_file, "exclude", ".csv"));
    write_exclusion(report.file, options.excluded, pairs);
    return report;
  }
  options.gap = report.gap_mm = kGapPerEdge * mean_edge_length(model.mesh.vertices, model.mesh.triangles);
  for (Eigen::Index node = 0; node < model.X.cols(); ++node)
    options.is_held.push_back(geometry.prescribed.fixed.col(node).any());
  const Separation separation = separate(model.X, facets, options);
  report.left = separation.pairs_left;
  report.passes = separation.passes;
  report.largest_move_mm = separation.largest_displacement;
  if (!report.left.empty()) {
    report.outcome = RepairOutcome::Failed;
    return report;
  }
  const std::filesystem::path mesh = scene.mesh->file;
  report.file = output.value_or(beside(mesh, "separated", mesh.extension().string()));
  write_mesh(report.file, as_in_file(model, separation.x, scene.mesh->scale));
  return report;
}

}  // namespace coapt
