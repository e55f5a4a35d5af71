#include "image/segment/fit_layer.hpp"

#include "core/random_source.hpp"
#include "image/segment/gap_deviation.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace coapt {
namespace {

constexpr double kRidgeReach = 1.25;    // to both sides of the layer in which the ridge is sought [mm]
constexpr double kRidgeStep = 0.25;     // [mm]
constexpr double kNearRidge = 0.7;      // places are preferred that lie nearer than this [mm]
constexpr double kOutlyingRidge = 0.5;  // residual from which a place counts less [mm]
constexpr double kAnnulusNoise = 0.5;   // to which the annulus is taken to be where it was given [mm]
constexpr double kSomeEvidence = 0.3;   // weight from which residuals are counted as noise
constexpr int kPosteriorSamples = 200;  // of the posterior
constexpr int kNoiseLags = 6;           // rows and columns over which noise is taken to be correlated

using Sparse = Eigen::SparseMatrix<double>;

struct Measured {
  Vector offsets, weights;  // of the ridge along the normal [mm], and how far it is believed
};

Measured measure(const LayerGrid& grid, const SheetEvidence& evidence) {
  const int half = static_cast<int>(kRidgeReach / kRidgeStep);
  Measured measured{Vector::Zero(grid.points.cols()), Vector::Zero(grid.points.cols())};
  std::vector<double> profile(static_cast<size_t>(2 * half + 1));
  for (Eigen::Index node = 0; node < grid.points.cols(); ++node) {
    const Vec3 x = grid.points.col(node), normal = grid.normals.col(node);
    int best = -1;
    double greatest = 0;
    for (int k = 0; k <= 2 * half; ++k) {
      const double offset = (k - half) * kRidgeStep;
      const double value = sheet_strength(evidence, x + offset * normal, normal);
      profile[static_cast<size_t>(k)] = value;
      const double preferred = value * std::exp(-0.5 * offset * offset / (kNearRidge * kNearRidge));
      if (preferred <= greatest) continue;
      greatest = preferred;
      best = k;
    }
    if (best <= 0 || best >= 2 * half) continue;
    const auto at = static_cast<size_t>(best);
    const double before = profile[at - 1], here = profile[at], after = profile[at + 1];
    const double bend = before - 2 * here + after;
    const double shift = bend < 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
    measured.offsets[node] = (best - half + shift) * kRidgeStep;
    measured.weights[node] = std::min(here, 1.0) * std::min(here, 1.0);
  }
  return measured;
}

// In the place of the ridge, where they are told.
void take(const Vector& places, Measured& measured) {
  for (Eigen::Index node = 0; node < places.size(); ++node)
    if (std::isfinite(places[node])) measured.offsets[node] = places[node];
}

// The curvature at a node as a linear function of how far the nodes go along their normals: sum of the
// coefficients times these, plus `now`.
struct CurvatureRow {
  std::vector<std::pair<Eigen::Index, double>> coefficients;
  double now = 0;
};

CurvatureRow curvature_row(const LayerGrid& grid, Eigen::Index centre,
                           const std::vector<std::pair<Eigen::Index, double>>& stencil, double factor) {
  CurvatureRow row;
  const Vec3 normal = grid.normals.col(centre);
  for (const auto& [node, weight] : stencil) {
    row.coefficients.emplace_back(node, factor * weight * normal.dot(grid.normals.col(node)));
    row.now += factor * weight * normal.dot(grid.points.col(node));
  }
  return row;
}

// Of a node: along the ring, along the column, and the twist.
std::vector<CurvatureRow> curvature_rows(const LayerGrid& grid, int column, int row) {
  const auto node = [&](int c, int r) { return grid.node(column + c, row + r); };
  const Eigen::Index centre = node(0, 0);
  const double around = 0.5 * (grid.at(column + 1, row) - grid.at(column - 1, row)).norm();
  std::vector<CurvatureRow> rows;
  rows.push_back(curvature_row(grid, centre, {{node(-1, 0), 1.0}, {centre, -2.0}, {node(1, 0), 1.0}},
                               1 / (around * around)));
  if (row == 0 || row == grid.rows - 1) return rows;
  const double along = 0.5 * (grid.at(column, row + 1) - grid.at(column, row - 1)).norm();
  rows.push_back(curvature_row(grid, centre, {{node(0, -1), 1.0}, {centre, -2.0}, {node(0, 1), 1.0}},
                               1 / (along * along)));
  rows.push_back(curvature_row(
      grid, centre, {{node(1, 1), 1.0}, {node(-1, -1), 1.0}, {node(1, -1), -1.0}, {node(-1, 1), -1.0}},
      std::sqrt(2.0) / (4 * around * along)));
  return rows;
}

struct PlateSystem {
  Sparse matrix;
  Vector right;
};

PlateSystem plate_system(const LayerGrid& grid, double smoothing) {
  const Eigen::Index n = grid.points.cols();
  const Vector areas = node_areas(grid);
  const double stiffness = std::pow(smoothing, 4);
  std::vector<Eigen::Triplet<double>> entries;
  PlateSystem system{Sparse(n, n), Vector::Zero(n)};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const double weight = stiffness * areas[grid.node(column, row)];
      for (const CurvatureRow& bend : curvature_rows(grid, column, row))
        for (const auto& [a, alpha] : bend.coefficients) {
          system.right[a] -= weight * alpha * bend.now;
          for (const auto& [b, beta] : bend.coefficients)
            entries.emplace_back(static_cast<int>(a), static_cast<int>(b), weight * alpha * beta);
        }
    }
  system.matrix.setFromTriplets(entries.begin(), entries.end());
  return system;
}

