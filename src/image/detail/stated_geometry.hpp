// What a file with a text header says of where its volume lies. ITK fills in what is missing and does not
// tell.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace coapt {

struct StatedGeometry {
  bool spacing = false, direction = false;
  bool is_list = false;    // of NRRD: an axis counts the frames of a sequence
  std::string space = {};  // of NRRD: "left-posterior-superior", ...; empty: not stated
};

// Of an NRRD file, or of its detached header. Fields that are not there, or hold no number, are not stated.
StatedGeometry stated_in_nrrd(const std::filesystem::path& path);

// Of a MetaImage file.
StatedGeometry stated_in_meta_image(const std::filesystem::path& path);

// Throws InputError where the file of a MetaImage's voxels is not there, or holds fewer than `wanted` bytes
// and they are not compressed: ITK takes what is missing as it happens to be in memory.
void check_meta_image_data(const std::filesystem::path& path, std::uintmax_t wanted);

// The same for a file of NIfTI, packed or not: ITK takes zeros for what is missing.
void check_nifti_data(const std::filesystem::path& path, std::uintmax_t wanted);

}  // namespace coapt
