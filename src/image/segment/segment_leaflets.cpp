#include "image/segment/segment_leaflets.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "image/segment/annulus_region.hpp"
#include "image/segment/centre_layer.hpp"
#include "image/segment/fit_layer.hpp"
#include "image/segment/free_edge.hpp"
#include "image/segment/leaflet_thickness.hpp"
#include "image/segment/track_layer.hpp"
#include "mesh/distance/intersections.hpp"
#include "mesh/remesh/round_triangles.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kColumnStep = 0.75;   // along the annulus [mm]
constexpr double kLeastRowStep = 0.5;  // and at least a voxel [mm]
constexpr int kFitRounds = 4;          // of measuring and fitting the layer by its ridge
constexpr double kShown = 0.3;         // evidence from which a place counts as shown
// What phantoms show beyond the noise of the fit: standard deviation of a place, in voxels.
constexpr double kPlaceNoise = 0.15;
constexpr double kLeastAngle = 20;    // below which the mesh is doubtful [degrees]
constexpr double kMostApart = 0.05;   // of the area, from which two routes do not agree
constexpr double kLittleShown = 0.7;  // of the area, below which the result is doubtful

bool is_route(SegmentMethod method) {
  return method == SegmentMethod::Ridge || method == SegmentMethod::Template;
}

bool can_be_learnt(const SegmentOptions& options) {
  return options.dynamic_range > 0 && !options.mask && is_route(options.method);
}

void check(const Volume& volume, const SegmentOptions& options) {
  std::vector<std::string> defects;
  if (options.annulus.cols() < 5)
    defects.push_back("the annulus has " + std::to_string(options.annulus.cols()) +
                      " points; at least 5 are needed, in their order around the ring");
  else if (!options.annulus.allFinite() || plane_of(options.annulus).diameter <= 0)
    defects.push_back("the annulus has a point that is no place, or no length");
  else if (!goes_round_once(options.annulus))
    defects.push_back(
        "the points of the annulus do not go round it once; draw it as a closed curve, from point to point");
  else if (std::isnan(sample(volume, options.annulus.rowwise().mean(), kNaN)))
    defects.push_back(
        "the middle of the annulus lies outside of the volume; are both in the same frame (LPS)?");
  if (!(options.dynamic_range >= 0 && options.dynamic_range <= 200))
    defects.push_back("the dynamic range is " + number_text(options.dynamic_range, 3) +
                      " dB; expected 0 (values that are linear) to 200");
  if (options.blur && !(*options.blur > 0 && *options.blur <= 5))
    defects.push_back("the blur is " + number_text(*options.blur, 3) + " mm; expected above 0 to 5");
  if (!(options.edge_length >= 0.3 && options.edge_length <= 5))
    defects.push_back("the edge length is " + number_text(options.edge_length, 3) + " mm; expected 0.3 to 5");
  if (!(options.smoothing >= 0.2 && options.smoothing <= 10))
    defects.push_back("the smoothing is " + number_text(options.smoothing, 3) + " mm; expected 0.2 to 10");
  if (options.has_second_route && !is_route(options.method))
    defects.push_back("only `ridge` and `template` are two routes to the same layer, that can be compared");
  if (options.edge == EdgeRule::Learnt && !can_be_learnt(options))
    defects.push_back(
        "the network that finds the free edge knows ultrasound alone: it needs a dynamic range, no mask, and "
        "the method `ridge`");
  if (!options.finder && (options.method == SegmentMethod::Template || options.has_second_route))
    defects.push_back("nobody said how the layer of a template is found");
  if (!defects.empty()) throw InputError(defects);
}

// Tells of a phase, and times it until the next.
class Phases {
 public:
  Phases(Segmentation& result, const SegmentOptions& options) : result_(result), options_(options) {}
  void begin(const std::string& phase) {
    timer_.reset();
    timer_.emplace(result_.times, phase);
    if (options_.on_phase) options_.on_phase(phase);
  }

 private:
  Segmentation& result_;
  const SegmentOptions& options_;
  std::optional<PhaseTimer> timer_;
};

Volume occupied_by_mask(const Volume& volume, const Volume& mask) {
  Volume occupied = volume_like(volume, 0);
  for (int k = 0; k < volume.size[2]; ++k)
    for (int j = 0; j < volume.size[1]; ++j)
      for (int i = 0; i < volume.size[0]; ++i)
        if (sample(mask, position_of(volume, Vec3(i, j, k)), 0) > 0.5)
          occupied.values[volume.voxel(i, j, k)] = 1;
  return occupied;
}

