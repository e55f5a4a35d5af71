// Elements whose law changes between two shapes: where derivatives have a kink.
#pragma once

#include "energy/objective.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace coapt {

struct Switch {
  std::string term;
  int element = 0;            // of the term; of a contact its first node
  std::string before, after;  // "slack", "rounded", "taut", "wrinkled"; "apart", "point on face", ...
};

// The state of each element at x (3 x node_count) that has one: lines (slack, within the rounded onset of
// their tension, taut), membranes that relax compression (slack, wrinkled, taut) and the contacts of a
// barrier (which features meet, and which of their nodes take part). Contacts by repulsion of facets are not
// followed.
struct ElementStates {
  struct State {
    std::string name;
    int nodes = 0;  // of a contact: bit a where its node a takes part
  };
  struct Key {
    std::string term;
    std::array<int, 4> element;  // number of the element in the first place, or the nodes of a contact
    auto operator<=>(const Key&) const = default;
  };
  std::map<Key, State> states;
};

// Pre: contact terms are prepared for positions near x.
ElementStates element_states(const Objective& objective, const Points& x);

// What has another state after than before; a contact that is only in one of them is "apart" in the other.
std::vector<Switch> switches_between(const ElementStates& before, const ElementStates& after);

}  // namespace coapt
