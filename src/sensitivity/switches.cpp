#include "sensitivity/switches.hpp"

#include "energy/contact_barrier.hpp"
#include "energy/contact_facet.hpp"
#include "energy/term_access.hpp"
#include "sensitivity/detail/element_positions.hpp"

#include <algorithm>
#include <bit>
#include <tuple>

namespace coapt {
namespace {

std::string_view line_state(const LineTraits& line, const ElementVector& x) {
  const double elongation = (x.tail<3>() - x.head<3>()).norm() - line.length;
  if (elongation <= 0) return "slack";
  return elongation < line.onset ? "rounded" : "taut";
}

std::string_view regime_name(MembraneRegime regime) {
  switch (regime) {
    case MembraneRegime::Slack:
      return "slack";
    case MembraneRegime::Wrinkled:
      return "wrinkled";
    case MembraneRegime::Taut:
      return "taut";
  }
  return "";
}

std::string_view contact_kind(const BarrierContact& contact) {
  const auto bits = [&](int mask) { return std::popcount(static_cast<unsigned>(contact.inside & mask)); };
  if (!contact.is_edge_edge) {
    const int corners = bits(0b1110);
    return corners == 3 ? "point on face" : corners == 2 ? "point on edge" : "point on point";
  }
  const int ends = bits(0b1111);
  return ends == 4 ? "edge on edge" : ends == 3 ? "point on edge" : "point on point";
}

bool comes_before(const ElementState& a, const ElementState& b) {
  return std::tie(a.term, a.element) < std::tie(b.term, b.element);
}

}  // namespace

ElementStates element_states(const Objective& objective, const Points& x) {
  ElementStates found;
  for (size_t k = 0; k < objective.terms().size(); ++k) {
    EnergyTerm& term = *objective.terms()[k];
    const int number = static_cast<int>(k);
    const auto note = [&](int e, std::string_view name, bool is_smooth) {
      found.push_back({.term = number, .element = {e, 0, 0, 0}, .name = name, .changes_smoothly = is_smooth});
    };
    const TermAccess* access = access_of(term);
    const int elements = access == nullptr || !access->has_elastic_elements() ? 0 : term.stencils().count();
    for (int e = 0; e < elements; ++e) {
      if (access->has_lines()) {
        const LineTraits line = access->line(e);
        if (!line.is_one_law) note(e, line_state(line, element_positions(term, e, x)), line.begins_softly);
      } else if (const auto regime = access->regime(e, element_positions(term, e, x).data())) {
        note(e, regime_name(*regime), false);
      }
    }
    for (const BarrierContact& contact : barrier_contacts(term, x))
      found.push_back({number, contact.nodes, contact_kind(contact), contact.inside, false, true});
    for (const FacetContact& contact : facet_contacts(term, x))
      found.push_back({number,
                       {contact.first, contact.second, 0, 0},
                       "within range",
                       contact.point_pairs,
                       contact.is_smooth,
                       contact.is_smooth});
  }
  std::sort(found.begin(), found.end(), comes_before);  // contacts come in the order of their list
  return found;
}

std::vector<Switch> switches_between(const Objective& objective, const ElementStates& before,
                                     const ElementStates& after) {
  std::vector<Switch> found;
  const auto add = [&](const ElementState& element, std::string_view was, std::string_view is,
                       bool is_smooth) {
    found.push_back({objective.terms()[static_cast<size_t>(element.term)]->name(), element.element[0],
                     std::string(was), std::string(is), !is_smooth});
  };
  auto a = before.begin(), b = after.begin();
  while (a != before.end() || b != after.end()) {
    if (b == after.end() || (a != before.end() && comes_before(*a, *b))) {
      add(*a, a->name, "apart", a->begins_smoothly);
      ++a;
    } else if (a == before.end() || comes_before(*b, *a)) {
      add(*b, "apart", b->name, b->begins_smoothly);
      ++b;
    } else {
      if (a->name != b->name || a->detail != b->detail) add(*a, a->name, b->name, a->changes_smoothly);
      ++a;
      ++b;
    }
  }
  return found;
}

std::vector<Switch> kinks_at(const Objective& objective, const Points& x) {
  constexpr double kBillionth = 1e-9;  // growth and shrinkage between which what switches is at a kink
  if (x.cols() == 0) return {};
  const Vec3 centre = x.rowwise().mean();
  const Points growth = kBillionth * (x.colwise() - centre);
  std::vector<Switch> found = switches_between(objective, element_states(objective, x - growth),
                                               element_states(objective, x + growth));
  std::erase_if(found, [](const Switch& each) { return !each.is_kink; });
  return found;
}

}  // namespace coapt