// The unit vector to the ventricle: as said, or to the side on which there are leaflets.
Vec3 side_of_ventricle(const SheetEvidence& evidence, const SegmentOptions& options,
                       const AnnulusPlane& plane, TrackOptions track) {
  if (options.ventricle)
    return (*options.ventricle - plane.middle).dot(plane.normal) < 0 ? Vec3(-plane.normal) : plane.normal;
  double found[2];
  for (const int side : {0, 1}) {
    track.ventricle = side == 0 ? plane.normal : Vec3(-plane.normal);
    found[side] =
        evidence_on_side(evidence, annulus_ring(options.annulus, track.ventricle, kColumnStep), track);
  }
  return found[0] >= found[1] ? plane.normal : Vec3(-plane.normal);
}

// Where no seeds are given the contours begin in the middle of the annulus, and below it in the ventricle.
BurlinaSegmentation burlina_pieces(const Volume& volume, const SegmentOptions& options,
                                   const AnnulusPlane& plane, TrackOptions track) {
  BurlinaOptions burlina{.inhibition = options.inhibition, .scale = sheet_scales(volume).front()};
  if (options.seeds) {
    burlina.atrium = options.seeds->col(0);
    burlina.ventricle = options.seeds->col(1);
    return segment_burlina_2010(volume, burlina);
  }
  burlina.atrium = plane.middle;
  const Vec3 down = side_of_ventricle(sheet_evidence(volume, sheet_scales(volume)), options, plane, track);
  burlina.ventricle = place_in_ventricle(without_speckle(volume), plane.middle, down, plane.diameter);
  return segment_burlina_2010(volume, burlina);
}

// What the sheet is looked for in: the volume, or what is leaflet by the mask, the threshold or Burlina's
// method.
Volume looked_at(const Volume& volume, const SegmentOptions& options, const AnnulusPlane& plane,
                 const TrackOptions& track, std::optional<double>& threshold, Segmentation& result) {
  if (options.mask) return occupied_by_mask(volume, *options.mask);
  if (options.method == SegmentMethod::Ridge || options.method == SegmentMethod::Template) return volume;
  if (options.method == SegmentMethod::Burlina2010) {
    result.burlina = burlina_pieces(volume, options, plane, track);
    return result.burlina->leaflets;
  }
  threshold = options.threshold ? *options.threshold : otsu_threshold(volume);
  return greatest_part(volume, *threshold);
}

// Row by row from the annulus.
FoundLayer followed_layer(const Volume& seen, const GreyScale& scale, const SheetEvidence& evidence,
                          const SheetEvidence& ridge, const SegmentOptions& options,
                          const TrackOptions& track, Phases& phases) {
  FoundLayer layer;
  const Points ring = annulus_ring(options.annulus, track.ventricle, kColumnStep);
  layer.grid = track_layer(ridge, ring, track);
  layer.fit = fit_layer(layer.grid, ring, ridge, options.smoothing, kFitRounds);
  phases.begin("free edge");
  const EdgeRule rule = options.edge.value_or(can_be_learnt(options) ? EdgeRule::Learnt : EdgeRule::Contrast);
  layer.edge = free_edge(seen, evidence, layer.grid, rule);
  phases.begin("middle of the layer");
  const LayerGrid by_ridge = layer.grid;
  layer.fit =
      centre_layer(layer.grid, layer.fit, layer.edge.lengths, ring, ridge, seen, scale, options.smoothing);
  layer.edge.lengths = lengths_at_same_places(layer.edge.lengths, by_ridge, layer.grid);
  if (layer.edge.clear.size() > 0)
    layer.edge.clear = lengths_at_same_places(layer.edge.clear, by_ridge, layer.grid);
  return layer;
}

// The points above the ends of the columns that the image shows.
std::vector<char> seen_points(const LayerGrid& grid, const LayerFit& fit, const Vector& ends) {
  const Eigen::MatrixXd lengths = lengths_along_columns(grid);
  std::vector<char> is_seen(static_cast<size_t>(grid.points.cols()));
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const Eigen::Index node = grid.node(column, row);
      is_seen[static_cast<size_t>(node)] = lengths(row, column) < ends[column] && fit.evidence[node] > kShown;
    }
  return is_seen;
}

// At vertices whose nodes count; NaN at others.
Vector over(Vector values, const LayerMesh& mesh, const std::vector<char>& is_counted) {
  for (Eigen::Index v = 0; v < values.size(); ++v)
    for (int k = 0; k < 3; ++k)
      if (!is_counted[static_cast<size_t>(mesh.nodes(k, v))]) values[v] = kNaN;
  return values;
}

