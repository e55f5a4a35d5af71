#include "image/detail/meta_image.hpp"

#include "core/error.hpp"
#include "formats/text.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace coapt {
namespace {

namespace fs = std::filesystem;
using formats::next_word;
using formats::trimmed;

constexpr std::streamsize kMostHeaderBytes = 1 << 24;  // bytes in which ElementDataFile must come
constexpr int kMostDimensions = 10;                    // axes that the format knows
constexpr std::size_t kChunk = 1 << 20;                // bytes that are unpacked at a time

// Kinds of numbers by their names without MET_; LONG has 32 bits in this format, whatever the machine.
constexpr std::array<std::pair<std::string_view, VoxelKind>, 12> kElementTypes{
    {{"CHAR", VoxelKind::Int8},
     {"UCHAR", VoxelKind::UInt8},
     {"SHORT", VoxelKind::Int16},
     {"USHORT", VoxelKind::UInt16},
     {"INT", VoxelKind::Int32},
     {"UINT", VoxelKind::UInt32},
     {"LONG", VoxelKind::Int32},
     {"ULONG", VoxelKind::UInt32},
     {"LONG_LONG", VoxelKind::Int64},
     {"ULONG_LONG", VoxelKind::UInt64},
     {"FLOAT", VoxelKind::Float32},
     {"DOUBLE", VoxelKind::Float64}}};

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// A damaged line may hold what would break a message.
std::string in_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, '?');
  return text;
}

[[noreturn]] void refuse_header(const fs::path& path, const std::string& reason) {
  throw InputError(path.string() + ": its header cannot be read as MetaImage: " + in_one_line(reason) +
                   "; mend it, or export it again");
}

[[noreturn]] void refuse_voxels(const fs::path& path, const std::string& reason) {
  throw InputError(path.string() + ": its voxels cannot be read: " + in_one_line(reason) +
                   "; copy or export it again");
}

// The lines up to ElementDataFile.
class MetaFields {
 public:
  explicit MetaFields(const fs::path& path) : path_(path) {
    std::ifstream file(path, std::ios::binary);
    std::string text(static_cast<std::size_t>(std::min<std::uintmax_t>(
                         fs::file_size(path), static_cast<std::uintmax_t>(kMostHeaderBytes))),
                     '\0');
    if (!file.read(text.data(), static_cast<std::streamsize>(text.size())))
      refuse_header(path, "the file cannot be read to its end");
    formats::Lines lines(text);
    for (std::string_view line; !has("elementdatafile") && lines.next(line);) take(line, lines.number());
    end_ = text.size() - lines.rest().size();
    for (const char* key : {"NDims", "DimSize", "ElementType", "ElementDataFile"})
      if (!has(lower_case(key))) refuse_header(path, std::string(key) + " is missing");
  }

  std::size_t end() const { return end_; }  // where the bytes behind the header begin
  bool has(const std::string& key) const { return values_.contains(key); }
  std::string text(const std::string& key) const { return has(key) ? values_.at(key) : ""; }
  bool is_true(const std::string& key) const {
    const std::string value = lower_case(text(key));
    return value.starts_with('t') || value == "1";
  }

  // Empty where none of these keys is there; else just as many finite numbers.
  std::vector<double> numbers(std::initializer_list<const char*> keys, std::size_t count) const {
    for (const char* key : keys) {
      if (!has(lower_case(key))) continue;
      std::string_view rest = values_.at(lower_case(key));
      std::vector<double> found;
      for (auto word = next_word(rest); !word.empty() && found.size() <= count; word = next_word(rest)) {
        double value = 0;
        if (const auto reason = formats::read_number(word, value))
          refuse_header(path_, std::string(key) + ": " + *reason);
        found.push_back(value);
      }
      if (found.size() != count)
        refuse_header(path_, std::string(key) + " wants " + std::to_string(count) + " numbers, not " +
                                 formats::quoted(text(lower_case(key))));
      return found;
    }
    return {};
  }

  // The default where the key is not there.
  long long whole(const char* key, long long least, long long greatest,
                  std::optional<long long> missing) const {
    const std::vector<double> found = numbers({key}, 1);
    if (found.empty() && missing) return *missing;
    if (found.empty() || found[0] != std::floor(found[0]) || found[0] < static_cast<double>(least) ||
        found[0] > static_cast<double>(greatest))
      refuse_header(path_, std::string(key) + " is " + formats::quoted(text(lower_case(key))) +
                               ", not a whole number from " + std::to_string(least) + " to " +
                               std::to_string(greatest));
    return static_cast<long long>(found[0]);
  }

