#include "image/template/template_deviation.hpp"

#include "image/segment/gap_deviation.hpp"
#include "linear/factorisation.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kSomeEvidence = 0.3;  // from which a ridge is measured
constexpr double kFarthestRidge = 1;   // [mm]
constexpr int kNoiseLags = 6;          // rows and columns over which noise is taken to be correlated

// Of the ridge beside each point; NaN where there is none to measure.
struct RidgeNoise {
  Vector offsets;   // [mm]
  double bend = 0;  // mean second derivative of the potential across it [1/mm^2]
};

RidgeNoise ridge_noise(const LayerGrid& grid, const SplineField& potential, const Vector& evidence) {
  RidgeNoise noise{Vector::Constant(grid.points.cols(), kNaN)};
  int count = 0;
  for (Eigen::Index node = grid.columns; node < grid.points.cols(); ++node) {
    if (evidence[node] < kSomeEvidence) continue;
    Vec3 slope;
    Eigen::Matrix3d bend;
    potential.at(grid.points.col(node), &slope, &bend);
    const Vec3 normal = grid.normals.col(node);
    const double across = normal.dot(bend * normal);
    if (!(across > 0) || std::abs(normal.dot(slope)) > kFarthestRidge * across) continue;
    noise.offsets[node] = -normal.dot(slope) / across;
    noise.bend += across;
    ++count;
  }
  noise.bend /= std::max(count, 1);
  return noise;
}

// The mean product of the offsets of points that lie so far apart.
double product_at(const LayerGrid& grid, const Vector& offsets, int columns, int rows) {
  double sum = 0;
  int count = 0;
  for (int row = std::max(0, -rows); row < std::min(grid.rows, grid.rows - rows); ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const double product =
          offsets[grid.node(column, row)] * offsets[grid.node(column + columns, row + rows)];
      if (std::isnan(product)) continue;
      sum += product;
      ++count;
    }
  return count > 0 ? sum / count : 0;
}

void measure_noise(const LayerGrid& grid, const Vector& offsets, LayerFit& fit) {
  const double variance = product_at(grid, offsets, 0, 0);
  double together = 0;
  for (int rows = -kNoiseLags; rows <= kNoiseLags; ++rows)
    for (int columns = -kNoiseLags; columns <= kNoiseLags; ++columns)
      together += std::max(product_at(grid, offsets, columns, rows) / std::max(variance, 1e-12), 0.0);
  fit.noise = std::sqrt(variance);
  fit.noise_area = std::max(together, 1.0) * node_areas(grid).mean();
}

// A factor of the Hessian without its negative curvatures; a node that nothing holds gets a trace of its own.
std::unique_ptr<Factorisation> factor_at(Objective& objective, const Vector& q) {
  Vector gradient;
  SparseMatrix hessian;
  objective.hessian(q, gradient, hessian, Projection::PositiveSemidefinite);
  std::unique_ptr<Factorisation> factor = make_multifrontal_factorisation();
  factor->analyse(hessian);
  const double mean = hessian.diagonal().mean();
  for (double shift = 1e-9 * mean; shift < mean; shift *= 10) {
    for (Eigen::Index k = 0; k < hessian.rows(); ++k) hessian.coeffRef(k, k) += shift;
    if (factor->factorise(hessian)) return factor;
  }
  return nullptr;
}

}  // namespace

TemplateDeviation template_deviation(const LayerGrid& grid, Objective& objective,
                                     const SplineField& potential, Vector evidence) {
  TemplateDeviation result;
  LayerFit& fit = result.fit;
  fit.evidence = std::move(evidence);
  const RidgeNoise noise = ridge_noise(grid, potential, fit.evidence);
  measure_noise(grid, noise.offsets, fit);
  const double unit = fit.noise * fit.noise * fit.noise_area * noise.bend;
  fit.deviation = gap_deviation(grid, fit.evidence).cwiseAbs2();
  const std::unique_ptr<Factorisation> factor = factor_at(objective, objective.unknowns(grid.points));
  if (factor != nullptr) {
    Vector right = Vector::Zero(objective.unknown_count()), solved;
    const auto variance = [&](Eigen::Index node, const Vec3& direction) {
      const Eigen::Index first = 3 * (node - grid.columns);
      right.segment<3>(first) = direction;
      factor->solve(right, solved);
      right.segment<3>(first).setZero();
      return unit * direction.dot(solved.segment<3>(first));
    };
    for (Eigen::Index node = grid.columns; node < grid.points.cols(); ++node)
      fit.deviation[node] += variance(node, grid.normals.col(node));
    for (int column = 0; column < grid.columns; ++column)
      result.free_edge +=
          variance(grid.node(column, grid.rows - 1),
                   (grid.at(column, grid.rows - 1) - grid.at(column, grid.rows - 2)).normalized()) /
          grid.columns;
  }
  fit.deviation = fit.deviation.cwiseSqrt();
  result.free_edge = std::sqrt(result.free_edge);
  return result;
}

}  // namespace coapt
