#include "valve/detail/bare_leaflets.hpp"

#include "core/number_text.hpp"
#include "mesh/mesh_topology.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace coapt::detail {
namespace {

constexpr double kMostBare = 0.3;  // of a free edge, between two insertions; rough valves have up to 0.18
constexpr const char* kRemedy =
    "; pressure will turn it over unless something else holds its free edge. Add the missing chords "
    "(`coapt chords` makes some).";

std::vector<int> insertions(const Valve& valve) {
  std::vector<int> list;
  for (const Chord& chord : valve.chords.chords)
    for (const ChordEnd& end : {chord.from, chord.to})
      if (end.kind == ChordEnd::Kind::Leaflet) list.push_back(end.index);
  return list;
}

std::vector<std::string> bare_regions(const TriangleMesh& mesh, const std::vector<bool>& is_held) {
  std::vector<int> triangles(mesh.region_names.size(), 0), ends = triangles;
  for (int t = 0; !triangles.empty() && t < mesh.triangle_count(); ++t) {
    const auto region = static_cast<size_t>(mesh.regions[static_cast<size_t>(t)]);
    ++triangles[region];
    for (const int v : mesh.triangles.col(t)) ends[region] += is_held[static_cast<size_t>(v)] ? 1 : 0;
  }
  std::string bare;
  for (size_t r = 0; r < ends.size(); ++r)
    if (triangles[r] > 0 && ends[r] == 0)
      bare += (bare.empty() ? "\"" : ", \"") + mesh.region_names[r] + "\"";
  if (bare.empty()) return {};
  return {"region " + bare + ": no chord inserts there while others have chords" + kRemedy};
}

// Their triangles, and the first of these.
std::vector<std::string> bare_pieces(const TriangleMesh& mesh, const Components& parts,
                                     const std::vector<int>& ends, Numbering numbering) {
  const auto count = static_cast<size_t>(parts.count);
  std::vector<bool> is_held(count, false);
  for (const int v : ends)
    if (const int part = parts.of_vertex[static_cast<size_t>(v)]; part >= 0)
      is_held[static_cast<size_t>(part)] = true;
  std::vector<int> triangles(count, 0), first(count, -1);
  for (int t = mesh.triangle_count() - 1; t >= 0; --t) {
    const auto part = static_cast<size_t>(parts.of_triangle[static_cast<size_t>(t)]);
    ++triangles[part];
    first[part] = t;
  }
  std::vector<std::string> doubts;
  for (size_t part = 0; part < count; ++part)
    if (!is_held[part] && triangles[part] > 0)
      doubts.push_back("the leaflet of triangle " + numbering.of(first[part]) + numbering.note() + " (" +
                       std::to_string(triangles[part]) +
                       " triangles): no chord inserts there while others have chords" + kRemedy);
  return doubts;
}

// Where more than two triangles meet, rims are cut into chains.
bool is_closed(const std::vector<int>& loop, const std::vector<Edge>& sorted) {
  const int a = std::min(loop.front(), loop.back()), b = std::max(loop.front(), loop.back());
  const auto found =
      std::lower_bound(sorted.begin(), sorted.end(), std::pair(a, b),
                       [](const Edge& edge, const auto& ends) { return std::pair(edge.a, edge.b) < ends; });
  return found != sorted.end() && found->a == a && found->b == b && found->triangles.size() == 1;
}

// The longest rim of each piece that is not on the annulus alone.
std::vector<std::vector<int>> free_edges(const Valve& valve, const Components& parts) {
  std::vector<bool> is_annulus(static_cast<size_t>(valve.leaflets.vertex_count()), false);
  for (const int v : valve.annulus) is_annulus[static_cast<size_t>(v)] = true;
  std::vector<std::vector<int>> longest(static_cast<size_t>(parts.count));
  Triangles triangles = valve.leaflets.triangles;  // all to one side, or rims would not go round
  const Orientation sides = consistent_orientation(valve.leaflets);
  for (size_t t = 0; t < sides.flip.size(); ++t)
    if (sides.flip[t]) {
      const auto column = static_cast<Eigen::Index>(t);
      std::swap(triangles(0, column), triangles(1, column));
    }
  const std::vector<Edge> sorted = edges(triangles);
  for (std::vector<int>& loop : boundary_loops(triangles)) {
    if (!is_closed(loop, sorted)) continue;
    if (std::all_of(loop.begin(), loop.end(), [&](int v) { return is_annulus[static_cast<size_t>(v)]; }))
      continue;
    std::vector<int>& known =
        longest[static_cast<size_t>(parts.of_vertex[static_cast<size_t>(loop.front())])];
    if (loop.size() > known.size()) known = std::move(loop);
  }
  std::erase_if(longest, [](const std::vector<int>& loop) { return loop.empty(); });
  return longest;
}

struct BareRun {
  double share = 0;
  int from = 0, to = 0;  // vertices of the free edge
};

// The longest run between two places at which an insertion is nearest to the free edge. What runs along the
// annulus counts for nothing.
std::optional<BareRun> longest_bare(const Valve& valve, const std::vector<int>& loop,
                                    const std::vector<int>& ends) {
  const Points& x = valve.leaflets.vertices;
  std::vector<bool> is_annulus(static_cast<size_t>(x.cols()), false), is_held(loop.size(), false);
  for (const int v : valve.annulus) is_annulus[static_cast<size_t>(v)] = true;
  const Points edge = x(Eigen::all, loop);
  for (const int v : ends) {
    Eigen::Index nearest = 0;
    (edge.colwise() - x.col(v)).colwise().squaredNorm().minCoeff(&nearest);
    is_held[static_cast<size_t>(nearest)] = true;
  }
  const auto start = static_cast<size_t>(std::find(is_held.begin(), is_held.end(), true) - is_held.begin());
  if (start == loop.size()) return std::nullopt;
  double whole = 0, run = 0, longest = 0;
  BareRun bare;
  int from = loop[start];
  for (size_t k = 0; k < loop.size(); ++k) {
    const size_t here = (start + k) % loop.size(), next = (here + 1) % loop.size();
    const int a = loop[here], b = loop[next];
    if (!is_annulus[static_cast<size_t>(a)] || !is_annulus[static_cast<size_t>(b)]) {
      const double length = (x.col(b) - x.col(a)).norm();
      whole += length;
      run += length;
    }
    if (!is_held[next]) continue;
    if (run > longest) {
      longest = run;
      bare.from = from;
      bare.to = b;
    }
    run = 0;
    from = b;
  }
  bare.share = whole > 0 ? longest / whole : 0;
  return bare;
}

}  // namespace

