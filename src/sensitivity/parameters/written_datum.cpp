#include "sensitivity/parameters/written_datum.hpp"

#include "sensitivity/parameters/parameter.hpp"

#include <algorithm>
#include <functional>

namespace coapt {
namespace {

using Kind = WrittenDatum::Kind;

bool makes_anew(Kind kind) { return kind == Kind::Remade || kind == Kind::Made; }
bool is_of_element(Kind kind) { return makes_anew(kind) || kind == Kind::Shape || kind == Kind::Stiffness; }

bool do_clash(Kind a, Kind b) {
  if (a == b) return a != Kind::Stiffness && a != Kind::Remade;
  return is_of_element(a) && is_of_element(b) && (makes_anew(a) || makes_anew(b));
}

bool is_before(const WrittenDatum& a, const WrittenDatum& b) {
  if (a.term != b.term) return std::less<>()(a.term, b.term);
  return a.index < b.index;
}

std::string text_of(const WrittenDatum& datum) {
  const std::string number = std::to_string(datum.index);
  const std::string term = datum.term == nullptr ? "" : " of term \"" + datum.term->name() + "\"";
  switch (datum.kind) {
    case Kind::Place:
      return "the place of node " + number;
    case Kind::Length:
      return "the rest length of line " + number + term;
    case Kind::Shape:
      return "the rest shape of element " + number + term;
    case Kind::Pressure:
      return "the pressure" + term;
    case Kind::Force:
      return "force " + number + term;
    case Kind::Stiffness:
    case Kind::Remade:
    case Kind::Made:
      break;
  }
  return "element " + number + term;
}

}  // namespace

std::vector<WrittenDatum> whole_term(Kind kind, const EnergyTerm& term) {
  std::vector<WrittenDatum> data;
  for (int e = 0; e < term.stencils().count(); ++e) data.push_back({kind, &term, e});
  return data;
}

std::string clash_of(const Parameter& parameter, const Parameter& other) {
  std::vector<WrittenDatum> known = other.written();
  std::sort(known.begin(), known.end(), is_before);
  const std::string where = "parameter \"" + parameter.name() + "\": ", others = "\"" + other.name() + "\"";
  for (const WrittenDatum& own : parameter.written()) {
    const auto [first, last] = std::equal_range(known.begin(), known.end(), own, is_before);
    const auto shared =
        std::find_if(first, last, [&](const WrittenDatum& each) { return do_clash(own.kind, each.kind); });
    if (shared == last) continue;
    if (shared->kind == own.kind)
      return where + "changes " + text_of(own) + ", which " + others + " changes; leave one of them out";
    return where + "does not go with " + others + ", one changes " + text_of(own) +
           " in place that the other makes anew; take numbers of the scene for both, such as TERM.young, or "
           "neither";
  }
  return {};
}

std::string clash_within(const Parameter& parameter) {
  std::vector<WrittenDatum> data = parameter.written();
  std::sort(data.begin(), data.end(), is_before);
  for (auto first = data.begin(); first != data.end();) {
    const auto last = std::upper_bound(first, data.end(), *first, is_before);
    for (auto a = first; a != last; ++a)
      for (auto b = a + 1; b != last; ++b)
        if (do_clash(a->kind, b->kind))
          return "parameter \"" + parameter.name() + "\": changes " + text_of(*a) + " twice; name it once";
    first = last;
  }
  return {};
}

}  // namespace coapt
