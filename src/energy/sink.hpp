// Where a term pours its derivatives: a gradient, and Hessian blocks at places computed beforehand.
#pragma once

#include "core/types.hpp"

namespace coapt {

// How element Hessians enter the assembled one.
enum class Projection {
  None,                 // exact; may be indefinite
  PositiveSemidefinite  // each element's negative eigenvalues set to zero (Teran et al. 2005)
};

// Place of one 3x3 block in the values of a column-compressed matrix. Row r, column c of the block
// stands at values[base + c * stride + r]. Blocks above the diagonal are not stored (base < 0).
struct BlockSlot {
  int base = -1;
  int stride = 0;
};

class Sink {
 public:
  // Energy alone.
  Sink() = default;

  // Energy and gradient, 3 x node_count values in column order, added to.
  explicit Sink(double* gradient) : gradient_(gradient) {}

  // Energy, gradient and Hessian. slots: width * width for each element of the term. threads: that may
  // evaluate elements; what is poured, and in which order, does not depend on them.
  Sink(double* gradient, double* hessian, const BlockSlot* slots, Projection projection, int threads = 1)
      : gradient_(gradient), hessian_(hessian), slots_(slots), projection_(projection), threads_(threads) {}

  bool wants_gradient() const { return gradient_ != nullptr; }
  bool wants_hessian() const { return hessian_ != nullptr; }
  Projection projection() const { return projection_; }
  int threads() const { return threads_; }

  // Everything that is poured in from now on is multiplied by this factor (continuation in load or
  // stiffness).
  void set_factor(double factor) { factor_ = factor; }

  void add_gradient(int node, const Vec3& g) {
    double* to = gradient_ + 3 * static_cast<long>(node);
    to[0] += factor_ * g[0];
    to[1] += factor_ * g[1];
    to[2] += factor_ * g[2];
  }

  // Adds the block of one element's local nodes (a, b); element_offset = element * width * width.
  template <typename Block>
  void add_block(long element_offset, int width, int a, int b, const Block& block) {
    const BlockSlot slot = slots_[element_offset + a * width + b];
    if (slot.base < 0) return;
    double* to = hessian_ + slot.base;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) to[c * slot.stride + r] += factor_ * block(r, c);
  }

 private:
  double* gradient_ = nullptr;
  double* hessian_ = nullptr;
  const BlockSlot* slots_ = nullptr;
  Projection projection_ = Projection::None;
  int threads_ = 1;
  double factor_ = 1;
};

}  // namespace coapt
