// VTK XML PolyData: points and polygons, the whole-number cell array `region` and the strings
// `region_names`. Data inline or appended, as text, base64 or raw bytes, compressed by zlib or not.
#include "core/error.hpp"
#include "formats/formats.hpp"
#include "formats/mesh_builder.hpp"
#include "formats/text.hpp"
#include "formats/vtk/vtk_coding.hpp"

#include <pugixml.hpp>

#include <cmath>

namespace coapt::formats {
namespace {

struct TypeName {
  std::string_view name;
  Scalar type;
};
constexpr TypeName kTypes[] = {{"Int8", Scalar::Int8},       {"UInt8", Scalar::UInt8},
                               {"Int16", Scalar::Int16},     {"UInt16", Scalar::UInt16},
                               {"Int32", Scalar::Int32},     {"UInt32", Scalar::UInt32},
                               {"Int64", Scalar::Int64},     {"UInt64", Scalar::UInt64},
                               {"Float32", Scalar::Float32}, {"Float64", Scalar::Float64}};
constexpr double kMostRegions = 10000;

// Numbers that a file may hold besides those that its bytes account for, and for each of its bytes. A mesh
// has at most some two a byte, however well it is packed; zlib's best is a thousand bytes for one.
constexpr std::uint64_t kMostNumbers = std::uint64_t{8} << 20;
constexpr std::uint64_t kMostNumbersPerByte = 10;

class VtpReader {
 public:
  VtpReader(std::string_view bytes, const std::string& file)
      : bytes_(bytes), defects_(file), builder_(defects_, "polygon", 0) {}

  MeshFile read() {
    if (bytes_.empty()) defects_.fail("the file is empty");
    parse();
    const pugi::xml_node data = document_.child("VTKFile").child("PolyData");
    if (!data) defects_.fail("is not a VTK XML file of type PolyData");
    read_coding(document_.child("VTKFile"));
    for (const pugi::xml_node& piece : data.children("Piece"))
      if (!holds_too_much_) read_piece(piece);
    if (left_out_ > 0)
      builder_.warnings.push_back(defects_.file() + ": " + std::to_string(left_out_) +
                                  " points, lines or strips are no polygons and were left out");
    const pugi::xml_node field_data = data.child("FieldData");
    // Not within the call: a compiler may well empty regions_ into its argument first.
    std::vector<std::string> names = has_regions_ ? region_names(field_data) : std::vector<std::string>();
    MeshFile file = has_regions_ ? builder_.finish(std::move(regions_), std::move(names)) : builder_.finish();
    if (const auto space = texts(field_data, "SPACE");
        !space.empty() && (space[0] == "RAS" || space[0] == "LPS"))
      file.space = space[0];
    return file;
  }

 private:
  // Raw bytes are no XML: only what stands before them is parsed.
  void parse() {
    std::string_view xml = bytes_;
    std::string closed;
    const size_t begin = bytes_.find("<AppendedData");
    if (begin != std::string_view::npos) {
      const size_t underscore = bytes_.find('_', std::min(bytes_.find('>', begin), bytes_.size()));
      if (underscore == std::string_view::npos) defects_.fail("AppendedData does not begin with '_'");
      const std::string_view head = bytes_.substr(begin, underscore - begin);
      appended_is_base64_ = head.find("base64") != std::string_view::npos;
      const size_t end = bytes_.rfind("</AppendedData>");
      appended_ = bytes_.substr(underscore + 1);
      if (end != std::string_view::npos && end > underscore)
        appended_ = bytes_.substr(underscore + 1, end - underscore - 1);
      closed = std::string(bytes_.substr(0, begin)) + "</VTKFile>";
      xml = closed;
    }
    const pugi::xml_parse_result result = document_.load_buffer(xml.data(), xml.size());
    if (!result)
      defects_.fail("is not XML: " + std::string(result.description()) + " at byte " +
                    std::to_string(result.offset));
  }

