// The codings of a VTK XML data array: text, base64 or raw bytes, with or without compression.
#pragma once

#include "formats/bytes.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace coapt::formats {

struct VtkCoding {
  bool swap = false;         // the file's byte order is not the machine's
  bool wide_header = false;  // sizes are UInt64, else UInt32
  bool compressed = false;   // vtkZLibDataCompressor
};

// The first `count` bytes that a base64 text stands for (fewer when it ends before). Groups of four
// characters may end in padding anywhere, as VTK codes header and data one after the other.
// Throws InputError, the bare reason, for a character that is not base64.
std::string decoded_base64(std::string_view text, size_t count);

// The bytes of the array that begins at the start of `block` (which may go on behind it).
// announced: called before anything is decoded, with the number of bytes that this takes: header, packed data
// and what they are said to hold; what it throws ends the reading. Throws InputError, the bare reason, when
// the block is shorter than its header says, or cannot be inflated to just what that says.
std::string array_bytes(std::string_view block, bool is_base64, const VtkCoding& coding,
                        const std::function<void(std::uint64_t)>& announced);

}  // namespace coapt::formats
