#include "image/routes/distance_from_sheet.hpp"

#include "image/itk/itk_volume.hpp"

#include <itkBinaryThresholdImageFilter.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>

namespace coapt {

Volume distance_from_sheet(const Volume& strength, double least) {
  using ByteImage = itk::Image<unsigned char, 3>;
  const auto binary = itk::BinaryThresholdImageFilter<FloatImage, ByteImage>::New();
  binary->SetInput(as_image(strength));
  binary->SetLowerThreshold(static_cast<float>(least));
  binary->SetInsideValue(1);
  binary->SetOutsideValue(0);
  const auto distance = itk::SignedMaurerDistanceMapImageFilter<ByteImage, FloatImage>::New();
  distance->SetInput(binary->GetOutput());
  distance->UseImageSpacingOn();
  distance->SquaredDistanceOff();
  distance->Update();
  return as_volume(distance->GetOutput(), strength);
}

}  // namespace coapt
