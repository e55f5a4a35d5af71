// What the files of the studies share.
#pragma once

#include "formats/json/json_text.hpp"
#include "formats/table.hpp"
#include "results/reference/reference_distance.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace coapt {

// NAME.json and NAME.csv in the folder, each whole or not there.
void write_study(const std::filesystem::path& folder, const std::string& name, const OrderedJson& json,
                 const Table& table);

// Null where there is none, or it is not finite.
OrderedJson number_json(const std::optional<double>& value);

// mean_mm, p95_mm and max_mm; null where there is none.
OrderedJson distances_json(const std::optional<DistanceFigures>& distance);

}  // namespace coapt
