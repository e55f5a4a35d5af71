#include "formats/vtk/vtp_writer.hpp"

#include "core/error.hpp"
#include "formats/bytes.hpp"
#include "formats/text.hpp"
#include "formats/whole_file.hpp"
#include "formats/xml_escaped.hpp"

#include <cmath>
#include <set>

namespace coapt {
namespace {

using formats::append_number;
using formats::store;
using formats::xml_escaped;

// Whole numbers that VTK holds in 32 bits; a value without meaning is -1.
std::int32_t whole(double value) {
  return std::abs(value) < 2147483648.0 ? static_cast<std::int32_t>(std::lround(value)) : -1;
}

// Writes the XML text and, beside it, the block of appended bytes.
class VtpDocument {
 public:
  explicit VtpDocument(MeshCoding coding) : coding_(coding) {}

  void line(const std::string& text) { xml_ += text + '\n'; }

  void array(const VtpArray& array) {
    open(array.name, array.integer ? "Int32" : "Float64", array.values.rows());
    const Eigen::Index count = array.values.size();  // column by column: a node's components together
    begin(static_cast<size_t>(count) * (array.integer ? 4 : 8));
    for (Eigen::Index i = 0; i < count; ++i) {
      const double value = array.values.data()[i];
      if (array.integer)
        number(whole(value));
      else
        number(value);
    }
    close();
  }

  // Points and cell corners, whose types are given.
  template <class Array>
  void numbers(const std::string& name, const char* type, int components, const Array& values) {
    using Number = typename Array::value_type;
    open(name, type, components);
    begin(values.size() * sizeof(Number));
    for (const Number value : values) number(value);
    close();
  }

  // VTK keeps a string as its character codes and a zero, in text also for appended files.
  void text(const VtpText& text) {
    xml_ += "<Array type=\"String\" Name=\"" + xml_escaped(text.name) + "\" NumberOfTuples=\"" +
            std::to_string(text.values.size()) + "\" format=\"ascii\">\n";
    for (const std::string& value : text.values) {
      for (const char c : value) xml_ += std::to_string(static_cast<unsigned char>(c)) + ' ';
      xml_ += "0\n";
    }
    xml_ += "</Array>\n";
  }

  void write(const std::filesystem::path& path) const {
    if (coding_ == MeshCoding::Binary)
      formats::write_whole(
          path, {xml_, "<AppendedData encoding=\"raw\">\n_", appended_, "\n</AppendedData>\n</VTKFile>\n"});
    else
      formats::write_whole(path, {xml_, "</VTKFile>\n"});
  }

 private:
  void open(const std::string& name, const char* type, Eigen::Index components) {
    xml_ += "<DataArray type=\"" + std::string(type) + "\" Name=\"" + xml_escaped(name) +
            "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\"";
  }
  void begin(size_t byte_count) {
    if (coding_ == MeshCoding::Binary) {
      xml_ += "appended\" offset=\"" + std::to_string(appended_.size()) + "\"";
      store(appended_, static_cast<std::uint64_t>(byte_count));
    } else {
      xml_ += "ascii\">\n";
    }
  }
  template <class Number>
  void number(Number value) {
    if (coding_ == MeshCoding::Binary) return store(appended_, value);
    if constexpr (std::is_same_v<Number, double>)
      append_number(xml_, value);
    else
      append_number(xml_, static_cast<long long>(value));
    xml_ += ' ';
  }
  void close() { xml_ += coding_ == MeshCoding::Binary ? "/>\n" : "\n</DataArray>\n"; }

