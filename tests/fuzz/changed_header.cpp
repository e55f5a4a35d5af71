#include "fuzz/changed_header.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace coapt::fuzz {
namespace {

constexpr std::array<std::string_view, 16> kNumbers = {
    "0",     "-1",    "1",          "2",   "3.5", "1e-320",     "1e308", "-1e39",
    "32768", "65536", "2147483647", "nan", "inf", "4294967295", "99999", "9223372036854775807"};
constexpr std::string_view kDigits = "+-.0123456789";
constexpr std::size_t kNiftiHeader = 348, kNiftiMagic = 344, kDicomMagic = 128;  // [bytes]

std::size_t below(std::mt19937& random, std::size_t bound) { return bound == 0 ? 0 : random() % bound; }

// Where the header of a text ends; 0 where the bytes are no such text.
std::size_t text_header(std::string_view bytes) {
  if (bytes.substr(0, 4) == "NRRD") {
    const std::size_t blank = bytes.find("\n\n");
    return blank == std::string_view::npos ? bytes.size() : blank + 1;
  }
  const std::size_t last = bytes.find("ElementDataFile");
  if (last == std::string_view::npos) return 0;
  const std::size_t end = bytes.find('\n', last);
  return end == std::string_view::npos ? bytes.size() : end + 1;
}

std::vector<std::string> lines_of(std::string_view header) {
  std::vector<std::string> lines;
  while (!header.empty()) {
    const std::size_t end = std::min(header.find('\n'), header.size() - 1);
    lines.emplace_back(header.substr(0, end + 1));
    header.remove_prefix(end + 1);
  }
  return lines;
}

// Behind the colon or equals sign and its blanks; the end where the line has none.
std::size_t value_of(const std::string& line) {
  const std::size_t sign = line.find_first_of(":=");
  return sign == std::string::npos ? line.size() : std::min(line.find_first_not_of(":= ", sign), line.size());
}

struct Piece {
  std::size_t place = 0, length = 0;
};

std::vector<Piece> numbers_of(const std::string& line) {
  std::vector<Piece> found;
  for (std::size_t place = value_of(line);;) {
    place = line.find_first_of(kDigits, place);
    if (place == std::string::npos) return found;
    const std::size_t end = std::min(line.find_first_not_of(kDigits, place), line.size());
    found.push_back({place, end - place});
    place = end;
  }
}

std::string_view number_from(const std::vector<std::string>& lines, std::mt19937& random) {
  const std::string& line = lines[below(random, lines.size())];
  const std::vector<Piece> numbers = numbers_of(line);
  if (numbers.empty() || below(random, 3) > 0) return kNumbers[below(random, kNumbers.size())];
  const Piece& one = numbers[below(random, numbers.size())];
  return std::string_view(line).substr(one.place, one.length);
}

void change_line(std::vector<std::string>& lines, std::mt19937& random) {
  const std::size_t k = below(random, lines.size());
  std::string& line = lines[k];
  const std::vector<Piece> numbers = numbers_of(line);
  switch (below(random, 6)) {
    case 0:
      lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(k));
      return;
    case 1:
      lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(k), std::string(line));
      return;
    case 2: {
      const std::string other = lines[below(random, lines.size())];
      line = line.substr(0, value_of(line)) + other.substr(value_of(other));
      return;
    }
    default:
      if (numbers.empty()) return;
      const Piece& one = numbers[below(random, numbers.size())];
      line.replace(one.place, one.length, std::string(number_from(lines, random)));
  }
}

template <class Number>
void write(std::string& bytes, std::size_t place, Number value) {
  std::memcpy(bytes.data() + place, &value, sizeof value);
}

void change_field(std::string& bytes, std::size_t begin, std::size_t end, std::mt19937& random) {
  const std::size_t place = begin + 2 * below(random, (end - begin - 4) / 2);
  constexpr std::array<std::int16_t, 8> shorts = {0, -1, 1, 3, 8, 2000, 32767, -32768};
  constexpr std::array<std::uint32_t, 6> longs = {0, 1, 0xffff, 0x7fffffff, 0x80000000, 0xffffffff};
  constexpr float greatest = std::numeric_limits<float>::max();
  constexpr std::array<float, 7> floats = {0,
                                           -1,
                                           1e-40F,
                                           greatest,
                                           -greatest,
                                           std::numeric_limits<float>::infinity(),
                                           std::numeric_limits<float>::quiet_NaN()};
  switch (below(random, 3)) {
    case 0:
      return write(bytes, place, shorts[below(random, shorts.size())]);
    case 1:
      return write(bytes, place, longs[below(random, longs.size())]);
    default:
      return write(bytes, place, floats[below(random, floats.size())]);
  }
}

}  // namespace

std::string changed_header(std::string_view bytes, std::size_t seed) {
  std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
  const std::size_t times = 1 + below(random, 3);
  if (const std::size_t end = text_header(bytes); end > 0) {
    std::vector<std::string> lines = lines_of(bytes.substr(0, end));
    for (std::size_t k = 0; k < times && !lines.empty(); ++k) change_line(lines, random);
    std::string changed;
    for (const std::string& line : lines) changed += line;
    return changed.append(bytes.substr(end));
  }
  const bool is_nifti = bytes.size() >= kNiftiHeader && bytes.substr(kNiftiMagic, 3) == "n+1";
  const bool is_dicom = bytes.size() > kDicomMagic + 12 && bytes.substr(kDicomMagic, 4) == "DICM";
  if (!is_nifti && !is_dicom) return {};
  std::string changed(bytes);
  for (std::size_t k = 0; k < times; ++k)
    change_field(changed, is_nifti ? 0 : kDicomMagic + 4, is_nifti ? kNiftiMagic : bytes.size(), random);
  return changed;
}

}  // namespace coapt::fuzz
