#include "exchange/export.hpp"

#include "core/error.hpp"
#include "exchange/febio_export.hpp"
#include "formats/json/markups.hpp"
#include "formats/json/named_files.hpp"
#include "formats/json/read_json.hpp"
#include "formats/json/suggestion.hpp"
#include "formats/lower_extension.hpp"
#include "formats/mesh_io.hpp"
#include "formats/whole_file.hpp"
#include "scene/build/scene_geometry.hpp"

namespace coapt {
namespace {

constexpr std::string_view kClosed = "_closed";

Markup markup_of(const Scene& scene, const std::string& what) {
  const SceneGeometry geometry = scene_geometry(scene);
  if (!geometry.defects.empty()) throw InputError(geometry.defects);
  const Model& model = geometry.model;
  const bool is_closed = what.ends_with(kClosed) && !model.sets.contains(what);
  const std::string set = is_closed ? what.substr(0, what.size() - kClosed.size()) : what;
  const auto found = model.sets.find(set);
  if (found == model.sets.end() || found->second.empty()) {
    std::vector<std::string> names;
    for (const auto& entry : model.sets) names.push_back(entry.first);
    throw InputError(scene.file.string() + ": no node set \"" + set +
                     "\" to export; its sets: " + listed(names) + suggestion(set, names));
  }
  Points points = model.X(Eigen::all, found->second);
  if (is_closed) {
    const MotionPath motion = motion_path(geometry.prescribed, model.X, scene.motion_steps);
    if (motion.positions) points = motion.positions(1)(Eigen::all, found->second);
  }
  points.colwise() += model.origin;
  const bool is_rim = set == "annulus" || set == "free_edge";
  return {what, is_rim && points.cols() >= 3 ? "ClosedCurve" : "Fiducial", points, {}};
}

// Throws InputError where `out` is the file to export from, or one that this scene names.
void refuse_replaced_inputs(const std::filesystem::path& from, const std::filesystem::path& out) {
  std::error_code unreadable;
  if (std::filesystem::equivalent(from, out, unreadable))
    throw InputError(out.string() + ": is the file to export from; write to another");
  if (formats::lower_extension(from) != ".json" || !std::filesystem::exists(out, unreadable)) return;
  for (const std::filesystem::path& input : named_files(read_json(from), from.parent_path()))
    if (std::filesystem::equivalent(input, out, unreadable))
      throw InputError(out.string() + ": is read by " + from.string() + "; write to another file");
}

std::vector<std::string> export_mesh(const std::filesystem::path& from, const std::filesystem::path& out) {
  MeshFile file;
  if (formats::lower_extension(from) == ".json") {
    const SceneGeometry geometry = scene_geometry(load_scene(from));
    if (!geometry.defects.empty()) throw InputError(geometry.defects);
    file.mesh = geometry.model.mesh;
    if (file.mesh.triangle_count() == 0) throw InputError(from.string() + ": has no mesh to export");
    file.mesh.vertices.colwise() += geometry.model.origin;
    file.warnings = geometry.model.warnings;
  } else {
    file = read_mesh(from);
  }
  write_mesh(out, file.mesh, std::nullopt, "LPS");
  return file.warnings;
}

}  // namespace

std::vector<std::string> export_file(const std::filesystem::path& from, const std::filesystem::path& out,
                                     const std::string& what) {
  refuse_replaced_inputs(from, out);
  if (is_markup_file(out)) {
    write_markups(out, {markup_of(load_scene(from), what)});
    return {};
  }
  if (formats::lower_extension(out) != ".feb") return export_mesh(from, out);
  const FebioText text = febio_text(load_scene(from));
  formats::write_whole(out, text.xml);
  return text.warnings;
}

}  // namespace coapt
