// Lists of three numbers.
#pragma once

#include "core/types.hpp"

#include <string>

namespace coapt {

// Three numbers a line; lines that start with # and a first line of names are passed over. Throws InputError
// with the file and line of all defects.
Points read_csv(const std::string& path);

}  // namespace coapt
