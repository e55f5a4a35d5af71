#include "image/segment/sheet_evidence.hpp"

#include "core/error.hpp"
#include "image/itk/itk_volume.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <itkConnectedComponentImageFilter.h>
#include <itkHessianRecursiveGaussianImageFilter.h>
#include <itkImageRegionConstIterator.h>
#include <itkImageToHistogramFilter.h>
#include <itkOtsuThresholdCalculator.h>
#include <itkRelabelComponentImageFilter.h>

namespace coapt {
namespace {

using LabelImage = itk::Image<unsigned int, 3>;
using TensorImage = itk::Image<itk::SymmetricSecondRankTensor<float, 3>, 3>;

// Parts smaller than this share of the greatest are speckle.
constexpr double kSmallPart = 0.05;
// Bins of the histograms that thresholds are found in.
constexpr unsigned int kBins = 256;

// Takes over what is clearer at this scale.
void add_scale(SheetEvidence& evidence, const FloatImage::Pointer& image, double scale) {
  const auto filter = itk::HessianRecursiveGaussianImageFilter<FloatImage, TensorImage>::New();
  filter->SetInput(image);
  filter->SetSigma(scale);
  filter->Update();
  itk::ImageRegionConstIterator<TensorImage> tensor(filter->GetOutput(),
                                                    filter->GetOutput()->GetLargestPossibleRegion());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  Eigen::Matrix3f hessian;
  const auto squared = static_cast<float>(scale * scale);
  for (size_t voxel = 0; !tensor.IsAtEnd(); ++tensor, ++voxel) {
    const auto& t = tensor.Get();
    const float trace = t(0, 0) + t(1, 1) + t(2, 2);
    if (trace >= 0) continue;  // darker than around it
    hessian << t(0, 0), t(0, 1), t(0, 2), t(0, 1), t(1, 1), t(1, 2), t(0, 2), t(1, 2), t(2, 2);
    solver.computeDirect(hessian);
    const Eigen::Vector3f& values = solver.eigenvalues();  // ascending: the sheet's is the first
    const float others = std::max(std::abs(values[1]), std::abs(values[2]));
    const float strength = squared * (-values[0] - others);
    if (!(strength > evidence.strength.values[voxel])) continue;
    evidence.strength.values[voxel] = strength;
    evidence.normals[voxel] = solver.eigenvectors().col(0);
  }
}

// Labels 1, 2, ... of the connected parts that are at least the threshold, the greatest first.
LabelImage::Pointer labelled_parts(const Volume& volume, double threshold, std::vector<size_t>& sizes) {
  Volume binary = volume_like(volume, 0);
  for (size_t voxel = 0; voxel < volume.values.size(); ++voxel)
    if (volume.values[voxel] >= threshold) binary.values[voxel] = 1;
  const auto parts = itk::ConnectedComponentImageFilter<FloatImage, LabelImage>::New();
  parts->SetInput(as_image(binary));
  parts->FullyConnectedOn();
  const auto ordered = itk::RelabelComponentImageFilter<LabelImage, LabelImage>::New();
  ordered->SetInput(parts->GetOutput());
  ordered->Update();
  for (const auto size : ordered->GetSizeOfObjectsInPixels()) sizes.push_back(size);
  return ordered->GetOutput();
}

// Strengths of speckle become 0, the others are counted in the median of what remains.
void normalise(SheetEvidence& evidence) {
  Volume& strength = evidence.strength;
  std::vector<size_t> sizes;
  const LabelImage::Pointer labels = labelled_parts(strength, otsu_threshold(strength), sizes);
  const auto kept = static_cast<unsigned int>(std::count_if(sizes.begin(), sizes.end(), [&](size_t size) {
    return static_cast<double>(size) >= kSmallPart * static_cast<double>(sizes.front());
  }));
  const unsigned int* label = labels->GetBufferPointer();
  std::vector<float> sheet;
  for (size_t voxel = 0; voxel < strength.values.size(); ++voxel)
    if (label[voxel] >= 1 && label[voxel] <= kept)
      sheet.push_back(strength.values[voxel]);
    else
      strength.values[voxel] = 0;
  const auto middle = sheet.begin() + static_cast<std::ptrdiff_t>(sheet.size() / 2);
  std::nth_element(sheet.begin(), middle, sheet.end());
  const float unit = *middle;
  for (float& value : strength.values) value /= unit;
}

}  // namespace

Volume without_speckle(const Volume& volume) { return as_volume(without_speckle(as_image(volume)), volume); }

double otsu_threshold(const Volume& volume) {
  const auto [least, greatest] = std::minmax_element(volume.values.begin(), volume.values.end());
  if (!(*least < *greatest))
    throw InputError(
        "the volume has the same value everywhere around the annulus, so that nothing can be told "
        "from it; does the annulus lie in this volume, and in its frame (LPS)?");
  const auto histogram = itk::Statistics::ImageToHistogramFilter<FloatImage>::New();
  histogram->SetInput(as_image(volume));
  itk::Statistics::ImageToHistogramFilter<FloatImage>::HistogramSizeType bins(1);
  bins.Fill(kBins);
  histogram->SetHistogramSize(bins);
  histogram->Update();
  const auto calculator =
      itk::OtsuThresholdCalculator<itk::Statistics::ImageToHistogramFilter<FloatImage>::HistogramType,
                                   float>::New();
  calculator->SetInput(histogram->GetOutput());
  calculator->Compute();
  return calculator->GetThreshold();
}

Volume greatest_part(const Volume& volume, double threshold) {
  std::vector<size_t> sizes;
  const LabelImage::Pointer labels = labelled_parts(volume, threshold, sizes);
  Volume part = volume_like(volume, 0);
  const unsigned int* label = labels->GetBufferPointer();
  for (size_t voxel = 0; voxel < part.values.size(); ++voxel)
    if (label[voxel] == 1) part.values[voxel] = 1;
  return part;
}

SheetEvidence sheet_evidence(const Volume& volume, const std::vector<double>& scales, bool has_speckle) {
  SheetEvidence evidence{volume_like(volume, 0),
                         std::vector<Eigen::Vector3f>(volume.values.size(), Eigen::Vector3f::Zero())};
  FloatImage::Pointer image = as_image(volume);
  if (has_speckle) image = without_speckle(image);
  for (const double scale : scales) add_scale(evidence, image, scale);
  normalise(evidence);
  const Eigen::Matrix3f direction = volume.direction.cast<float>();
  for (Eigen::Vector3f& normal : evidence.normals) normal = direction * normal;
  return evidence;
}

}  // namespace coapt
