#include "mesh/remesh/detail/order_of_place.hpp"

#include <algorithm>
#include <numeric>

namespace coapt::coarsening {
namespace {

std::vector<int> counted(int count) {
  std::vector<int> numbers(static_cast<size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

// Where each number stands in the list.
std::vector<int> inverse(const std::vector<int>& list) {
  std::vector<int> place(list.size());
  for (size_t k = 0; k < list.size(); ++k) place[static_cast<size_t>(list[k])] = static_cast<int>(k);
  return place;
}

bool is_before(const Eigen::Ref<const Vec3>& a, const Eigen::Ref<const Vec3>& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

// Corners in the numbers of `number`, the least one first.
Eigen::Vector3i corners_in(const std::vector<int>& number, const Eigen::Vector3i& triangle) {
  Eigen::Vector3i corners;
  for (int k = 0; k < 3; ++k) corners[k] = number[static_cast<size_t>(triangle[k])];
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

}  // namespace

OrderedMesh in_order_of_place(const TriangleMesh& mesh, const CoarsenOptions& options) {
  OrderedMesh ordered{{}, options, counted(mesh.vertex_count())};
  std::stable_sort(ordered.vertex.begin(), ordered.vertex.end(),
                   [&](int a, int b) { return is_before(mesh.vertices.col(a), mesh.vertices.col(b)); });
  const std::vector<int> number = inverse(ordered.vertex);
  ordered.mesh.vertices = mesh.vertices(Eigen::all, ordered.vertex);

  Triangles triangles(3, mesh.triangle_count());
  for (int t = 0; t < mesh.triangle_count(); ++t)
    triangles.col(t) = corners_in(number, mesh.triangles.col(t));
  std::vector<int> triangle = counted(mesh.triangle_count());
  std::stable_sort(triangle.begin(), triangle.end(), [&](int s, int t) {
    const auto a = triangles.col(s), b = triangles.col(t);
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  });
  ordered.mesh.triangles = triangles(Eigen::all, triangle);
  ordered.mesh.region_names = mesh.region_names;
  if (!mesh.regions.empty())
    for (const int t : triangle) ordered.mesh.regions.push_back(mesh.regions[static_cast<size_t>(t)]);

  for (int& v : ordered.options.keep) v = number[static_cast<size_t>(v)];
  for (auto& line : ordered.options.lines)
    for (int& v : line) v = number[static_cast<size_t>(v)];
  for (size_t k = 0; k < options.kinds.size(); ++k)
    ordered.options.kinds[static_cast<size_t>(number[k])] = options.kinds[k];
  return ordered;
}

Coarsening renumbered(const Coarsening& coarsening, const OrderedMesh& ordered, const TriangleMesh& given) {
  Coarsening result;
  result.number.assign(ordered.vertex.size(), -1);
  for (const int v : coarsening.kept) result.kept.push_back(ordered.vertex[static_cast<size_t>(v)]);
  std::vector<int> fine = result.kept;  // of each coarse vertex of the ordered mesh
  std::sort(result.kept.begin(), result.kept.end());
  for (size_t k = 0; k < result.kept.size(); ++k)
    result.number[static_cast<size_t>(result.kept[k])] = static_cast<int>(k);
  const auto number = [&](int coarse) {
    return result.number[static_cast<size_t>(fine[static_cast<size_t>(coarse)])];
  };

  result.mesh = coarsening.mesh;
  result.mesh.vertices = given.vertices(Eigen::all, result.kept);
  for (int& corner : result.mesh.triangles.reshaped()) corner = number(corner);
  result.host.resize(ordered.vertex.size());
  result.weights.resize(3, given.vertex_count());
  for (size_t k = 0; k < ordered.vertex.size(); ++k) {
    const auto v = static_cast<size_t>(ordered.vertex[k]);
    result.host[v] = coarsening.host[k];
    result.weights.col(static_cast<Eigen::Index>(v)) = coarsening.weights.col(static_cast<Eigen::Index>(k));
  }
  for (const auto& [a, b] : coarsening.lines) result.lines.push_back({number(a), number(b)});
  return result;
}

}  // namespace coapt::coarsening
