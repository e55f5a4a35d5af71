#include "image/template/fit_template.hpp"

#include "core/error.hpp"
#include "image/segment/leaflet_thickness.hpp"
#include "image/segment/track_layer.hpp"
#include "image/template/given_template.hpp"
#include "image/template/sheet_potential.hpp"
#include "image/template/template_deviation.hpp"
#include "image/template/template_energy.hpp"
#include "image/template/template_grid.hpp"
#include "optim/newton.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kCost = 0.55;      // of area: the strength at which a leaflet ends, as a share of leaflets'
constexpr double kFirstCost = 0.7;  // in the unit of the evidence, before that is known
constexpr double kMembrane = 0.1;   // against strain within one round
constexpr double kTension = 0.5;    // of the free edge [mm]
constexpr double kFineShare = 0.5;  // of the finest scale in the last evidence
// Plate stiffness over the fourth power of the smoothing: the potential of a sheet is 0.78 d^2 at a distance
// of d mm, and shapes below the smoothing are to cost more than that.
constexpr double kBending = 1.5;
constexpr double kCoarseBending = 4;                                  // times that in coarse rounds
constexpr double kFirstStep = 3, kCoarseStep = 2.4, kFineStep = 1.2;  // between points [mm]
constexpr int kFunnelRows = 9;                                        // of the first shape
// Rounds that draw the template to the sheet and leave its size alone; and of each stage after, at most.
constexpr int kDrawnRounds = 2, kMostRounds = 8;
constexpr double kEdgeAtRest = 0.15;  // mean way of the edge in a round, in steps, after which none follows
constexpr double kTolerance = 1e-3;   // of a round, relative residual
constexpr int kMostIterations = 25;   // of a round
constexpr double kLevelFrom = 2, kLevelTo = 6, kLevelReach = 1;  // where leaflets show their strength [mm]
constexpr int kRowsBeyond = 2;                                   // the edge

struct Stage {
  TemplateEnergy energy;
  double step;
  int rounds;
};

int rows_for(const LayerGrid& grid, double step) {
  const Eigen::MatrixXd lengths = lengths_along_columns(grid);
  return std::max(5, static_cast<int>(std::lround(lengths.row(grid.rows - 1).mean() / step)) + 1);
}

void minimise(LayerGrid& grid, Objective& objective) {
  const auto solver = make_newton();
  const Result result = solve(*solver, {objective, objective.unknowns()},
                              {.tolerance = kTolerance, .max_iterations = kMostIterations});
  grid.points = objective.positions(result.q);
  update_normals(grid);
}

// Returns the objective of the last round.
std::unique_ptr<Objective> run_stage(LayerGrid& grid, const LayerImage& image, const Stage& stage) {
  const Points ring = annulus_ring(image.annulus, image.ventricle, stage.step);
  std::unique_ptr<Objective> objective;
  for (int round = 0; round < stage.rounds; ++round) {
    grid = resampled(grid, ring, rows_for(grid, stage.step));
    const LayerGrid before = grid;
    objective = template_objective(grid, stage.energy);
    minimise(grid, *objective);
    const double way = (grid.points - before.points).rightCols(grid.columns).colwise().norm().mean();
    if (way < kEdgeAtRest * stage.step) break;
  }
  return objective;
}

// The strength of leaflets: the middle one of the greatest across the template, some millimetres from the
// annulus.
double leaflet_level(const LayerGrid& grid, const SheetEvidence& evidence) {
  constexpr double kLook = 0.25;  // [mm]
  const Eigen::MatrixXd lengths = lengths_along_columns(grid);
  Vector found = Vector::Constant(grid.points.cols(), kNaN);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      if (lengths(row, column) < kLevelFrom || lengths(row, column) > kLevelTo) continue;
      const Vec3 x = grid.at(column, row), normal = grid.normals.col(grid.node(column, row));
      double most = 0;
      for (double t = -kLevelReach; t <= kLevelReach; t += kLook)
        most = std::max(most, sheet_strength(evidence, x + t * normal, normal));
      if (most > 0) found[grid.node(column, row)] = most;
    }
  const double level = median_of_finite(found);
  if (level == 0)
    throw InputError(
        "no sheet hangs from the annulus that a template could be drawn to; is the annulus that of this "
        "volume?");
  return level;
}

