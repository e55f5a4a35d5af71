// Volume images to files, by the writers of ITK.
#pragma once

#include "image/volume.hpp"
#include "image/voxel_kind.hpp"

#include <filesystem>

namespace coapt {

// Writes NRRD (.nrrd), NIfTI (.nii, .nii.gz) or MetaImage (.mha), told apart by the extension, positions in
// LPS (NIfTI: RAS, as its standard wants), compressed where the format can; the same volume gives the same
// bytes. Whole numbers are rounded to the nearest that the kind holds. The file appears under its name only
// when it is whole. Pre: values has one entry per voxel. Throws InputError, naming the file, for another
// extension, for a value that is not finite, or when the file cannot be written.
void write_volume(const std::filesystem::path& path, const Volume& volume, VoxelKind kind);

}  // namespace coapt
