#include "image/burlina/thin_tissue.hpp"

#include "image/itk/itk_volume.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <itkHessianRecursiveGaussianImageFilter.h>
#include <itkImageRegionConstIterator.h>

namespace coapt {

Volume thin_tissue(const Volume& volume, double scale) {
  using TensorImage = itk::Image<itk::SymmetricSecondRankTensor<float, 3>, 3>;
  const auto filter = itk::HessianRecursiveGaussianImageFilter<FloatImage, TensorImage>::New();
  filter->SetInput(without_speckle(as_image(volume)));
  filter->SetSigma(scale);
  filter->Update();
  Volume tissue = volume_like(volume, 0);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  Eigen::Matrix3f hessian;
  itk::ImageRegionConstIterator<TensorImage> tensor(filter->GetOutput(),
                                                    filter->GetOutput()->GetLargestPossibleRegion());
  for (float& value : tissue.values) {
    const auto& t = tensor.Get();
    ++tensor;
    hessian << t(0, 0), t(0, 1), t(0, 2), t(0, 1), t(1, 1), t(1, 2), t(0, 2), t(1, 2), t(2, 2);
    solver.computeDirect(hessian, Eigen::EigenvaluesOnly);
    const Eigen::Vector3f& l = solver.eigenvalues();  // ascending
    if (l[0] < 0) value = std::max(0.0F, 1 - std::max(std::abs(l[1]), std::abs(l[2])) / -l[0]);
  }
  return tissue;
}

}  // namespace coapt
