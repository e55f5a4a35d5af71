// Other equilibria in result.json.
#pragma once

#include "formats/json/json_text.hpp"
#include "results/branch_report.hpp"

namespace coapt {

// The value of the key `branches`.
nlohmann::ordered_json branches_json(const Branches& branches);

}  // namespace coapt
