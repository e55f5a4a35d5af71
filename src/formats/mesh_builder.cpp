#include "formats/mesh_builder.hpp"

#include <limits>

namespace coapt::formats {

void MeshBuilder::reserve(size_t vertex_count, size_t face_count) {
  coordinates_.reserve(3 * vertex_count);
  corners_.reserve(3 * face_count);
  origins_.reserve(face_count);
}

void MeshBuilder::add_vertex(double x, double y, double z) {
  coordinates_.push_back(x);
  coordinates_.push_back(y);
  coordinates_.push_back(z);
}

void MeshBuilder::add_face(const std::vector<long long>& corners, long long origin) {
  if (corners.size() < 3)
    return defects_.add(unit_, origin,
                        "face with " + std::to_string(corners.size()) +
                            " corners; at least 3 are needed (is the file truncated?)");
  for (const long long corner : corners)
    if (corner < 0 || corner > std::numeric_limits<int>::max())
      return defects_.add(unit_, origin,
                          "vertex " + std::to_string(corner + first_index_) +
                              " does not exist; vertices are numbered from " + std::to_string(first_index_));
  if (corners.size() > 3 && polygon_count_++ == 0) first_polygon_ = origin;
  for (size_t k = 2; k < corners.size(); ++k) {
    for (const size_t c : {size_t{0}, k - 1, k}) corners_.push_back(static_cast<int>(corners[c]));
    origins_.push_back(origin);
  }
}

void MeshBuilder::check_indices() {
  const long long count = vertex_count();
  long long reported = -1;
  for (size_t t = 0; t < origins_.size(); ++t) {
    if (origins_[t] == reported) continue;
    for (size_t k = 0; k < 3; ++k) {
      const int corner = corners_[3 * t + k];
      if (corner < count) continue;
      reported = origins_[t];
      defects_.add(unit_, reported,
                   "vertex " + std::to_string(corner + static_cast<long long>(first_index_)) +
                       " does not exist; the file has " + std::to_string(count) +
                       " vertices, numbered from " + std::to_string(first_index_));
      break;
    }
  }
}

MeshFile MeshBuilder::finish(std::vector<int> regions, std::vector<std::string> names) {
  constexpr size_t kMost = std::numeric_limits<int>::max();
  if (coordinates_.size() / 3 > kMost || origins_.size() > kMost)
    defects_.fail("more than 2^31 vertices or triangles; split the mesh");
  check_indices();
  if (!defects_.any() && coordinates_.empty()) defects_.add("no vertices; is this a mesh file?");
  if (!defects_.any() && origins_.empty()) defects_.add("no faces; a surface of triangles is needed");
  defects_.throw_if_any();

  MeshFile result;
  const auto columns = [](size_t entries) { return static_cast<Eigen::Index>(entries / 3); };
  result.mesh.vertices = Eigen::Map<const Points>(coordinates_.data(), 3, columns(coordinates_.size()));
  result.mesh.triangles = Eigen::Map<const Triangles>(corners_.data(), 3, columns(corners_.size()));
  if (!regions.empty()) {
    compact_regions(regions, names);
    result.mesh.regions = std::move(regions);
    result.mesh.region_names = std::move(names);
  }
  result.warnings = std::move(warnings);
  if (polygon_count_ > 0)
    result.warnings.push_back(defects_.file() + ": " + std::to_string(polygon_count_) +
                              " faces with more than 3 corners were cut into triangles (the first: " + unit_ +
                              " " + std::to_string(first_polygon_) +
                              "); triangles are counted after the cut");
  return result;
}

void compact_regions(std::vector<int>& regions, std::vector<std::string>& names) {
  std::vector<int> renumbered(names.size(), -1);
  std::vector<std::string> kept;
  for (int& region : regions) {
    int& number = renumbered[static_cast<size_t>(region)];
    if (number < 0) {
      number = static_cast<int>(kept.size());
      kept.push_back(names[static_cast<size_t>(region)]);
    }
    region = number;
  }
  names = std::move(kept);
}

}  // namespace coapt::formats
