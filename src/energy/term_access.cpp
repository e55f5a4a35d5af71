#include "energy/term_access.hpp"

#include <utility>

namespace coapt {

const TermAccess* access_of(const EnergyTerm& term) { return dynamic_cast<const TermAccess*>(&term); }

TermAccess* access_of(EnergyTerm& term) { return const_cast<TermAccess*>(access_of(std::as_const(term))); }

TermKind kind_of(const EnergyTerm& term) {
  const TermAccess* access = access_of(term);
  return access == nullptr ? TermKind::Other : access->kind();
}

}  // namespace coapt
