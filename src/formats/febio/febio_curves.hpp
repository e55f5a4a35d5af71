// The load curves of a FEBio model.
#pragma once

#include "formats/febio/febio_materials.hpp"

#include <pugixml.hpp>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace coapt::formats {

// A curve over time: its value at the end. At its points every kind of curve has their values; nothing where
// it is not linear between points, or not constant beyond them, and the end is there.
struct FebioCurve {
  std::vector<std::pair<double, double>> points;
  bool is_linear = true, is_constant_beyond = true;
  std::optional<double> end_value(std::optional<double> end) const;  // nothing: the end is not known
};

// The curves of <LoadData> by the number that values refer to.
class FebioCurves {
 public:
  FebioCurves() = default;
  FebioCurves(const pugi::xml_node& root, const FebioPlaces& places);

  // What a value is to be multiplied by at the end of the time; 1 without a curve. Adds a defect where its
  // curve is missing, or does not say what it is then.
  double factor(const pugi::xml_node& value, std::optional<double> end, const FebioPlaces& places) const;

 private:
  std::map<std::string, FebioCurve> curves_;
};

}  // namespace coapt::formats
