#include "energy/connected_parts.hpp"

#include "core/small_eigen.hpp"

#include <Eigen/Dense>

#include <numeric>

namespace coapt {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Union of the nodes that an element couples: each node points to another of its part, roots to themselves.
class Groups {
 public:
  explicit Groups(int node_count) : parent_(static_cast<size_t>(node_count)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int root(int node) {
    while (parent_[static_cast<size_t>(node)] != node) {
      int& parent = parent_[static_cast<size_t>(node)];
      parent = parent_[static_cast<size_t>(parent)];
      node = parent;
    }
    return node;
  }

  void join(int a, int b) { parent_[static_cast<size_t>(root(a))] = root(b); }

 private:
  std::vector<int> parent_;
};

// Of a Gram matrix: squares of sines, so that directions some 1e-5 apart still count as two.
int rank(const Matrix6& gram) {
  const SmallVector values = small_eigenvalues(gram);
  return static_cast<int>((values.array() > 1e-10 * values[5]).count());
}

void find_motions(Part& part, const Points& x, const FixedMask& fixed) {
  Vec3 centre = Vec3::Zero();
  for (const int node : part.nodes) centre += x.col(node) / static_cast<double>(part.nodes.size());
  double size = 0;
  for (const int node : part.nodes) size = std::max(size, (x.col(node) - centre).norm());
  part.can_shift.fill(true);
  Matrix6 all = Matrix6::Zero(), held = Matrix6::Zero();
  for (const int node : part.nodes) {
    const Vec3 arm = size > 0 ? Vec3((x.col(node) - centre) / size) : Vec3::Zero();
    for (int c = 0; c < 3; ++c) {
      // What the three shifts and the three turns do to this coordinate.
      Eigen::Vector<double, 6> motion = Eigen::Vector<double, 6>::Zero();
      motion[c] = 1;
      motion[3 + (c + 1) % 3] = arm[(c + 2) % 3];
      motion[3 + (c + 2) % 3] = -arm[(c + 1) % 3];
      all += motion * motion.transpose();
      if (!fixed(c, node)) continue;
      held += motion * motion.transpose();
      part.can_shift[static_cast<size_t>(c)] = false;
    }
  }
  part.free_motions = rank(all) - rank(held);
}

}  // namespace

std::string Part::description() const {
  const bool is_held = !(can_shift[0] && can_shift[1] && can_shift[2]);
  return "the part with node " + std::to_string(nodes.front()) + " (" + std::to_string(nodes.size()) +
         (nodes.size() == 1 ? " node) is held " : " nodes) is held ") +
         (is_held ? "incompletely" : "by nothing") + ": it can move in " + std::to_string(free_motions) +
         (free_motions == 1 ? " way" : " ways");
}

std::vector<Part> connected_parts(const std::vector<std::unique_ptr<EnergyTerm>>& terms, const Points& x,
                                  const FixedMask& fixed) {
  const int node_count = static_cast<int>(x.cols());
  Groups groups(node_count);
  for (const auto& term : terms) {
    if (term->role() != TermRole::Internal) continue;
    const Stencils& stencils = term->stencils();
    for (size_t k = 0; k < stencils.nodes.size(); ++k)
      groups.join(stencils.nodes[k], stencils.nodes[k - k % static_cast<size_t>(stencils.width)]);
  }
  std::vector<Part> parts;
  std::vector<int> part_of(static_cast<size_t>(node_count), -1);  // of each root
  for (int node = 0; node < node_count; ++node) {
    int& part = part_of[static_cast<size_t>(groups.root(node))];
    if (part < 0) {
      part = static_cast<int>(parts.size());
      parts.emplace_back();
    }
    parts[static_cast<size_t>(part)].nodes.push_back(node);
  }
  for (Part& part : parts) find_motions(part, x, fixed);
  return parts;
}

Points nodal_forces(const EnergyTerm& term, const Points& x) {
  Points gradient = Points::Zero(3, x.cols()), force = gradient;
  Sink sink(gradient.data());
  term.evaluate(x, sink);
  if (term.has_circulatory_force()) term.add_circulatory_force(x, force);
  return force - gradient;
}

}  // namespace coapt
