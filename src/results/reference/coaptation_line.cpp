#include "results/reference/coaptation_line.hpp"

#include "core/bounded_int.hpp"
#include "core/error.hpp"
#include "mesh/distance/vertex_gaps.hpp"
#include "mesh/projected_area.hpp"
#include "registration/registration.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr int kMostRadius = 1024;           // of the closing, in cells
constexpr int kCoarsest = 128;              // cells over the extent of the annulus
constexpr int kPieces = 400;                // of the shorter line, whose middles are compared
constexpr int kMostPieces = 100 * kPieces;  // of one stretch of a line that is far longer than the other

// Eight cells to an edge, four to the contact distance, within bounds that keep the view cheap and useful.
double cell_size(double extent, double mean_edge, double contact_distance, int finest) {
  return std::clamp(std::min(mean_edge / 8, contact_distance / 4), extent / finest, extent / kCoarsest);
}

// Nodes near which, seen from above, a vertex is in contact: a bulge may hide where contact begins.
std::vector<char> near_contact(const TopView& view, const Points& x, double mean_edge,
                               const std::vector<char>& is_contact) {
  const Points plan = in_frame(x, view.frame);
  std::vector<char> marked(static_cast<size_t>(view.node_count()), 0);
  for (Eigen::Index v = 0; v < plan.cols(); ++v) {
    if (!is_contact[static_cast<size_t>(v)]) continue;
    const double i = std::round((plan(0, v) - view.x0) / view.cell),
                 j = std::round((plan(1, v) - view.y0) / view.cell);
    if (i >= 0 && j >= 0 && i < view.columns && j < view.rows)
      marked[static_cast<size_t>(j * view.columns + i)] = 1;
  }
  const double extent = view.cell * std::max(view.columns, view.rows);
  return near_marked(view, marked,
                     bounded_int(std::ceil(std::max(extent / 20, mean_edge) / view.cell), 0,
                                 std::max(view.columns, view.rows)));
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double squared = along.squaredNorm();
  const double share = squared > 0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0;
  return (a + share * along - p).norm();
}

double distance_to(const Vec3& p, const std::vector<Seam>& line) {
  double least = kInfinity;
  for (const Seam& seam : line)
    for (Eigen::Index k = 0; k + 1 < seam.points.cols(); ++k)
      least = std::min(least, distance_to_segment(p, seam.points.col(k), seam.points.col(k + 1)));
  return least;
}

double total_length(const std::vector<Seam>& line) {
  double sum = 0;
  for (const Seam& seam : line) sum += length_of(seam);
  return sum;
}

// At the middles of pieces of at most `piece` of each stretch, weighted by their lengths.
DistanceFigures figures(const std::vector<Seam>& from, const std::vector<Seam>& to, double piece) {
  std::vector<std::pair<double, double>> places;  // distance, length
  for (const Seam& seam : from)
    for (Eigen::Index k = 0; k + 1 < seam.points.cols(); ++k) {
      const Vec3 a = seam.points.col(k), b = seam.points.col(k + 1);
      const int count = bounded_int(std::ceil((b - a).norm() / piece), 1, kMostPieces);
      for (int i = 0; i < count; ++i)
        places.emplace_back(distance_to(a + (i + 0.5) / count * (b - a), to), (b - a).norm() / count);
    }
  std::sort(places.begin(), places.end());
  DistanceFigures figures;
  double length = 0, below = 0;
  for (const auto& [distance, of] : places) {
    length += of;
    figures.mean += distance * of;
  }
  figures.mean /= length;
  figures.max = places.back().first;
  figures.p95 = figures.max;
  for (const auto& [distance, of] : places)
    if ((below += of) >= 0.95 * length) {
      figures.p95 = distance;
      break;
    }
  return figures;
}

}  // namespace

SeenSurface seen_surface(const Points& x, const Triangles& triangles, const Points& annulus,
                         const ViewFrame& frame, double contact_distance, int finest) {
  const Points outline = in_frame(annulus, frame);
  const double extent = (outline.rowwise().maxCoeff() - outline.rowwise().minCoeff()).head<2>().maxCoeff();
  const double cell = cell_size(extent, mean_edge_length(x, triangles), contact_distance, finest);
  SeenSurface seen;
  seen.radius = bounded_int(std::round(contact_distance / 2 / cell), 1, kMostRadius);
  seen.view = top_view(x, triangles, annulus, frame, cell, seen.radius + 1);
  seen.closed = closed_view(seen.view, seen.radius);
  return seen;
}

std::vector<Seam> coaptation_line(const SeenSurface& seen, const Points& x, const Triangles& triangles,
                                  const std::vector<char>& is_contact, double contact_distance) {
  const double mean_edge = mean_edge_length(x, triangles);
  return seams(seen.view, seen.closed, x, triangles,
               {near_contact(seen.view, x, mean_edge, is_contact), seen.radius,
                std::max(2 * contact_distance, 2 * mean_edge)});
}

std::vector<Seam> coaptation_line_of(const TriangleMesh& surface, const Points& annulus,
                                     const ViewFrame& frame, double contact_distance) {
  const Vector gaps = vertex_gaps(surface.vertices, surface.triangles, contact_distance);
  std::vector<char> is_contact;
  for (const double gap : gaps) is_contact.push_back(gap <= contact_distance);  // NaN: none in reach
  return coaptation_line(seen_surface(surface.vertices, surface.triangles, annulus, frame, contact_distance),
                         surface.vertices, surface.triangles, is_contact, contact_distance);
}

std::optional<LineDistance> line_distance(const std::vector<Seam>& from, const std::vector<Seam>& to) {
  const double length = std::min(total_length(from), total_length(to));
  if (!(length > 0)) return std::nullopt;
  const double piece = length / kPieces;
  return LineDistance{figures(from, to, piece), figures(to, from, piece)};
}

std::optional<LineDistance> distance_of_lines(const TriangleMesh& moved, const TriangleMesh& target) try {
  const Points annulus = annulus_loop(target);
  const Plane plane = best_fit_plane(annulus);
  const Vec3 hang = target.vertices.rowwise().mean() - annulus.rowwise().mean();
  const ViewFrame frame =
      view_frame(plane.centre, hang.dot(plane.normal) > 0 ? Vec3(-plane.normal) : plane.normal);
  const double contact = std::max(mean_edge_length(moved.vertices, moved.triangles),
                                  mean_edge_length(target.vertices, target.triangles)) /
                         2;
  return line_distance(coaptation_line_of(moved, annulus, frame, contact),
                       coaptation_line_of(target, annulus, frame, contact));
} catch (const InputError&) {  // no loop, or one on a line
  return std::nullopt;
}

}  // namespace coapt
