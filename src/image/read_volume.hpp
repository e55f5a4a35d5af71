// Volume images from files: NRRD (.nrrd, .nhdr; also the sequences .seq.nrrd of 3D Slicer), NIfTI (.nii,
// .nii.gz) and DICOM (a folder with the slices of one series, or a file with several slices) by the readers
// of ITK, MetaImage (.mha, .mhd) by our own. DICOM is read in a copy of the process first (fork), as GDCM
// ends the program on some damaged files.
#pragma once

#include "image/volume.hpp"
#include "image/voxel_kind.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace coapt {

// Greatest number of voxels of a file, over all of its frames: a header that promises more is refused before
// anything is allocated. 1024 x 1024 x 1024 fit.
inline constexpr double kMostVoxels = 1073741824;

struct VolumeFile {
  Volume volume;                      // without values where only the header was read
  std::string format;                 // "NRRD", "NIfTI", "MetaImage", "DICOM"
  VoxelKind kind = VoxelKind::UInt8;  // in the file
  int frames = 1;                     // of a time series
  bool states_spacing = true;         // whether the file says how large its voxels are
  std::vector<std::string> warnings;  // what was assumed, and what is unusual; each names the file
};

struct VolumeReadOptions {
  std::optional<int> frame;              // of a time series, from 0
  std::optional<Vec3> spacing;           // in place of the file's [mm]
  std::string frame_option = "--frame";  // by which a user chooses the frame, for what is said of it
};

// Size, grid, kind of voxel and number of frames. Positions are turned to LPS where the file has them in RAS
// or LAS. A file that says nothing of its axes lies along x, y and z, which is warned of; so are voxels whose
// longest edge is more than 1.5 times the shortest. Throws InputError, naming file, reason and remedy, for a
// path that is no such file, an empty file, other dimensions than three (and time), colours or vectors as
// voxels, more than kMostVoxels voxels, a spacing that is not positive, directions that are not orthogonal
// (to 0.001), and for slices of a series that do not lie evenly behind each other, or are of several series.
VolumeFile read_volume_header(const std::filesystem::path& path, const VolumeReadOptions& options = {});

// The same with the values. Throws InputError also for a time series without a frame chosen, a frame that is
// not there, a file that says nothing of its spacing where the options do not either, a file that ends too
// early, for voxels that are not finite, and for a DICOM file that its reader does not survive.
VolumeFile read_volume(const std::filesystem::path& path, const VolumeReadOptions& options = {});

}  // namespace coapt
