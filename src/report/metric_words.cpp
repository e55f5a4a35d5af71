#include "report/metric_words.hpp"

#include <algorithm>
#include <cctype>

namespace coapt {

std::string metric_in_words(const MetricRow& row) {
  std::string name = row.name, unit = row.unit;
  for (char& letter : unit) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  if (!unit.empty() && name.ends_with("_" + unit)) name.resize(name.size() - unit.size() - 1);
  std::replace(name.begin(), name.end(), '_', ' ');
  if (const size_t at = name.find("cauchy"); at != std::string::npos) name[at] = 'C';
  if (const size_t at = name.find("mises"); at != std::string::npos) name[at] = 'M';
  return name;
}

std::string unit_sign(const std::string& unit) {
  if (unit == "mm2") return "mm²";
  if (unit == "mm3") return "mm³";
  return unit;
}

std::string metric_title(const MetricRow& row) {
  return metric_in_words(row) + (row.unit.empty() ? "" : " [" + unit_sign(row.unit) + "]");
}

}  // namespace coapt
