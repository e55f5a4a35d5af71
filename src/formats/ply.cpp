// PLY: ASCII, binary little and big endian. Read: vertex x y z, face vertex_indices (or vertex_index) and
// an integer `region` of the face; other elements and properties are skipped.
#include "formats/bytes.hpp"
#include "formats/formats.hpp"
#include "formats/mesh_builder.hpp"
#include "formats/ply_header.hpp"
#include "formats/text.hpp"

#include <cmath>

namespace coapt::formats {
namespace {

// The numbers of one vertex or face, whatever the coding.
class PlyReader {
 public:
  PlyReader(std::string_view bytes, const std::string& file)
      : defects_(file),
        builder_(defects_, "face", 0),
        header_(read_ply_header(bytes, defects_)),
        rest_(header_.body),
        lines_(header_.body) {}

  MeshFile read() {
    const bool swap = header_.coding == PlyCoding::BinaryLittle ? !kLittleEndian : kLittleEndian;
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;
      const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
      if (is_vertex) builder_.reserve(static_cast<size_t>(element.count), 0);
      for (long long i = 0; i < element.count; ++i) {
        if (header_.coding == PlyCoding::Ascii)
          read_line(element, i);
        else
          read_record(element, i, swap);
        if (is_vertex) builder_.add_vertex(x_[0], x_[1], x_[2]);
        if (is_face && ok_) add_face(i);
      }
    }
    check_end();
    if (!has_regions_) return builder_.finish();
    std::vector<std::string> names = header_.region_names;
    for (const int region : regions_)
      while (static_cast<int>(names.size()) <= region)
        names.push_back("region " + std::to_string(names.size()));
    return builder_.finish(std::move(regions_), std::move(names));
  }

 private:
  void add_face(long long i) {
    builder_.add_face(corners_, i);
    regions_.resize(static_cast<size_t>(builder_.triangle_count()), region_);
  }

  // What a number means is given by the role of its property.
  void take(const PlyProperty& property, double value, const PlyElement& element, long long i) {
    switch (property.role) {
      case PlyRole::X:
      case PlyRole::Y:
      case PlyRole::Z:
        if (!std::isfinite(value)) {
          defects_.add(element.name, i, "coordinate is not a finite number");
          value = 0;
        }
        x_[static_cast<int>(property.role) - static_cast<int>(PlyRole::X)] = value;
        break;
      case PlyRole::Region:
        // Numbers beyond what a list of names can hold are no region numbers.
        has_regions_ = has_regions_ || (value >= 0 && value < kMostRegions);
        region_ = value >= 0 && value < kMostRegions ? static_cast<int>(value) : 0;
        break;
      case PlyRole::Corners:
        if (std::isfinite(value) && value != std::floor(value)) {
          std::string text;
          append_number(text, value);
          defects_.add(element.name, i, "corner " + text + " is not a whole number");
        }
        corners_.push_back(value >= -1e15 && value <= 1e15 ? static_cast<long long>(value) : -1);
        break;
      case PlyRole::None:
        break;
    }
  }

  void begin_item() {
    ok_ = true;
    x_[0] = x_[1] = x_[2] = 0;
    corners_.clear();
    region_ = 0;
  }

  void read_line(const PlyElement& element, long long i) {
    begin_item();
    std::string_view line;
    do {
      if (!lines_.next(line)) fail_at_end(element, i);
    } while (trimmed(line).empty());
    const int number = header_.line_count + lines_.number();
    const auto next = [&](double& value) {
      const std::string_view word = next_word(line);
      const auto reason =
          word.empty() ? std::optional<std::string>("a number is missing") : read_number(word, value);
      if (reason) defects_.add("line", number, element.name + ": " + *reason);
      return ok_ = !reason;
    };
    for (const PlyProperty& property : element.properties) {
      double count = 1, value = 0;
      if (property.is_list && !next(count)) return;
      if (!(count >= 0) || count != std::floor(count)) {
        defects_.add("line", number, element.name + ": the length of a list is not a whole number");
        ok_ = false;
        return;
      }
      for (double k = 0; k < count; ++k) {
        if (!next(value)) return;
        take(property, value, element, i);
      }
    }
  }

