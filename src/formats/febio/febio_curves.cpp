#include "formats/febio/febio_curves.hpp"

#include "formats/abaqus/abaqus_cards.hpp"
#include "formats/text.hpp"

#include <cmath>

namespace coapt::formats {

std::optional<double> FebioCurve::end_value(std::optional<double> end) const {
  const auto beyond = [&](double value) { return is_constant_beyond ? std::optional(value) : std::nullopt; };
  constexpr double kRoundOff = 1e-9;  // of the sum of the time steps
  if (!end) return points.back().second;
  for (size_t k = 0; k < points.size(); ++k) {
    if (std::abs(points[k].first - *end) <= kRoundOff * *end) return points[k].second;
    if (points[k].first < *end) continue;
    if (k == 0) return beyond(points[0].second);
    if (!is_linear) return std::nullopt;
    const double part = (*end - points[k - 1].first) / (points[k].first - points[k - 1].first);
    return points[k - 1].second + part * (points[k].second - points[k - 1].second);
  }
  return beyond(points.back().second);
}

FebioCurves::FebioCurves(const pugi::xml_node& root, const FebioPlaces& places) {
  for (const pugi::xml_node& controller : root.child("LoadData").children("load_controller")) {
    FebioCurve curve;
    for (const char* name : {"pt", "point"})
      for (const pugi::xml_node& pt : controller.child("points").children(name)) {
        const auto pair = places.numbers(pt, pt.text().get());
        if (!pair) continue;
        if (pair->size() != 2 || (!curve.points.empty() && (*pair)[0] <= curve.points.back().first))
          places.add(pt, "expected a time, greater than the one before, and a value");
        else
          curve.points.emplace_back((*pair)[0], (*pair)[1]);
      }
    const auto says = [&](const char* child, const char* usual) {
      const std::string text = upper_case(trimmed(controller.child(child).text().get()));
      return text.empty() || text == usual;
    };
    curve.is_linear = says("interpolate", "LINEAR");
    curve.is_constant_beyond = says("extend", "CONSTANT");
    if (!curve.points.empty()) curves_[controller.attribute("id").as_string()] = std::move(curve);
  }
}

double FebioCurves::factor(const pugi::xml_node& value, std::optional<double> end,
                           const FebioPlaces& places) const {
  const pugi::xml_attribute lc = value.attribute("lc");
  if (!lc) return 1;
  const auto found = curves_.find(lc.as_string());
  if (found != curves_.end()) {
    const auto at_end = found->second.end_value(end);
    if (!at_end)
      places.add(value, "load controller " + formats::quoted(lc.as_string()) +
                            " is not LINEAR between points, or not CONSTANT beyond them, and the end of the "
                            "time is no point of it; add one there");
    return at_end.value_or(1);
  }
  places.add(value, "load controller " + formats::quoted(lc.as_string()) + " is no load curve of the file");
  return 1;
}

}  // namespace coapt::formats
