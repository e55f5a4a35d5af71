// On which side of the leaflets the pressure acts, judged by the way their rims run around.
#include "core/number_text.hpp"
#include "mesh/mesh_topology.hpp"
#include "valve/valve_check.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <cmath>
#include <optional>

namespace coapt {
namespace {

constexpr double kLeastTurning = 0.5;  // of the area swept around the axis, below which a side is not told
constexpr double kLeastFacing = 0.2;   // projected over whole area; of a piece that is not on the annulus
constexpr double kFlatAnnulus = 0.6;   // height over width of one whose axis is told by its shape
constexpr double kLeastDepth = 0.1;    // of the free edge beside the annulus, over the radius of this

// An edge with one triangle, in the direction in which that runs along it.
struct RimEdge {
  int from = 0, to = 0, triangle = 0;
};

std::vector<RimEdge> rim_edges(const TriangleMesh& mesh) {
  std::vector<RimEdge> rim;
  for (const Edge& edge : edges(mesh.triangles)) {
    if (edge.triangles.size() != 1) continue;
    const int t = edge.triangles[0];
    for (int k = 0; k < 3; ++k) {
      const int from = mesh.triangles(k, t), to = mesh.triangles((k + 1) % 3, t);
      if (std::min(from, to) == edge.a && std::max(from, to) == edge.b) rim.push_back({from, to, t});
    }
  }
  return rim;
}

// From the annulus the way the leaflets go.
struct Axis {
  Vec3 point, direction;
};

// Without tips the axis is the annulus' own, toward the free edges; none where either is not clear.
std::optional<Axis> valve_axis(const Valve& valve, const std::vector<bool>& is_annulus,
                               const std::vector<RimEdge>& rim) {
  const Points ring = valve.leaflets.vertices(Eigen::all, valve.annulus);
  const Vec3 middle = ring.rowwise().mean();
  if (valve.chords.papillary.cols() > 0) {
    const Vec3 way = valve.chords.papillary.rowwise().mean() - middle;
    if (!(way.norm() > 0)) return std::nullopt;
    return Axis{middle, way.normalized()};
  }
  const Points apart = ring.colwise() - middle;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> extents(apart * apart.transpose());
  const Vec3 squares = extents.eigenvalues().cwiseMax(0);
  if (!(squares[0] < kFlatAnnulus * kFlatAnnulus * squares[1])) return std::nullopt;
  Vec3 free = Vec3::Zero();
  int count = 0;
  for (const RimEdge& edge : rim)
    for (const int v : {edge.from, edge.to})
      if (!is_annulus[static_cast<size_t>(v)]) {
        free += valve.leaflets.vertices.col(v) - middle;
        ++count;
      }
  if (count == 0) return std::nullopt;
  const Vec3 normal = extents.eigenvectors().col(0);
  const double depth = normal.dot(free) / count;
  const double radius = std::sqrt((squares[1] + squares[2]) / static_cast<double>(ring.cols()));
  if (!(std::abs(depth) > kLeastDepth * radius)) return std::nullopt;
  return Axis{middle, depth > 0 ? normal : Vec3(-normal)};
}

// What one piece of the leaflets says of its side.
struct Piece {
  int triangles = 0, first = -1;
  double area = 0, facing = 0;    // whole, and as seen along the axis
  double swept = 0, turning = 0;  // by the annulus around the axis, without and with sign

  // A leaflet hangs from the annulus along the axis, around the lumen. With its normals on the outside its
  // triangles run counter-clockwise along the annulus, seen from where it hangs to; and so do those of a flat
  // leaflet whose normals point that way. That is a matter of the annulus alone: what the leaflet does below,
  // and whether its free edge is as wide, says nothing.
  bool is_turned_over() const {
    return swept > 0 ? turning < -kLeastTurning * swept : facing < -kLeastFacing * area;
  }
  bool is_right_side_out() const {
    return swept > 0 ? turning > kLeastTurning * swept : facing > kLeastFacing * area;
  }
};

std::vector<Piece> pieces_of(const TriangleMesh& mesh, const std::vector<bool>& is_annulus,
                             const std::vector<RimEdge>& rim, const Axis& axis) {
  const Components parts = connected_components(mesh);
  std::vector<Piece> pieces(static_cast<size_t>(parts.count));
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    Piece& piece = pieces[static_cast<size_t>(parts.of_triangle[static_cast<size_t>(t)])];
    const Vec3 area = area_vector(mesh.vertices, mesh.triangles.col(t));
    if (piece.triangles++ == 0) piece.first = t;
    piece.facing += area.dot(axis.direction);
    piece.area += area.norm();
  }
  for (const RimEdge& edge : rim) {
    if (!is_annulus[static_cast<size_t>(edge.from)] || !is_annulus[static_cast<size_t>(edge.to)]) continue;
    Piece& piece = pieces[static_cast<size_t>(parts.of_triangle[static_cast<size_t>(edge.triangle)])];
    const Vec3 a = mesh.vertices.col(edge.from) - axis.point, b = mesh.vertices.col(edge.to) - axis.point;
    const double area = 0.5 * axis.direction.dot(a.cross(b));
    piece.turning += area;
    piece.swept += std::abs(area);
  }
  return pieces;
}

}  // namespace

std::vector<std::string> pressure_side_doubts(const Valve& valve, Numbering numbering, bool is_on_back) {
  const TriangleMesh& mesh = valve.leaflets;
  if (valve.annulus.size() < 3 || mesh.triangle_count() == 0) return {};
  std::vector<bool> is_annulus(static_cast<size_t>(mesh.vertex_count()), false);
  for (const int v : valve.annulus) is_annulus[static_cast<size_t>(v)] = true;
  const std::vector<RimEdge> rim = rim_edges(mesh);
  const std::optional<Axis> axis = valve_axis(valve, is_annulus, rim);
  if (!axis) return {};
  const std::vector<Piece> pieces = pieces_of(mesh, is_annulus, rim, *axis);
  std::string turned;
  size_t count = 0;
  for (const Piece& piece : pieces) {
    if (!(is_on_back ? piece.is_right_side_out() : piece.is_turned_over())) continue;
    constexpr size_t kFew = 10;
    if (++count > kFew) continue;
    turned.append(count == 1 ? "" : ", ").append(std::to_string(piece.triangles));
    turned.append(" with triangle ").append(numbering.of(piece.first));
  }
  if (count == 0) return {};
  const bool has_tips = valve.chords.papillary.cols() > 0;
  if (is_on_back)
    return {"the pressure acts on the back of " +
            (count == pieces.size() ? "the leaflets"
                                    : std::to_string(count) + " of " + std::to_string(pieces.size()) +
                                          " leaflets (triangles: " + turned + numbering.note() + ")") +
            ", in the lumen, " + (has_tips ? "away from the papillary tips" : "from which blood comes") +
            ", so it acts on the wrong side and opens the valve; set the side of the pressure to \"front\"."};
  const std::string where =
      has_tips ? "into the lumen, away from the papillary tips," : "into the lumen, from which blood comes,";
  if (count == pieces.size())
    return {"the normals of the leaflets point " + where +
            " so the pressure acts on the wrong side; turn all triangles over, or set the side of the "
            "pressure."};
  return {"the normals of " + std::to_string(count) + " of " + std::to_string(pieces.size()) +
          " leaflets (triangles: " + turned + numbering.note() + ") point " + where +
          " so the pressure acts on the wrong side there; turn their triangles over."};
}

}  // namespace coapt
