// Collects vertices and faces of a file and makes a checked TriangleMesh of them.
#pragma once

#include "formats/defects.hpp"
#include "formats/mesh_io.hpp"

#include <string>
#include <vector>

namespace coapt::formats {

class MeshBuilder {
 public:
  // `unit` is what the origin of a face counts: "line" or "face". `first_index` is the number of the
  // first vertex in messages, as the format counts (OBJ 1, else 0).
  MeshBuilder(Defects& defects, std::string unit, int first_index)
      : defects_(defects), unit_(std::move(unit)), first_index_(first_index) {}

  void reserve(size_t vertex_count, size_t face_count);
  void add_vertex(double x, double y, double z);
  long long vertex_count() const { return static_cast<long long>(coordinates_.size() / 3); }
  int triangle_count() const { return static_cast<int>(origins_.size()); }

  // Corners counted from 0; a corner may come before its vertex. A polygon becomes a fan.
  void add_face(const std::vector<long long>& corners, long long origin);

  // Checks all indices and that there is a face, throws InputError with all defects of the file.
  // `regions`, where not empty, has one entry per triangle added.
  MeshFile finish(std::vector<int> regions = {}, std::vector<std::string> names = {});

  std::vector<std::string> warnings;

 private:
  void check_indices();

  Defects& defects_;
  std::string unit_;
  int first_index_;
  std::vector<double> coordinates_;
  std::vector<int> corners_;
  std::vector<long long> origins_;  // of each triangle
  long long polygon_count_ = 0, first_polygon_ = 0;
};

// Leaves the regions in use, numbered in the order of their first triangle.
void compact_regions(std::vector<int>& regions, std::vector<std::string>& names);

}  // namespace coapt::formats
