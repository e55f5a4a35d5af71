#include "cli/modules/itk_functions.hpp"
#include "cli/modules/module.hpp"

namespace coapt {
namespace {

const cli::ItkFunctions& itk() {
  static const cli::Module& images = cli::loaded_module(COAPT_IMAGES_FILE);
  return *images.itk;
}

}  // namespace

std::unique_ptr<ImageFile> open_image(const std::filesystem::path& path) { return itk().open_image(path); }

std::vector<std::filesystem::path> dicom_series(const std::filesystem::path& folder) {
  return itk().dicom_series(folder);
}

void write_volume(const std::filesystem::path& path, const Volume& volume, VoxelKind kind) {
  itk().write_volume(path, volume, kind);
}

void write_png(const std::filesystem::path& path, const Picture& picture) { itk().write_png(path, picture); }

Volume gradient_magnitude(const Volume& volume, double scale) {
  return itk().gradient_magnitude(volume, scale);
}

Volume thin_tissue(const Volume& volume, double scale) { return itk().thin_tissue(volume, scale); }

Volume distance_from_sheet(const Volume& strength, double least) {
  return itk().distance_from_sheet(strength, least);
}

Volume without_speckle(const Volume& volume) { return itk().without_speckle(volume); }

SheetEvidence sheet_evidence(const Volume& volume, const std::vector<double>& scales, bool has_speckle) {
  return itk().sheet_evidence(volume, scales, has_speckle);
}

double otsu_threshold(const Volume& volume) { return itk().otsu_threshold(volume); }

Volume greatest_part(const Volume& volume, double threshold) {
  return itk().greatest_part(volume, threshold);
}

}  // namespace coapt
