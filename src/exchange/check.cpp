#include "exchange/check.hpp"

#include "core/error.hpp"
#include "exchange/valve_doubts.hpp"
#include "formats/file_numbering.hpp"
#include "formats/json/json_text.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/mesh_check.hpp"
#include "scene/build/build.hpp"
#include "scene/build/scene_geometry.hpp"
#include "scene/file/scene.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>

namespace coapt {
namespace {

constexpr unsigned kSeed = 20240607;
constexpr int kDirections = 6;

void append(std::vector<std::string>& list, const std::vector<std::string>& more) {
  for (const std::string& item : more)
    if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
}

// The mesh that a scene names, even where the rest of the scene cannot be used: the user wants to hear
// about both at once.
void check_named_mesh(const std::filesystem::path& scene_file, CheckReport& report) {
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(scene_file, unreadable)) return;
  std::ifstream in(scene_file);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const auto json = nlohmann::json::parse(text, nullptr, false, true);
  if (!json.is_object() || !json.contains("mesh") || !json["mesh"].is_object()) return;
  const auto file = json["mesh"].find("file");
  if (file == json["mesh"].end() || !file->is_string()) return;
  const std::filesystem::path path = scene_file.parent_path() / file->get<std::string>();
  if (!std::filesystem::is_regular_file(path, unreadable)) return;  // the scene's own defect
  try {
    const MeshFile mesh = read_mesh(path);
    append(report.warnings, mesh.warnings);
    for (const MeshDefect& defect : check_mesh(mesh.mesh, {.numbering = file_numbering(path)}))
      append(defect.severity == Severity::Error ? report.defects : report.warnings,
             {path.string() + ": " + defect.message});
  } catch (const InputError& error) {
    append(report.defects, error.defects());
  }
}

std::optional<Model> load(const std::filesystem::path& scene_file, CheckReport& report) {
  std::optional<Scene> scene;
  try {
    scene = load_scene(scene_file);
  } catch (const InputError& error) {
    append(report.defects, error.defects());
    check_named_mesh(scene_file, report);
    return std::nullopt;
  }
  try {
    const SceneGeometry geometry = scene_geometry(*scene);
    Model model = build(*scene, geometry);
    append(report.warnings, model.warnings);
    append(report.warnings, valve_doubts(*scene, geometry, model));
    return model;
  } catch (const InputError& error) {
    append(report.defects, error.defects());
    return std::nullopt;
  }
}

// Mean edge or line: the scale of what a small step is.
double length_scale(const Model& model) {
  const double edge = mean_edge_length(model.X, model.mesh.triangles);
  if (edge > 0 || model.lines.empty()) return edge > 0 ? edge : 1;
  double sum = 0;
  for (const Line& line : model.lines) sum += (model.X.col(line.a) - model.X.col(line.b)).norm();
  return sum > 0 ? sum / static_cast<double>(model.lines.size()) : 1;
}

// How far each node may be moved, as a share of the scale: what is small beside a regular triangle would
// stretch a sliver a hundredfold. 3 x node_count, the coordinates of a node alike.
Points sliver_shares(const Model& model, double scale) {
  Points shares = Points::Ones(3, model.X.cols());
  for (int t = 0; t < model.mesh.triangle_count(); ++t) {
    const Eigen::Vector3i v = model.mesh.triangles.col(t);
    double longest = 0;
    for (int k = 0; k < 3; ++k)
      longest = std::max(longest, (model.X.col(v[k]) - model.X.col(v[(k + 1) % 3])).norm());
    const double height = 2 * area_vector(model.X, v).norm() / longest, share = 2 * height / scale;
    if (!(share < 1)) continue;
    for (const int node : v) shares.col(node) = shares.col(node).cwiseMin(share);
  }
  return shares;
}

std::vector<DerivativeReport> check_model(Model& model) {
  Objective& objective = *model.objective;
  const double scale = length_scale(model);
  const Points start = objective.positions(model.q0);
  const Points shares = sliver_shares(model, scale);
  const auto per_node = [&](Eigen::MatrixXd directions) {
    for (Eigen::Index k = 0; k < directions.cols(); ++k)
      directions.col(k).array() *= shares.reshaped().array();
    return directions;
  };
  const Eigen::MatrixXd motion = per_node(random_directions(objective.fixed(), 1, scale / 20, kSeed));
  const Points near = start + Eigen::Map<const Points>(motion.data(), 3, start.cols());
  const Vec3 centre = near.rowwise().mean();
  const Points larger = (1.1 * (near.colwise() - centre)).colwise() + centre;
  // Beside its rest state a membrane that wrinkles has a border of its regimes in every other facet, where
  // the Hessian jumps by right. Enlarged by a quarter it is taut.
  const Points taut = (1.25 * (start + 0.2 * (near - start))).colwise() - 0.25 * centre;

  std::vector<DerivativeReport> reports;
  const auto smooth_of = [](const DerivativeReport& first, const DerivativeReport& second) {
    return !first.has_passed() && second.is_active() && second.has_passed() ? second : first;
  };
  const FixedMask all_free = FixedMask::Constant(3, start.cols(), false);
  const Eigen::MatrixXd directions = per_node(random_directions(all_free, kDirections, scale, kSeed + 1));
  for (const auto& term : objective.terms()) {
    DerivativeReport report = check_derivatives(*term, near, directions);
    if (!report.is_active()) report = check_derivatives(*term, larger, directions);
    if (!report.has_passed()) report = smooth_of(report, check_derivatives(*term, taut, directions));
    reports.push_back(report);
  }
  if (objective.unknown_count() == 0) return reports;
  const Eigen::MatrixXd nodal = per_node(random_directions(objective.fixed(), kDirections, scale, kSeed + 2));
  Eigen::MatrixXd free(objective.unknown_count(), nodal.cols());
  for (int k = 0; k < nodal.cols(); ++k)
    free.col(k) = objective.unknowns(Eigen::Map<const Points>(nodal.col(k).data(), 3, start.cols()));
  DerivativeReport sum = check_derivatives(objective, objective.unknowns(near), free);
  for (const Points* state : {&taut, &larger})
    if (!sum.has_passed())
      sum = smooth_of(sum, check_derivatives(objective, objective.unknowns(*state), free));
  reports.push_back(sum);
  return reports;
}

}  // namespace

bool CheckReport::is_sound() const {
  return defects.empty() && std::all_of(derivatives.begin(), derivatives.end(),
                                        [](const DerivativeReport& r) { return r.has_passed(); });
}

CheckReport check(const std::filesystem::path& scene_file) {
  CheckReport report;
  std::optional<Model> model = load(scene_file, report);
  if (!model) return report;
  report.derivatives = check_model(*model);
  return report;
}

}  // namespace coapt
