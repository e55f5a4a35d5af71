// The reader for one file, ITK's or ours, without ITK in the header.
#pragma once

#include "formats/lower_extension.hpp"
#include "image/detail/found_image.hpp"

#include <filesystem>
#include <memory>
#include <vector>

namespace coapt {

// By the name of the file: .nii or .nii.gz.
inline bool is_nifti(const std::filesystem::path& path) {
  const std::string ending = formats::lower_extension(path);
  return ending == ".nii" || (ending == ".gz" && formats::lower_extension(path.stem()) == ".nii");
}

class ImageFile {
 public:
  ImageFile() = default;
  ImageFile(const ImageFile&) = delete;
  ImageFile& operator=(const ImageFile&) = delete;
  virtual ~ImageFile() = default;

  const FoundImage& found() const { return found_; }

  // All numbers of the file as they lie there, components fastest. Throws InputError where the file ends too
  // early.
  virtual std::vector<char> read() const = 0;

 protected:
  FoundImage found_;
};

// Reads the header. Throws InputError for a file that is not there, is empty, of another format, or that its
// reader refuses.
std::unique_ptr<ImageFile> open_image(const std::filesystem::path& path);

// The slices of the one DICOM series in a folder, in their order along the axis across them. Throws
// InputError where there is none, or more than one.
std::vector<std::filesystem::path> dicom_series(const std::filesystem::path& folder);

}  // namespace coapt
