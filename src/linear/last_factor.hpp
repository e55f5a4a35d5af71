// What factorisations that are made one after the other, as those of one solve are, leave to the next.
#pragma once

#include "linear/multifrontal_factor.hpp"
#include "linear/updated_order.hpp"

#include <memory>

namespace coapt {

struct LastFactor {
  KeptOrder order;

  // For its memory alone, which is 100 MB at 40,000 triangles: pages that come from the system are cleared
  // first. Null: in use, or there was none yet.
  std::unique_ptr<MultifrontalFactor> factor;
};

}  // namespace coapt
