// STL, ASCII and binary. The format has no vertices of its own: corners with the same coordinates, bit by
// bit, become one vertex.
#include "formats/bytes.hpp"
#include "formats/formats.hpp"
#include "formats/mesh_builder.hpp"
#include "formats/text.hpp"

#include <array>
#include <cmath>
#include <unordered_map>

namespace coapt::formats {
namespace {

constexpr size_t kHeader = 84, kRecord = 50;  // bytes of a binary file

using Corner = std::array<double, 3>;

struct CornerHash {
  size_t operator()(const Corner& corner) const {
    std::uint64_t hash = 0;
    for (const double x : corner) {
      hash ^= std::bit_cast<std::uint64_t>(x);
      hash *= 0x9e3779b97f4a7c15u;  // golden ratio: spreads the few bits in which neighbours differ
      hash ^= hash >> 29;
    }
    return static_cast<size_t>(hash);
  }
};

class StlReader {
 public:
  StlReader(std::string_view bytes, const std::string& file)
      : bytes_(bytes), defects_(file), builder_(defects_, "triangle", 0) {}

  MeshFile read() {
    if (bytes_.empty()) defects_.fail("the file is empty");
    const bool holds_count = bytes_.size() >= kHeader;
    const std::uint64_t count = holds_count ? load<std::uint32_t>(bytes_.data() + 80, !kLittleEndian) : 0;
    const std::uint64_t size = kHeader + kRecord * count;
    if (holds_count && bytes_.size() == size) {
      read_binary(count);
    } else if (bytes_.substr(0, 5) == "solid" && !looks_binary(bytes_)) {
      read_ascii();
    } else {
      defects_.fail(holds_count
                        ? "is neither ASCII STL nor a whole binary one: its header announces " +
                              std::to_string(count) + " triangles, which need " + std::to_string(size) +
                              " bytes, but it has " + std::to_string(bytes_.size())
                        : "is not an STL file (no 'solid' and too short for binary)");
    }
    if (corner_count_ > 0)
      builder_.warnings.push_back(defects_.file() + ": STL stores the corners of each triangle apart; " +
                                  std::to_string(corner_count_) + " corners were joined to " +
                                  std::to_string(builder_.vertex_count()) + " vertices");
    return names_.size() > 1 ? builder_.finish(std::move(regions_), std::move(names_)) : builder_.finish();
  }

 private:
  int vertex(Corner corner) {
    ++corner_count_;
    for (double& x : corner) x += 0.0;  // -0 becomes 0
    const auto [found, is_new] = numbers_.try_emplace(corner, static_cast<int>(numbers_.size()));
    if (is_new) builder_.add_vertex(corner[0], corner[1], corner[2]);
    return found->second;
  }

  void read_binary(std::uint64_t count) {
    builder_.reserve(count / 2, count);
    for (std::uint64_t t = 0; t < count; ++t) {
      const char* at = bytes_.data() + kHeader + kRecord * t + 12;  // behind the normal
      bool finite = true;
      std::vector<long long> corners(3);
      for (size_t c = 0; c < 3; ++c) {
        Corner corner;
        for (size_t k = 0; k < 3; ++k) {
          corner[k] = load<float>(at + 12 * c + 4 * k, !kLittleEndian);
          finite = finite && std::isfinite(corner[k]);
        }
        if (finite) corners[c] = vertex(corner);
      }
      if (finite)
        builder_.add_face(corners, static_cast<long long>(t));
      else
        defects_.add("triangle", static_cast<long long>(t), "a coordinate is not a finite number");
    }
  }

  void read_ascii() {
    Lines lines(bytes_);
    std::string_view rest;
    while (lines.next(rest)) {
      const std::string_view word = next_word(rest);
      if (word == "vertex") {
        read_vertex(rest, lines.number());
      } else if (word == "solid") {
        names_.emplace_back(trimmed(rest));
        if (names_.back().empty()) names_.back() = "solid " + std::to_string(names_.size());
      } else if (word == "facet" || word == "outer") {
        refuse_open_loop(lines.number());
        facet_has_loop_ = facet_has_loop_ && word == "outer";
      } else if (word == "endloop") {
        close_loop(lines.number());
      } else if (word == "endfacet") {
        refuse_open_loop(lines.number());
        if (!facet_has_loop_) defects_.add("line", lines.number(), "a facet without a loop of vertices");
        facet_has_loop_ = false;
      } else if (!word.empty() && word != "endsolid") {
        defects_.add("line", lines.number(), quoted(word) + " is not a statement of STL");
      }
    }
    if (!loop_.empty()) defects_.add("the file ends inside a facet");
  }

