// What the files of the studies share.
#pragma once

#include "formats/json/json_text.hpp"
#include "results/reference_distance.hpp"

#include <filesystem>
#include <optional>
#include <sstream>
#include <string>

namespace coapt {

// NAME.json and NAME.csv in the folder, each whole or not there.
void write_study(const std::filesystem::path& folder, const std::string& name, const OrderedJson& json,
                 const std::string& csv);

// Null where there is none, or it is not finite.
OrderedJson number_json(const std::optional<double>& value);

// mean_mm, p95_mm and max_mm.
OrderedJson distances_json(const DistanceFigures& distance);

// A table with its first line, of 12 digits.
std::ostringstream csv_with_header(const std::string& header);

}  // namespace coapt
