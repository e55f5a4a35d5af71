// Whether the bytes of a DICOM file are all there.
#pragma once

#include <filesystem>

namespace coapt {

// Walks along the elements of a file (DICOM PS3.5, chapter 7) up to its pixels. GDCM must not meet a file
// that ends within an element: where it was built with assertions, as on Debian, it ends the program. Throws
// InputError, naming the file, for one that does not begin as DICOM PS3.10 wants, and for one that ends too
// early or whose pixels are of no kind that there is, as GDCM guesses their length then. Files in the
// big-endian or the deflated transfer syntax are passed over.
void check_dicom_structure(const std::filesystem::path& path);

// Whether the file begins as a DICOM file does.
bool begins_as_dicom(const std::filesystem::path& path);

}  // namespace coapt
