// Texts of files as UTF-8, which is what JSON takes.
#pragma once

#include <string>

namespace coapt::formats {

// The bytes where they are UTF-8; else they are taken as Latin-1, which older programs write, so that names
// keep their letters.
std::string as_utf8(std::string bytes);

}  // namespace coapt::formats
