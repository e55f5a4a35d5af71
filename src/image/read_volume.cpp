#include "image/read_volume.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "image/detail/dicom_structure.hpp"
#include "image/detail/trial_process.hpp"
#include "image/itk/image_io.hpp"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace coapt {
namespace {

namespace fs = std::filesystem;

constexpr double kMostSkew =
    1e-3;  // greatest cosine between two axes of a grid that still counts as orthogonal
constexpr double kUsualAspect = 1.5;  // longest over shortest edge of a voxel; beyond it a warning says so
constexpr double kUnevenSlices =
    0.01;  // greatest deviation of a slice from its even place, in distances of slices
// What GDCM may take for files of so many bytes. With less memory it gives up where this process goes on.
constexpr double kTrialSeconds = 15, kTrialSecondsPerByte = 3e-6;
constexpr std::uintmax_t kTrialBytes = std::uintmax_t(4) << 30, kTrialBytesPerByte = 100;

std::string sizes_text(const std::vector<std::size_t>& sizes) {
  std::string text;
  for (const std::size_t size : sizes) text += (text.empty() ? "" : " x ") + std::to_string(size);
  return text;
}

// Of a file with three axes, or four of which the last is time.
void check_shape(const FoundImage& found, const std::string& file) {
  if (found.size.size() < 3 || (found.size.size() == 3 && found.size[2] == 1))
    throw InputError(
        file + ": is a flat image of " + sizes_text(found.size) + " pixels; a volume is needed" +
        (found.format == "DICOM" ? ": name the folder in which all slices of the series lie" : ""));
  if (found.size.size() > 4)
    throw InputError(file + ": has " + std::to_string(found.size.size()) + " axes (" +
                     sizes_text(found.size) + "); three and one of time are understood");
  if (found.components > 1 && !found.is_list)
    throw InputError(file + ": its voxels are no numbers but " + found.pixel + "s of " +
                     std::to_string(found.components) + " numbers; export the grey values alone");
  double voxels = static_cast<double>(found.components);
  for (const std::size_t size : found.size) voxels *= static_cast<double>(size);
  if (voxels == 0) throw InputError(file + ": has no voxels: " + sizes_text(found.size));
  if (!(voxels <= kMostVoxels))
    throw InputError(file + ": its header promises " + number_text(voxels) + " voxels, more than the " +
                     number_text(kMostVoxels) + " that are read; crop it, or halve its resolution");
}

int frames_of(const FoundImage& found) {
  return static_cast<int>(found.components * (found.size.size() == 4 ? found.size[3] : 1));
}

Vec3 spacing_of(const FoundImage& found, const VolumeReadOptions& options, const std::string& file) {
  const Vec3 spacing = options.spacing.value_or(Vec3(found.spacing[0], found.spacing[1], found.spacing[2]));
  for (int axis = 0; axis < 3; ++axis)
    if (!(spacing[axis] > 0 && std::isfinite(spacing[axis])))
      throw InputError(file + ": the spacing of its voxels along axis " + std::to_string(axis + 1) + " is " +
                       number_text(spacing[axis]) +
                       " mm; it must be positive: give the right one with --spacing");
  return spacing;
}

// The nearest orthogonal axes: files keep directions rounded.
Eigen::Matrix3d orthogonal(const Eigen::Matrix3d& found, const std::string& file) {
  Eigen::Matrix3d axes = found;
  for (int axis = 0; axis < 3; ++axis) axes.col(axis).normalize();
  double skew = 0;
  for (int axis = 0; axis < 3; ++axis)
    skew = std::max(skew, std::abs(axes.col(axis).dot(axes.col((axis + 1) % 3))));
  if (!(skew <= kMostSkew) || !axes.allFinite())
    throw InputError(
        file + ": the axes of its grid are not orthogonal (cosine " + number_text(skew) +
        " between two of them), as those of a tilted gantry; resample it onto a straight grid first");
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

void warn(const FoundImage& found, VolumeFile& file, const std::string& name) {
  if (!found.states_direction)
    file.warnings.push_back(name +
                            ": does not say how its axes lie; they are taken as x, y and z of the patient "
                            "(left, posterior, superior)");
  if (!found.states_space)
    file.warnings.push_back(name + ": does not say that its positions are LPS, RAS or LAS; LPS is assumed");
  const double aspect = file.volume.spacing.maxCoeff() / file.volume.spacing.minCoeff();
  if (aspect > kUsualAspect)
    file.warnings.push_back(name + ": its voxels are " + number_text(aspect) +
                            " times as long as wide; what is thinner than the longer edge may be lost");
}

VolumeFile described(const FoundImage& found, const VolumeReadOptions& options, const std::string& name) {
  check_shape(found, name);
  VolumeFile file;
  file.format = found.format;
  file.kind = found.kind;
  file.frames = frames_of(found);
  file.states_spacing = found.states_spacing || options.spacing.has_value();
  for (int axis = 0; axis < 3; ++axis) file.volume.size[axis] = static_cast<int>(found.size[axis]);
  file.volume.origin = found.origin;
  file.volume.spacing = spacing_of(found, options, name);
  file.volume.direction = orthogonal(found.direction, name);
  if (!file.volume.origin.allFinite())
    throw InputError(name + ": the place of its first voxel is no number; export it again");
  warn(found, file, name);
  return file;
}

// Of slices one behind the other the whole; images: at least one.
FoundImage stacked(const std::vector<FoundImage>& images, const std::string& folder) {
  FoundImage whole = images.front();
  if (images.size() == 1) return whole;
  const Vec3 across = (images.back().origin - whole.origin) / static_cast<double>(images.size() - 1);
  const double distance = across.norm();
  for (std::size_t k = 0; k < images.size(); ++k) {
    const FoundImage& slice = images[k];
    if (slice.size != whole.size || slice.components != 1 || (slice.size.size() == 3 && slice.size[2] != 1) ||
        (slice.direction.leftCols(2) - whole.direction.leftCols(2)).norm() > kMostSkew)
      throw InputError(folder +
                       ": its slices are not all of one size and direction; is it more than one scan?");
    const Vec3 place = whole.origin + static_cast<double>(k) * across;
    if (!((slice.origin - place).norm() <= kUnevenSlices * distance))
      throw InputError(folder + ": slice " + std::to_string(k + 1) + " of " + std::to_string(images.size()) +
                       " does not lie evenly between its neighbours; slices are missing, or lie there twice");
  }
  whole.size = {whole.size[0], whole.size[1], images.size()};
  whole.spacing.resize(3);
  whole.spacing[2] = distance;
  whole.direction.col(2) = across;
  return whole;
}

struct SeriesFiles {
  std::vector<fs::path> paths;
  FoundImage whole;
};

SeriesFiles series_in(const fs::path& folder) {
  SeriesFiles files{dicom_series(folder), {}};
  std::vector<FoundImage> slices;
  for (const fs::path& path : files.paths) slices.push_back(open_image(path)->found());
  files.whole = stacked(slices, folder.string());
  return files;
}

int chosen_frame(const VolumeFile& file, const VolumeReadOptions& options, const std::string& name) {
  const std::string choice =
      "; choose one with " + options.frame_option + ", from 0 to " + std::to_string(file.frames - 1);
  if (file.frames > 1 && !options.frame)
    throw InputError(name + ": is a time series of " + std::to_string(file.frames) + " frames" + choice);
  const int frame = options.frame.value_or(0);
  if (frame < 0 || frame >= file.frames)
    throw InputError(name + ": has no frame " + std::to_string(frame) +
                     (file.frames > 1 ? choice : "; it is a single volume, frame 0"));
  return frame;
}

void check_values(const Volume& volume, const std::string& name) {
  const auto is_bad = [](float value) { return !std::isfinite(value); };
  const auto first = std::find_if(volume.values.begin(), volume.values.end(), is_bad);
  if (first == volume.values.end()) return;
  const auto at = static_cast<std::size_t>(first - volume.values.begin());
  const auto nx = static_cast<std::size_t>(volume.size[0]), ny = static_cast<std::size_t>(volume.size[1]);
  throw InputError(name + ": " + std::to_string(std::count_if(first, volume.values.end(), is_bad)) + " of " +
                   std::to_string(volume.values.size()) + " voxels are no finite numbers, the first is (" +
                   std::to_string(at % nx) + ", " + std::to_string(at / nx % ny) + ", " +
                   std::to_string(at / nx / ny) + "); give them a value in the program that wrote the file");
}

VolumeFile header_of(const fs::path& path, const VolumeReadOptions& options) {
  if (fs::is_directory(path)) return described(series_in(path).whole, options, path.string());
  return described(open_image(path)->found(), options, path.string());
}

VolumeFile volume_of(const fs::path& path, const VolumeReadOptions& options) {
  const std::string name = path.string();
  const bool is_series = fs::is_directory(path);
  const SeriesFiles files = is_series ? series_in(path) : SeriesFiles{{path}, {}};
  VolumeFile file = is_series ? described(files.whole, options, name) : header_of(path, options);
  if (!file.states_spacing)
    throw InputError(name +
                     ": does not say how large its voxels are; `coapt image convert --spacing` "
                     "gives it, in mm");
  const auto frame = static_cast<std::size_t>(chosen_frame(file, options, name));
  for (const fs::path& part : files.paths) {
    const std::unique_ptr<ImageFile> image = open_image(part);
    const FoundImage& found = image->found();
    const std::vector<char> bytes = image->read();
    const std::size_t count = found.size[0] * found.size[1] * (found.size.size() > 2 ? found.size[2] : 1);
    const bool is_interleaved = found.components > 1;
    const std::size_t list = frame % found.components, time = frame / found.components;
    append_voxels(found.kind, bytes.data(),
                  is_interleaved ? list + time * count * found.components : time * count, found.components,
                  count, file.volume.values);
  }
  check_values(file.volume, name);
  return file;
}

std::vector<fs::path> dicom_files_at(const fs::path& path) {
  std::vector<fs::path> files;
  std::error_code error;
  if (!fs::is_directory(path, error)) {
    if (fs::is_regular_file(path, error) && begins_as_dicom(path)) files.push_back(path);
    return files;
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(path))
    if (entry.is_regular_file() && begins_as_dicom(entry.path())) files.push_back(entry.path());
  return files;
}

// What GDCM meets in a damaged file can end the program by an assertion, so that a copy of it reads DICOM
// first.
template <typename Read>
void check_dicom_by_trial(const fs::path& path, const Read& read) {
  const std::vector<fs::path> files = dicom_files_at(path);
  if (files.empty()) return;
  std::uintmax_t size = 0;
  for (const fs::path& file : files) size += fs::file_size(file);
  const TrialLimits limits{
      static_cast<unsigned>(kTrialSeconds + kTrialSecondsPerByte * static_cast<double>(size)),
      kTrialBytes + kTrialBytesPerByte * size};
  const std::string end = end_of_trial(read, limits);
  if (end.empty()) return;
  fs::path culprit = path;
  for (const fs::path& file : files)
    if (culprit == path && !end_of_trial([&] { open_image(file)->read(); }, limits).empty()) culprit = file;
  throw InputError(culprit.string() + ": its reader (GDCM) was ended by " + end +
                   ": the DICOM file is damaged; copy or export it again");
}

// ITK makes rotations of a NIfTI header by functions that end the program where they meet what is no number.
void check_nifti_by_trial(const fs::path& path) {
  std::error_code error;
  if (!is_nifti(path) || !fs::is_regular_file(path, error)) return;
  const std::string end = end_of_trial([&] { open_image(path); }, {});
  if (end.empty()) return;
  throw InputError(
      path.string() + ": its reader (ITK) was ended by " + end +
      ": the NIfTI header is damaged, where it says how the axes lie (qform, sform) for instance; " +
      "copy or export it again");
}

}  // namespace

VolumeFile read_volume_header(const fs::path& path, const VolumeReadOptions& options) {
  check_nifti_by_trial(path);
  check_dicom_by_trial(path, [&] { header_of(path, options); });
  return header_of(path, options);
}

VolumeFile read_volume(const fs::path& path, const VolumeReadOptions& options) {
  check_nifti_by_trial(path);
  check_dicom_by_trial(path, [&] { volume_of(path, options); });
  return volume_of(path, options);
}

}  // namespace coapt
