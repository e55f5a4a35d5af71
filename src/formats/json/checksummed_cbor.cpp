#include "formats/json/checksummed_cbor.hpp"

#include "core/error.hpp"
#include "formats/durable_file.hpp"
#include "formats/whole_file.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

namespace coapt {
namespace {

// The library reads CBOR by recursion: this ends the parsing where the nesting is deeper than we ever write,
// before the stack is at its end.
class NestingWatch final : public nlohmann::json_sax<Json> {
 public:
  bool start_object(std::size_t) override { return ++depth_ <= kGreatestDepth; }
  bool start_array(std::size_t) override { return ++depth_ <= kGreatestDepth; }
  bool end_object() override { return --depth_ >= 0; }
  bool end_array() override { return --depth_ >= 0; }
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool key(string_t&) override { return true; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }

  bool is_too_deep() const { return depth_ > kGreatestDepth; }

 private:
  static constexpr int kGreatestDepth = 16;
  int depth_ = 0;
};

Json shallow_cbor(std::string_view body) {
  NestingWatch watch;
  Json::sax_parse(body, &watch, Json::input_format_t::cbor);
  if (watch.is_too_deep()) throw std::domain_error("nested too deep");
  return Json::from_cbor(body);
}

}  // namespace

void Fingerprint::add(std::string_view bytes) {
  for (const char byte : bytes) hash_ = (hash_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
}

std::string Fingerprint::digits() const {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash_));
  return text;
}

std::string fingerprint(std::string_view bytes) {
  Fingerprint result;
  result.add(bytes);
  return result.digits();
}

void write_checksummed(const std::filesystem::path& path, const Seal& seal, const Json& json) {
  std::string body;
  Json::to_cbor(json, body);
  formats::write_durable(
      path, std::string(seal.kind) + " " + std::string(seal.format) + " " + fingerprint(body) + "\n" + body);
}

Json read_checksummed(const std::filesystem::path& path, const Seal& seal) {
  const std::string bytes = formats::read_whole(path), file = path.string(), remedy(seal.remedy);
  const std::string_view all = bytes;
  const std::string begin = std::string(seal.kind) + " ";
  const size_t end = all.find('\n');
  if (!all.starts_with(begin) || end == std::string_view::npos)
    throw InputError(file + ": is no " + std::string(seal.what) +
                     "; name the file that was given to --checkpoint");
  const std::string_view line = all.substr(begin.size(), end - begin.size()), body = all.substr(end + 1);
  const size_t space = line.find(' ');
  if (line.substr(0, space) != seal.format)
    throw InputError(file + ": is a " + std::string(seal.what) + " of format " +
                     std::string(line.substr(0, space).substr(0, 20)) + ", this version reads format " +
                     std::string(seal.format) + remedy);
  if (space == std::string_view::npos || line.substr(space + 1) != fingerprint(body))
    throw InputError(file + ": is damaged or cut off" + remedy);
  try {
    return shallow_cbor(body);
  } catch (const std::exception& error) {
    throw InputError(file + ": does not hold what a " + std::string(seal.what) + " holds (" + error.what() +
                     ")" + remedy);
  }
}

int count_of(double value) {
  if (!(value >= 0 && value <= std::numeric_limits<int>::max()) || value != std::trunc(value))
    throw std::domain_error("a count that is none");
  return static_cast<int>(value);
}

double seconds_of(double value) {
  if (!std::isfinite(value) || value < 0) throw std::domain_error("a time that is none");
  return value;
}

}  // namespace coapt
