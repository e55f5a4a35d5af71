// Elements whose law changes between two shapes: where derivatives have a kink.
#pragma once

#include "energy/objective.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace coapt {

struct Switch {
  std::string term;
  int element = 0;  // of the term; of a contact its first node or facet
  // "slack", "rounded", "taut", "wrinkled"; "apart", "point on face", ...; of facets "within range".
  std::string before, after;
  bool is_kink = true;  // false: the energy has two continuous derivatives there
};

// The state of one element that has several.
struct ElementState {
  int term = 0;  // of the objective
  std::array<int, 4> element =
      {};                      // its number in the first place; of a contact its four nodes, or two facets
  std::string_view name = {};  // see Switch
  int detail = 0;              // of a contact: bit a where its node a takes part; of facets: their pairs of
                               // points within range
  bool changes_smoothly = false;  // from one state to another: lines that are rounded
  bool begins_smoothly = false;   // from "apart"
};
using ElementStates = std::vector<ElementState>;  // by term, then element, ascending

// Of all elements at x (3 x node_count) that have states: lines (slack, within the rounded onset of their
// tension, taut), membranes that relax compression (slack, wrinkled, taut), and contacts: of a barrier which
// features meet and which of their nodes take part, of a repulsion of facets which pairs are within range.
// Pre: contact terms are prepared for positions near x.
ElementStates element_states(const Objective& objective, const Points& x);

// What has another state after than before; a contact that is only in one of them is "apart" in the other.
std::vector<Switch> switches_between(const Objective& objective, const ElementStates& before,
                                     const ElementStates& after);

// What stands so near a kink that rounding decides on which side: what has another state when the shape grows
// by a billionth than when it shrinks as much.
std::vector<Switch> kinks_at(const Objective& objective, const Points& x);

}  // namespace coapt
