#include "image/write_volume.hpp"

#include "core/error.hpp"
#include "formats/lower_extension.hpp"

#include <algorithm>
#include <cmath>

// The whole of Eigen before ITK, which brings an older one with it that skips what is there already.
#include <Eigen/Dense>

#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

namespace coapt {
namespace {

namespace fs = std::filesystem;

itk::ImageIOBase::Pointer writer_for(const fs::path& path) {
  const std::string ending = formats::lower_extension(path);
  if (ending == ".nrrd") return itk::NrrdImageIO::New().GetPointer();
  if (ending == ".nii" || (ending == ".gz" && formats::lower_extension(path.stem()) == ".nii"))
    return itk::NiftiImageIO::New().GetPointer();
  if (ending == ".mha") return itk::MetaImageIO::New().GetPointer();
  throw InputError(path.string() + ": volumes are written as .nrrd, .nii, .nii.gz or .mha");
}

itk::IOComponentEnum component_of(VoxelKind kind) {
  using Component = itk::IOComponentEnum;
  switch (kind) {
    case VoxelKind::UInt8:
      return Component::UCHAR;
    case VoxelKind::Int8:
      return Component::CHAR;
    case VoxelKind::UInt16:
      return Component::USHORT;
    case VoxelKind::Int16:
      return Component::SHORT;
    case VoxelKind::UInt32:
      return Component::UINT;
    case VoxelKind::Int32:
      return Component::INT;
    case VoxelKind::UInt64:
      return Component::ULONGLONG;
    case VoxelKind::Int64:
      return Component::LONGLONG;
    case VoxelKind::Float32:
      return Component::FLOAT;
    case VoxelKind::Float64:
      break;
  }
  return Component::DOUBLE;
}

void describe(itk::ImageIOBase& writer, const Volume& volume, VoxelKind kind) {
  writer.SetNumberOfDimensions(3);
  itk::ImageIORegion region(3);
  for (unsigned axis = 0; axis < 3; ++axis) {
    const auto size = static_cast<itk::SizeValueType>(volume.size[axis]);
    writer.SetDimensions(axis, size);
    writer.SetSpacing(axis, volume.spacing[axis]);
    writer.SetOrigin(axis, volume.origin[axis]);
    const Vec3 along = volume.direction.col(axis);
    writer.SetDirection(axis, std::vector<double>(along.begin(), along.end()));
    region.SetIndex(axis, 0);
    region.SetSize(axis, size);
  }
  writer.SetIORegion(region);
  writer.SetPixelType(itk::IOPixelEnum::SCALAR);
  writer.SetNumberOfComponents(1);
  writer.SetComponentType(component_of(kind));
  writer.SetUseCompression(true);
}

}  // namespace

void write_volume(const fs::path& path, const Volume& volume, VoxelKind kind) {
  const itk::ImageIOBase::Pointer writer = writer_for(path);
  if (!std::all_of(volume.values.begin(), volume.values.end(), [](float v) { return std::isfinite(v); }))
    throw InputError(path.string() + ": is not written, as values of the volume are not finite");
  describe(*writer, volume, kind);
  const std::vector<char> bytes = voxels_as(kind, volume.values);
  // The name must end as the format wants it.
  const fs::path unfinished = path.parent_path() / (".unfinished-" + path.filename().string());
  std::error_code error;
  try {
    writer->SetFileName(unfinished.string());
    writer->Write(bytes.data());
  } catch (const itk::ExceptionObject&) {
    fs::remove(unfinished, error);
    throw InputError(path.string() + ": cannot be written; is the folder there, and is there room?");
  }
  fs::rename(unfinished, path, error);
  if (!error) return;
  const std::string reason = error.message();
  fs::remove(unfinished, error);
  throw InputError(path.string() + ": cannot be written: " + reason);
}

}  // namespace coapt
