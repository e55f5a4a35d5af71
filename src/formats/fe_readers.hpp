// One reader per format of finite-element models.
#pragma once

#include "formats/fe_model.hpp"

#include <string>
#include <string_view>

namespace coapt::formats {

// Both throw InputError with all defects, each naming file and line.
FeModel read_abaqus(std::string_view bytes, const std::string& file);  // .inp
FeModel read_febio(std::string_view bytes, const std::string& file);   // .feb

}  // namespace coapt::formats