  void read_vertex(std::string_view rest, int line) {
    Corner corner{};
    for (double& x : corner)
      if (const auto reason = read_number(next_word(rest), x)) {
        defects_.add("line", line, "coordinate " + *reason);
        break;
      }
    loop_.push_back(vertex(corner));
  }

  // A loop that is not ended makes no triangle.
  void refuse_open_loop(int line) {
    if (loop_.empty()) return;
    defects_.add(
        "line", line,
        "the loop of " + std::to_string(loop_.size()) + " vertices before is not ended by 'endloop'");
    loop_.clear();
    facet_has_loop_ = true;  // said once
  }

  void close_loop(int line) {
    facet_has_loop_ = true;
    if (loop_.size() < 3)
      defects_.add("line", line, "facet with " + std::to_string(loop_.size()) + " vertices; 3 are needed");
    else
      builder_.add_face(loop_, builder_.triangle_count());
    regions_.resize(static_cast<size_t>(builder_.triangle_count()), static_cast<int>(names_.size()) - 1);
    loop_.clear();
  }

  std::string_view bytes_;
  Defects defects_;
  MeshBuilder builder_;
  std::unordered_map<Corner, int, CornerHash> numbers_;
  std::vector<long long> loop_;
  bool facet_has_loop_ = false;
  std::vector<int> regions_;
  std::vector<std::string> names_;
  std::uint64_t corner_count_ = 0;
};

Vec3 unit_normal(const TriangleMesh& mesh, int t) {
  const Vec3 area = area_vector(mesh.vertices, mesh.triangles.col(t));
  const double length = area.norm();
  return length > 0 ? Vec3(area / length) : Vec3(Vec3::Zero());
}

std::string write_binary(const TriangleMesh& mesh, const std::string& remark) {
  std::string bytes = "binary STL " + remark;
  bytes.resize(80, ' ');
  store(bytes, static_cast<std::uint32_t>(mesh.triangle_count()));
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 normal = unit_normal(mesh, t);
    for (int k = 0; k < 3; ++k) store(bytes, static_cast<float>(normal[k]));
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k) store(bytes, static_cast<float>(mesh.vertices(k, mesh.triangles(c, t))));
    store(bytes, std::uint16_t{0});
  }
  return bytes;
}

void append_facet(std::string& text, const TriangleMesh& mesh, int t) {
  const Vec3 normal = unit_normal(mesh, t);
  text += "facet normal";
  for (int k = 0; k < 3; ++k) append_number(text += ' ', normal[k]);
  text += "\nouter loop\n";
  for (int c = 0; c < 3; ++c) {
    text += "vertex";
    for (int k = 0; k < 3; ++k) append_number(text += ' ', mesh.vertices(k, mesh.triangles(c, t)));
    text += '\n';
  }
  text += "endloop\nendfacet\n";
}

}  // namespace

MeshFile read_stl(std::string_view bytes, const std::string& file) { return StlReader(bytes, file).read(); }

std::string write_stl(const TriangleMesh& mesh, Coding coding, const std::string& remark) {
  if (coding == Coding::Binary && kLittleEndian) return write_binary(mesh, remark);
  const std::vector<std::string> names =
      mesh.regions.empty() ? std::vector<std::string>{"surface"} : mesh.region_names;
  std::string text;
  for (size_t region = 0; region < names.size(); ++region) {
    text += "solid " + names[region] + '\n';
    for (int t = 0; t < mesh.triangle_count(); ++t)
      if (mesh.regions.empty() || mesh.regions[static_cast<size_t>(t)] == static_cast<int>(region))
        append_facet(text, mesh, t);
    text += "endsolid " + names[region] + '\n';
  }
  return text;
}

}  // namespace coapt::formats
