// Names and units of metrics for readers of a page, where files have keys: "orifice area", "mm²".
#pragma once

#include "results/metrics.hpp"

#include <string>

namespace coapt {

// "orifice_area_mm2" as "orifice area".
std::string metric_in_words(const MetricRow& row);

// "mm2" as "mm²"; others as they are.
std::string unit_sign(const std::string& unit);

// Both, for a column or an axis: "orifice area [mm²]"; a metric without a unit has its name alone.
std::string metric_title(const MetricRow& row);

}  // namespace coapt
