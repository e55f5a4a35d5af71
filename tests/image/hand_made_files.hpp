// Files of volumes put together byte by byte, so that what a reader makes of them is known from their
// standards.
#pragma once

#include "core/types.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace coapt {

static_assert(std::endian::native == std::endian::little, "the files below are little endian");

template <typename Number>
std::string bytes_of(Number number) {
  std::string bytes(sizeof(number), '\0');
  std::memcpy(bytes.data(), &number, sizeof(number));
  return bytes;
}

// 0, 1, 2, ... in this kind of number.
template <typename Number>
std::string counted(int count) {
  std::string bytes;
  for (int k = 0; k < count; ++k) bytes += bytes_of(static_cast<Number>(k));
  return bytes;
}

inline std::string nrrd(const std::string& fields, const std::string& data) {
  return "NRRD0005\n" + fields + "encoding: raw\nendian: little\n\n" + data;
}

// Fields of a volume of 2 x 3 x 4 numbers of 8 bits in this space, its axes turned by 90 degrees about z.
inline std::string turned_nrrd_fields(const std::string& space) {
  return "type: uint8\ndimension: 3\nspace: " + space +
         "\nsizes: 2 3 4\nspace directions: (0,0.5,0) (-0.6,0,0) (0,0,0.7)\nkinds: domain domain domain\n"
         "space origin: (10,20,30)\n";
}

struct NiftiHeader {
  std::array<std::int16_t, 8> dim = {3, 2, 3, 4, 1, 1, 1, 1};
  std::array<float, 8> pixdim = {1, 0.5F, 0.6F, 0.7F, 1, 1, 1, 1};
  std::int16_t qform_code = 0, sform_code = 0, datatype = 2, bitpix = 8;
  std::array<float, 6> quaternion_and_offset = {};  // b, c, d, x, y, z
  std::array<float, 12> srow = {};
};

// A file .nii, by the table of NIfTI-1.
inline std::string nifti(const NiftiHeader& header, const std::string& data) {
  std::string bytes(352, '\0');
  const auto put = [&](std::size_t at, const auto& value) { std::memcpy(&bytes[at], &value, sizeof(value)); };
  put(0, std::int32_t{348});
  put(40, header.dim);
  put(70, header.datatype);
  put(72, header.bitpix);
  put(76, header.pixdim);
  put(108, 352.0F);
  bytes[123] = 2;  // mm
  put(252, header.qform_code);
  put(254, header.sform_code);
  put(256, header.quaternion_and_offset);
  put(280, header.srow);
  std::memcpy(&bytes[344], "n+1", 4);
  return bytes + data;
}

inline std::string meta_image(const std::string& fields, const std::string& data) {
  return "ObjectType = Image\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\n" +
         fields + "ElementDataFile = LOCAL\n" + data;
}

struct DicomSlice {
  std::string series = "1.2.3.4", position = "0\\0\\0", orientation = "1\\0\\0\\0\\1\\0",
              spacing = "0.6\\0.5";
  int number = 1;
  std::uint16_t rows = 3, columns = 2;
};

// A slice of 16 bits in explicit VR little endian (DICOM PS3.5 and PS3.10); empty texts leave their element
// out.
inline std::string dicom(const DicomSlice& slice, const std::string& data) {
  const auto element = [](std::uint16_t group, std::uint16_t number, const char* kind, std::string value) {
    if (value.empty()) return std::string();
    const std::string type = kind;
    if (value.size() % 2) value += type == "UI" ? '\0' : ' ';
    const std::string head = bytes_of(group) + bytes_of(number) + type;
    if (type == "OW" || type == "OB")
      return head + bytes_of(std::uint16_t{0}) + bytes_of(static_cast<std::uint32_t>(value.size())) + value;
    return head + bytes_of(static_cast<std::uint16_t>(value.size())) + value;
  };
  const auto whole = [](int number) { return bytes_of(static_cast<std::uint16_t>(number)); };
  const std::string ct = "1.2.840.10008.5.1.4.1.1.2",
                    instance = slice.series + "." + std::to_string(slice.number);
  const std::string meta = element(2, 1, "OB", std::string("\0\1", 2)) + element(2, 2, "UI", ct) +
                           element(2, 3, "UI", instance) + element(2, 0x10, "UI", "1.2.840.10008.1.2.1") +
                           element(2, 0x12, "UI", "1.2.3");
  return std::string(128, '\0') + "DICM" +
         element(2, 0, "UL", bytes_of(static_cast<std::uint32_t>(meta.size()))) + meta +
         element(8, 0x16, "UI", ct) + element(8, 0x18, "UI", instance) + element(8, 0x60, "CS", "CT") +
         element(0x20, 0xd, "UI", "1.2.3.9") + element(0x20, 0xe, "UI", slice.series) +
         element(0x20, 0x13, "IS", std::to_string(slice.number)) + element(0x20, 0x32, "DS", slice.position) +
         element(0x20, 0x37, "DS", slice.orientation) + element(0x28, 2, "US", whole(1)) +
         element(0x28, 4, "CS", "MONOCHROME2") + element(0x28, 0x10, "US", bytes_of(slice.rows)) +
         element(0x28, 0x11, "US", bytes_of(slice.columns)) + element(0x28, 0x30, "DS", slice.spacing) +
         element(0x28, 0x100, "US", whole(16)) + element(0x28, 0x101, "US", whole(16)) +
         element(0x28, 0x102, "US", whole(15)) + element(0x28, 0x103, "US", whole(0)) +
         element(0x7fe0, 0x10, "OW", data);
}

}  // namespace coapt
