#include "mesh/seam_graph.hpp"

#include <algorithm>
#include <unordered_map>

namespace coapt {
namespace {

class Linker {
 public:
  explicit Linker(const std::vector<SeamStep>& steps) : steps_(steps), used_(steps.size(), 0) {
    for (size_t s = 0; s < steps.size(); ++s) {
      at_[steps[s].from].push_back(s);
      at_[steps[s].to].push_back(s);
    }
  }

  size_t degree(int corner) const { return at_.at(corner).size(); }

  // Open chains first, from their ends; then what is left: closed ones.
  std::vector<SeamChain> chains() {
    std::vector<SeamChain> found;
    for (const bool from_ends : {true, false})
      for (size_t s = 0; s < steps_.size(); ++s)
        for (const int corner : {steps_[s].from, steps_[s].to})
          if (!used_[s] && (!from_ends || degree(corner) != 2)) found.push_back(follow(corner, s));
    return found;
  }

 private:
  SeamChain follow(int corner, size_t step) {
    SeamChain chain;
    chain.corners = {corner};
    while (true) {
      used_[step] = 1;
      const SeamStep& taken = steps_[step];
      corner = taken.from == corner ? taken.to : taken.from;
      chain.corners.push_back(corner);
      chain.triangles.push_back(taken.triangles);
      const std::vector<size_t>& around = at_.at(corner);
      if (around.size() != 2) return chain;
      step = used_[around[0]] ? around[1] : around[0];
      if (used_[step]) return chain;
    }
  }

  const std::vector<SeamStep>& steps_;
  std::vector<char> used_;
  std::unordered_map<int, std::vector<size_t>> at_;
};

bool is_short(const SeamChain& chain, int shortest) {
  return static_cast<int>(chain.triangles.size()) < shortest;
}

void append_steps(const SeamChain& chain, std::vector<SeamStep>& steps) {
  for (size_t k = 0; k < chain.triangles.size(); ++k)
    steps.push_back({chain.corners[k], chain.corners[k + 1], chain.triangles[k]});
}

}  // namespace

std::vector<SeamChain> linked_chains(std::vector<SeamStep> steps, int shortest) {
  std::vector<SeamChain> chains;
  for (bool has_changed = true; has_changed;) {
    Linker linker(steps);
    chains = linker.chains();
    std::vector<SeamStep> kept;
    has_changed = false;
    for (const SeamChain& chain : chains) {
      const size_t first = linker.degree(chain.corners.front()), last = linker.degree(chain.corners.back());
      const bool is_spur = std::min(first, last) == 1 && std::max(first, last) > 2;
      if (is_spur && is_short(chain, shortest))
        has_changed = true;
      else
        append_steps(chain, kept);
    }
    if (has_changed) steps = std::move(kept);
  }
  const Linker linker(steps);
  std::erase_if(chains, [&](const SeamChain& chain) {
    return is_short(chain, shortest) && linker.degree(chain.corners.front()) <= 2 &&
           linker.degree(chain.corners.back()) <= 2;
  });
  return chains;
}

}  // namespace coapt
