#include "image/write_phantom.hpp"

#include "formats/json/markups.hpp"
#include "formats/mesh_io.hpp"
#include "formats/vtk/vtp_writer.hpp"
#include "image/write_volume.hpp"

namespace coapt {
namespace {

Points places_of(const Points& vertices, const std::vector<int>& numbers) {
  Points places(3, static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t k = 0; k < numbers.size(); ++k)
    places.col(static_cast<Eigen::Index>(k)) = vertices.col(numbers[k]);
  return places;
}

VtpSurface surface_with_truth(const PhantomValve& valve, const PhantomPattern& pattern, double thickness) {
  VtpSurface surface;
  const Eigen::Index vertices = valve.surface.vertices.cols(), ends = valve.line_ends.cols();
  surface.vertices.resize(3, vertices + ends);
  surface.vertices << valve.surface.vertices, valve.line_ends;
  surface.triangles = valve.surface.triangles;
  surface.lines.resize(2, ends / 2);
  for (Eigen::Index line = 0; line < ends / 2; ++line)
    surface.lines.col(line) << static_cast<int>(vertices + 2 * line),
        static_cast<int>(vertices + 2 * line + 1);
  Eigen::MatrixXd at_vertices = Eigen::MatrixXd::Zero(1, vertices + ends);
  at_vertices.leftCols(vertices).setConstant(thickness);
  surface.point_arrays.push_back({"thickness", at_vertices});
  Eigen::MatrixXd dropouts(1, surface.triangles.cols());
  for (Eigen::Index t = 0; t < dropouts.cols(); ++t)
    dropouts(0, t) = pattern.dropouts[static_cast<std::size_t>(t)];
  surface.triangle_arrays.push_back({"dropout", dropouts, true});
  surface.texts.push_back({"units", {"mm"}});
  surface.texts.push_back({"SPACE", {"LPS"}});
  return surface;
}

}  // namespace

std::vector<std::string> phantom_files() {
  return {"image.nrrd",  "labels.nrrd",      "surface.obj",
          "surface.vtp", "annulus.mrk.json", "free_edge.mrk.json"};
}

void write_phantom(const std::filesystem::path& folder, const PhantomValve& valve,
                   const PhantomPattern& pattern, const Phantom& phantom, const PhantomOptions& options) {
  write_volume(folder / "image.nrrd", phantom.image, VoxelKind::UInt8);
  write_volume(folder / "labels.nrrd", phantom.labels, VoxelKind::UInt8);
  write_mesh(folder / "surface.obj", valve.surface, std::nullopt, "LPS");
  write_vtp(folder / "surface.vtp", surface_with_truth(valve, pattern, options.thickness));
  const Points& x = valve.surface.vertices;
  write_markups(folder / "annulus.mrk.json", {{"annulus", "ClosedCurve", places_of(x, valve.annulus)}});
  std::vector<Markup> edges;
  for (const FreeRim& rim : free_rims(valve.surface, valve.annulus))
    edges.push_back({"free edge", rim.is_closed ? "ClosedCurve" : "Curve", places_of(x, rim.vertices)});
  write_markups(folder / "free_edge.mrk.json", edges);
}

}  // namespace coapt
