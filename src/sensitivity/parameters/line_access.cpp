#include "sensitivity/parameters/line_access.hpp"

#include "energy/element_term.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/kernels/cable_law.hpp"
#include "energy/kernels/tether_cubic.hpp"

namespace coapt {
namespace {

void lengthen(Cable::Rest& rest, double length) {
  rest.stiffness *= rest.length / length;
  rest.smoothing *= length / rest.length;
  rest.length = length;
}

template <typename Rest>
void lengthen(Rest& rest, double length) {
  rest.length = length;
}

// A cable is r w(l/r) (and its constant tension times l): homogeneous of degree one in both lengths, so that
// Euler's theorem gives the derivatives by r. A tether depends on l - r alone.
template <typename Kernel>
void differentiate_by_rest(double l, double r, LineState& state) {
  if constexpr (std::is_same_v<Kernel, TetherCubic>) {
    state.energy_by_rest = -state.law.force;
    state.force_by_rest = -state.law.stiffness;
  } else if (r > 0) {
    state.energy_by_rest = (state.law.energy - l * state.law.force) / r;
    state.force_by_rest = -l / r * state.law.stiffness;
  }
}

template <typename Kernel>
class Access final : public LineAccess {
 public:
  explicit Access(ElementTerm<Kernel>& term) : term_(term) {}

  double rest_length(int element) const override { return rest(element).length; }

  void set_rest_lengths(const Vector& lengths) override {
    std::vector<typename Kernel::Rest> changed = term_.rest();
    for (size_t e = 0; e < changed.size(); ++e) {
      const double length = lengths[static_cast<Eigen::Index>(e)];
      if (length != changed[e].length) lengthen(changed[e], length);
    }
    term_.set_rest(std::move(changed));
  }

  LineState at(int element, double l) const override {
    Eigen::Vector<double, 6> x = Eigen::Vector<double, 6>::Zero(), g;
    Eigen::Matrix<double, 6, 6> h;
    x[3] = l;
    LineState state;
    state.law.energy = Kernel::evaluate(rest(element), x, &g, &h);
    state.law.force = g[3];
    state.law.stiffness = h(3, 3);
    differentiate_by_rest<Kernel>(l, rest(element).length, state);
    return state;
  }

 private:
  const typename Kernel::Rest& rest(int element) const { return term_.rest()[static_cast<size_t>(element)]; }

  ElementTerm<Kernel>& term_;
};

template <typename... Kernels>
std::unique_ptr<LineAccess> first_of(EnergyTerm& term) {
  std::unique_ptr<LineAccess> access;
  const auto attempt = [&]<typename Kernel>(const Kernel*) {
    if (auto* lines = dynamic_cast<ElementTerm<Kernel>*>(&term))
      access = std::make_unique<Access<Kernel>>(*lines);
    return access != nullptr;
  };
  (attempt(static_cast<const Kernels*>(nullptr)) || ...);
  return access;
}

}  // namespace

std::unique_ptr<LineAccess> line_access(EnergyTerm& term) {
  return first_of<Cable, CableBilinear, CableOgden, CableToe, CableCrimpedFibre, TetherCubic>(term);
}

double line_length(const EnergyTerm& term, int element, const Points& x) {
  const int* ends = &term.stencils().nodes[2 * static_cast<size_t>(element)];
  return (x.col(ends[1]) - x.col(ends[0])).norm();
}

}  // namespace coapt
