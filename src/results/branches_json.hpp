// Other equilibria in result.json.
#pragma once

#include "results/branch_report.hpp"

#include <nlohmann/json.hpp>

namespace coapt {

// The value of the key `branches`.
nlohmann::ordered_json branches_json(const Branches& branches);

}  // namespace coapt
