#include "energy/film_net.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace coapt {
namespace {

constexpr double kHeld = 1e-11;         // least pivot over the greatest, of a net that something holds
constexpr int kMostLessenings = 8;      // of the area
constexpr double kLittleGain = 2e-3;    // of the area in one of them
constexpr double kLeastTriangle = 0.1;  // of a triangle's area before
constexpr int kRoundings = 12;          // steps of the flow by mean curvature
constexpr double kRounding = 0.1;       // time of a step over the area

using Matrix = Eigen::SparseMatrix<double>;
using Factor = Eigen::SimplicialLDLT<Matrix>;

size_t next(size_t k) { return k % 3 == 2 ? k - 2 : k + 1; }

// Of the edge from each corner to the next one of its triangle.
std::vector<double> equal_weights(const FilmNet& net) { return std::vector<double>(net.corners.size(), 1); }

Vec3 twice_area(const FilmNet& net, const Points& x, size_t first) {
  const Vec3 origin = x.col(net.corners[first]);
  return (x.col(net.corners[first + 1]) - origin).cross(Vec3(x.col(net.corners[first + 2]) - origin));
}

// Half the cotangent of the angle opposite. Empty where a triangle has no area.
std::optional<std::vector<double>> cotangents(const FilmNet& net, const Points& x) {
  std::vector<double> weights(net.corners.size());
  for (size_t k = 0; k < weights.size(); ++k) {
    const double area = twice_area(net, x, k - k % 3).norm();
    if (!(area > 0)) return std::nullopt;
    const Vec3 apex = x.col(net.corners[next(next(k))]);
    weights[k] = (x.col(net.corners[k]) - apex).dot(x.col(net.corners[next(k)]) - apex) / (2 * area);
  }
  return weights;
}

// The equations of one coordinate: those of the nodes that are free along it.
struct NetEquations {
  std::vector<int> number;  // of each node, -1: not free
  Matrix matrix;
  Vector pull;  // of the nodes that are not free
};

NetEquations equations(const FilmNet& net, const std::vector<double>& weights, int coordinate,
                       const Points& x) {
  NetEquations system;
  system.number.assign(static_cast<size_t>(x.cols()), -1);
  int count = 0;
  for (const int node : net.corners)
    if (int& number = system.number[static_cast<size_t>(node)]; number < 0 && net.is_free(coordinate, node))
      number = count++;
  system.pull = Vector::Zero(count);
  std::vector<Eigen::Triplet<double>> entries;
  for (size_t k = 0; k < net.corners.size(); ++k)
    for (const auto& [from, to] : {std::pair(k, next(k)), std::pair(next(k), k)}) {
      const int row = system.number[static_cast<size_t>(net.corners[from])],
                column = system.number[static_cast<size_t>(net.corners[to])];
      if (row < 0) continue;
      entries.emplace_back(row, row, weights[k]);
      if (column >= 0)
        entries.emplace_back(row, column, -weights[k]);
      else
        system.pull[row] += weights[k] * x(coordinate, net.corners[to]);
    }
  system.matrix.resize(count, count);
  system.matrix.setFromTriplets(entries.begin(), entries.end());
  return system;
}

void put(const NetEquations& system, const Vector& places, int coordinate, Points& x) {
  for (size_t node = 0; node < system.number.size(); ++node)
    if (system.number[node] >= 0)
      x(coordinate, static_cast<Eigen::Index>(node)) = places[system.number[node]];
}

bool balance(const FilmNet& net, const std::vector<double>& weights, int coordinate, Points& x) {
  const NetEquations system = equations(net, weights, coordinate, x);
  if (system.pull.size() == 0) return true;
  const Factor factor(system.matrix);
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > kHeld * factor.vectorD().maxCoeff()))
    return false;
  const Vector places = factor.solve(system.pull);
  if (!places.allFinite()) return false;
  put(system, places, coordinate, x);
  return true;
}

double film_area(const FilmNet& net, const Points& x) {
  double area = 0;
  for (size_t k = 0; k < net.corners.size(); k += 3) area += 0.5 * twice_area(net, x, k).norm();
  return area;
}

bool shrinks_a_triangle(const FilmNet& net, const Points& from, const Points& to) {
  for (size_t k = 0; k < net.corners.size(); k += 3)
    if (twice_area(net, to, k).norm() < kLeastTriangle * twice_area(net, from, k).norm()) return true;
  return false;
}

// A third of the areas of the triangles around each node.
Vector node_areas(const FilmNet& net, const Points& x) {
  Vector areas = Vector::Zero(x.cols());
  for (size_t k = 0; k < net.corners.size(); ++k)
    areas[net.corners[k]] += twice_area(net, x, k - k % 3).norm() / 6;
  return areas;
}

}  // namespace

void relax_net(const FilmNet& net, int coordinate, Points& x) {
  balance(net, equal_weights(net), coordinate, x);
}

bool lessen_area(const FilmNet& net, Points& x) {
  const Points start = x;
  double area = film_area(net, x);
  for (int step = 0; step < kMostLessenings; ++step) {
    const auto weights = cotangents(net, x);
    Points less = x;
    if (!weights) return false;
    for (int coordinate = 0; coordinate < 3; ++coordinate)
      if (!balance(net, *weights, coordinate, less)) return false;
    const double now = film_area(net, less);
    if (!(now <= area) || shrinks_a_triangle(net, start, less)) return false;
    x = less;
    if (now > (1 - kLittleGain) * area) return true;
    area = now;
  }
  return false;
}

void round_net(const FilmNet& net, const Vec3& centre, Points& x) {
  const auto weights = cotangents(net, x);
  if (!weights) return;
  const double area = film_area(net, x);
  Points round = x.colwise() - centre;
  std::vector<NetEquations> systems;
  std::array<bool, 3> is_held_along{};
  for (int coordinate = 0; coordinate < 3; ++coordinate) {
    systems.push_back(equations(net, *weights, coordinate, round));
    is_held_along[static_cast<size_t>(coordinate)] = std::any_of(
        net.corners.begin(), net.corners.end(), [&](int node) { return !net.is_free(coordinate, node); });
  }
  for (int step = 0; step < kRoundings; ++step) {
    const Vector areas = node_areas(net, round) / (kRounding * area);
    for (int coordinate = 0; coordinate < 3; ++coordinate) {
      const NetEquations& system = systems[static_cast<size_t>(coordinate)];
      Matrix matrix = system.matrix;
      Vector pull = system.pull;
      for (size_t node = 0; node < system.number.size(); ++node) {
        const int row = system.number[node];
        if (row < 0) continue;
        const auto column = static_cast<Eigen::Index>(node);
        matrix.coeffRef(row, row) += areas[column];
        pull[row] += areas[column] * round(coordinate, column);
      }
      const Factor factor(matrix);
      if (factor.info() != Eigen::Success) return;
      put(system, factor.solve(pull), coordinate, round);
      // What is not in the middle would be scaled up from step to step.
      if (is_held_along[static_cast<size_t>(coordinate)]) continue;
      round.row(coordinate).array() -= areas.dot(round.row(coordinate)) / areas.sum();
    }
    const double now = film_area(net, round);
    if (!(now > 0) || !round.allFinite()) return;
    round *= std::sqrt(area / now);
  }
  for (const int node : net.corners) x.col(node) = round.col(node) + centre;
}

}  // namespace coapt
