#include "image/segment/write_segmentation.hpp"

#include "formats/durable_file.hpp"
#include "formats/json/json_text.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/vtk/vtp_writer.hpp"
#include "image/segment/leaflet_thickness.hpp"
#include "image/write_volume.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

double loop_length(const Valve& valve, const std::vector<int>& loop) {
  double length = 0;
  for (size_t k = 0; k < loop.size(); ++k)
    length +=
        (valve.leaflets.vertices.col(loop[k]) - valve.leaflets.vertices.col(loop[(k + 1) % loop.size()]))
            .norm();
  return length;
}

// The value that this share of the finite ones does not exceed; 0 where there are none.
double quantile(const Vector& values, double share) {
  std::vector<double> finite;
  for (const double value : values)
    if (std::isfinite(value)) finite.push_back(value);
  if (finite.empty()) return 0;
  const auto place = finite.begin() + std::lround(share * static_cast<double>(finite.size() - 1));
  std::nth_element(finite.begin(), place, finite.end());
  return *place;
}

OrderedJson document(const Segmentation& found, const std::string& volume, const std::string& annulus) {
  const Valve& valve = found.valve;
  const auto fitted = static_cast<double>(found.thickness.array().isFinite().count());
  OrderedJson phases = OrderedJson::object();
  for (const auto& [phase, seconds] : found.times.wall()) phases[phase] = seconds;
  OrderedJson written = {
      {"volume", volume},
      {"annulus", annulus},
      {"voxels", found.size},
      {"vertices", valve.leaflets.vertex_count()},
      {"triangles", valve.leaflets.triangle_count()},
      {"least_angle_deg", found.least_angle},
      {"crossing_pairs", found.crossing_pairs},
      {"area_mm2", surface_area(valve.leaflets.vertices, valve.leaflets.triangles)},
      {"annulus_length_mm", loop_length(valve, valve.annulus)},
      {"free_edge_length_mm", loop_length(valve, valve.free_edge)},
      {"thickness_mm",
       {{"median", found.thickness_median},
        {"p05", quantile(found.thickness, 0.05)},
        {"p95", quantile(found.thickness, 0.95)},
        {"fitted_share", fitted / std::max(1.0, static_cast<double>(found.thickness.size()))}}},
      {"deviation_mm", {{"mean", found.deviation.mean()}, {"p95", quantile(found.deviation, 0.95)}}},
      {"free_edge_deviation_mm", found.edge_deviation},
      {"ridge_noise_mm", found.noise},
      {"ridge_noise_area_mm2", found.noise_area},
      {"blur_mm", found.blur},
      {"contrast", found.contrast},
      {"shown_share", found.shown_share},
      {"phase_seconds", phases},
      {"cpu_seconds", found.cpu_seconds},
      {"warnings", found.warnings}};
  if (const std::optional<RouteAgreement>& other = found.second_route)
    written["second_route"] = {{"mean_mm", other->mean},
                               {"p95_mm", other->p95},
                               {"free_edge_mean_mm", other->free_edge},
                               {"area_difference", other->area_difference},
                               {"apart_share", other->apart_share}};
  if (found.burlina)
    written["level_set"] = {{"steps", found.burlina->steps}, {"is_done", found.burlina->is_done}};
  return written;
}

}  // namespace

void write_segmentation(const std::filesystem::path& folder, const Segmentation& found,
                        const std::string& volume, const std::string& annulus) {
  write_valve(folder / "valve.json", found.valve);
  VtpSurface surface;
  surface.vertices = found.valve.leaflets.vertices;
  surface.triangles = found.valve.leaflets.triangles;
  surface.point_arrays.push_back({"thickness_mm", found.thickness.transpose()});
  surface.point_arrays.push_back({"deviation_mm", found.deviation.transpose()});
  surface.point_arrays.push_back({"evidence", found.evidence.transpose()});
  if (found.second_route)
    surface.point_arrays.push_back({"second_route_mm", found.second_route->distances.transpose()});
  surface.texts.push_back({"units", {"mm"}});
  surface.texts.push_back({"SPACE", {"LPS"}});
  write_vtp(folder / "leaflets.vtp", surface);
  if (found.strength) write_volume(folder / "evidence.nrrd", *found.strength, VoxelKind::Float32);
  if (found.strength && found.burlina) {
    write_volume(folder / "thin_tissue.nrrd", found.burlina->thin_tissue, VoxelKind::Float32);
    write_volume(folder / "chambers.nrrd", found.burlina->chambers, VoxelKind::UInt8);
    write_volume(folder / "tissue_mask.nrrd", found.burlina->leaflets, VoxelKind::UInt8);
  }
  formats::write_durable(folder / "segmentation.json", json_text(document(found, volume, annulus), 2) + "\n");
}

}  // namespace coapt
