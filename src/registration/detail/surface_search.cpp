#include "registration/detail/surface_search.hpp"

#include "core/error.hpp"
#include "core/small_eigen.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace coapt::registration {
namespace {

constexpr double kClose = 0.04;           // of the size: such a point has a counterpart
constexpr double kFar = 0.1;              // of the size: beyond it a distance counts for no more
constexpr double kTukey = 4.685;          // of the standard deviation (Holland & Welsch 1977)
constexpr double kDeviation = 1.4826;     // standard deviation over the median of the sizes, of a normal law
constexpr double kLeastDeviation = 1e-9;  // of the size: below it all pairs weigh the same
constexpr double kAtRest = 1e-14;         // of the size: a step that ends the search
constexpr double kWithinNoise = 0.25;     // of the standard error of a place: a step that ends the search
constexpr double kUndetermined = 1e-8;    // of the greatest eigenvalue: such a direction is left as it is
constexpr double kLargestTurn = 0.35;     // rad in one step, as the equations are linear in the turn
constexpr double kOnEdge = 1e-9;          // barycentric weight below which a point lies on the edge across

using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Steps of the golden section through the list: any first part of it is spread over the whole.
std::vector<int> spread_order(size_t count) {
  std::vector<double> places(count);
  for (size_t k = 0; k < count; ++k) places[k] = std::fmod(static_cast<double>(k) * 0.6180339887498949, 1.0);
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return places[static_cast<size_t>(a)] < places[static_cast<size_t>(b)]; });
  return order;
}

struct Pair {
  Vec3 point, closest, normal;
  double distance = 0, weight = 0;
};

// The closest points of the moved ones; fills score and overlap.
std::vector<Pair> pairs_of(const Points& points, const SearchedSurface& on, bool leaves_border_out,
                           SearchResult& result) {
  std::vector<Pair> pairs;
  pairs.reserve(static_cast<size_t>(points.cols()));
  double sum = 0;
  int close = 0;
  for (const auto& p : points.colwise()) {
    const ClosestOnSurface closest = on.tree.closest(p);
    const double distance = std::sqrt(closest.distance_squared);
    sum += std::min(distance, kFar * on.size);
    if (distance < kClose * on.size) ++close;
    const auto& borders = on.borders[static_cast<size_t>(closest.triangle)];
    bool is_beyond = false;
    for (int k = 0; k < 3; ++k) {
      const bool is_corner = closest.weights[k] > 1 - kOnEdge;
      if (borders[static_cast<size_t>(k)] && closest.weights[k] < kOnEdge) is_beyond = true;
      if (is_corner && on.border_vertices[static_cast<size_t>(on.triangles(k, closest.triangle))])
        is_beyond = true;
    }
    if (leaves_border_out && is_beyond) continue;
    pairs.push_back({p, closest.point, on.normals.col(closest.triangle), distance, 1});
  }
  const auto count = static_cast<double>(points.cols());
  result.score = sum / count;
  result.overlap = close / count;
  return pairs;
}

// Leaves the farthest pairs out and weighs the others down as their distance from the plane exceeds what is
// usual.
void trim_and_weigh(std::vector<Pair>& pairs, double trim, double size) {
  const auto kept = static_cast<size_t>(std::ceil((1 - trim) * static_cast<double>(pairs.size())));
  std::nth_element(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(kept == 0 ? 0 : kept - 1),
                   pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  pairs.resize(kept);
  std::vector<double> off;
  for (const Pair& pair : pairs) off.push_back(std::abs(pair.normal.dot(pair.point - pair.closest)));
  const double limit = kTukey * std::max(kDeviation * median(off), kLeastDeviation * size);
  for (size_t k = 0; k < pairs.size(); ++k) {
    const double share = off[k] / limit;
    pairs[k].weight = share < 1 ? (1 - share * share) * (1 - share * share) : 0;
  }
}

struct Step {
  Vector7 change = Vector7::Zero();      // turn [rad], shift over the size, relative scale
  Matrix7 covariance = Matrix7::Zero();  // of the change, for pairs of unit variance; 0 where left open
  int free_directions = 0;
};

// The least-squares step about `centre`; directions that the pairs do not determine stay as they are.
Step least_squares_step(const std::vector<Pair>& pairs, const Vec3& centre, double size, double point_share,
                        bool with_scale) {
  Matrix7 h = Matrix7::Zero();
  Vector7 g = Vector7::Zero();
  const auto add = [&](const Pair& pair, const Vec3& direction, double weight) {
    const Vec3 arm = (pair.point - centre) / size;
    Vector7 row;
    row << arm.cross(direction), direction, with_scale ? arm.dot(direction) : 0;
    h.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    g += weight * direction.dot(pair.closest - pair.point) / size * row;
  };
  for (const Pair& pair : pairs) {
    if (pair.weight <= 0) continue;
    add(pair, pair.normal, pair.weight);
    if (point_share > 0)
      for (int axis = 0; axis < 3; ++axis) add(pair, Vec3::Unit(axis), point_share * pair.weight);
  }
  const SmallEigen eigen = small_eigen(h);  // reads the lower triangle
  const SmallVector& values = eigen.values;
  Step step;
  for (int k = 0; k < 7; ++k) {
    if (values[k] <= kUndetermined * values[6]) {
      ++step.free_directions;
      continue;
    }
    const Vector7 direction = eigen.vectors.col(k);
    step.change += direction.dot(g) / values[k] * direction;
    step.covariance += direction * direction.transpose() / values[k];
  }
  if (!with_scale) --step.free_directions;  // the scale itself, whose row is zero
  const double turn = step.change.head<3>().norm();
  if (turn > kLargestTurn) step.change *= kLargestTurn / turn;
  return step;
}

// Root mean square over the points, of the normal equations' covariance: point p moves by
// turn x arm + shift + growth arm. Pairs count as independent, with the variance that they have [length].
double standard_error(const Matrix7& covariance, const Points& points, const Vec3& centre, double size,
                      double rms) {
  double sum = 0;
  for (const auto& p : points.colwise()) {
    const Vec3 arm = (p - centre) / size;
    Eigen::Matrix<double, 3, 7> moves;
    moves << Eigen::Vector3d::UnitX().cross(arm), Eigen::Vector3d::UnitY().cross(arm),
        Eigen::Vector3d::UnitZ().cross(arm), Eigen::Matrix3d::Identity(), arm;
    sum += (moves * covariance * moves.transpose()).trace();
  }
  return rms * std::sqrt(sum / static_cast<double>(points.cols()));
}

RigidMotion moved_on(const RigidMotion& motion, const Vector7& change, const Vec3& centre, double size) {
  const Vec3 turn = change.head<3>();
  const double angle = turn.norm(), growth = 1 + change[6];
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  if (angle > 0) rotation = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  RigidMotion next;
  next.rotation = Eigen::Quaterniond(rotation * motion.rotation).normalized().toRotationMatrix();
  next.scale = growth * motion.scale;
  next.translation =
      growth * (rotation * (motion.translation - centre)) + centre + size * change.segment<3>(3);
  return next;
}

}  // namespace

