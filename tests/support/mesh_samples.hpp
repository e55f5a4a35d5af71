// Small meshes, scratch files and the given data that the mesh tests share.
#pragma once

#include "formats/mesh_io.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <unistd.h>

namespace coapt {

// A folder that is gone with the test.
class ScratchFolder {
 public:
  ScratchFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / (std::string("coapt-") + test->test_suite_name() +
                                                        "-" + test->name() + "-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~ScratchFolder() { std::filesystem::remove_all(folder_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  std::filesystem::path file(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }
  std::string bytes(const std::string& name) const {
    std::ifstream stream(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  size_t file_count() const {
    const std::filesystem::directory_iterator begin(folder_);
    return static_cast<size_t>(std::distance(begin, {}));
  }

 private:
  std::filesystem::path folder_;
};

// A wavy sheet of n x n squares over the unit square, two triangles each, normals along +z.
inline TriangleMesh wavy_sheet(int n) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, (n + 1) * (n + 1));
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = i / double(n), y = j / double(n);
      mesh.vertices.col(j * (n + 1) + i) << x, y, 0.1 * std::sin(5 * x) * std::cos(4 * y);
    }
  mesh.triangles.resize(3, 2 * n * n);
  for (int j = 0, t = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
      mesh.triangles.col(t++) << a, b, c;
      mesh.triangles.col(t++) << a, c, d;
    }
  return mesh;
}

inline std::filesystem::path shared_path(const std::string& name) {
  return std::filesystem::path(COAPT_SHARED_DIR) / name;
}

inline bool is_shared(const std::string& name) { return std::filesystem::exists(shared_path(name)); }
inline constexpr const char* kDataNotFound = "skipped: data not found";

}  // namespace coapt
