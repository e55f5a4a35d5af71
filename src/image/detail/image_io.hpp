// The reader of ITK for one file, without ITK in the header.
#pragma once

#include "image/read_volume.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace coapt {

// A file as ITK finds it, before anything is judged; positions are in LPS [mm].
struct FoundImage {
  std::string format;
  std::vector<std::size_t> size;  // voxels along each axis, time the last of four
  std::vector<double> spacing;    // of each axis
  Vec3 origin = Vec3::Zero();     // missing coordinates are 0
  Eigen::Matrix3d direction = Eigen::Matrix3d::Identity();
  std::size_t components = 1;  // numbers of a voxel
  bool is_list = false;        // components are frames of a sequence
  std::string pixel;           // "scalar", "rgb", "vector", ...
  VoxelKind kind = VoxelKind::UInt8;
  bool states_spacing = true, states_direction = true, states_space = true;
};

class ImageFile {
 public:
  // Reads the header. Throws InputError for a file that is not there, is empty, of another format, or that
  // ITK refuses.
  explicit ImageFile(const std::filesystem::path& path);
  ~ImageFile();
  ImageFile(const ImageFile&) = delete;
  ImageFile& operator=(const ImageFile&) = delete;

  const FoundImage& found() const { return found_; }

  // All numbers of the file as they lie there, components fastest. Throws InputError where the file ends too
  // early.
  std::vector<char> read() const;

 private:
  struct Reader;
  std::filesystem::path path_;
  std::unique_ptr<Reader> reader_;
  FoundImage found_;
};

// The slices of the one DICOM series in a folder, in their order along the axis across them. Throws
// InputError where there is none, or more than one.
std::vector<std::filesystem::path> dicom_series(const std::filesystem::path& folder);

}  // namespace coapt
