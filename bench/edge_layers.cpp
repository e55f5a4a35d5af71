// Unrolls the layer of a phantom's open valve for bench/edge_network.py: what the network is given of each
// place, and whether the place is leaflet.
//
//     bench_edge_layers FOLDER_OF_OPEN_VALVE OUTPUT
//
// Written: three int32 (channels, places, columns), the channels (float32, column after column of
// layer_channels), and for each place, in the same order, its distance from the true leaflets and how far
// their nearest point lies from the true edge, below 0 beyond it [mm].
#include "formats/json/markups.hpp"
#include "formats/mesh_io.hpp"
#include "image/edge/edge_network.hpp"
#include "image/read_volume.hpp"
#include "image/segment/annulus_region.hpp"
#include "image/segment/fit_layer.hpp"
#include "image/segment/track_layer.hpp"
#include "mesh/distance/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

namespace {

using namespace coapt;

constexpr double kSmoothing = 1.2;   // as of SegmentOptions [mm]
constexpr double kColumns = 0.75;    // as of segment_leaflets() [mm]
constexpr double kAtTheEdge = 1e-3;  // [mm]

double distance_from_loop(const Points& loop, const Vec3& x) {
  double least = kInfinity;
  for (Eigen::Index i = 0; i < loop.cols(); ++i) {
    const Vec3 a = loop.col(i), along = loop.col((i + 1) % loop.cols()) - a;
    const double part = std::clamp((x - a).dot(along) / std::max(along.squaredNorm(), 1e-12), 0.0, 1.0);
    least = std::min(least, (x - a - part * along).norm());
  }
  return least;
}

Vec3 to_ventricle(const SheetEvidence& ridge, const Points& annulus, const Vec3& normal, TrackOptions track) {
  double found[2];
  for (const int side : {0, 1}) {
    track.ventricle = side == 0 ? normal : Vec3(-normal);
    found[side] = evidence_on_side(ridge, annulus_ring(annulus, track.ventricle, kColumns), track);
  }
  return found[0] >= found[1] ? normal : Vec3(-normal);
}

Vec3 place_on(const LayerGrid& grid, const Eigen::MatrixXd& lengths, int column, double length) {
  int row = 0;
  while (row + 2 < grid.rows && lengths(row + 1, column) < length) ++row;
  const double span = std::max(lengths(row + 1, column) - lengths(row, column), 1e-9);
  const double part = std::clamp((length - lengths(row, column)) / span, 0.0, 1.0);
  return (1 - part) * grid.at(column, row) + part * grid.at(column, row + 1);
}

void write(std::ofstream& out, const void* data, size_t bytes) {
  out.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
}

void unroll(const std::filesystem::path& folder, const std::filesystem::path& output) {
  const Points annulus = annulus_curve(folder / "annulus.mrk.json");
  const Points edge = read_markups(folder / "free_edge.mrk.json").front().points;
  const TriangleMesh truth = read_mesh(folder / "surface.obj").mesh;
  const Volume volume = around_annulus(read_volume(folder / "image.nrrd").volume, annulus, std::nullopt);
  const AnnulusPlane plane = plane_of(annulus);
  const std::vector<double> scales = sheet_scales(volume);
  const SheetEvidence evidence = sheet_evidence(volume, scales),
                      ridge = sheet_evidence(volume, {scales.front()});
  TrackOptions track{.step = std::max(0.5, volume.spacing.maxCoeff()),
                     .greatest_length = kGreatestShare * plane.diameter};
  track.ventricle = to_ventricle(evidence, annulus, plane.normal, track);
  const Points ring = annulus_ring(annulus, track.ventricle, kColumns);
  LayerGrid grid = track_layer(ridge, ring, track);
  fit_layer(grid, ring, ridge, kSmoothing, 4);

  const Eigen::MatrixXf channels = layer_channels(volume, evidence, grid);
  const Eigen::MatrixXd lengths = lengths_along_columns(grid);
  const TriangleTree tree(truth.vertices, truth.triangles);
  std::vector<float> away, inside;
  for (int place = 0; place < channels.cols(); ++place) {
    const Vec3 x = place_on(grid, lengths, place % grid.columns, (place / grid.columns + 0.5) * kPlaceStep);
    const ClosestOnSurface foot = tree.closest(x);
    const double from_edge = distance_from_loop(edge, foot.point);
    away.push_back(static_cast<float>(std::sqrt(foot.distance_squared)));
    inside.push_back(static_cast<float>(from_edge > kAtTheEdge ? from_edge : -distance_from_loop(edge, x)));
  }
  std::ofstream out(output, std::ios::binary);
  const int sizes[3] = {static_cast<int>(channels.rows()), static_cast<int>(channels.cols()) / grid.columns,
                        grid.columns};
  write(out, sizes, sizeof sizes);
  write(out, channels.data(), sizeof(float) * static_cast<size_t>(channels.size()));
  write(out, away.data(), sizeof(float) * away.size());
  write(out, inside.data(), sizeof(float) * inside.size());
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "bench_edge_layers FOLDER_OF_OPEN_VALVE OUTPUT\n");
    return 2;
  }
  unroll(arguments[1], arguments[2]);
}