  void read_coding(const pugi::xml_node& root) {
    const std::string_view order = root.attribute("byte_order").as_string("LittleEndian");
    coding_.swap = (order == "LittleEndian") != kLittleEndian;
    coding_.wide_header = std::string_view(root.attribute("header_type").as_string()) == "UInt64";
    const std::string_view compressor = root.attribute("compressor").as_string();
    coding_.compressed = !compressor.empty();
    if (coding_.compressed && compressor != "vtkZLibDataCompressor")
      defects_.fail("is compressed by " + quoted(compressor) + "; only vtkZLibDataCompressor is read");
  }

  // The numbers of one data array. A defect is noted and gives an empty array.
  template <class Number>
  std::vector<Number> numbers(const pugi::xml_node& node, const std::string& what) {
    const auto fail = [&](const std::string& reason) {
      defects_.add(what + ": " + reason);
      return std::vector<Number>{};
    };
    if (!node) return fail("the data array is missing");
    const std::string_view type_name = node.attribute("type").as_string();
    const TypeName* type = nullptr;
    for (const TypeName& known : kTypes)
      if (known.name == type_name) type = &known;
    if (!type) return fail(quoted(type_name) + " is not a type of number");
    const std::string_view format = node.attribute("format").as_string("ascii");
    try {
      if (format == "ascii") return from_text<Number>(node.text().get());
      const bool is_appended = format == "appended";
      if (!is_appended && format != "binary") return fail(quoted(format) + " is not a format");
      std::string_view block = node.text().get();
      if (is_appended) {
        const std::uint64_t offset = node.attribute("offset").as_ullong();
        if (offset > appended_.size()) return fail("its offset lies behind the appended data");
        block = appended_.substr(offset);
      }
      const size_t width = byte_count(type->type);
      const std::string bytes = array_bytes(block, !is_appended || appended_is_base64_, coding_,
                                            [&](std::uint64_t size) { take(size, width); });
      std::vector<Number> values(bytes.size() / width);
      for (size_t i = 0; i < values.size(); ++i)
        values[i] = checked<Number>(load_as<double>(type->type, bytes.data() + i * width, coding_.swap));
      return values;
    } catch (const InputError& error) {
      return fail(error.what());
    }
  }

  // Takes numbers of this width [bytes] from those that may still be decoded, also where their array proves
  // to be damaged: many pieces may name the same one.
  void take(std::uint64_t size, size_t width) {
    if (size / width > numbers_left_) holds_too_much_ = true;
    if (holds_too_much_)
      throw InputError("announces " + std::to_string(size >> 20) +
                       " MB, with which the file would hold more than " +
                       std::to_string(most_numbers() >> 20) +
                       " million numbers, the most that are read of one of its size; write it uncompressed");
    numbers_left_ -= size / width;
  }
  std::uint64_t most_numbers() const { return kMostNumbers + kMostNumbersPerByte * bytes_.size(); }

  template <class Number>
  static Number checked(double value) {
    if (!std::isfinite(value)) throw InputError("holds a number that is not finite");
    if constexpr (std::is_integral_v<Number>) {
      if (std::abs(value) > 1e15) throw InputError("holds a number that is out of range");
      if (value != std::floor(value)) throw InputError("holds a number that is not whole");
    }
    return static_cast<Number>(value);
  }

  template <class Number>
  static std::vector<Number> from_text(std::string_view text) {
    std::vector<Number> values;
    for (std::string_view word = next_word(text); !word.empty(); word = next_word(text)) {
      double value = 0;
      if (const auto reason = read_number(word, value)) throw InputError(*reason);
      values.push_back(checked<Number>(value));
    }
    return values;
  }

  static pugi::xml_node named(const pugi::xml_node& parent, const char* name) {
    return parent.find_child_by_attribute("DataArray", "Name", name);
  }

  // The piece says how many there are; a file that was cut or edited holds another number.
  void compare_count(const pugi::xml_node& piece, const char* announced, size_t count) {
    if (count == 0 && defects_.any()) return;  // said already
    const pugi::xml_attribute number = piece.attribute(announced);
    if (number && number.as_llong(-1) != static_cast<long long>(count))
      defects_.add(std::string(announced) + " is " + quoted(number.as_string()) + ", but the file holds " +
                   std::to_string(count));
  }