SearchedSurface::SearchedSurface(const TriangleMesh& mesh)
    : tree(mesh.vertices, mesh.triangles),
      normals(3, mesh.triangle_count()),
      borders(static_cast<size_t>(mesh.triangle_count()), {false, false, false}),
      border_vertices(static_cast<size_t>(mesh.vertex_count()), false),
      triangles(mesh.triangles) {
  if (!(surface_area(mesh.vertices, mesh.triangles) > 0))
    throw InputError("a surface without area has no place");
  for (int t = 0; t < mesh.triangle_count(); ++t)
    normals.col(t) = area_vector(mesh.vertices, mesh.triangles.col(t)).normalized();
  std::vector<bool> is_used(static_cast<size_t>(mesh.vertex_count()), false);
  int inner = 0;
  for (const Edge& edge : edges(mesh.triangles)) {
    for (const int v : {edge.a, edge.b}) is_used[static_cast<size_t>(v)] = true;
    if (edge.triangles.size() >= 2) {
      roughness += 1 - normals.col(edge.triangles[0]).dot(normals.col(edge.triangles[1]));
      ++inner;
      continue;
    }
    const int t = edge.triangles[0];
    for (int k = 0; k < 3; ++k)
      if (mesh.triangles(k, t) != edge.a && mesh.triangles(k, t) != edge.b)
        borders[static_cast<size_t>(t)][static_cast<size_t>(k)] = true;
    for (const int v : {edge.a, edge.b}) border_vertices[static_cast<size_t>(v)] = true;
  }
  if (inner > 0) roughness /= inner;
  std::vector<int> used;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (is_used[static_cast<size_t>(v)]) used.push_back(v);
  points.resize(3, static_cast<Eigen::Index>(used.size()));
  const std::vector<int> order = spread_order(used.size());
  for (size_t k = 0; k < used.size(); ++k)
    points.col(static_cast<Eigen::Index>(k)) = mesh.vertices.col(used[static_cast<size_t>(order[k])]);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector row = points.row(axis);
    middle[axis] = median({row.begin(), row.end()});
  }
  const Vector apart = (points.colwise() - middle).colwise().norm();
  size = 2 * median({apart.begin(), apart.end()});
}

SearchResult search(const SearchedSurface& sought, const SearchedSurface& on, const RigidMotion& start,
                    const SearchSettings& settings) {
  const Eigen::Index count = settings.points > 0
                                 ? std::min<Eigen::Index>(settings.points, sought.points.cols())
                                 : sought.points.cols();
  const Points points = sought.points.leftCols(count);
  SearchResult result;
  result.motion = start;
  Matrix7 covariance = Matrix7::Zero();
  for (double move = kInfinity; move > kAtRest && result.iterations < settings.most_iterations;
       ++result.iterations) {
    const Points moved = result.motion.apply(points);
    std::vector<Pair> pairs = pairs_of(moved, on, settings.leaves_border_out, result);
    result.pairs = static_cast<int>(pairs.size());
    if (pairs.size() < 7) break;  // as many as the unknowns of a motion with scale
    trim_and_weigh(pairs, settings.options.trim, on.size);
    result.pairs = static_cast<int>(pairs.size());
    double sum = 0, weights = 0;
    for (const Pair& pair : pairs) {
      const double off = pair.normal.dot(pair.point - pair.closest);
      sum += pair.weight * off * off;
      weights += pair.weight;
    }
    result.rms = weights > 0 ? std::sqrt(sum / weights) : 0;
    const Vec3 centre = result.motion.apply(sought.middle);
    const Step step =
        least_squares_step(pairs, centre, on.size, settings.point_share, settings.options.with_scale);
    result.free_directions = step.free_directions;
    result.motion = moved_on(result.motion, step.change, centre, on.size);
    covariance = step.covariance;
    move = step.change.norm();
    if (move * on.size < kWithinNoise * result.rms / std::sqrt(static_cast<double>(pairs.size()))) break;
  }
  if (settings.points == 0)
    result.standard_error = standard_error(covariance, result.motion.apply(points),
                                           result.motion.apply(sought.middle), on.size, result.rms);
  return result;
}

}  // namespace coapt::registration