  void read_record(const PlyElement& element, long long i, bool swap) {
    begin_item();
    for (const PlyProperty& property : element.properties) {
      std::uint64_t count = 1;
      if (property.is_list) {
        count = load_as<std::uint64_t>(property.count_type,
                                       bytes(byte_count(property.count_type), element, i), swap);
      }
      const size_t width = byte_count(property.type);
      if (count > rest_.size() / width) fail_at_end(element, i);
      for (std::uint64_t k = 0; k < count; ++k)
        take(property, load_as<double>(property.type, bytes(width, element, i), swap), element, i);
    }
  }

  const char* bytes(size_t count, const PlyElement& element, long long i) {
    if (rest_.size() < count) fail_at_end(element, i);
    const char* at = rest_.data();
    rest_.remove_prefix(count);
    return at;
  }

  [[noreturn]] void fail_at_end(const PlyElement& element, long long i) {
    defects_.fail("the file ends in " + element.name + " " + std::to_string(i) + " of " +
                  std::to_string(element.count));
  }

  // What is left over belongs to no element: the counts are wrong. Blanks mean nothing.
  void check_end() {
    if (header_.coding != PlyCoding::Ascii) {
      if (!trimmed(rest_).empty())
        defects_.add(std::to_string(rest_.size()) +
                     " bytes stand behind the elements announced; correct the counts");
      return;
    }
    for (std::string_view line; lines_.next(line);)
      if (!trimmed(line).empty())
        return defects_.add("line", header_.line_count + lines_.number(),
                            "stands behind the elements announced; correct the counts");
  }

  static constexpr double kMostRegions = 10000;

  Defects defects_;
  MeshBuilder builder_;
  PlyHeader header_;
  std::string_view rest_;  // of a binary body
  Lines lines_;            // of an ASCII body
  bool ok_ = true;
  double x_[3] = {0, 0, 0};
  std::vector<long long> corners_;
  int region_ = 0;
  std::vector<int> regions_;
  bool has_regions_ = false;
};

std::string header_of(const TriangleMesh& mesh, const std::string& format, const std::string& remark) {
  std::string text = "ply\nformat " + format + " 1.0\n";
  if (!remark.empty()) text += "comment " + remark + "\n";
  for (size_t r = 0; r < mesh.region_names.size() && !mesh.regions.empty(); ++r)
    text += "comment region " + std::to_string(r) + " " + mesh.region_names[r] + "\n";
  text += "element vertex " + std::to_string(mesh.vertex_count()) +
          "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
          std::to_string(mesh.triangle_count()) + "\nproperty list uchar int vertex_indices\n";
  if (!mesh.regions.empty()) text += "property int region\n";
  return text + "end_header\n";
}

std::string write_ascii(const TriangleMesh& mesh, const std::string& remark) {
  std::string text = header_of(mesh, "ascii", remark);
  for (int i = 0; i < mesh.vertex_count(); ++i)
    for (int k = 0; k < 3; ++k) {
      append_number(text, mesh.vertices(k, i));
      text += k < 2 ? ' ' : '\n';
    }
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    text += '3';
    for (int k = 0; k < 3; ++k) append_number(text += ' ', static_cast<long long>(mesh.triangles(k, t)));
    if (!mesh.regions.empty())
      append_number(text += ' ', static_cast<long long>(mesh.regions[static_cast<size_t>(t)]));
    text += '\n';
  }
  return text;
}

}  // namespace

MeshFile read_ply(std::string_view bytes, const std::string& file) { return PlyReader(bytes, file).read(); }

std::string write_ply(const TriangleMesh& mesh, Coding coding, const std::string& remark) {
  if (coding == Coding::Ascii) return write_ascii(mesh, remark);
  std::string bytes = header_of(mesh, kLittleEndian ? "binary_little_endian" : "binary_big_endian", remark);
  for (int i = 0; i < mesh.vertex_count(); ++i)
    for (int k = 0; k < 3; ++k) store(bytes, mesh.vertices(k, i));
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    store(bytes, std::uint8_t{3});
    for (int k = 0; k < 3; ++k) store(bytes, static_cast<std::int32_t>(mesh.triangles(k, t)));
    if (!mesh.regions.empty()) store(bytes, static_cast<std::int32_t>(mesh.regions[static_cast<size_t>(t)]));
  }
  return bytes;
}

}  // namespace coapt::formats
