#include "image/itk/image_io.hpp"

#include "core/error.hpp"
#include "formats/whole_file.hpp"
#include "image/detail/dicom_structure.hpp"
#include "image/detail/meta_image.hpp"
#include "image/detail/stated_geometry.hpp"

#include <algorithm>
#include <utility>

// The whole of Eigen before ITK, which brings an older one with it that skips what is there already.
#include <Eigen/Dense>

#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkMetaDataObject.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

namespace coapt {
namespace {

namespace fs = std::filesystem;

// None for a format that ITK does not read here.
itk::ImageIOBase::Pointer reader_for(const fs::path& path, std::string& format) {
  const std::string ending = formats::lower_extension(path);
  const auto is = [&](std::initializer_list<const char*> endings) {
    return std::find(endings.begin(), endings.end(), ending) != endings.end();
  };
  if (is({".nrrd", ".nhdr"})) return format = "NRRD", itk::NrrdImageIO::New().GetPointer();
  if (is_nifti(path)) return format = "NIfTI", itk::NiftiImageIO::New().GetPointer();
  if (is({".mha", ".mhd"})) return format = "MetaImage", nullptr;   // is read by meta_image.hpp
  if (is({".dcm", ".dicom", ".ima", ""}) || begins_as_dicom(path))  // whose names may end anyhow
    return format = "DICOM", itk::GDCMImageIO::New().GetPointer();
  throw InputError(
      path.string() + ": is no volume that can be read by its name: .nrrd, .seq.nrrd, .nhdr, .nii, " +
      ".nii.gz, .mha, .mhd, .dcm, or a folder with a DICOM series; convert it, with 3D Slicer for instance");
}

void check_file(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) throw InputError(path.string() + ": does not exist");
  formats::refuse_what_is_no_file(path);
  if (fs::file_size(path, error) == 0)
    throw InputError(path.string() + ": is empty; copy or export it again");
}

// What ITK says, in one line and without the place in its sources. Of what the NRRD library says, each of its
// functions in turn, only the cause, which is last.
std::string reason_of(const itk::ExceptionObject& error) {
  std::string text = error.GetDescription();
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  if (const std::size_t at = text.find("): "); text.starts_with("itk::ERROR") && at != std::string::npos)
    text.erase(0, at + 3);
  while (text.ends_with(' ')) text.pop_back();
  const std::string nrrd = "[nrrd] ";
  if (const std::size_t at = text.rfind(nrrd); at != std::string::npos) {
    text.erase(0, at + nrrd.size());
    if (const std::size_t name = text.find(": "); name != std::string::npos) text.erase(0, name + 2);
  }
  return text;
}

VoxelKind kind_of(itk::IOComponentEnum component, const std::string& file) {
  using Component = itk::IOComponentEnum;
  switch (component) {
    case Component::UCHAR:
      return VoxelKind::UInt8;
    case Component::CHAR:
      return VoxelKind::Int8;
    case Component::USHORT:
      return VoxelKind::UInt16;
    case Component::SHORT:
      return VoxelKind::Int16;
    case Component::UINT:
      return VoxelKind::UInt32;
    case Component::INT:
      return VoxelKind::Int32;
    case Component::ULONG:
      return sizeof(long) == 8 ? VoxelKind::UInt64 : VoxelKind::UInt32;
    case Component::LONG:
      return sizeof(long) == 8 ? VoxelKind::Int64 : VoxelKind::Int32;
    case Component::ULONGLONG:
      return VoxelKind::UInt64;
    case Component::LONGLONG:
      return VoxelKind::Int64;
    case Component::FLOAT:
      return VoxelKind::Float32;
    case Component::DOUBLE:
      return VoxelKind::Float64;
    default:
      break;
  }
  throw InputError(file +
                   ": its voxels are numbers of a kind that is not known; convert them to 8 or 16 bits");
}

std::string text_in(const itk::ImageIOBase& reader, const char* key) {
  std::string text;
  itk::ExposeMetaData<std::string>(reader.GetMetaDataDictionary(), key, text);
  return text;
}

// ITK 5 turns x of positions in LAS where it is y that has the other sign in LPS.
void turn_as_las_wants(FoundImage& found) {
  for (int row = 0; row < 2; ++row) {
    found.direction.row(row) *= -1;
    found.origin[row] *= -1;
  }
}

void find_what_is_stated(const itk::ImageIOBase& reader, const fs::path& path, FoundImage& found) {
  if (found.format == "NRRD") {
    const StatedGeometry stated = stated_in_nrrd(path);
    found.states_spacing = stated.spacing;
    found.states_direction = stated.direction;
    if (stated.space == "left-anterior-superior" || stated.space == "las") turn_as_las_wants(found);
    // The three that ITK turns to LPS; others stay as they are.
    found.states_space = !stated.direction || text_in(reader, "NRRD_space") == "left-posterior-superior";
    found.is_list = stated.is_list;
  } else if (found.format == "NIfTI") {
    const auto is_zero = [&](const char* key) { return text_in(reader, key) == "0"; };
    found.states_direction = !is_zero("qform_code") || !is_zero("sform_code");
  } else {
    found.states_spacing = !text_in(reader, "0028|0030").empty();
    found.states_direction = !text_in(reader, "0020|0037").empty();
  }
}

FoundImage found_by(const itk::ImageIOBase& reader, const fs::path& path, const std::string& format) {
  FoundImage found;
  found.format = format;
  const unsigned axes = reader.GetNumberOfDimensions();
  for (unsigned axis = 0; axis < axes; ++axis) {
    found.size.push_back(reader.GetDimensions(axis));
    found.spacing.push_back(reader.GetSpacing(axis));
    if (axis >= 3) continue;
    found.origin[axis] = reader.GetOrigin(axis);
    const std::vector<double> along = reader.GetDirection(axis);
    for (unsigned row = 0; row < 3; ++row)
      found.direction(row, axis) = row < along.size() ? along[row] : row == axis;
  }
  found.components = reader.GetNumberOfComponents();
  found.pixel = itk::ImageIOBase::GetPixelTypeAsString(reader.GetPixelType());
  found.kind = kind_of(reader.GetComponentType(), path.string());
  find_what_is_stated(reader, path, found);
  return found;
}

class MetaImageFile : public ImageFile {
 public:
  explicit MetaImageFile(const fs::path& path) : path_(path), header_(meta_image_header(path)) {
    found_ = header_.found;
  }
  std::vector<char> read() const override { return meta_image_voxels(header_, path_); }