  MeshCoding coding_;
  std::string xml_, appended_;
};

void check_arrays(const std::vector<VtpArray>& arrays, Eigen::Index columns, const std::string& of,
                  const std::string& file, std::vector<std::string>& defects) {
  std::set<std::string> names;
  for (const VtpArray& array : arrays) {
    if (array.values.cols() != columns)
      defects.push_back(file + ": array '" + array.name + "' has " + std::to_string(array.values.cols()) +
                        " columns for " + std::to_string(columns) + " " + of);
    if (!names.insert(array.name).second)
      defects.push_back(file + ": two arrays of the " + of + " are named '" + array.name + "'");
  }
}

// Lines first, then triangles.
std::vector<VtpArray> cell_arrays(const VtpSurface& surface, const std::string& file,
                                  std::vector<std::string>& defects) {
  const Eigen::Index lines = surface.lines.cols(), triangles = surface.triangles.cols();
  std::vector<VtpArray> cells;
  const auto blank = [&](const VtpArray& like) {
    const double empty = like.integer ? -1 : 0;
    return VtpArray{like.name, Eigen::MatrixXd::Constant(like.values.rows(), lines + triangles, empty),
                    like.integer};
  };
  for (const VtpArray& array : surface.triangle_arrays) {
    cells.push_back(blank(array));
    cells.back().values.rightCols(triangles) = array.values;
  }
  for (const VtpArray& array : surface.line_arrays) {
    auto found = cells.begin();
    while (found != cells.end() && found->name != array.name) ++found;
    if (found == cells.end()) found = cells.insert(cells.end(), blank(array));
    if (found->values.rows() != array.values.rows() || found->integer != array.integer)
      defects.push_back(file + ": array '" + array.name + "' differs in kind between lines and triangles");
    else
      found->values.leftCols(lines) = array.values;
  }
  return cells;
}

template <class Cells>
void add_cells(VtpDocument& out, const std::string& kind, const Cells& cells) {
  const std::vector<std::int32_t> corners(cells.data(), cells.data() + cells.size());
  std::vector<std::int32_t> offsets;
  offsets.reserve(static_cast<size_t>(cells.cols()));
  for (Eigen::Index c = 1; c <= cells.cols(); ++c)
    offsets.push_back(static_cast<std::int32_t>(c * cells.rows()));
  out.line("<" + kind + ">");
  out.numbers("connectivity", "Int32", 1, corners);
  out.numbers("offsets", "Int32", 1, offsets);
  out.line("</" + kind + ">");
}

}  // namespace

void write_vtp(const std::filesystem::path& path, const VtpSurface& surface, MeshCoding coding) {
  std::vector<std::string> defects;
  const std::string file = path.string();
  check_arrays(surface.point_arrays, surface.vertices.cols(), "vertices", file, defects);
  check_arrays(surface.triangle_arrays, surface.triangles.cols(), "triangles", file, defects);
  check_arrays(surface.line_arrays, surface.lines.cols(), "lines", file, defects);
  if (!defects.empty()) throw InputError(defects);
  const std::vector<VtpArray> cells = cell_arrays(surface, file, defects);
  if (!defects.empty()) throw InputError(defects);

  VtpDocument out(coding);
  out.line("<?xml version=\"1.0\"?>");
  out.line(std::string("<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"") +
           (formats::kLittleEndian ? "LittleEndian" : "BigEndian") + "\" header_type=\"UInt64\">");
  out.line("<PolyData>");
  out.line("<FieldData>");
  for (const VtpText& text : surface.texts) out.text(text);
  out.line("</FieldData>");
  out.line("<Piece NumberOfPoints=\"" + std::to_string(surface.vertices.cols()) +
           "\" NumberOfVerts=\"0\" NumberOfLines=\"" + std::to_string(surface.lines.cols()) +
           "\" NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(surface.triangles.cols()) + "\">");
  out.line("<PointData>");
  for (const VtpArray& array : surface.point_arrays) out.array(array);
  out.line("</PointData>");
  out.line("<CellData>");
  for (const VtpArray& array : cells) out.array(array);
  out.line("</CellData>");
  out.line("<Points>");
  out.array({"Points", surface.vertices, false});
  out.line("</Points>");
  if (surface.lines.cols() > 0) add_cells(out, "Lines", surface.lines);
  add_cells(out, "Polys", surface.triangles);
  out.line("</Piece>");
  out.line("</PolyData>");
  out.write(path);
}

}  // namespace coapt
