// The JSON of a comparison, for its file and for its page. Private to this room.
#pragma once

#include "scene/comparison_report.hpp"
#include "scene/detail/study_files.hpp"

namespace coapt {

Json comparison_as_json(const Comparison& comparison);

}  // namespace coapt
