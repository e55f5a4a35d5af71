#include "image/itk/gradient_magnitude.hpp"

#include "image/itk/itk_volume.hpp"

#include <itkGradientMagnitudeRecursiveGaussianImageFilter.h>

namespace coapt {

Volume gradient_magnitude(const Volume& volume, double scale) {
  const auto filter = itk::GradientMagnitudeRecursiveGaussianImageFilter<FloatImage, FloatImage>::New();
  filter->SetInput(as_image(volume));
  filter->SetSigma(scale);
  filter->Update();
  return as_volume(filter->GetOutput(), volume);
}

}  // namespace coapt