// A weighted sum of two evidences on one grid.
Volume mixed(const Volume& a, double of_a, const Volume& b, double of_b) {
  Volume sum = a;
  for (size_t voxel = 0; voxel < sum.values.size(); ++voxel)
    sum.values[voxel] = static_cast<float>(of_a * a.values[voxel] + of_b * b.values[voxel]);
  return sum;
}

// Columns go on straight beyond the edge.
LayerGrid longer(const LayerGrid& grid) {
  LayerGrid result = grid;
  result.rows += kRowsBeyond;
  result.points.conservativeResize(3, result.rows * grid.columns);
  for (int column = 0; column < grid.columns; ++column) {
    const Vec3 end = grid.at(column, grid.rows - 1), step = end - grid.at(column, grid.rows - 2);
    for (int k = 0; k < kRowsBeyond; ++k)
      result.points.col(result.node(column, grid.rows + k)) = end + (k + 1) * step;
  }
  update_normals(result);
  return result;
}

Vector longer(const Vector& values, int columns) {
  Vector result(values.size() + kRowsBeyond * columns);
  result << values, values.tail(columns).replicate(kRowsBeyond, 1);
  return result;
}

Vector evidence_on(const LayerGrid& grid, const SheetEvidence& evidence) {
  Vector found(grid.points.cols());
  for (Eigen::Index node = 0; node < found.size(); ++node)
    found[node] = std::min(1.0, sheet_strength(evidence, grid.points.col(node), grid.normals.col(node)));
  return found;
}

// What the values on the layer exceed those on its darker side by, in the middle.
double contrast_of(const Volume& volume, const LayerGrid& grid) {
  constexpr double kBeside = 2;  // [mm]
  Vector found(grid.points.cols());
  for (Eigen::Index node = 0; node < found.size(); ++node) {
    const Vec3 x = grid.points.col(node), aside = kBeside * grid.normals.col(node);
    found[node] =
        sample(volume, x, kNaN) - std::min(sample(volume, x + aside, kNaN), sample(volume, x - aside, kNaN));
  }
  return median_of_finite(found);
}

}  // namespace

FoundLayer fit_template(const LayerImage& image, const TemplateOptions& options) {
  const Points first_ring = annulus_ring(image.annulus, image.ventricle, kFirstStep);
  const SplineField first = sheet_potential(image.evidence.strength);
  LayerGrid grid = options.shape
                       ? given_template(*options.shape, first_ring, image.ventricle, first, kFirstCost)
                       : funnel(first_ring, image.ventricle, first, kFirstCost, kFunnelRows);
  const double bending = kBending * std::pow(image.smoothing, 4), stiff = kCoarseBending * bending;
  run_stage(grid, image, {{first, kFirstCost, 0, kMembrane, stiff, 0}, kCoarseStep, kDrawnRounds});

  const Volume &all = image.evidence.strength, &finest = image.ridge.strength;
  const double of_all = 1 / leaflet_level(grid, image.evidence),
               of_finest = 1 / leaflet_level(grid, image.ridge);
  const SplineField coarse = sheet_potential(mixed(all, of_all, finest, 0));
  run_stage(grid, image, {{coarse, kCost, 1, kMembrane, stiff, kTension}, kCoarseStep, kMostRounds});
  const SplineField fine =
      sheet_potential(mixed(all, (1 - kFineShare) * of_all, finest, kFineShare * of_finest));
  const std::unique_ptr<Objective> objective =
      run_stage(grid, image, {{fine, kCost, 1, kMembrane, bending, kTension}, kFineStep, kMostRounds});

  TemplateDeviation known = template_deviation(grid, *objective, fine, evidence_on(grid, image.ridge));
  FoundLayer found;
  found.edge = {lengths_along_columns(grid).row(grid.rows - 1).transpose(), known.free_edge,
                contrast_of(image.volume, grid)};
  found.grid = longer(grid);
  found.fit = std::move(known.fit);
  found.fit.deviation = longer(found.fit.deviation, grid.columns);
  found.fit.evidence = longer(found.fit.evidence, grid.columns);
  return found;
}

LayerFinder template_finder(const TemplateOptions& options) {
  return [options](const LayerImage& image) { return fit_template(image, options); };
}

}  // namespace coapt
