#include "results/detail/anterior_share.hpp"

#include "core/bounded_int.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

int region_named(const TriangleMesh& mesh, const char* name) {
  const auto at = std::find(mesh.region_names.begin(), mesh.region_names.end(), name);
  return at == mesh.region_names.end() ? -1 : static_cast<int>(at - mesh.region_names.begin());
}

// Middle, by length, of the longest stretch of the loop whose vertices all belong to the region.
std::optional<Vec3> attachment_middle(const TriangleMesh& mesh, int region, const std::vector<int>& annulus,
                                      const Points& outline) {
  std::vector<char> belongs(static_cast<size_t>(mesh.vertex_count()), 0);
  for (int t = 0; t < mesh.triangle_count(); ++t)
    if (mesh.regions[static_cast<size_t>(t)] == region)
      for (const int v : mesh.triangles.col(t)) belongs[static_cast<size_t>(v)] = 1;
  const size_t count = annulus.size();
  const auto place = [&](size_t k) { return Vec3(outline.col(static_cast<Eigen::Index>(k % count))); };
  const auto is_of_region = [&](size_t k) { return belongs[static_cast<size_t>(annulus[k % count])] != 0; };
  double longest = 0;
  std::optional<Vec3> middle;
  for (size_t begin = 0; begin < count; ++begin) {
    if (!is_of_region(begin) || is_of_region(begin + count - 1)) continue;
    double length = 0;
    size_t end = begin;
    for (; is_of_region(end + 1); ++end) length += (place(end + 1) - place(end)).norm();
    if (length <= longest) continue;
    longest = length;
    double left = 0.5 * length, step = 0;
    size_t k = begin;
    for (; left > (step = (place(k + 1) - place(k)).norm()); ++k) left -= step;
    middle = place(k) + left / step * (place(k + 1) - place(k));
  }
  return middle;
}

}  // namespace

std::optional<double> anterior_share(const TriangleMesh& mesh, const std::vector<int>& annulus,
                                     const Points& outline, const TopView& view, const ClosedView& closed) {
  const int anterior = region_named(mesh, "anterior"), posterior = region_named(mesh, "posterior");
  if (mesh.regions.empty() || anterior < 0 || posterior < 0 || region_named(mesh, "septal") >= 0) return {};
  const auto from = attachment_middle(mesh, anterior, annulus, outline),
             to = attachment_middle(mesh, posterior, annulus, outline);
  if (!from || !to) return {};
  const Eigen::Vector2d way = (*to - *from).head<2>();
  const int samples = bounded_int(std::ceil(way.norm() / view.cell), 1, view.node_count());
  int covered = 0;
  for (int k = 0; k < samples; ++k) {
    const Eigen::Vector2d at = from->head<2>() + (k + 0.5) / samples * way;
    const int i = bounded_int(std::round((at[0] - view.x0) / view.cell), 0, view.columns - 1),
              j = bounded_int(std::round((at[1] - view.y0) / view.cell), 0, view.rows - 1);
    const int source = closed.source[static_cast<size_t>(j * view.columns + i)];
    const int triangle = source < 0 ? -1 : view.triangle[static_cast<size_t>(source)];
    covered += triangle >= 0 && mesh.regions[static_cast<size_t>(triangle)] == anterior;
  }
  return static_cast<double>(covered) / samples;
}

}  // namespace coapt