 private:
  void take(std::string_view line, int number) {
    if (trimmed(line).empty()) return;
    const std::size_t mark = line.find('=') < line.size() ? line.find('=') : line.find(':');
    const std::string key = lower_case(std::string(trimmed(line.substr(0, mark))));
    const bool is_word = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
      return c >= ' ' && static_cast<unsigned char>(c) < 127;
    });
    if (mark == std::string_view::npos || !is_word)
      refuse_header(path_,
                    "line " + std::to_string(number) + " is no `key = value` but " + formats::quoted(line));
    if (!values_.emplace(key, trimmed(line.substr(mark + 1))).second)
      refuse_header(path_, "line " + std::to_string(number) + " says " + formats::quoted(key) + " once more");
  }

  const fs::path& path_;
  std::map<std::string, std::string> values_;  // by keys in small letters
  std::size_t end_ = 0;
};

VoxelKind element_kind(const fs::path& path, const std::string& name) {
  for (const auto& [its_name, kind] : kElementTypes)
    if (name.starts_with("MET_") && std::string_view(name).substr(4) == its_name) return kind;
  refuse_header(path, "ElementType is " + formats::quoted(name) +
                          ", not a kind of number such as MET_SHORT or MET_FLOAT");
}

FoundImage described_by(const MetaFields& fields, const fs::path& path) {
  if (fields.has("objecttype") && lower_case(fields.text("objecttype")) != "image")
    refuse_header(path, "ObjectType is " + formats::quoted(fields.text("objecttype")) + " instead of Image");
  FoundImage found;
  found.format = "MetaImage";
  const auto axes = static_cast<std::size_t>(fields.whole("NDims", 1, kMostDimensions, {}));
  for (const double size : fields.numbers({"DimSize"}, axes)) {
    if (size != std::floor(size) || size < 1 || size > 1e9)
      refuse_header(path, "DimSize is " + formats::quoted(fields.text("dimsize")) +
                              "; whole positive numbers are wanted");
    found.size.push_back(static_cast<std::size_t>(size));
  }
  found.spacing = fields.numbers({"ElementSpacing", "ElementSize"}, axes);
  found.states_spacing = !found.spacing.empty();
  if (found.spacing.empty()) found.spacing.assign(axes, 1);
  const std::vector<double> origin = fields.numbers({"Offset", "Position", "Origin"}, axes);
  const std::vector<double> matrix =
      fields.numbers({"TransformMatrix", "Rotation", "Orientation"}, axes * axes);
  found.states_direction = !matrix.empty();
  for (std::size_t axis = 0; axis < std::min<std::size_t>(axes, 3); ++axis) {
    const auto column = static_cast<Eigen::Index>(axis);
    if (!origin.empty()) found.origin[column] = origin[axis];
    for (std::size_t row = 0; row < std::min<std::size_t>(axes, 3) && !matrix.empty(); ++row)
      found.direction(static_cast<Eigen::Index>(row), column) = matrix[axis * axes + row];  // an axis a row
  }
  found.components = static_cast<std::size_t>(fields.whole("ElementNumberOfChannels", 1, 1000000, 1));
  found.pixel = found.components > 1 ? "vector" : "scalar";
  found.kind = element_kind(path, fields.text("elementtype"));
  return found;
}

// Between the orders of bytes in numbers of this size.
void turn_bytes(std::vector<char>& bytes, std::size_t size) {
  for (std::size_t at = 0; at + size <= bytes.size(); at += size)
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
}

std::string missing_bytes(const fs::path& data, std::uintmax_t found, std::size_t wanted) {
  return formats::quoted(data.filename().string()) + " holds " + std::to_string(found) +
         " bytes of voxels instead of " + std::to_string(wanted);
}

