#include "image/itk/itk_functions.hpp"

namespace coapt {

std::unique_ptr<ImageFile> open_image(const std::filesystem::path& path) {
  return itk_functions().open_image(path);
}

std::vector<std::filesystem::path> dicom_series(const std::filesystem::path& folder) {
  return itk_functions().dicom_series(folder);
}

void write_volume(const std::filesystem::path& path, const Volume& volume, VoxelKind kind) {
  itk_functions().write_volume(path, volume, kind);
}

void write_png(const std::filesystem::path& path, const Picture& picture) {
  itk_functions().write_png(path, picture);
}

Volume gradient_magnitude(const Volume& volume, double scale) {
  return itk_functions().gradient_magnitude(volume, scale);
}

Volume thin_tissue(const Volume& volume, double scale) { return itk_functions().thin_tissue(volume, scale); }

Volume distance_from_sheet(const Volume& strength, double least) {
  return itk_functions().distance_from_sheet(strength, least);
}

Volume without_speckle(const Volume& volume) { return itk_functions().without_speckle(volume); }

SheetEvidence sheet_evidence(const Volume& volume, const std::vector<double>& scales, bool has_speckle) {
  return itk_functions().sheet_evidence(volume, scales, has_speckle);
}

double otsu_threshold(const Volume& volume) { return itk_functions().otsu_threshold(volume); }

Volume greatest_part(const Volume& volume, double threshold) {
  return itk_functions().greatest_part(volume, threshold);
}

}  // namespace coapt
