// Every format of volumes: each input is read as all of them. What is accepted keeps the promises of
// read_volume. DICOM is tried in a process of its own, as GDCM ends the program on some damaged files.
#include "core/error.hpp"
#include "fuzz/fuzz_target.hpp"
#include "image/read_volume.hpp"

#include <algorithm>
#include <cmath>

namespace coapt::fuzz {
namespace {

double voxels_of_header(const VolumeFile& file) {
  double count = file.frames;
  for (const int size : file.volume.size) {
    require(size > 0, "a volume has voxels along every axis");
    count *= size;
  }
  return count;
}

void check_header(const VolumeFile& file) {
  require(voxels_of_header(file) <= kMostVoxels, "no more voxels than are allowed");
  require((file.volume.spacing.array() > 0).all() && file.volume.spacing.allFinite(), "spacing is positive");
  require(file.volume.origin.allFinite(), "the origin is a place");
  const Eigen::Matrix3d& axes = file.volume.direction;
  require((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm() < 1e-9, "axes are orthogonal");
}

void check_values(const VolumeFile& file) {
  const Volume& volume = file.volume;
  require(volume.values.size() == static_cast<std::size_t>(volume.size[0]) *
                                      static_cast<std::size_t>(volume.size[1]) *
                                      static_cast<std::size_t>(volume.size[2]),
          "a value for every voxel");
  require(std::all_of(volume.values.begin(), volume.values.end(), [](float v) { return std::isfinite(v); }),
          "values are finite");
}

void read(const Scratch& scratch, const std::string& name, std::string_view bytes) {
  const std::filesystem::path path = scratch.write(name, bytes);
  const VolumeFile header = read_volume_header(path);
  check_header(header);
  require(header.volume.values.empty(), "a header alone has no values");
  const VolumeFile whole = read_volume(path, {.frame = header.frames - 1, .spacing = Vec3(1, 1, 1)});
  check_values(whole);
  require(whole.volume.size == header.volume.size, "the header tells the size");
}

}  // namespace

void run_target(std::string_view bytes) {
  static const Scratch scratch;
  std::vector<std::function<void()>> readers;
  for (const char* name : {"input.nrrd", "input.nii", "input.mha", "input.dcm"})
    readers.push_back([&bytes, name] { read(scratch, name, bytes); });
  try_each(readers, "NRRD nor NIfTI, MetaImage or DICOM");
}

}  // namespace coapt::fuzz
