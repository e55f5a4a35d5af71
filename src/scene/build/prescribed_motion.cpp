#include "scene/build/prescribed_motion.hpp"

#include "core/error.hpp"
#include "formats/json/read_points.hpp"
#include "formats/json/suggestion.hpp"
#include "formats/lower_extension.hpp"
#include "formats/mesh_io.hpp"
#include "scene/build/node_selection.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

Points named_points(const std::string& name, const std::map<std::string, Points>& points,
                    const std::string& where) {
  const auto found = points.find(name);
  if (found != points.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& entry : points) names.push_back(entry.first);
  throw InputError(where + ".move_to: no positions \"" + name + "\"; known: " + listed(names) +
                   suggestion(name, names) + " A file needs its extension.");
}

// Positions of `nodes` at one station, relative to the origin.
Points station(const MoveTarget& target, const BoundaryEntry& entry, const std::vector<int>& nodes,
               const Model& model, const std::map<std::string, Points>& points) {
  const Points start = model.X(Eigen::all, nodes);
  if (target.kind == MoveTarget::Kind::Translation) return start.colwise() + target.translation;
  Points read;
  if (target.kind == MoveTarget::Kind::Named) {
    read = named_points(target.text, points, entry.where);
  } else if (formats::lower_extension(target.text) == ".csv") {
    read = entry.scale * read_csv(target.text);
  } else {
    read = entry.scale * read_mesh(target.text).mesh.vertices;
    // A mesh of the whole surface gives each node its own vertex.
    const bool is_whole = read.cols() == model.mesh.vertex_count() && read.cols() != start.cols();
    const bool are_vertices = std::all_of(nodes.begin(), nodes.end(), [&](int n) { return n < read.cols(); });
    if (is_whole && are_vertices) read = Points(read(Eigen::all, nodes));
  }
  if (read.cols() != start.cols())
    throw InputError(entry.where + ".move_to: \"" + target.text + "\" has " + std::to_string(read.cols()) +
                     " positions for " + std::to_string(start.cols()) + " nodes");
  return read.colwise() - model.origin;
}

void apply(const BoundaryEntry& entry, const Model& model, const std::map<std::string, Points>& points,
           Prescribed& prescribed) {
  const std::vector<int> nodes = selected_nodes(entry.nodes, model, entry.where + ".nodes");
  std::vector<Points> stations;
  for (const MoveTarget& target : entry.path)
    stations.push_back(station(target, entry, nodes, model, points));
  for (size_t k = 0; k < nodes.size(); ++k) {
    for (size_t c = 0; c < 3; ++c) prescribed.fixed(static_cast<int>(c), nodes[k]) = entry.fix[c];
    prescribed.paths.erase(nodes[k]);
    for (const Points& positions : stations)
      prescribed.paths[nodes[k]].push_back(positions.col(static_cast<Eigen::Index>(k)));
  }
}

// Stations of the longest path; zero where nothing moves.
size_t station_count(const Prescribed& prescribed, const Points& X) {
  size_t count = 0;
  for (const auto& [node, path] : prescribed.paths) {
    const bool moves =
        std::any_of(path.begin(), path.end(), [&, node = node](const Vec3& to) { return to != X.col(node); });
    if (moves) count = std::max(count, path.size());
  }
  return count;
}

}  // namespace

Prescribed prescribe(const std::vector<BoundaryEntry>& boundary, const std::vector<int>& held,
                     const Model& model, const std::map<std::string, Points>& points,
                     std::vector<std::string>& defects) {
  Prescribed prescribed{FixedMask::Constant(3, model.X.cols(), false), {}};
  for (const int node : held) prescribed.fixed.col(node).setConstant(true);
  for (const BoundaryEntry& entry : boundary) {
    try {
      apply(entry, model, points, prescribed);
    } catch (const InputError& error) {
      defects.insert(defects.end(), error.defects().begin(), error.defects().end());
    }
  }
  return prescribed;
}

Vec3 place_on_path(const Vec3& start, const std::vector<Vec3>& path, double t) {
  const double place = std::clamp(t, 0.0, 1.0) * static_cast<double>(path.size());
  const size_t section = std::min(static_cast<size_t>(place), path.size() - 1);
  const Vec3 from = section == 0 ? start : path[section - 1];
  const double part = place - static_cast<double>(section);
  return part == 1 ? path[section] : Vec3(from + part * (path[section] - from));
}

MotionPath motion_path(const Prescribed& prescribed, const Points& X, int steps) {
  MotionPath motion;
  const size_t stations = station_count(prescribed, X);
  if (stations == 0) return motion;
  motion.steps = steps > 0 ? steps : static_cast<int>(stations);
  motion.positions = [paths = prescribed.paths, X](double t) {
    Points x = X;
    for (const auto& [node, path] : paths) x.col(node) = place_on_path(X.col(node), path, t);
    return x;
  };
  return motion;
}

}  // namespace coapt
