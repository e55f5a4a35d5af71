// The JSON of a comparison, for its file and for its page, and of what a benchmark shares with it. Private to
// this room.
#pragma once

#include "results/study_files.hpp"
#include "study/comparison_report.hpp"

namespace coapt {

// Both directions together, each by itself and, where it makes sense, between vertices of the same number.
OrderedJson distance_json(const ReferenceDistance& distance);
OrderedJson gap_json(const MethodGap& gap);

OrderedJson comparison_as_json(const Comparison& comparison);

}  // namespace coapt
