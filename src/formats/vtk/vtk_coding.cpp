#include "formats/vtk/vtk_coding.hpp"

#include "core/error.hpp"

#include <array>
#include <vector>

#ifdef COAPT_HAS_ZLIB
#include <zlib.h>
#endif

namespace coapt::formats {
namespace {

constexpr size_t kDeflateRatio = 1032;  // most that deflate can expand; guards against false sizes

// Gives the first bytes of a block, whatever its coding.
class Block {
 public:
  Block(std::string_view block, bool is_base64) : block_(block), is_base64_(is_base64) {}

  std::string bytes(size_t from, size_t count) const {
    const size_t most = block_.size();
    if (count > most || from > most) throw InputError("announces more data than the file has");
    std::string all =
        is_base64_ ? decoded_base64(block_, from + count) : std::string(block_.substr(0, from + count));
    if (all.size() < from + count) throw InputError("announces more data than the file has");
    return from == 0 ? all : all.substr(from);
  }

 private:
  std::string_view block_;
  bool is_base64_;
};

std::vector<std::uint64_t> words(const std::string& bytes, const VtkCoding& coding) {
  const Scalar type = coding.wide_header ? Scalar::UInt64 : Scalar::UInt32;
  std::vector<std::uint64_t> result;
  for (size_t at = 0; at + byte_count(type) <= bytes.size(); at += byte_count(type))
    result.push_back(load_as<std::uint64_t>(type, bytes.data() + at, coding.swap));
  return result;
}

#ifdef COAPT_HAS_ZLIB
std::string inflated(std::string_view packed, size_t size) {
  std::string bytes(size, '\0');
  uLongf length = static_cast<uLongf>(size);
  const int status =
      uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                 reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
  if (status != Z_OK || length != size) throw InputError("compressed data are damaged");
  return bytes;
}

// Header: number of blocks, their size, size of the last one where it is partial, packed size of each.
std::string inflated_array(const Block& block, const VtkCoding& coding,
                           const std::function<void(std::uint64_t)>& announced) {
  const size_t width = coding.wide_header ? 8 : 4;
  const std::uint64_t block_count = words(block.bytes(0, width), coding)[0];
  if (block_count == 0) return {};
  if (block_count > (std::uint64_t{1} << 31)) throw InputError("announces more blocks than the file has");
  const size_t header_size = width * (3 + static_cast<size_t>(block_count));
  announced(header_size);
  const std::vector<std::uint64_t> header = words(block.bytes(0, header_size), coding);
  const auto size_of = [&](size_t b) {
    return b + 1 == block_count && header[2] > 0 ? header[2] : header[1];
  };
  std::uint64_t packed_size = 0, size = 0;
  for (size_t b = 0; b < block_count; ++b) {
    const bool is_beyond = header[3 + b] > (std::uint64_t{1} << 40);
    if (is_beyond || size_of(b) / kDeflateRatio > header[3 + b] + 1)
      throw InputError("announces more data than the file has");
    packed_size += header[3 + b];
    size += size_of(b);
  }
  announced(packed_size);
  announced(size);
  const std::string packed = block.bytes(header_size, packed_size);
  std::string result;
  result.reserve(size);
  size_t at = 0;
  for (size_t b = 0; b < block_count; ++b) {
    result += inflated(std::string_view(packed).substr(at, header[3 + b]), size_of(b));
    at += header[3 + b];
  }
  return result;
}
#else
std::string inflated_array(const Block&, const VtkCoding&, const std::function<void(std::uint64_t)>&) {
  throw InputError("is compressed; rebuild with zlib (Debian: zlib1g-dev), or write it uncompressed");
}
#endif

std::array<int, 256> base64_values() {
  std::array<int, 256> values{};
  values.fill(-1);
  const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < digits.size(); ++i)
    values[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
  return values;
}

}  // namespace

std::string decoded_base64(std::string_view text, size_t count) {
  static const std::array<int, 256> kValues = base64_values();
  std::string bytes;
  unsigned group = 0;
  int digits = 0, padding = 0;
  for (const char c : text) {
    if (bytes.size() >= count) break;
    if (c == ' ' || (c >= '\t' && c <= '\r')) continue;
    const int value = kValues[static_cast<unsigned char>(c)];
    if (value < 0 && c != '=') throw InputError("holds a character that is not base64");
    if (c == '=') ++padding;
    group = group << 6 | static_cast<unsigned>(value < 0 ? 0 : value);
    if (++digits < 4) continue;
    for (int k = 0; k < 3 - padding; ++k) bytes += static_cast<char>(group >> (16 - 8 * k) & 0xff);
    group = 0;
    digits = padding = 0;
  }
  if (bytes.size() > count) bytes.resize(count);
  return bytes;
}

std::string array_bytes(std::string_view text, bool is_base64, const VtkCoding& coding,
                        const std::function<void(std::uint64_t)>& announced) {
  const Block block(text, is_base64);
  if (coding.compressed) return inflated_array(block, coding, announced);
  const size_t width = coding.wide_header ? 8 : 4;
  const std::uint64_t size = words(block.bytes(0, width), coding)[0];
  announced(size);
  return block.bytes(width, size);
}

}  // namespace coapt::formats
