// The force that residuals are measured against: a value of the problem and of the state that is judged,
// never of what was evaluated before (docs/theory.md, "Residual and balance").
#pragma once

#include "energy/term.hpp"

#include <algorithm>
#include <memory>
#include <vector>

namespace coapt {

using FixedMask = Eigen::Array<bool, 3, Eigen::Dynamic>;  // 3 x node_count: true = prescribed

double largest_column_norm(const Points& vectors);  // 0 without columns

class ForceScale {
 public:
  // What the reference state X has to say: the reactions of a prestress that is in equilibrium by itself, and
  // where no node feels a load, how stiff the body is.
  void measure_reference(const std::vector<std::unique_ptr<EnergyTerm>>& terms, const Points& X,
                         const FixedMask& fixed);

  // A scale that is given, as that of a whole to its part. Pre: positive.
  void give(double force) { given_ = force; }

  // The state that is judged: gradient of the loads and of all terms, 3 x node_count; stiffness: factor on
  // all energies but those of loads. First the loads.
  void measure_loads(const Points& gradient, const FixedMask& fixed);
  void measure_reactions(const Points& gradient, const FixedMask& fixed, double stiffness);

  // Largest load or reaction [force]. Loads on wholly prescribed nodes do not count, and of reactions only
  // what is added to those of a prestressed reference state, which would hide a load that is small beside the
  // prestress. Without loads never less than what a small strain of the whole body asks for.
  double force() const;

  // The same with the whole reactions, prestress included [force]: what round-off is measured against.
  double largest_force() const { return std::max(force(), whole_reaction_); }

 private:
  Points prestress_reaction_;  // at prescribed coordinates; empty: there is none
  double rest_ = 0;            // of a body that nothing loads
  double given_ = 0;
  double load_ = 0, reaction_ = 0, whole_reaction_ = 0, stiffness_ = 1;
};

}  // namespace coapt