// Over the points that count; over all where none does.
double mean_of(const Vector& values, const std::vector<char>& is_counted) {
  double sum = 0, count = 0;
  for (Eigen::Index node = 0; node < values.size(); ++node)
    if (is_counted[static_cast<size_t>(node)]) sum += values[node], ++count;
  return count > 0 ? sum / count : values.mean();
}

// From the middle of the sheet to where its values fall below the threshold, against the normal.
void move_to_atrium(LayerMesh& mesh, const LayerGrid& grid, const Volume& volume, double threshold) {
  constexpr double kStep = 0.1, kFarthest = 3;  // [mm]
  for (int v = 0; v < mesh.mesh.vertex_count(); ++v) {
    Vec3 normal = Vec3::Zero();
    for (int k = 0; k < 3; ++k) normal += mesh.weights(k, v) * grid.normals.col(mesh.nodes(k, v));
    normal.normalize();
    const Vec3 x = mesh.mesh.vertices.col(v);
    double before = sample(volume, x, kNaN);
    for (double t = kStep; t <= kFarthest && before >= threshold; t += kStep) {
      const double here = sample(volume, x - t * normal, kNaN);
      if (here < threshold) {
        const double part = (before - threshold) / (before - here);
        mesh.mesh.vertices.col(v) = x - (t - kStep + part * kStep) * normal;
        break;
      }
      before = here;
    }
  }
}

void add_warnings(Segmentation& result) {
  if (result.crossing_pairs > 0)
    result.warnings.push_back(
        "the leaflets pass through themselves: " + std::to_string(result.crossing_pairs) +
        (result.crossing_pairs == 1 ? " pair of triangles touches or passes"
                                    : " pairs of triangles touch or pass") +
        " through each other; `coapt import` takes such leaflets only where a short push parts them. Give a "
        "mask, or mend the mesh there");
  if (result.shown_share < kLittleShown)
    result.warnings.push_back("the image shows only " + number_text(100 * result.shown_share, 2) +
                              " % of the area of the leaflets; the rest follows from its neighbours");
  if (result.least_angle < kLeastAngle)
    result.warnings.push_back("the least angle of the mesh is " + number_text(result.least_angle, 3) +
                              " degrees, below " + number_text(kLeastAngle, 2));
  if (result.second_route && result.second_route->apart_share > kMostApart)
    result.warnings.push_back("the two routes to the leaflets lie farther apart than both say they may on " +
                              number_text(100 * result.second_route->apart_share, 2) +
                              " % of the area; look at second_route_mm in leaflets.vtp");
  if (result.second_route && result.second_route->has_edges_apart)
    result.warnings.push_back("the two routes to the leaflets end " +
                              number_text(result.second_route->free_edge, 2) +
                              " mm apart on average, more than both say they may; the free edge is in doubt");
  if (result.burlina && !result.burlina->is_done)
    result.warnings.push_back("the contours of the chambers still grew after " +
                              std::to_string(result.burlina->steps) + " steps");
  if (result.thickness_median <= 0)
    result.warnings.push_back("no thickness could be fitted; the valve states none");
}

// Eight bits are what ultrasound is kept in, its logarithm; CT and MR have more.
void warn_of_scale(const Volume& volume, const GreyScale& scale, Segmentation& result) {
  if (scale.is_logarithmic()) return;
  const bool has_eight_bits = std::all_of(volume.values.begin(), volume.values.end(), [](float value) {
    return value >= 0 && value <= 255 && value == std::floor(value);
  });
  if (has_eight_bits && *std::max_element(volume.values.begin(), volume.values.end()) > 100)
    result.warnings.push_back(
        "the image has whole values up to 255, as ultrasound has, and they were taken as linear: give the "
        "dynamic range (--dynamic-range 50, say) if they are decibels, or leaflets are found too thick");
}

// The deviation of each vertex along its normal.
Vector deviation_at(const LayerMesh& mesh, const LayerFit& fit, double voxel) {
  const double common = kPlaceNoise * voxel;
  return (at_vertices(mesh, fit.deviation).array().square() + common * common).sqrt();
}

