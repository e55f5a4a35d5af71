#include "study/point_shapes.hpp"

#include "core/error.hpp"
#include "formats/mesh_io.hpp"
#include "report/compared_view.hpp"
#include "scene/build/build.hpp"

#include <algorithm>
#include <memory>

namespace coapt {
namespace {

constexpr double kRoom = 2'500'000;    // of all shapes with their colours in the page [bytes]
constexpr double kTriangleBytes = 75;  // of one triangle in one shape: a dozen numbers, and half a node
constexpr size_t kLeastShapes = 2, kMostShapes = 12;

struct PointShape {
  Model model;
  Report report;
};

std::string label_of(const StudyPoint& point, const std::vector<Sweep>& sweeps) {
  std::string label;
  for (size_t k = 0; k < sweeps.size(); ++k)
    label += (k == 0 ? "" : ", ") + sweeps[k].path + " = " + point.values[k];
  return label;
}

// Null where the point's file does not hold its nodes.
std::unique_ptr<PointShape> point_shape(const std::filesystem::path& scene, const StudyPoint& point,
                                        const PointResult& result, const std::filesystem::path& folder) {
  try {
    auto shape = std::make_unique<PointShape>();
    const Points x = read_mesh(point_folder(folder, point.number) / "closed.vtp").mesh.vertices;
    shape->model = build(parse_scene(point.scene, scene));
    if (x.cols() != shape->model.X.cols()) return nullptr;
    Report& report = shape->report;
    report.result.status = Status::Converged;
    report.result.residual = result.residual;
    report.fields = compute_fields(shape->model, x.colwise() - shape->model.origin);
    const IntersectionChecker none = {
        "nobody", [](const Points&, const Triangles&) { return std::vector<std::array<int, 2>>(); }};
    report.metrics =
        measure(shape->model, shape->model.objective->unknowns(report.fields.x), report.fields, none);
    return shape;
  } catch (const InputError&) {  // the page does without
    return nullptr;
  }
}

}  // namespace

std::optional<ShapeView> point_shapes(const std::filesystem::path& scene,
                                      const std::vector<StudyPoint>& points,
                                      const std::vector<PointResult>& results,
                                      const std::vector<Sweep>& sweeps, const std::filesystem::path& folder) {
  std::vector<const PointResult*> converged;
  for (const PointResult& result : results)
    if (result.has_converged()) converged.push_back(&result);
  std::vector<std::unique_ptr<PointShape>> shapes;
  std::vector<ComparedShape> compared;
  size_t shown = std::min(kMostShapes, converged.size());
  for (size_t k = 0; k < shown; ++k) {
    // Evenly over those that converged, the first and the last among them.
    const PointResult& result = *converged[shown > 1 ? k * (converged.size() - 1) / (shown - 1) : 0];
    const StudyPoint& point = points[result.number];
    auto shape = point_shape(scene, point, result, folder);
    if (shape == nullptr) continue;
    if (shapes.empty()) {
      const double room = kRoom / (kTriangleBytes * std::max(1, shape->model.mesh.triangle_count()));
      shown = std::min(shown, std::max(kLeastShapes, static_cast<size_t>(std::min(room, 1.0 * kMostShapes))));
    }
    compared.push_back({label_of(point, sweeps), &shape->model, &shape->report});
    shapes.push_back(std::move(shape));
  }
  if (compared.empty()) return std::nullopt;
  return compared_view(compared, compared.size() - 1, "study",
                       sweeps.size() == 1 ? sweeps.front().path : "Points of the grid");
}

}  // namespace coapt
