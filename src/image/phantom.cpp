#include "image/phantom.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "image/detail/beam_field.hpp"
#include "image/detail/echoes.hpp"
#include "image/detail/heart_walls.hpp"
#include "image/detail/phantom_labels.hpp"
#include "image/detail/valve_frame.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace coapt {
namespace {

constexpr double kMostPhantomVoxels = 5e8;  // of a grid
constexpr double kNearest = 2;              // from the probe to the grid [mm]
constexpr double kWhite = 63.2;  // amplitude that is shown white: 36 dB above blood, 6 dB above leaflets

void check_phantom_options(const PhantomOptions& options) {
  const auto refuse = [](const std::string& what, double value) {
    throw InputError(what + " of a phantom cannot be " + number_text(value));
  };
  for (const auto& [name, value] : {std::pair{"the edge of the voxels", options.voxel},
                                    {"the axial spread", options.axial},
                                    {"the lateral spread", options.lateral},
                                    {"the thickness of the leaflets", options.thickness},
                                    {"the dynamic range", options.dynamic_range},
                                    {"the distance of the probe", options.probe_distance}})
    if (!(value > 0 && std::isfinite(value))) refuse(name, value);
  for (const auto& [name, value] :
       {std::pair{"the thickness of the walls", options.wall}, {"the margin", options.margin}})
    if (!(value >= 0 && std::isfinite(value))) refuse(name, value);
  if (!(options.dropout >= 0 && options.dropout <= 0.9)) refuse("the share of dropout", options.dropout);
  if (!(options.sector > 0 && options.sector < 180)) refuse("the opening of the sector", options.sector);
  if (options.shadows < 0) refuse("the number of shadows", options.shadows);
}

Points nodes_of(const PhantomValve& valve) {
  Points nodes(3, valve.surface.vertices.cols() + valve.line_ends.cols());
  nodes << valve.surface.vertices, valve.line_ends;
  return nodes;
}

struct BeamRange {
  Vec3 low, high;
};

// Of all beams within the sector that meet the grid.
BeamRange beams_of(const Volume& grid, const Probe& probe, double sector) {
  BeamRange range{Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
  Vec3 nearest = Vec3::Constant(kInfinity), farthest = Vec3::Constant(-kInfinity);
  const Vec3 last(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1);
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at = position_of(grid, last.cwiseProduct(Vec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1)));
    const Vec3 beam = probe.beam_of(at), along = probe.axes.transpose() * (at - probe.position);
    range.low = range.low.cwiseMin(beam);
    range.high = range.high.cwiseMax(beam);
    nearest = nearest.cwiseMin(along);
    farthest = farthest.cwiseMax(along);
  }
  range.low.z() = Vec3::Zero().cwiseMax(nearest).cwiseMin(farthest).norm();
  const double half = sector / 2 * std::numbers::pi / 180;
  for (int axis = 0; axis < 2; ++axis) {
    range.low[axis] = std::clamp(range.low[axis], -half, half);
    range.high[axis] = std::clamp(range.high[axis], -half, half);
  }
  return range;
}

std::vector<BrightSpot> spots_of(const PhantomPattern& pattern, const TriangleMesh& surface) {
  std::vector<BrightSpot> spots;
  for (const PhantomPattern::Spot& spot : pattern.spots) {
    const Eigen::Vector3i corners = surface.triangles.col(spot.triangle);
    Vec3 at = Vec3::Zero();
    for (int corner = 0; corner < 3; ++corner)
      at += spot.weights[corner] * surface.vertices.col(corners[corner]);
    spots.push_back({at, spot.radius});
  }
  return spots;
}

Volume envelope_on(const Volume& grid, const BeamField& field, const Probe& probe, const BeamRange& range) {
  Volume envelope = volume_like(grid, 0);
  for (int k = 0; k < grid.size[2]; ++k)
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i) {
        const Vec3 beam = probe.beam_of(position_of(grid, Vec3(i, j, k)));
        const bool is_seen = beam.x() >= range.low.x() && beam.x() <= range.high.x() &&
                             beam.y() >= range.low.y() && beam.y() <= range.high.y();
        if (is_seen) envelope.values[envelope.voxel(i, j, k)] = field.envelope(field.cell(beam));
      }
  return envelope;
}

Volume grey_values(const Volume& envelope, double dynamic_range) {
  Volume image = envelope;
  for (float& value : image.values) {
    const double decibels = value > 0 ? 20 * std::log10(value / kWhite) : -kInfinity;
    value = static_cast<float>(std::nearbyint(std::clamp(255 * (1 + decibels / dynamic_range), 0.0, 255.0)));
  }
  return image;
}

}  // namespace

