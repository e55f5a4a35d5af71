// MetaImage (.mha, .mhd), read without ITK, whose reader does not end on some damaged headers.
#pragma once

#include "image/detail/found_image.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace coapt {

// What a header says, and where the voxels lie.
struct MetaImageHeader {
  FoundImage found;
  std::filesystem::path data;               // file of the voxels
  std::uintmax_t first_byte = 0;            // of the voxels in it
  std::uintmax_t packed_bytes = 0;          // where they are compressed; 0: to the end of the file
  bool is_at_end = false;                   // voxels are the last bytes of the file, wherever they begin
  bool is_packed = false, is_text = false;  // by zlib; as decimal numbers
  bool is_big_endian = false;
};

// Every line up to ElementDataFile must be `key = value`; those that are understood must hold as many numbers
// as the dimensions want, and stand there once. Other keys are passed over. Throws InputError, naming file,
// line or key, and remedy. Voxels that are spread over several files (LIST, or a pattern with %) are refused.
MetaImageHeader meta_image_header(const std::filesystem::path& path);

// The voxels as they are in memory. Throws InputError where there are fewer of them than the header promises.
// Pre: their number was found to be no more than can be allocated.
std::vector<char> meta_image_voxels(const MetaImageHeader& header, const std::filesystem::path& path);

}  // namespace coapt
