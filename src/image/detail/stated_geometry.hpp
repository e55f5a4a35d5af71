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

// Throws InputError where a file of NIfTI, packed or not, holds fewer than `wanted` bytes of voxels: ITK
// takes zeros for what is missing.
void check_nifti_data(const std::filesystem::path& path, std::uintmax_t wanted);

}  // namespace coapt