Vec3 upstream_direction(const TriangleMesh& open, const std::vector<int>& annulus) {
  Points loop(3, static_cast<Eigen::Index>(annulus.size()));
  for (std::size_t k = 0; k < annulus.size(); ++k)
    loop.col(static_cast<Eigen::Index>(k)) = open.vertices.col(annulus[k]);
  Vec3 across = polygon_normal(loop).normalized(), normals = Vec3::Zero(), centroid = Vec3::Zero();
  double area = 0;
  for (const auto& t : open.triangles.colwise()) {
    const Vec3 vector = area_vector(open.vertices, t);
    normals += vector;
    area += vector.norm();
    centroid +=
        vector.norm() / 3 * (open.vertices.col(t[0]) + open.vertices.col(t[1]) + open.vertices.col(t[2]));
  }
  const double below = area > 0 ? across.dot(loop.rowwise().mean() - centroid / area) : 0;
  const bool is_flat = std::abs(below) < 1e-6 * bounding_box_diagonal(open.vertices);
  return (is_flat ? across.dot(normals) : below) < 0 ? Vec3(-across) : across;
}

Vec3 probe_position(const PhantomValve& valve, const PhantomOptions& options) {
  if (options.probe) return *options.probe;
  const ValveFrame frame = valve_frame(valve.surface.vertices, valve.annulus, valve.upstream);
  return frame.centre + options.probe_distance * frame.axes.col(2);
}

Volume phantom_grid(const std::vector<PhantomValve>& states, const PhantomOptions& options) {
  check_phantom_options(options);
  const PhantomValve& first = states.front();
  const ValveFrame frame = valve_frame(first.surface.vertices, first.annulus, first.upstream);
  Volume grid;
  const Vec3 probe = probe_position(first, options);
  const Vec3 beam = (frame.centre - probe).normalized();
  const Vec3 aside = std::abs(beam.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  grid.direction.col(0) = (aside - aside.dot(beam) * beam).normalized();
  grid.direction.col(1) = beam.cross(grid.direction.col(0));
  grid.direction.col(2) = beam;
  grid.spacing = Vec3::Constant(options.voxel);
  Vec3 low = Vec3::Constant(kInfinity), high = Vec3::Constant(-kInfinity);
  for (const PhantomValve& state : states) {
    const Points nodes = grid.direction.transpose() * nodes_of(state);
    low = low.cwiseMin(nodes.rowwise().minCoeff());
    high = high.cwiseMax(nodes.rowwise().maxCoeff());
  }
  low.array() -= options.margin;
  high.array() += options.margin;
  double voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double count = std::ceil((high[axis] - low[axis]) / options.voxel) + 1;
    voxels *= count;
    if (!(voxels <= kMostPhantomVoxels))
      throw InputError("the image would have more than " + number_text(kMostPhantomVoxels) +
                       " voxels; choose greater ones, or a smaller margin");
    grid.size[static_cast<std::size_t>(axis)] = static_cast<int>(count);
  }
  if (!(low.z() - beam.dot(probe) > kNearest))
    throw InputError("the probe lies within the image or behind it; put it farther from the valve");
  grid.origin = grid.direction * low;
  grid.values.assign(static_cast<std::size_t>(voxels), 0);
  return grid;
}

Phantom make_phantom(const PhantomValve& valve, const PhantomPattern& pattern, const Volume& grid,
                     const PhantomOptions& options, int state) {
  check_phantom_options(options);
  const ValveFrame frame = valve_frame(valve.surface.vertices, valve.annulus, valve.upstream);
  const HeartWalls walls(frame, valve, options);
  const Probe probe{probe_position(valve, options),
                    grid.direction};  // the beams run along the grid's last axis
  const BeamRange range = beams_of(grid, probe, options.sector);
  const double depth = (frame.centre - probe.position).norm(), angle = options.lateral / depth / 2;
  BeamField field(range.low, range.high, Vec3(angle, angle, options.axial / 2));
  const std::vector<BrightSpot> spots = spots_of(pattern, valve.surface);
  const EchoScene scene{valve, options, probe, pattern.dropouts, spots, depth, state};
  add_tissue(scene, walls, field);
  add_leaflets(scene, field);
  add_chords(scene, field);
  cast_shadows(scene, field);
  field.spread();
  Phantom phantom;
  phantom.envelope = envelope_on(grid, field, probe, range);
  phantom.image = grey_values(phantom.envelope, options.dynamic_range);
  phantom.labels = phantom_labels(valve, frame, walls, grid, options.thickness);
  return phantom;
}

std::vector<FreeRim> free_rims(const TriangleMesh& surface, const std::vector<int>& annulus) {
  std::vector<char> is_on_annulus(static_cast<std::size_t>(surface.vertex_count()), 0);
  for (const int v : annulus) is_on_annulus[static_cast<std::size_t>(v)] = 1;
  const auto is_fixed = [&](int v) { return is_on_annulus[static_cast<std::size_t>(v)] != 0; };
  std::vector<FreeRim> rims;
  for (std::vector<int> loop : boundary_loops(surface.triangles)) {
    const auto start = std::find_if(loop.begin(), loop.end(), is_fixed);
    if (start == loop.end()) {
      rims.push_back({loop, true});
      continue;
    }
    std::rotate(loop.begin(), start, loop.end());
    loop.push_back(loop.front());
    FreeRim rim;  // from one vertex of the annulus to the next, both included
    for (const int v : loop) {
      rim.vertices.push_back(v);
      if (!is_fixed(v)) continue;
      if (rim.vertices.size() > 2) rims.push_back(rim);
      rim.vertices = {v};
    }
  }
  return rims;
}

}  // namespace coapt
