#include "cli/images/image_distance.hpp"

#include "cli/images/image_line.hpp"
#include "core/error.hpp"
#include "formats/durable_file.hpp"
#include "formats/json/json_text.hpp"
#include "formats/vtk/vtp_writer.hpp"
#include "mesh/distance/surface_distance.hpp"

#include <algorithm>
#include <vector>

namespace coapt::cli {
namespace {

constexpr double kSameSheet = 5;  // a ridge farther from the closed leaflets is another structure [mm]
constexpr double kSharePercentile = 0.95;

}  // namespace

DistanceFigures figures_of(std::vector<double> values) {
  if (values.empty()) return {kNaN, kNaN, kNaN};
  std::sort(values.begin(), values.end());
  DistanceFigures figures;
  for (const double value : values) figures.mean += value / static_cast<double>(values.size());
  figures.p95 = values[static_cast<size_t>(kSharePercentile * static_cast<double>(values.size() - 1))];
  figures.max = values.back();
  return figures;
}

ImageDistance distance_from_image(const TriangleMesh& closed, const Points& ridges) {
  if (ridges.cols() == 0) throw InputError("the closed volume shows no sheets around the annulus");
  ImageDistance distance;
  const Vector from_ridges = surface_distance(ridges, closed).vertex_distances;
  std::vector<double> near;
  for (Eigen::Index k = 0; k < ridges.cols(); ++k)
    if (from_ridges[k] < kSameSheet) near.push_back(from_ridges[k]);
  distance.ridge_points = static_cast<Eigen::Index>(near.size());
  distance.from_image = figures_of(std::move(near));
  distance.vertices.resize(closed.vertex_count());
  for (int v = 0; v < closed.vertex_count(); ++v)
    distance.vertices[v] = (ridges.colwise() - closed.vertices.col(v)).colwise().norm().minCoeff();
  distance.to_image = figures_of({distance.vertices.begin(), distance.vertices.end()});
  return distance;
}

void write_image_distance(const std::filesystem::path& folder, const TriangleMesh& closed,
                          const ImageDistance& distance, const ImageLine& line,
                          const std::string& closed_volume) {
  VtpSurface surface;
  surface.vertices = closed.vertices;
  surface.triangles = closed.triangles;
  surface.point_arrays.push_back({"distance_to_image_mm", distance.vertices.transpose()});
  surface.texts.push_back({"units", {"mm"}});
  write_vtp(folder / "image_distance.vtp", surface);
  const auto json = [](const DistanceFigures& d) {
    return OrderedJson{{"mean_mm", d.mean}, {"p95_mm", d.p95}, {"max_mm", d.max}};
  };
  const OrderedJson document = {
      {"closed_volume", closed_volume},
      {"to_image", json(distance.to_image)},
      {"from_image", json(distance.from_image)},
      {"ridge_points", distance.ridge_points},
      {"farthest_counted_mm", kSameSheet},
      {"coaptation_line", {{"shown_share", line.shown_share}, {"to_predicted", json(line.to_predicted)}}}};
  formats::write_durable(folder / "image_distance.json", json_text(document, 2) + "\n");
}

}  // namespace coapt::cli
