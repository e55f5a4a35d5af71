// Where a term pours its derivatives: a gradient, and Hessian blocks at places computed beforehand.
#pragma once

#include "core/thread_team.hpp"
#include "core/types.hpp"

#include <vector>

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

// What one of several threads pours: into these nodes of the gradient, and these values of the Hessian, which
// are the columns of the same nodes.
struct SinkPart {
  unsigned first_node = 0, nodes = 0xFFFFFFFF;
  unsigned first_value = 0, values = 0xFFFFFFFF;
};

class Sink {
 public:
  // Energy alone.
  Sink() = default;

  // Energy and gradient, 3 x node_count values in column order, added to.
  explicit Sink(double* gradient) : gradient_(gradient) {}

  // Energy, gradient and Hessian. slots: width * width for each element of the term.
  Sink(double* gradient, double* hessian, const BlockSlot* slots, Projection projection)
      : gradient_(gradient), hessian_(hessian), slots_(slots), projection_(projection) {}

  // Threads that may each pour one part, all elements that touch it in their order: the sums are those of one
  // thread. parts: as many as there are threads; they must outlive the sink.
  void share(ThreadTeam* team, const std::vector<SinkPart>* parts) {
    team_ = team;
    parts_ = parts;
  }
  bool is_shared() const { return team_ != nullptr && team_->size() > 1; }
  ThreadTeam& team() const { return *team_; }
  Sink part(int k) const {
    Sink sink = *this;
    sink.part_ = (*parts_)[static_cast<size_t>(k)];
    return sink;
  }
  bool has_node(int node) const { return static_cast<unsigned>(node) - part_.first_node < part_.nodes; }

  bool wants_gradient() const { return gradient_ != nullptr; }
  bool wants_hessian() const { return hessian_ != nullptr; }
  Projection projection() const { return projection_; }

  // Everything that is poured in from now on is multiplied by this factor (continuation in load or
  // stiffness).
  void set_factor(double factor) { factor_ = factor; }

  void add_gradient(int node, const Vec3& g) {
    if (!has_node(node)) return;
    double* to = gradient_ + 3 * static_cast<long>(node);
    to[0] += factor_ * g[0];
    to[1] += factor_ * g[1];
    to[2] += factor_ * g[2];
  }

  // Adds the block of one element's local nodes (a, b); element_offset = element * width * width.
  template <typename Block>
  void add_block(long element_offset, int width, int a, int b, const Block& block) {
    const BlockSlot slot = slots_[element_offset + a * width + b];
    if (static_cast<unsigned>(slot.base) - part_.first_value >= part_.values)
      return;  // or above the diagonal
    double* to = hessian_ + slot.base;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) to[c * slot.stride + r] += factor_ * block(r, c);
  }

 private:
  double* gradient_ = nullptr;
  double* hessian_ = nullptr;
  const BlockSlot* slots_ = nullptr;
  Projection projection_ = Projection::None;
  ThreadTeam* team_ = nullptr;
  const std::vector<SinkPart>* parts_ = nullptr;
  SinkPart part_;
  double factor_ = 1;
};

}  // namespace coapt
