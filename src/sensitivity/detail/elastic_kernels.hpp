// The laws of elastic elements that parameters know how to change.
#pragma once

#include "energy/kernels/bending.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/kernels/cable_law.hpp"
#include "energy/kernels/cst_fibrous.hpp"
#include "energy/kernels/cst_isotropic.hpp"
#include "energy/kernels/cst_tension_field.hpp"
#include "energy/kernels/spring.hpp"
#include "energy/kernels/tether_cubic.hpp"
#include "sensitivity/detail/element_visit.hpp"

namespace coapt {

using ElasticKernels =
    KernelList<CstStVK, CstTensionField, CstBilinear, CstNeoHookean, CstExponential, CstOrthotropic,
               CstMayNewmanYin, CstCrimpedFibre, BendingHinge, Cable, CableBilinear, CableOgden, CableToe,
               CableCrimpedFibre, TetherCubic, Spring>;

}  // namespace coapt
