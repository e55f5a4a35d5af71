// The reader for one file, ITK's or ours, without ITK in the header.
#pragma once

#include "image/detail/found_image.hpp"

#include <filesystem>
#include <memory>
#include <vector>

namespace coapt {

// By the name of the file: .nii or .nii.gz.
bool is_nifti(const std::filesystem::path& path);

class ImageFile {
 public:
  // Reads the header. Throws InputError for a file that is not there, is empty, of another format, or that
  // its reader refuses.
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
