#include "sensitivity/switches.hpp"

#include "energy/contact_barrier.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/kernels/cable_law.hpp"
#include "energy/kernels/cst_fibrous.hpp"
#include "energy/kernels/cst_isotropic.hpp"
#include "energy/kernels/cst_tension_field.hpp"
#include "energy/kernels/spring.hpp"
#include "energy/kernels/tether_cubic.hpp"
#include "sensitivity/detail/element_visit.hpp"

#include <bit>

namespace coapt {
namespace {

using Lines = KernelList<Cable, CableBilinear, CableOgden, CableToe, CableCrimpedFibre, TetherCubic, Spring>;
using RelaxingMembranes = KernelList<CstTensionField, CstBilinear, CstNeoHookean, CstExponential,
                                     CstOrthotropic, CstMayNewmanYin, CstCrimpedFibre>;

// Length of the rounded onset [length].
double onset(const Cable::Rest& rest) { return rest.smoothing; }
double onset(const TetherCubic::Rest&) { return 0; }
template <typename Rest>
double onset(const Rest& rest) {
  return rest.smoothing * rest.length;
}

// Lines whose law does not change: springs both ways, constant forces.
bool is_one_law(const Cable::Rest& rest) { return rest.length == 0; }
bool is_one_law(const Spring::Rest& rest) { return rest.resists; }
template <typename Rest>
bool is_one_law(const Rest&) {
  return false;
}

// Membranes that resist compression have no regimes.
template <typename Rest>
bool relaxes(const Rest& rest) {
  return rest.relaxes;
}
bool relaxes(const CstTensionField::Rest&) { return true; }

template <typename Rest>
std::string line_state(const Rest& rest, const Eigen::Vector<double, 6>& x) {
  const double elongation = (x.tail<3>() - x.head<3>()).norm() - rest.length;
  if (elongation <= 0) return "slack";
  return elongation < onset(rest) ? "rounded" : "taut";
}

std::string regime_name(MembraneRegime regime) {
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

std::string contact_kind(const BarrierContact& contact) {
  const auto bits = [&](int mask) { return std::popcount(static_cast<unsigned>(contact.inside & mask)); };
  if (!contact.is_edge_edge) {
    const int corners = bits(0b1110);
    return corners == 3 ? "point on face" : corners == 2 ? "point on edge" : "point on point";
  }
  const int ends = bits(0b1111);
  return ends == 4 ? "edge on edge" : ends == 3 ? "point on edge" : "point on point";
}

}  // namespace

ElementStates element_states(const Objective& objective, const Points& x) {
  ElementStates found;
  for (const auto& term : objective.terms()) {
    const auto note = [&](size_t e, const std::string& state) {
      found.states[{term->name(), {static_cast<int>(e), 0, 0, 0}}] = {state, 0};
    };
    visit_element_term(Lines{}, *term, [&](const auto& lines) {
      for (size_t e = 0; e < lines.rest().size(); ++e)
        if (!is_one_law(lines.rest()[e]))
          note(e, line_state(lines.rest()[e], element_positions(lines, e, x)));
    });
    visit_element_term(RelaxingMembranes{}, *term, [&]<typename Kernel>(const ElementTerm<Kernel>& membrane) {
      for (size_t e = 0; e < membrane.rest().size(); ++e)
        if (relaxes(membrane.rest()[e]))
          note(e, regime_name(Kernel::state(membrane.rest()[e], element_positions(membrane, e, x)).regime));
    });
    for (const BarrierContact& contact : barrier_contacts(*term, x))
      found.states[{term->name(), contact.nodes}] = {contact_kind(contact), contact.inside};
  }
  return found;
}

std::vector<Switch> switches_between(const ElementStates& before, const ElementStates& after) {
  std::vector<Switch> found;
  for (const auto& [key, state] : before.states) {
    const auto other = after.states.find(key);
    if (other == after.states.end())
      found.push_back({key.term, key.element[0], state.name, "apart"});
    else if (other->second.name != state.name || other->second.nodes != state.nodes)
      found.push_back({key.term, key.element[0], state.name, other->second.name});
  }
  for (const auto& [key, state] : after.states)
    if (!before.states.contains(key)) found.push_back({key.term, key.element[0], "apart", state.name});
  return found;
}

}  // namespace coapt
