#include "core/error.hpp"
#include "image/slices/slice_picture.hpp"

// The whole of Eigen before ITK, which brings an older one with it that skips what is there already.
#include <Eigen/Dense>

#include <itkPNGImageIO.h>

namespace coapt {

void write_png(const std::filesystem::path& path, const Picture& picture) {
  const auto writer = itk::PNGImageIO::New();
  writer->SetFileName(path.string());
  writer->SetNumberOfDimensions(2);
  itk::ImageIORegion region(2);
  const int size[2] = {picture.width, picture.height};
  for (unsigned axis = 0; axis < 2; ++axis) {
    writer->SetDimensions(axis, static_cast<itk::SizeValueType>(size[axis]));
    region.SetSize(axis, static_cast<itk::SizeValueType>(size[axis]));
  }
  writer->SetPixelType(itk::IOPixelEnum::RGB);
  writer->SetNumberOfComponents(3);
  writer->SetComponentType(itk::IOComponentEnum::UCHAR);
  writer->SetIORegion(region);
  writer->UseCompressionOn();
  try {
    writer->Write(picture.colours.data());
  } catch (const itk::ExceptionObject&) {
    throw InputError(path.string() + ": cannot be written");
  }
}

}  // namespace coapt
