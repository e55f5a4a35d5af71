// The files of src/scene/report, which the build puts into the library. Private to this room.
#pragma once

#include <string_view>

namespace coapt::report_files {

extern const std::string_view style;  // style.css

}  // namespace coapt::report_files
