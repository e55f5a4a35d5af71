// Calls a function with a term as what it is: one of the element terms of a list of kernels.
#pragma once

#include "energy/element_term.hpp"

namespace coapt {

template <typename... Kernels>
struct KernelList {};

// visit(ElementTerm<Kernel>&) for the first kernel of the list that the term is made of; false: of none.
template <typename... Kernels, typename Visit>
bool visit_element_term(KernelList<Kernels...>, EnergyTerm& term, const Visit& visit) {
  const auto attempt = [&]<typename Kernel>(const Kernel*) {
    auto* found = dynamic_cast<ElementTerm<Kernel>*>(&term);
    if (found != nullptr) visit(*found);
    return found != nullptr;
  };
  return (attempt(static_cast<const Kernels*>(nullptr)) || ...);
}

// Positions of an element's nodes, node after node.
template <typename Kernel>
Eigen::Vector<double, 3 * Kernel::kNodes> element_positions(const ElementTerm<Kernel>& term, size_t e,
                                                            const Points& x) {
  Eigen::Vector<double, 3 * Kernel::kNodes> local;
  for (int a = 0; a < Kernel::kNodes; ++a)
    local.template segment<3>(3 * a) = x.col(term.stencils().nodes[e * Kernel::kNodes + a]);
  return local;
}

}  // namespace coapt
