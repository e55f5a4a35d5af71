// Wavefront OBJ. Read: v, f, g, o, usemtl; other known statements concern appearance and are skipped.
#include "formats/formats.hpp"
#include "formats/mesh_builder.hpp"
#include "formats/text.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace coapt::formats {
namespace {

// Names set by one kind of grouping statement, and the one in force at each triangle.
struct Grouping {
  std::map<std::string, int, std::less<>> numbers;
  std::vector<std::string> names = {"default"};  // faces before the first statement
  int current = 0;
  std::vector<int> of_triangle;

  void set(std::string_view name) {
    const auto found = numbers.find(name);
    if (found != numbers.end()) {
      current = found->second;
      return;
    }
    current = static_cast<int>(names.size());
    names.emplace_back(name);
    numbers.emplace(name, current);
  }
  bool is_used() const { return names.size() > 1; }
  bool divides() const {
    return std::adjacent_find(of_triangle.begin(), of_triangle.end(), std::not_equal_to<>()) !=
           of_triangle.end();
  }
};

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const std::string& file)
      : bytes_(bytes), defects_(file), builder_(defects_, "line", 1) {}

  MeshFile read() {
    if (bytes_.empty()) defects_.fail("the file is empty");
    if (looks_binary(bytes_)) defects_.fail("is binary, not an OBJ text");
    Lines lines(bytes_);
    std::string_view line;
    while (lines.next(line, true)) read_line(line, lines.number());
    if (unknown_count_ > 0)
      builder_.warnings.push_back(defects_.file() + ": " + std::to_string(unknown_count_) +
                                  " lines with an unknown statement were skipped (the first: line " +
                                  std::to_string(first_unknown_) + ", " + quoted(unknown_) + ")");
    return finish();
  }

 private:
  void read_line(std::string_view rest, int line) {
    const std::string_view word = next_word(rest);
    if (word.empty() || word[0] == '#') return;
    if (word == "v")
      read_vertex(rest, line);
    else if (word == "f")
      read_face(rest, line);
    else if (word == "g")
      groups_[0].set(trimmed(rest));
    else if (word == "o")
      groups_[1].set(trimmed(rest));
    else if (word == "usemtl")
      groups_[2].set(trimmed(rest));
    else
      skip(word, line);
  }

  void skip(std::string_view word, int line) {
    static constexpr std::array<std::string_view, 8> kAppearance = {"vn",     "vt", "vp", "s",
                                                                    "mtllib", "l",  "p",  "lod"};
    if (std::find(kAppearance.begin(), kAppearance.end(), word) != kAppearance.end()) return;
    if (unknown_count_++ > 0) return;
    first_unknown_ = line;
    unknown_ = word;
  }

  // x y z, followed by a weight, a colour, or both, which are not used.
  void read_vertex(std::string_view rest, int line) {
    double x[3] = {0, 0, 0};
    int count = 0;
    for (std::string_view word = next_word(rest); !word.empty() && word[0] != '#'; word = next_word(rest)) {
      double value = 0;
      if (const auto reason = read_number(word, value)) {
        defects_.add("line", line, "coordinate " + *reason);
        count = 3;
        break;
      }
      if (count < 3) x[count] = value;
      ++count;
    }
    if (count != 3 && count != 4 && count != 6 && count != 7)
      defects_.add("line", line, "vertex with " + std::to_string(count) + " numbers; 3 are needed");
    builder_.add_vertex(x[0], x[1], x[2]);  // also when defective, to keep the numbering
  }

  // A corner is i, i/t, i//n or i/t/n; i counts from 1, or back from the last vertex when negative.
  void read_face(std::string_view rest, int line) {
    corners_.clear();
    for (std::string_view word = next_word(rest); !word.empty() && word[0] != '#'; word = next_word(rest)) {
      const size_t slash = std::min(word.find('/'), word.size());
      long long index = 0;
      auto reason = read_integer(word.substr(0, slash), index);
      if (!reason && word.find_first_not_of("0123456789-/", slash) != std::string_view::npos)
        reason = quoted(word) + " is not a corner";
      if (!reason && index == 0) reason = "index 0; OBJ counts vertices from 1";
      if (!reason && index < 0 && -index > builder_.vertex_count())
        reason = "index " + std::to_string(index) + " points before the first vertex (" +
                 std::to_string(builder_.vertex_count()) + " so far)";
      if (reason) return defects_.add("line", line, "face: " + *reason);
      corners_.push_back(index > 0 ? index - 1 : builder_.vertex_count() + index);
    }
    builder_.add_face(corners_, line);
    for (Grouping& grouping : groups_)
      grouping.of_triangle.resize(static_cast<size_t>(builder_.triangle_count()), grouping.current);
  }

  // Groups come first, then materials, then objects; one that divides the mesh beats one that does not.
  MeshFile finish() {
    Grouping* chosen = nullptr;
    for (Grouping* grouping : {&groups_[0], &groups_[2], &groups_[1]})
      if (grouping->is_used() && (!chosen || (grouping->divides() && !chosen->divides()))) chosen = grouping;
    if (!chosen) return builder_.finish();
    return builder_.finish(std::move(chosen->of_triangle), std::move(chosen->names));
  }

  std::string_view bytes_;
  Defects defects_;
  MeshBuilder builder_;
  std::array<Grouping, 3> groups_;  // g, o, usemtl
  std::vector<long long> corners_;
  long long unknown_count_ = 0;
  int first_unknown_ = 0;
  std::string_view unknown_;
};

}  // namespace

MeshFile read_obj(std::string_view bytes, const std::string& file) { return ObjReader(bytes, file).read(); }

std::string write_obj(const TriangleMesh& mesh, const std::string& remark) {
  std::string text = remark.empty() ? "" : "# " + remark + "\n";
  text.reserve(static_cast<size_t>(mesh.vertex_count()) * 60 +
               static_cast<size_t>(mesh.triangle_count()) * 24);
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    text += 'v';
    for (int k = 0; k < 3; ++k) append_number(text += ' ', mesh.vertices(k, i));
    text += '\n';
  }
  int region = -1;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    if (!mesh.regions.empty() && mesh.regions[static_cast<size_t>(t)] != region) {
      region = mesh.regions[static_cast<size_t>(t)];
      text += "g " + mesh.region_names[static_cast<size_t>(region)] + '\n';
    }
    text += 'f';
    for (int k = 0; k < 3; ++k) append_number(text += ' ', static_cast<long long>(mesh.triangles(k, t)) + 1);
    text += '\n';
  }
  return text;
}

}  // namespace coapt::formats
