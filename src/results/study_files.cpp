// The files of the studies: JSON and CSV.
#include "results/study_files.hpp"

#include "formats/csv_table.hpp"
#include "formats/json/json_text.hpp"
#include "formats/whole_file.hpp"

#include <cmath>

namespace coapt {
OrderedJson number_json(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? OrderedJson(*value) : OrderedJson(nullptr);
}

OrderedJson distances_json(const std::optional<DistanceFigures>& distance) {
  if (!distance) return nullptr;
  return {{"mean_mm", number_json(distance->mean)},
          {"p95_mm", number_json(distance->p95)},
          {"max_mm", number_json(distance->max)}};
}

void write_study(const std::filesystem::path& folder, const std::string& name, const OrderedJson& json,
                 const Table& table) {
  formats::write_whole(folder / (name + ".json"), json_text(json, 2) + "\n");
  formats::write_whole(folder / (name + ".csv"), csv_table(table));
}

}  // namespace coapt