// Lowers the weights of what lies far from the layer as it is.
void lower_outliers(Measured& measured, const Vector& residuals) {
  measured.weights.array() /= 1 + (residuals.array() / kOutlyingRidge).square();
}

// Variance of the residuals, and the area over which they go together.
void estimate_noise(const LayerGrid& grid, const Vector& residuals, const Vector& weights, LayerFit& fit) {
  const auto is_counted = [&](Eigen::Index node) { return weights[node] >= kSomeEvidence; };
  const auto product = [&](int columns, int rows) {
    double sum = 0;
    int count = 0;
    for (int row = std::max(0, -rows); row < std::min(grid.rows, grid.rows - rows); ++row)
      for (int column = 0; column < grid.columns; ++column) {
        const Eigen::Index a = grid.node(column, row), b = grid.node(column + columns, row + rows);
        if (!is_counted(a) || !is_counted(b)) continue;
        sum += residuals[a] * residuals[b];
        ++count;
      }
    return count > 0 ? sum / count : 0.0;
  };
  const double variance = product(0, 0);
  fit.noise = std::sqrt(variance);
  double together = 0;
  for (int rows = -kNoiseLags; rows <= kNoiseLags; ++rows)
    for (int columns = -kNoiseLags; columns <= kNoiseLags; ++columns)
      together += std::max(product(columns, rows) / std::max(variance, 1e-12), 0.0);
  fit.noise_area = std::max(together, 1.0) * node_areas(grid).mean();
}

// Diagonal of the inverse by samples of the distribution that the matrix is the precision of.
Vector sampled_variances(const Eigen::SimplicialLLT<Sparse>& factor, Eigen::Index n) {
  RandomSource random(1);
  Vector sum = Vector::Zero(n), z(n);
  for (int sample = 0; sample < kPosteriorSamples; ++sample) {
    for (Eigen::Index i = 0; i < n; ++i) {  // Box and Muller 1958
      const double radius = std::sqrt(-2 * std::log(1 - random.unit()));
      z[i] = radius * std::cos(2 * std::numbers::pi * random.unit());
    }
    const Vector drawn = factor.permutationPinv() * factor.matrixU().solve(z);
    sum.array() += drawn.array().square();
  }
  return sum / kPosteriorSamples;
}

}  // namespace

LayerFit fit_layer(LayerGrid& grid, const Points& annulus, const SheetEvidence& evidence, double smoothing,
                   int rounds, const PlacesAcross& places) {
  LayerFit fit;
  Eigen::SimplicialLLT<Sparse> factor;
  Vector moved = Vector::Zero(grid.points.cols());
  for (int round = 0; round < rounds; ++round) {
    Measured measured = measure(grid, evidence);
    fit.evidence = measured.weights.cwiseSqrt();
    if (places) take(places(grid), measured);
    fit.measured = grid.points + grid.normals * measured.offsets.asDiagonal();
    lower_outliers(measured, measured.offsets);
    PlateSystem system = plate_system(grid, smoothing);
    const Vector areas = node_areas(grid);
    for (int column = 0; column < grid.columns; ++column) {
      const Vec3 back = annulus.col(column) - grid.points.col(column);
      measured.offsets[column] = back.dot(grid.normals.col(column));
      measured.weights[column] = 1 / (kAnnulusNoise * kAnnulusNoise);
    }
    Vector diagonal = areas.cwiseProduct(measured.weights);
    diagonal.array() += 1e-9;  // a point without evidence or curvature stays
    for (Eigen::Index node = 0; node < diagonal.size(); ++node)
      system.matrix.coeffRef(node, node) += diagonal[node];
    factor.compute(system.matrix);
    moved = factor.solve(system.right + diagonal.cwiseProduct(measured.offsets));
    for (Eigen::Index node = 0; node < moved.size(); ++node)
      grid.points.col(node) += moved[node] * grid.normals.col(node);
    update_normals(grid);
    if (round < rounds - 1) continue;
    Vector counted = measured.weights;
    counted.head(grid.columns).setZero();
    estimate_noise(grid, measured.offsets - moved, counted, fit);
    const Vector of_noise = fit.noise * fit.noise * fit.noise_area * sampled_variances(factor, moved.size());
    fit.deviation = (of_noise + gap_deviation(grid, fit.evidence).cwiseAbs2()).cwiseSqrt();
  }
  return fit;
}

}  // namespace coapt
