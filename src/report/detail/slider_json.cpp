#include "report/detail/slider_json.hpp"

#include "core/number_text.hpp"
#include "formats/json/base64.hpp"
#include "report/metric_words.hpp"
#include "report/shape_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <span>

namespace coapt {
namespace {

constexpr size_t kRoom = 178'000;  // of all displacements, as text [bytes]: names and figures take 20 kB

// A number takes four letters for three bytes.
size_t text_bytes(size_t nodes, size_t parameters, size_t number_bytes) {
  return 4 * (parameters * 3 * nodes * number_bytes + 2) / 3;
}

template <class Integer>
std::string packed(const Points& motion, double step) {
  std::vector<Integer> steps(static_cast<size_t>(motion.size()));
  for (size_t k = 0; k < steps.size(); ++k)
    steps[k] = static_cast<Integer>(std::lround(motion.data()[k] / step));  // within its range by the step
  return base64(std::span<const Integer>(steps));
}

// What solves found, by the words that figures have in a page.
OrderedJson figures_json(const ParameterResponse& response) {
  OrderedJson json = OrderedJson::object();
  for (size_t end = 0; end < 2; ++end)
    for (const MetricRow& row : response.ends[end].figures) {
      if (!row.value || !std::isfinite(*row.value)) continue;
      const std::string name = metric_in_words(row);
      if (!json.contains(name)) json[name] = {nullptr, nullptr};
      json[name][end] = std::strtod(number_text(*row.value, 5).c_str(), nullptr);
    }
  return json;
}

// Without the last digits, which depend on how threads shared the work.
double in_six_digits(double value) { return std::strtod(number_text(value, 6).c_str(), nullptr); }

OrderedJson response_json(const ParameterResponse& response, bool is_short) {
  const double most =
      is_short ? std::numeric_limits<std::int8_t>::max() : std::numeric_limits<std::int16_t>::max();
  const double greatest = response.motion.cwiseAbs().maxCoeff(), step = greatest > 0 ? greatest / most : 1;
  OrderedJson range = OrderedJson::array(), errors = range;
  for (const CheckedEnd& end : response.ends) {
    range.push_back(in_six_digits(end.change));
    errors.push_back(in_six_digits(end.error_mm + std::abs(end.change) * std::sqrt(3.0) * step / 2));
  }
  return {{"name", response.name},
          {"unit", response.unit},
          {"usual", response.usual_change},
          {"range", range},
          {"errors", errors},
          {"figures", figures_json(response)},
          {"bytes", is_short ? 1 : 2},
          {"step", step},
          {"motion", is_short ? packed<std::int8_t>(response.motion, step)
                              : packed<std::int16_t>(response.motion, step)}};
}

}  // namespace

size_t most_sliders(size_t nodes) { return nodes == 0 ? 0 : 3 * kRoom / (4 * 3 * nodes); }

OrderedJson sliders_json(const FirstOrder& first_order) {
  size_t count = first_order.parameters.size();
  if (count == 0) return {{"parameters", OrderedJson::array()}, {"message", first_order.message}};
  const auto nodes = static_cast<size_t>(first_order.parameters.front().motion.cols());
  const bool is_short = text_bytes(nodes, count, 2) > kRoom;
  count = std::min(count, std::max<size_t>(1, most_sliders(nodes)));
  OrderedJson parameters = OrderedJson::array();
  for (size_t k = 0; k < count; ++k) parameters.push_back(response_json(first_order.parameters[k], is_short));
  return {
      {"candidates", first_order.candidates}, {"left_out", first_order.left_out}, {"parameters", parameters}};
}

}  // namespace coapt
