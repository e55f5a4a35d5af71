// The JSON of a comparison, for its file and for its page, and of what a benchmark shares with it. Private to
// this room.
#pragma once

#include "results/reference/reference_results.hpp"
#include "results/study_files.hpp"
#include "study/comparison_report.hpp"

namespace coapt {

OrderedJson gap_json(const MethodGap& gap);

OrderedJson comparison_as_json(const Comparison& comparison);

}  // namespace coapt