void compare_routes(Segmentation& result, const FoundLayer& other, double edge_length, double voxel) {
  const LayerMesh mesh = layer_mesh(other.grid, other.edge.lengths, edge_length);
  const Valve& valve = result.valve;
  result.second_route =
      agreement_of({valve.leaflets, valve.free_edge, result.deviation, result.edge_deviation},
                   {mesh.mesh, mesh.free_edge, deviation_at(mesh, other.fit, voxel), other.edge.deviation});
}

void gather(Segmentation& result, const LayerMesh& mesh, const LayerFit& fit, double voxel) {
  result.valve.leaflets = mesh.mesh;
  result.valve.annulus = mesh.annulus;
  result.valve.free_edge = mesh.free_edge;
  result.valve.thickness = result.thickness_median;
  result.deviation = deviation_at(mesh, fit, voxel);
  result.evidence = at_vertices(mesh, fit.evidence);
  result.noise = fit.noise;
  result.noise_area = fit.noise_area;
  result.least_angle = least_angle(mesh.mesh);
  result.crossing_pairs =
      static_cast<int>(intersecting_pairs(mesh.mesh.vertices, mesh.mesh.triangles).size());
  const Vector areas = nodal_areas(mesh.mesh.vertices, mesh.mesh.triangles);
  double shown = 0;
  for (Eigen::Index v = 0; v < areas.size(); ++v)
    if (result.evidence[v] >= kShown) shown += areas[v];
  result.shown_share = shown / areas.sum();
}

}  // namespace

Segmentation segment_leaflets(const Volume& volume, const SegmentOptions& options) {
  check(volume, options);
  Segmentation result;
  const double cpu_start = cpu_seconds();
  Phases phases(result, options);
  const AnnulusPlane plane = plane_of(options.annulus);
  const auto [least, greatest] = std::minmax_element(volume.values.begin(), volume.values.end());
  const GreyScale scale{*greatest > *least ? options.dynamic_range / (*greatest - *least) : 0.0};

  phases.begin("evidence of sheets");
  const Volume part = around_annulus(volume, options.annulus, options.ventricle);
  result.size = part.size;
  std::optional<double> threshold;
  TrackOptions track{.step = std::max(kLeastRowStep, part.spacing.maxCoeff()),
                     .greatest_length = kGreatestShare * plane.diameter};
  const Volume seen = looked_at(part, options, plane, track, threshold, result);
  const bool is_image = !options.mask && is_route(options.method);
  const GreyScale scale_of_seen = is_image ? scale : GreyScale{};
  const std::vector<double> scales = sheet_scales(part);
  SheetEvidence evidence = sheet_evidence(seen, scales, is_image);
  // Greater scales see a leaflet and the chords beside it as one sheet.
  const SheetEvidence ridge = sheet_evidence(seen, {scales.front()}, is_image);

  phases.begin("layer from the annulus");
  track.ventricle = side_of_ventricle(evidence, options, plane, track);
  const auto fitted = [&] {
    return options.finder({seen, evidence, ridge, options.annulus, track.ventricle, options.smoothing});
  };
  const auto followed = [&] {
    return followed_layer(seen, scale_of_seen, evidence, ridge, options, track, phases);
  };
  const bool is_fitted = options.method == SegmentMethod::Template;
  const auto [grid, fit, edge] = is_fitted ? fitted() : followed();
  const bool has_clear_part = edge.clear.size() > 0;
  const std::vector<char> is_seen = seen_points(grid, fit, has_clear_part ? edge.clear : edge.lengths);
  const Vector blur = blur_across(part, grid, is_seen, options.blur, scale);
  result.blur = mean_of(blur, is_seen);
  result.edge_deviation = edge.deviation;
  result.contrast = edge.contrast;

  phases.begin("mesh");
  LayerMesh mesh = layer_mesh(grid, edge.lengths, options.edge_length);

  phases.begin("thickness");
  result.thickness = thickness_at_vertices(part, grid, mesh, blur, median_of_finite(fit.deviation), scale);
  result.thickness_median =
      median_of_finite(has_clear_part ? over(result.thickness, mesh, is_seen) : result.thickness);
  if (threshold) move_to_atrium(mesh, grid, part, *threshold);
  gather(result, mesh, fit, part.spacing.maxCoeff());
  if (options.has_second_route) {
    phases.begin("second route");
    compare_routes(result, is_fitted ? followed() : fitted(), options.edge_length, part.spacing.maxCoeff());
  }
  if (options.keeps_evidence) result.strength = std::move(evidence.strength);
  warn_of_scale(volume, scale, result);
  add_warnings(result);
  result.cpu_seconds = cpu_seconds() - cpu_start;
  return result;
}

}  // namespace coapt