  void read_piece(const pugi::xml_node& piece) {
    const long long first_vertex = builder_.vertex_count();
    const auto points = numbers<double>(piece.child("Points").child("DataArray"), "Points");
    if (points.size() % 3 != 0) defects_.add("Points: the coordinates are not a multiple of 3");
    compare_count(piece, "NumberOfPoints", points.size() / 3);
    for (size_t i = 0; i + 2 < points.size(); i += 3)
      builder_.add_vertex(points[i], points[i + 1], points[i + 2]);

    size_t cells_before = 0;
    for (const char* kind : {"Verts", "Lines", "Strips"}) {
      const long long count = piece.attribute((std::string("NumberOf") + kind).c_str()).as_llong();
      if (count <= 0) continue;
      left_out_ += static_cast<size_t>(count);
      if (std::string_view(kind) != "Strips") cells_before += static_cast<size_t>(count);
    }
    const pugi::xml_node polys = piece.child("Polys");
    if (!polys || piece.attribute("NumberOfPolys").as_llong(1) == 0) return;
    const auto corners = numbers<long long>(named(polys, "connectivity"), "Polys connectivity");
    const auto ends = numbers<long long>(named(polys, "offsets"), "Polys offsets");
    compare_count(piece, "NumberOfPolys", ends.size());
    if (!ends.empty() && ends.back() < static_cast<long long>(corners.size()))
      defects_.add("Polys connectivity: holds corners behind the last offset");
    std::vector<double> regions;
    if (const pugi::xml_node node = named(piece.child("CellData"), "region")) {
      regions = numbers<double>(node, "CellData region");
      has_regions_ = true;
    }
    long long begin = 0;
    std::vector<long long> polygon;
    for (size_t p = 0; p < ends.size(); ++p) {
      if (ends[p] < begin || ends[p] > static_cast<long long>(corners.size()))
        return defects_.add("polygon", static_cast<long long>(p), "its offset is out of range");
      polygon.clear();
      for (; begin < ends[p]; ++begin) {
        const long long corner = corners[static_cast<size_t>(begin)];
        polygon.push_back(corner < 0 ? corner : first_vertex + corner);
      }
      builder_.add_face(polygon, static_cast<long long>(p));
      const double region = cells_before + p < regions.size() ? regions[cells_before + p] : 0;
      regions_.resize(static_cast<size_t>(builder_.triangle_count()),
                      region >= 0 && region < kMostRegions ? static_cast<int>(region) : 0);
    }
  }

  // Strings are stored as character codes, each string ended by a zero.
  static std::vector<std::string> texts(const pugi::xml_node& field_data, const char* array) {
    std::vector<std::string> names;
    std::string_view codes = field_data.find_child_by_attribute("Array", "Name", array).text().get();
    std::string name;
    for (std::string_view word = next_word(codes); !word.empty(); word = next_word(codes)) {
      long long code = 0;
      if (read_integer(word, code)) break;
      if (code != 0) {
        name += static_cast<char>(code);
        continue;
      }
      names.push_back(std::move(name));
      name.clear();
    }
    return names;
  }

  std::vector<std::string> region_names(const pugi::xml_node& field_data) const {
    std::vector<std::string> names = texts(field_data, "region_names");
    for (const int region : regions_)
      while (static_cast<int>(names.size()) <= region)
        names.push_back("region " + std::to_string(names.size()));
    return names;
  }

  std::string_view bytes_;
  Defects defects_;
  MeshBuilder builder_;
  pugi::xml_document document_;
  std::string_view appended_;
  bool appended_is_base64_ = false;
  VtkCoding coding_;
  std::uint64_t numbers_left_ = most_numbers();  // that may still be decoded
  bool holds_too_much_ = false;
  std::vector<int> regions_;
  bool has_regions_ = false;
  size_t left_out_ = 0;
};

}  // namespace

MeshFile read_vtp(std::string_view bytes, const std::string& file) { return VtpReader(bytes, file).read(); }

}  // namespace coapt::formats
