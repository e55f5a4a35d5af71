// Object File Format (text). Colours behind the numbers of a line are skipped.
#include "formats/formats.hpp"
#include "formats/mesh_builder.hpp"
#include "formats/text.hpp"

#include <algorithm>

namespace coapt::formats {
namespace {

class OffReader {
 public:
  OffReader(std::string_view bytes, const std::string& file)
      : bytes_(bytes), lines_(bytes), defects_(file), builder_(defects_, "line", 0) {}

  MeshFile read() {
    if (bytes_.empty()) defects_.fail("the file is empty");
    if (looks_binary(bytes_)) defects_.fail("is binary; only OFF text is read");
    std::string_view rest;
    if (!next_line(rest)) defects_.fail("the file is empty");
    const std::string_view first = rest;
    const std::string_view word = next_word(rest);
    if (word != "OFF" && word != "COFF" && word != "NOFF" && word != "CNOFF" && word != "STOFF")
      defects_.fail("does not begin with OFF but with " + quoted(first));
    if (trimmed(rest).empty() && !next_line(rest)) defects_.fail("the file ends before its counts");
    const long long vertex_count = read_count(rest, "vertices");
    const long long face_count = read_count(rest, "faces");
    builder_.reserve(static_cast<size_t>(vertex_count), static_cast<size_t>(face_count));
    for (long long i = 0; i < vertex_count; ++i) read_vertex(i, vertex_count);
    for (long long i = 0; i < face_count; ++i) read_face(i, face_count);
    if (std::string_view more; next_line(more))
      defects_.add("line", lines_.number(),
                   "stands behind the " + std::to_string(vertex_count) + " vertices and " +
                       std::to_string(face_count) + " faces announced; correct the counts");
    return builder_.finish();
  }

 private:
  bool next_line(std::string_view& line) {
    while (lines_.next(line)) {
      line = trimmed(line.substr(0, std::min(line.find('#'), line.size())));
      if (!line.empty()) return true;
    }
    return false;
  }

  // A count that the rest of the file (at least two bytes for each) can hold.
  long long read_count(std::string_view& rest, const std::string& what) {
    long long count = 0;
    if (const auto reason = read_integer(next_word(rest), count))
      defects_.fail("line " + std::to_string(lines_.number()) + ": number of " + what + ": " + *reason);
    if (count < 0 || count > static_cast<long long>(lines_.rest().size()))
      defects_.fail("line " + std::to_string(lines_.number()) + ": " + std::to_string(count) + " " + what +
                    " announced, which the file cannot hold");
    return count;
  }

  void read_vertex(long long i, long long count) {
    std::string_view rest;
    if (!next_line(rest))
      defects_.fail("the file ends after " + std::to_string(i) + " of " + std::to_string(count) +
                    " vertices");
    double x[3] = {0, 0, 0};
    for (double& value : x)
      if (const auto reason = read_number(next_word(rest), value)) {
        defects_.add("line", lines_.number(), "coordinate " + *reason);
        break;
      }
    builder_.add_vertex(x[0], x[1], x[2]);
  }

  void read_face(long long i, long long count) {
    std::string_view rest;
    if (!next_line(rest))
      defects_.fail("the file ends after " + std::to_string(i) + " of " + std::to_string(count) + " faces");
    long long corner_count = 0;
    auto reason = read_integer(next_word(rest), corner_count);
    corners_.clear();
    for (long long k = 0; !reason && k < corner_count; ++k) {
      long long corner = 0;
      const std::string_view word = next_word(rest);
      if (word.empty())
        reason = "has " + std::to_string(k) + " of " + std::to_string(corner_count) + " corners";
      else
        reason = read_integer(word, corner);
      corners_.push_back(corner);
    }
    if (reason)
      defects_.add("line", lines_.number(), "face: " + *reason);
    else
      builder_.add_face(corners_, lines_.number());
  }

  std::string_view bytes_;
  Lines lines_;
  Defects defects_;
  MeshBuilder builder_;
  std::vector<long long> corners_;
};

}  // namespace

MeshFile read_off(std::string_view bytes, const std::string& file) { return OffReader(bytes, file).read(); }

std::string write_off(const TriangleMesh& mesh, const std::string& remark) {
  std::string text = "OFF\n" + (remark.empty() ? "" : "# " + remark + "\n") +
                     std::to_string(mesh.vertex_count()) + ' ' + std::to_string(mesh.triangle_count()) +
                     " 0\n";
  for (int i = 0; i < mesh.vertex_count(); ++i)
    for (int k = 0; k < 3; ++k) {
      append_number(text, mesh.vertices(k, i));
      text += k < 2 ? ' ' : '\n';
    }
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    text += '3';
    for (int k = 0; k < 3; ++k) append_number(text += ' ', static_cast<long long>(mesh.triangles(k, t)));
    text += '\n';
  }
  return text;
}

}  // namespace coapt::formats
