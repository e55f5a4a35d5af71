// Volumes as ITK's filters take them. For sources that include ITK anyway.
#pragma once

#include "image/volume.hpp"

#include <algorithm>
#include <itkImage.h>
#include <itkMedianImageFilter.h>

namespace coapt {

using FloatImage = itk::Image<float, 3>;

// In the frame of the grid: the direction of its axes is left out.
inline FloatImage::Pointer as_image(const Volume& volume) {
  const auto image = FloatImage::New();
  FloatImage::SizeType size;
  FloatImage::SpacingType spacing;
  for (unsigned int axis = 0; axis < 3; ++axis) {
    size[axis] = static_cast<itk::SizeValueType>(volume.size[axis]);
    spacing[axis] = volume.spacing[axis];
  }
  image->SetRegions(FloatImage::RegionType(size));
  image->SetSpacing(spacing);
  image->Allocate();
  std::copy(volume.values.begin(), volume.values.end(), image->GetBufferPointer());
  return image;
}

// The values of an image on the grid of a volume of the same size.
inline Volume as_volume(const FloatImage::Pointer& image, const Volume& grid) {
  Volume volume = volume_like(grid, 0);
  std::copy_n(image->GetBufferPointer(), volume.values.size(), volume.values.begin());
  return volume;
}

// A median over 3 x 3 x 3 voxels.
inline FloatImage::Pointer without_speckle(const FloatImage::Pointer& image) {
  const auto filter = itk::MedianImageFilter<FloatImage, FloatImage>::New();
  filter->SetInput(image);
  filter->SetRadius(1);
  filter->Update();
  return filter->GetOutput();
}

}  // namespace coapt
