#include "formats/ply_header.hpp"

#include "formats/text.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace coapt::formats {
namespace {

std::optional<Scalar> scalar_type(std::string_view word) {
  using enum Scalar;
  static constexpr std::array<std::pair<std::string_view, Scalar>, 16> kTypes = {{{"char", Int8},
                                                                                  {"int8", Int8},
                                                                                  {"uchar", UInt8},
                                                                                  {"uint8", UInt8},
                                                                                  {"short", Int16},
                                                                                  {"int16", Int16},
                                                                                  {"ushort", UInt16},
                                                                                  {"uint16", UInt16},
                                                                                  {"int", Int32},
                                                                                  {"int32", Int32},
                                                                                  {"uint", UInt32},
                                                                                  {"uint32", UInt32},
                                                                                  {"float", Float32},
                                                                                  {"float32", Float32},
                                                                                  {"double", Float64},
                                                                                  {"float64", Float64}}};
  for (const auto& [name, type] : kTypes)
    if (name == word) return type;
  return std::nullopt;
}

PlyRole role_of(const std::string& element, const PlyProperty& property) {
  const std::string& name = property.name;
  if (element == "vertex" && !property.is_list && name.size() == 1 && name[0] >= 'x' && name[0] <= 'z')
    return static_cast<PlyRole>(static_cast<int>(PlyRole::X) + (name[0] - 'x'));
  if (element != "face") return PlyRole::None;
  if (property.is_list && (name == "vertex_indices" || name == "vertex_index")) return PlyRole::Corners;
  return !property.is_list && name == "region" ? PlyRole::Region : PlyRole::None;
}

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, Defects& defects) : lines_(bytes), defects_(defects) {}

  PlyHeader read() {
    std::string_view rest;
    if (!lines_.next(rest) || trimmed(rest) != "ply") defects_.fail("does not begin with 'ply'");
    bool ended = false;
    while (!ended && lines_.next(rest)) {
      const std::string_view word = next_word(rest);
      if (word == "format")
        read_format(next_word(rest));
      else if (word == "element")
        read_element(rest);
      else if (word == "property")
        read_property(rest);
      else if (word == "comment")
        read_comment(rest);
      else if (word == "end_header")
        ended = true;
      else if (!word.empty() && word != "obj_info")
        add(quoted(word) + " is not a statement of a PLY header");
    }
    if (!ended) defects_.fail("the header does not end with 'end_header'; is the file truncated?");
    if (!has_format_) defects_.add("the header has no 'format'");
    header_.line_count = lines_.number();
    header_.body = lines_.rest();
    check();
    return std::move(header_);
  }

 private:
  void add(const std::string& what) { defects_.add("line", lines_.number(), what); }

  void read_format(std::string_view word) {
    has_format_ = true;
    if (word == "ascii")
      header_.coding = PlyCoding::Ascii;
    else if (word == "binary_little_endian")
      header_.coding = PlyCoding::BinaryLittle;
    else if (word == "binary_big_endian")
      header_.coding = PlyCoding::BinaryBig;
    else
      add(quoted(word) + " is not a PLY format (ascii, binary_little_endian, binary_big_endian)");
  }

  void read_element(std::string_view rest) {
    PlyElement element;
    element.name = next_word(rest);
    if (const auto reason = read_integer(next_word(rest), element.count))
      add("count of elements: " + *reason);
    if (element.count < 0) add("a negative count of elements");
    header_.elements.push_back(std::move(element));
  }

  void read_property(std::string_view rest) {
    if (header_.elements.empty()) return add("a property before the first element");
    PlyElement& element = header_.elements.back();
    PlyProperty property;
    std::string_view type = next_word(rest);
    if (type == "list") {
      property.is_list = true;
      const std::string_view count = next_word(rest);
      if (const auto known = scalar_type(count); known && *known < Scalar::Float32)
        property.count_type = *known;
      else
        add(quoted(count) + " cannot count the entries of a list");
      type = next_word(rest);
    }
    if (const auto known = scalar_type(type))
      property.type = *known;
    else
      add(quoted(type) + " is not a type of PLY");
    property.name = next_word(rest);
    property.role = role_of(element.name, property);
    element.properties.push_back(std::move(property));
  }

  void read_comment(std::string_view rest) {
    long long number = 0;
    if (next_word(rest) != "region" || read_integer(next_word(rest), number)) return;
    if (number == static_cast<long long>(header_.region_names.size()))
      header_.region_names.emplace_back(trimmed(rest));
  }

  // Each item takes at least the bytes of its numbers (in ASCII two for each), a list those of its count.
  void check_size() {
    std::uint64_t left = header_.body.size() + 1;  // the last line may lack its end
    for (const PlyElement& element : header_.elements) {
      std::uint64_t least = 0;
      for (const PlyProperty& property : element.properties)
        least += header_.coding == PlyCoding::Ascii ? 2
                 : property.is_list                 ? byte_count(property.count_type)
                                                    : byte_count(property.type);
      if (least == 0) continue;
      const std::uint64_t count = static_cast<std::uint64_t>(std::max(0LL, element.count));
      if (count > left / least)
        defects_.fail(std::to_string(count) + " of element '" + element.name +
                      "' announced, which the file cannot hold");
      left -= count * least;
    }
  }

  void check() {
    int vertex_roles = 0, corner_lists = 0;
    for (const PlyElement& element : header_.elements)
      for (const PlyProperty& property : element.properties) {
        const int role = static_cast<int>(property.role);
        if (role >= 1 && role <= 3) vertex_roles |= 1 << role;
        corner_lists += property.role == PlyRole::Corners;
      }
    if (vertex_roles != 0b1110) defects_.add("the element 'vertex' needs the properties x, y and z");
    if (corner_lists != 1) defects_.add("the element 'face' needs one list 'vertex_indices'");
    defects_.throw_if_any();
    check_size();
  }

  Lines lines_;
  Defects& defects_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

PlyHeader read_ply_header(std::string_view bytes, Defects& defects) {
  if (bytes.empty()) defects.fail("the file is empty");
  return HeaderReader(bytes, defects).read();
}

}  // namespace coapt::formats
