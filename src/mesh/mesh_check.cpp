#include "mesh/mesh_check.hpp"

#include "core/number_text.hpp"
#include "mesh/distance/intersections.hpp"
#include "mesh/mesh_topology.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

namespace coapt {
namespace {

constexpr double kZeroHeight = 1e-12;  // of the longest edge: the rest strain is lost in rounding
constexpr double kMixedScales = 1e6;   // longest over shortest edge
constexpr double kLargeOffset = 1e6;   // distance from the origin over size: six of sixteen digits are lost
constexpr size_t kListed = 10;

using Kind = MeshDefectKind;

std::string counted(size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

class Report {
 public:
  explicit Report(Numbering numbering) : numbering_(numbering) {}

  // "3, 7, 9 and 12 more"; with width 2 "(3, 7), (9, 11)".
  std::string listed(const std::vector<int>& elements, size_t width = 1) const {
    std::string text;
    const size_t count = elements.size() / width;
    for (size_t i = 0; i < std::min(count, kListed); ++i) {
      const std::string one = numbering_.of(elements[width * i]);
      text.append(i > 0 ? ", " : "");
      text += width == 1 ? one : "(" + one + ", " + numbering_.of(elements[2 * i + 1]) + ")";
    }
    if (count > kListed) text += " and " + std::to_string(count - kListed) + " more";
    return text + numbering_.note();
  }
  std::string triangles(const std::vector<int>& elements) const {
    return (elements.size() == 1 ? "triangle " : "triangles ") + listed(elements);
  }
  std::string vertices(const std::vector<int>& elements) const {
    return (elements.size() == 1 ? "vertex " : "vertices ") + listed(elements);
  }

  // Nothing is reported when no element is affected.
  void add(Severity severity, Kind kind, std::vector<int> elements, const std::string& message) {
    if (!elements.empty()) defects.push_back({severity, kind, message, std::move(elements)});
  }
  void error(Kind kind, std::vector<int> elements, const std::string& message) {
    add(Severity::Error, kind, std::move(elements), message);
  }
  void warn(Kind kind, std::vector<int> elements, const std::string& message) {
    add(Severity::Warning, kind, std::move(elements), message);
  }

  std::vector<MeshDefect> defects;

 private:
  Numbering numbering_;
};

bool corners_are_in_range(const TriangleMesh& mesh, Report& report) {
  std::vector<int> out;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    if (mesh.triangles.col(t).minCoeff() < 0 || mesh.triangles.col(t).maxCoeff() >= mesh.vertex_count())
      out.push_back(t);
  report.error(Kind::IndexOutOfRange, out,
               report.triangles(out) + ": names a vertex that does not exist (there are " +
                   std::to_string(mesh.vertex_count()) + "); correct the corners");
  return out.empty();
}

void check_corners(const TriangleMesh& mesh, Report& report) {
  std::vector<int> repeated;
  std::map<std::array<int, 3>, int> first;
  std::vector<int> twice;
  std::vector<bool> used(static_cast<size_t>(mesh.vertex_count()), false);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    std::array<int, 3> corners = {mesh.triangles(0, t), mesh.triangles(1, t), mesh.triangles(2, t)};
    for (const int corner : corners) used[static_cast<size_t>(corner)] = true;
    std::sort(corners.begin(), corners.end());
    if (corners[0] == corners[1] || corners[1] == corners[2])
      repeated.push_back(t);
    else if (!first.emplace(corners, t).second)
      twice.push_back(t);
  }
  report.error(Kind::RepeatedIndex, repeated,
               report.triangles(repeated) + ": names a vertex twice, so it has no area; remove it");
  report.warn(
      Kind::DuplicateTriangle, twice,
      report.triangles(twice) + ": repeats an earlier triangle, which doubles stiffness and load; remove it");
  std::vector<int> isolated;
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (!used[static_cast<size_t>(i)]) isolated.push_back(i);
  report.warn(Kind::IsolatedVertex, isolated,
              report.vertices(isolated) + ": on no triangle; stays where it is and gets no unknowns");
}

bool coordinates_are_finite(const TriangleMesh& mesh, Report& report) {
  std::vector<int> bad;
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (!mesh.vertices.col(i).allFinite()) bad.push_back(i);
  report.error(Kind::NotFinite, bad,
               report.vertices(bad) + ": a coordinate is NaN or infinite; correct the position");
  return bad.empty();
}

void check_edges(const TriangleMesh& mesh, const MeshCheckOptions& options, Report& report) {
  std::vector<int> crowded;
  for (const Edge& edge : edges(mesh.triangles))
    if (edge.triangles.size() > 2 && edge.a != edge.b) crowded.insert(crowded.end(), {edge.a, edge.b});
  report.warn(
      Kind::NonManifoldEdge, crowded,
      counted(crowded.size() / 2, "edge has", "edges have") + " more than two triangles, between vertices " +
          report.listed(crowded, 2) +
          (options.orientation_matters ? "; the side on which pressure acts is not defined across it" : "") +
          "; split the surface there if that is not meant");
  const std::vector<int> bowties = bowtie_vertices(mesh);
  report.warn(Kind::BowtieVertex, bowties,
              report.vertices(bowties) +
                  ": joins parts that share no edge there, as a hinge without stiffness; " +
                  "give each part a vertex of its own, or close the gap");
}

void check_sides(const TriangleMesh& mesh, const MeshCheckOptions& options, Report& report) {
  const Orientation orientation = consistent_orientation(mesh);
  if (!orientation.one_sided.empty()) {
    report.add(options.orientation_matters ? Severity::Error : Severity::Warning, Kind::NotOrientable,
               orientation.one_sided,
               "the surface has one side only (it closes on itself with a twist at " +
                   report.triangles(orientation.one_sided) +
                   "): the side on which pressure acts is not defined; cut it, or leave out the pressure");
    return;
  }
  std::vector<int> flipped;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    if (orientation.flip[static_cast<size_t>(t)]) flipped.push_back(t);
  report.warn(Kind::InconsistentOrientation, flipped,
              report.triangles(flipped) + ": the normal points against that of the neighbours" +
                  (options.orientation_matters ? ", so pressure would push the wrong way" : "") +
                  "; orient the mesh consistently (orient_consistently)");
}

void check_seams(const TriangleMesh& mesh, Report& report) {
  const std::vector<int> first = first_coincident(mesh.vertices);
  std::vector<int> twins;
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (first[static_cast<size_t>(i)] != i) twins.push_back(i);
  report.warn(Kind::DuplicateVertices, twins,
              counted(twins.size(), "vertex lies", "vertices lie") +
                  " exactly on an earlier one without being joined (" + report.listed(twins) +
                  "): seams there are open; weld the mesh (weld) if they should be closed");
}

void check_components(const TriangleMesh& mesh, Report& report) {
  const Components components = connected_components(mesh);
  if (components.count < 2) return;
  std::vector<int> starts;  // a triangle of each
  for (int t = 0; t < mesh.triangle_count(); ++t)
    if (components.of_triangle[static_cast<size_t>(t)] == static_cast<int>(starts.size()))
      starts.push_back(t);
  report.warn(Kind::SeveralComponents, starts,
              "the mesh has " + std::to_string(components.count) +
                  " components (the first triangles of each: " + report.listed(starts) +
                  "); each needs a support");
}

void check_shapes(const TriangleMesh& mesh, Report& report) {
  std::vector<int> flat, slivers;
  double shortest = kInfinity, longest = 0, worst = 0;
  Eigen::AlignedBox3d box;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    double side = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = mesh.vertices.col(mesh.triangles(k, t)),
                 b = mesh.vertices.col(mesh.triangles((k + 1) % 3, t));
      const double length = (b - a).stableNorm();
      side = std::max(side, length);
      if (length > 0) shortest = std::min(shortest, length);
      box.extend(a);
    }
    longest = std::max(longest, side);
    if (!(side > 0)) {
      flat.push_back(t);
      continue;
    }
    // Relative to the longest edge, so that neither tiny nor huge meshes leave the range of doubles.
    const Vec3 a = mesh.vertices.col(mesh.triangles(0, t));
    const Vec3 u = (mesh.vertices.col(mesh.triangles(1, t)) - a) / side;
    const Vec3 v = (mesh.vertices.col(mesh.triangles(2, t)) - a) / side;
    const double height = u.cross(v).norm();
    if (!(height >= kZeroHeight))
      flat.push_back(t);
    else if (height * kSliverAspect < 1) {
      slivers.push_back(t);
      worst = std::max(worst, 1 / height);
    }
  }
  report.error(Kind::ZeroArea, flat,
               report.triangles(flat) +
                   ": no area (height below 1e-12 of the longest edge), so strain is undefined; " +
                   "collapse an edge or remove it");
  report.warn(Kind::Sliver, slivers,
              report.triangles(slivers) + ": slivers, longest edge up to " + number_text(worst) +
                  " times the height; results there are poor and a solve may stall: `coapt import` repairs "
                  "those of a "
                  "valve, other meshes want remeshing there");
  if (longest > kMixedScales * shortest)
    report.warn(Kind::MixedScales, {0},
                "edge lengths differ by a factor of " + number_text(longest / shortest) +
                    "; mixed units, or a fine part beside a coarse one, make solving slow and inexact");
  const double size = box.isEmpty() ? 0 : box.diagonal().stableNorm();
  const double offset = box.isEmpty() ? 0 : box.center().stableNorm();
  if (size > 0 && offset > kLargeOffset * size)
    report.warn(Kind::LargeOffset, {0},
                "the mesh lies " + number_text(offset / size) +
                    " times its size away from the origin, which costs digits; move it to the origin");
}

