// Volumes whose header was changed as a header: the rest stays as it was, so that what reads the voxels meets
// a header that tells them otherwise.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace coapt::fuzz {

// NRRD or MetaImage with one to three of its header's lines changed: a number replaced by an extreme one or
// by another number of the header, the value by that of another line, the line left out or doubled; NIfTI or
// DICOM with one to three fields of 2 or 4 bytes set to extreme whole or floating-point numbers. Empty where
// the input is none of them. The same for the same input and seed, on every machine.
std::string changed_header(std::string_view bytes, std::size_t seed);

}  // namespace coapt::fuzz
