// JSON in a file that tells when it is damaged: a line of text, `KIND FORMAT CHECKSUM`, then CBOR (RFC 8949).
#pragma once

#include "formats/json/read_json.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace coapt {

// FNV-1a, 64 bits (Fowler, Noll and Vo): tells files apart, and finds damage that nobody intended.
class Fingerprint {
 public:
  void add(std::string_view bytes);
  std::string digits() const;  // 16, hexadecimal

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};
std::string fingerprint(std::string_view bytes);

struct Seal {
  std::string_view kind;    // "coapt checkpoint"
  std::string_view what;    // for messages: "a checkpoint of coapt"
  std::string_view format;  // "1"
  std::string_view remedy;  // "; solve without --resume to begin anew"
};

// The file appears whole or not at all, and is on the disk when this returns. Throws InputError where it
// cannot be written.
void write_checksummed(const std::filesystem::path& path, const Seal& seal, const Json& json);

// Throws InputError where there is no file, where it is none of these, damaged, cut off or of another format,
// and where it nests deeper than 16.
Json read_checksummed(const std::filesystem::path& path, const Seal& seal);

// What such a file says was counted, and timed [s]. Throw std::domain_error: negative or not finite; a count
// that is not whole or more than an int holds.
int count_of(double value);
double seconds_of(double value);

}  // namespace coapt