// A seam of coincident vertices touches without crossing: where each edge at them has at most two triangles
// once they are joined. Such pairs are neighbours in all but number.
class Seams {
 public:
  explicit Seams(const TriangleMesh& mesh)
      : joined_(weld(mesh).mesh), crowded_(static_cast<size_t>(joined_.vertex_count()), false) {
    for (const Edge& edge : edges(joined_.triangles))
      if (edge.triangles.size() > 2) {
        crowded_[static_cast<size_t>(edge.a)] = true;
        crowded_[static_cast<size_t>(edge.b)] = true;
      }
  }
  bool joins(int s, int t) const {
    bool share = false;
    for (int k = 0; k < 3; ++k) {
      const int vertex = joined_.triangles(k, t);
      if (!(joined_.triangles.col(s).array() == vertex).any()) continue;
      if (crowded_[static_cast<size_t>(vertex)]) return false;
      share = true;
    }
    return share;
  }

 private:
  TriangleMesh joined_;
  std::vector<bool> crowded_;
};

void check_contact(const TriangleMesh& mesh, Report& report) {
  const Seams seams(mesh);
  std::vector<int> crossing, coincident;
  for (const Intersection& pair : intersections(mesh.vertices, mesh.triangles)) {
    if (seams.joins(pair.first, pair.second)) continue;
    std::vector<int>& list = pair.is_coplanar ? coincident : crossing;
    list.insert(list.end(), {pair.first, pair.second});
  }
  report.error(Kind::InitialIntersection, crossing,
               counted(crossing.size() / 2, "pair", "pairs") +
                   " of triangles intersect at the start, which contact cannot undo: " +
                   report.listed(crossing, 2) + "; move the sheets apart, or leave out contact");
  report.warn(Kind::CoincidentSheets, coincident,
              counted(coincident.size() / 2, "pair", "pairs") +
                  " of triangles lie on each other at the start: " + report.listed(coincident, 2) +
                  "; their distance is 0 and contact has no direction, move the sheets apart");
}

}  // namespace

std::vector<MeshDefect> check_mesh(const TriangleMesh& mesh, const MeshCheckOptions& options) {
  Report report(options.numbering);
  if (mesh.triangle_count() == 0) {
    report.defects.push_back(
        {Severity::Error, Kind::NoTriangles, "the mesh has no triangles; a surface is needed", {}});
    return report.defects;
  }
  if (!corners_are_in_range(mesh, report)) return report.defects;
  check_corners(mesh, report);
  check_edges(mesh, options, report);
  check_sides(mesh, options, report);
  check_components(mesh, report);
  if (!coordinates_are_finite(mesh, report)) return report.defects;
  check_seams(mesh, report);
  check_shapes(mesh, report);
  if (options.contact) check_contact(mesh, report);
  std::stable_partition(report.defects.begin(), report.defects.end(),
                        [](const MeshDefect& defect) { return defect.severity == Severity::Error; });
  return report.defects;
}

bool has_error(const std::vector<MeshDefect>& defects) {
  return std::any_of(defects.begin(), defects.end(),
                     [](const MeshDefect& defect) { return defect.severity == Severity::Error; });
}

}  // namespace coapt
