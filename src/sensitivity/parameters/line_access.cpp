#include "sensitivity/parameters/line_access.hpp"

namespace coapt {

void LineAccess::set_rest_lengths(const Vector& lengths) {
  for (int e = 0; e < term_.stencils().count(); ++e)
    if (lengths[e] != rest_length(e)) access_.set_rest_length(e, lengths[e]);
}

LineState LineAccess::at(int element, double l) const {
  Eigen::Vector<double, 6> x = Eigen::Vector<double, 6>::Zero(), g;
  Eigen::Matrix<double, 6, 6> h;
  x[3] = l;
  LineState state;
  state.law.energy = access_.evaluate_element(element, x.data(), g.data(), h.data());
  state.law.force = g[3];
  state.law.stiffness = h(3, 3);
  const RestSlope slope = access_.slope_by_rest(element, state.law, l);
  state.energy_by_rest = slope.energy;
  state.force_by_rest = slope.force;
  return state;
}

std::unique_ptr<LineAccess> line_access(EnergyTerm& term) {
  TermAccess* access = access_of(term);
  if (access == nullptr || !access->has_rest_lengths()) return nullptr;
  return std::make_unique<LineAccess>(term, *access);
}

double line_length(const EnergyTerm& term, int element, const Points& x) {
  const int* ends = &term.stencils().nodes[2 * static_cast<size_t>(element)];
  return (x.col(ends[1]) - x.col(ends[0])).norm();
}

}  // namespace coapt