 private:
  fs::path path_;
  MetaImageHeader header_;
};

class ItkFile : public ImageFile {
 public:
  ItkFile(const fs::path& path, const std::string& format, itk::ImageIOBase::Pointer io)
      : path_(path), io_(std::move(io)) {
    if (format == "DICOM") check_dicom_structure(path);
    itk::Object::SetGlobalWarningDisplay(false);  // of what ITK doubts, what matters is said here
    try {
      if (!io_->CanReadFile(path.c_str()))
        throw InputError(path.string() + ": is no " + format +
                         " file, whatever its name says; export it again");
      io_->SetFileName(path.string());
      io_->ReadImageInformation();
    } catch (const itk::ExceptionObject& error) {
      throw InputError(path.string() + ": its header cannot be read as " + format + ": " + reason_of(error));
    }
    found_ = found_by(*io_, path, format);
  }

  std::vector<char> read() const override {
    itk::ImageIORegion region(io_->GetNumberOfDimensions());
    for (unsigned axis = 0; axis < io_->GetNumberOfDimensions(); ++axis) {
      region.SetIndex(axis, 0);
      region.SetSize(axis, io_->GetDimensions(axis));
    }
    io_->SetIORegion(region);
    try {
      std::vector<char> bytes(io_->GetImageSizeInBytes());
      if (found_.format == "NIfTI") check_nifti_data(path_, bytes.size());
      io_->Read(bytes.data());
      return bytes;
    } catch (const itk::ExceptionObject& error) {
      throw InputError(path_.string() + ": its voxels cannot be read: " + reason_of(error) +
                       "; a file that ends too early must be copied or exported again");
    }
  }

 private:
  fs::path path_;
  itk::ImageIOBase::Pointer io_;
};

}  // namespace

std::unique_ptr<ImageFile> open_image(const fs::path& path) {
  std::string format;
  check_file(path);
  itk::ImageIOBase::Pointer io = reader_for(path, format);
  if (!io) return std::make_unique<MetaImageFile>(path);
  return std::make_unique<ItkFile>(path, format, std::move(io));
}

std::vector<fs::path> dicom_series(const fs::path& folder) {
  itk::Object::SetGlobalWarningDisplay(false);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && begins_as_dicom(entry.path())) check_dicom_structure(entry.path());
  const auto names = itk::GDCMSeriesFileNames::New();
  names->SetUseSeriesDetails(false);
  names->SetDirectory(folder.string());
  const std::vector<std::string>& series = names->GetSeriesUIDs();
  if (series.empty())
    throw InputError(folder.string() +
                     ": holds no DICOM images; name the folder in which the slices themselves lie");
  if (series.size() > 1)
    throw InputError(folder.string() + ": holds " + std::to_string(series.size()) +
                     " DICOM series; put the files of one of them into a folder of their own");
  const std::vector<std::string>& files = names->GetFileNames(series.front());
  return {files.begin(), files.end()};
}

}  // namespace coapt