void unpack(std::ifstream& file, const MetaImageHeader& header, const fs::path& path,
            std::vector<char>& bytes) {
  constexpr int kEitherHead = 47;  // of zlib's window bits: the largest window, heads of zlib and of gzip
  z_stream stream{};
  if (inflateInit2(&stream, kEitherHead) != Z_OK) throw std::bad_alloc();
  std::vector<char> packed(kChunk);
  std::uintmax_t left = header.packed_bytes > 0 ? header.packed_bytes : std::uintmax_t(-1);
  std::size_t done = 0;
  int state = Z_OK;
  while (state == Z_OK && left > 0) {  // to the checksum at the end of the stream
    file.read(packed.data(), static_cast<std::streamsize>(std::min<std::uintmax_t>(packed.size(), left)));
    const auto count = static_cast<std::size_t>(file.gcount());
    if (count == 0) break;
    left -= count;
    stream.next_in = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_in = static_cast<uInt>(count);
    while (state == Z_OK && stream.avail_in > 0) {
      const std::size_t room = std::min(bytes.size() - done, kChunk);
      stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + done);
      stream.avail_out = static_cast<uInt>(room);
      state = inflate(&stream, Z_NO_FLUSH);
      done += room - stream.avail_out;
    }
  }
  inflateEnd(&stream);
  if (state != Z_OK && state != Z_STREAM_END && state != Z_BUF_ERROR)  // which is: more than is wanted
    refuse_voxels(path, "their compressed bytes are damaged");
  if (done < bytes.size()) refuse_voxels(path, missing_bytes(header.data, done, bytes.size()));
}

void read_text(std::ifstream& file, const MetaImageHeader& header, const fs::path& path,
               std::vector<char>& bytes) {
  const std::size_t size = voxel_bytes(header.found.kind), count = bytes.size() / size;
  std::vector<float> values;
  for (double value = 0; values.size() < count && file >> value;) values.push_back(static_cast<float>(value));
  if (values.size() < count)
    refuse_voxels(path, formats::quoted(header.data.filename().string()) + " holds " +
                            std::to_string(values.size()) + " numbers instead of " + std::to_string(count));
  bytes = voxels_as(header.found.kind, values);
}

}  // namespace

MetaImageHeader meta_image_header(const fs::path& path) {
  const MetaFields fields(path);
  MetaImageHeader header;
  header.found = described_by(fields, path);
  const std::string data = fields.text("elementdatafile");
  const bool is_local = lower_case(data) == "local";
  if (data.empty() || data.starts_with("LIST") || data.find('%') != std::string::npos)
    throw InputError(path.string() + ": ElementDataFile is " + in_one_line(formats::quoted(data)) +
                     "; voxels are read from one file alone: convert it, with 3D Slicer for instance");
  header.data = is_local ? path : path.parent_path() / data;
  const long long skipped = fields.whole("HeaderSize", -1, 1LL << 40, 0);
  header.is_at_end = skipped == -1;
  header.first_byte = skipped > 0 ? static_cast<std::uintmax_t>(skipped) : is_local ? fields.end() : 0;
  header.is_packed = fields.is_true("compresseddata");
  header.packed_bytes = static_cast<std::uintmax_t>(fields.whole("CompressedDataSize", 0, 1LL << 40, 0));
  header.is_text = fields.has("binarydata") && !fields.is_true("binarydata") && !header.is_packed;
  header.is_big_endian = fields.is_true("binarydatabyteordermsb") || fields.is_true("elementbyteordermsb");
  return header;
}

std::vector<char> meta_image_voxels(const MetaImageHeader& header, const fs::path& path) {
  std::size_t wanted = voxel_bytes(header.found.kind) * header.found.components;
  for (const std::size_t size : header.found.size) wanted *= size;
  std::error_code error;
  const std::uintmax_t whole = fs::file_size(header.data, error);
  if (error) refuse_voxels(path, formats::quoted(header.data.filename().string()) + ": " + error.message());
  std::uintmax_t first = header.first_byte;
  if (header.is_at_end && !header.is_packed && !header.is_text)
    first = whole - std::min<std::uintmax_t>(whole, wanted);
  const std::uintmax_t there = whole - std::min(whole, first);
  // A byte of zlib's holds at most 1032, and a number of a text is at least one digit and a space.
  const std::uintmax_t most = header.is_packed ? 1040 * there : header.is_text ? 8 * there : there;
  if (most < wanted) refuse_voxels(path, missing_bytes(header.data, there, wanted));
  std::vector<char> bytes(wanted);
  std::ifstream file(header.data, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(first));
  if (header.is_packed) {
    unpack(file, header, path, bytes);
  } else if (header.is_text) {
    read_text(file, header, path, bytes);
  } else if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    refuse_voxels(path, formats::quoted(header.data.filename().string()) + " cannot be read");
  }
  const bool is_turned = header.is_big_endian != (std::endian::native == std::endian::big);
  if (is_turned && !header.is_text) turn_bytes(bytes, voxel_bytes(header.found.kind));
  return bytes;
}

}  // namespace coapt
