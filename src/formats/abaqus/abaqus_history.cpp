#include "formats/abaqus/abaqus_history.hpp"

#include "formats/text.hpp"

#include <algorithm>

namespace coapt::formats {
namespace {

// First and last coordinate of a support by name, counted from 1; nothing where it is no such name.
std::vector<int> named_axes(const std::string& name) {
  static const std::map<std::string, std::vector<int>> kNames = {
      {"ENCASTRE", {1, 2, 3}}, {"PINNED", {1, 2, 3}}, {"XSYMM", {1}},     {"YSYMM", {2}},
      {"ZSYMM", {3}},          {"XASYMM", {2, 3}},    {"YASYMM", {1, 3}}, {"ZASYMM", {1, 2}}};
  const auto found = kNames.find(name);
  return found == kNames.end() ? std::vector<int>{} : found->second;
}

}  // namespace

bool AbaqusHistory::take(const AbaqusCard& card) {
  const std::string& keyword = card.keyword;
  if (keyword == "AMPLITUDE") {
    read_amplitude(card);
  } else if (keyword == "STEP") {
    begin_step(card);
  } else if (keyword == "END STEP") {
    in_step_ = false;
    total_time_ += period_;
  } else if (keyword == "STATIC") {
    read_period(card);
  } else if (keyword == "DYNAMIC") {
    read_period(card);
    left_out_.emplace("*DYNAMIC", card.line);
  } else if (keyword == "BOUNDARY") {
    read_boundary(card);
  } else if (keyword == "DSLOAD" || keyword == "DLOAD") {
    read_pressure(card, keyword == "DSLOAD");
  } else {
    return false;
  }
  return true;
}

void AbaqusHistory::read_amplitude(const AbaqusCard& card) {
  const std::string form = card.upper("DEFINITION");
  if (!form.empty() && form != "TABULAR" && form != "SMOOTH STEP" && form != "EQUALLY SPACED")
    return;  // an amplitude in use that is not known is refused where it is used
  if (card.has("INPUT") || form == "EQUALLY SPACED") return;
  Amplitude amplitude;
  amplitude.is_smooth = form == "SMOOTH STEP";
  amplitude.is_total_time = card.upper("TIME") == "TOTAL TIME";
  for (const AbaqusLine& line : card.data) {
    if (line.fields.size() % 2 != 0)
      defects_.add("line", line.number, "an amplitude needs pairs of a time and a value");
    for (size_t k = 0; k + 1 < line.fields.size(); k += 2) {
      const auto time = abaqus_number(line.fields[k], line.number, defects_);
      const auto value = abaqus_number(line.fields[k + 1], line.number, defects_);
      if (!time || !value) continue;
      if (!amplitude.points.empty() && *time <= amplitude.points.back().first)
        defects_.add("line", line.number, "the times of an amplitude must grow");
      amplitude.points.emplace_back(*time, *value);
    }
  }
  if (amplitude.points.empty()) return defects_.add("line", card.line, "an amplitude without values");
  if (!amplitudes_.emplace(card.upper("NAME"), std::move(amplitude)).second)
    defects_.add("line", card.line,
                 "an amplitude " + formats::quoted(card.text("NAME")) + " stands in the file already");
}

void AbaqusHistory::begin_step(const AbaqusCard& card) {
  if (in_step_) defects_.add("line", card.line, "a step begins inside another");
  in_step_ = true;
  period_ = 1;
  renewed_.clear();
}

void AbaqusHistory::read_period(const AbaqusCard& card) {
  if (card.data.empty() || card.data[0].fields.size() < 2) return;
  const double period = abaqus_number(card.data[0].fields[1], card.data[0].number, defects_).value_or(0);
  if (period > 0) period_ = period;
}

// Value of the card's amplitude at the end of the step.
double AbaqusHistory::final_factor(const AbaqusCard& card) {
  if (!card.has("AMPLITUDE")) return 1;
  const auto found = amplitudes_.find(card.upper("AMPLITUDE"));
  if (found == amplitudes_.end()) {
    defects_.add("line", card.line,
                 "amplitude " + formats::quoted(card.text("AMPLITUDE")) +
                     " does not stand before this line as a table or a smooth step");
    return 1;
  }
  const Amplitude& amplitude = found->second;
  const auto& points = amplitude.points;
  const double time = amplitude.is_total_time ? total_time_ + period_ : period_;
  const auto next =
      std::find_if(points.begin(), points.end(), [&](const auto& p) { return p.first >= time; });
  if (next == points.end()) return points.back().second;
  if (next == points.begin()) return points.front().second;
  const auto& [t0, a0] = *(next - 1);
  const auto& [t1, a1] = *next;
  const double s = (time - t0) / (t1 - t0);
  return a0 + (a1 - a0) * (amplitude.is_smooth ? s * s * s * (10 - 15 * s + 6 * s * s) : s);
}

// Whether OP=NEW removes what earlier steps gave; within a step it does so once.
bool AbaqusHistory::renews(const AbaqusCard& card, std::set<std::string>& renewed) {
  return card.upper("OP") == "NEW" && renewed.insert(card.keyword).second;
}

void AbaqusHistory::read_boundary(const AbaqusCard& card) {
  if (renews(card, renewed_)) holds_.clear();
  if (card.has("USER") || card.has("FIXED"))
    return defects_.add("line", card.line,
                        "supports from a user routine or from a running analysis cannot be read");
  const double factor = final_factor(card);
  for (const AbaqusLine& line : card.data) hold(line, card, factor);
}

void AbaqusHistory::hold(const AbaqusLine& line, const AbaqusCard& card, double factor) {
  if (line.fields.size() < 2)
    return defects_.add("line", line.number, "expected nodes, first and last coordinate and a displacement");
  std::vector<int> axes = named_axes(upper_case(line.fields[1]));
  double value = 0;
  if (axes.empty()) {
    const auto first = abaqus_integer(line.fields[1], line.number, defects_);
    const bool has_last = line.fields.size() > 2 && !line.fields[2].empty();
    const auto last = has_last ? abaqus_integer(line.fields[2], line.number, defects_) : first;
    if (!first || !last) return;
    if (*first < 1 || *last < *first || *last > 30)
      return defects_.add("line", line.number,
                          "coordinates are numbered from 1, the first not above the last");
    if (line.fields.size() > 3)
      value = factor * abaqus_number(line.fields[3], line.number, defects_).value_or(0);
    for (long long axis = *first; axis <= std::min(*last, 3LL); ++axis)
      axes.push_back(static_cast<int>(axis));
    if (*last > 3) left_out_.emplace("rotations in *BOUNDARY", line.number);
  }
  const std::string type = card.upper("TYPE");
  if (value != 0 && !type.empty() && type != "DISPLACEMENT")
    return defects_.add("line", line.number,
                        "a prescribed " + formats::quoted(type) + "; only displacements can be read");
  for (const AbaqusItem& item : assembly_.items(line.fields[0], 0, true, line.number)) {
    FeHold& hold = holds_[{item.scope, item.label}];
    for (const int axis : axes) {
      hold.axes[static_cast<size_t>(axis - 1)] = true;
      hold.displacement[axis - 1] = value;
    }
  }
}

void AbaqusHistory::read_pressure(const AbaqusCard& card, bool is_surface) {
  if (renews(card, renewed_))
    std::erase_if(pressures_, [&](const AbaqusPressure& p) { return p.is_surface == is_surface; });
  const double factor = final_factor(card);
  for (const AbaqusLine& line : card.data) {
    if (line.fields.size() < 2) {
      defects_.add("line", line.number, "expected a surface or elements, a label and a magnitude");
      continue;
    }
    const std::string label = upper_case(line.fields[1]);
    if (label != "P") {
      left_out_.emplace("load " + label + " in *" + card.keyword, line.number);
      continue;
    }
    const double value =
        line.fields.size() > 2 ? abaqus_number(line.fields[2], line.number, defects_).value_or(0) : 0;
    const std::string target = upper_case(line.fields[0]);
    std::erase_if(pressures_, [&](const AbaqusPressure& p) {  // a later step states it anew
      return p.target == target && p.is_surface == is_surface;
    });
    pressures_.push_back({target, is_surface, factor * value, line.number});
  }
}

}  // namespace coapt::formats