std::vector<std::string> bare_leaflets(const Valve& valve, Numbering numbering) {
  const TriangleMesh& mesh = valve.leaflets;
  const std::vector<int> ends = insertions(valve);
  if (ends.empty()) return {};
  std::vector<bool> is_held(static_cast<size_t>(mesh.vertex_count()), false);
  for (const int v : ends) is_held[static_cast<size_t>(v)] = true;
  const Components parts = connected_components(mesh);
  std::vector<std::string> doubts = bare_regions(mesh, is_held);
  if (!doubts.empty()) return doubts;
  doubts = bare_pieces(mesh, parts, ends, numbering);
  for (const std::vector<int>& loop : free_edges(valve, parts)) {
    const int part = parts.of_vertex[static_cast<size_t>(loop.front())];
    std::vector<int> own;
    for (const int v : ends)
      if (parts.of_vertex[static_cast<size_t>(v)] == part) own.push_back(v);
    const std::optional<BareRun> bare = longest_bare(valve, loop, own);
    if (!bare || bare->share <= kMostBare) continue;
    doubts.push_back("the free edge from vertex " + numbering.of(bare->from) + " to vertex " +
                     numbering.of(bare->to) + numbering.note() + " (" + number_text(100 * bare->share, 2) +
                     " % of it): no chord inserts there while the rest has chords" + kRemedy);
  }
  return doubts;
}

}  // namespace coapt::detail
