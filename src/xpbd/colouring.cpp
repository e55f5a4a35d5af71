#include "xpbd/colouring.hpp"

#include <algorithm>
#include <cstdint>

namespace coapt {
namespace {

constexpr int kPerPage = 64;

// The colours that each node has, in pages of 64, so that a node of many constraints costs no more than it
// needs.
class UsedColours {
 public:
  explicit UsedColours(int node_count) : nodes_(static_cast<size_t>(node_count)) {}

  int first_free(const int* nodes, int width) const {
    for (size_t page = 0;; ++page) {
      std::uint64_t used = 0;
      for (int k = 0; k < width; ++k) {
        const std::vector<std::uint64_t>& pages = nodes_[static_cast<size_t>(nodes[k])];
        if (page < pages.size()) used |= pages[page];
      }
      if (used == ~std::uint64_t{0}) continue;
      int bit = 0;
      while ((used >> bit & 1U) != 0) ++bit;
      return static_cast<int>(page) * kPerPage + bit;
    }
  }

  void take(int colour, const int* nodes, int width) {
    const auto page = static_cast<size_t>(colour / kPerPage);
    for (int k = 0; k < width; ++k) {
      std::vector<std::uint64_t>& pages = nodes_[static_cast<size_t>(nodes[k])];
      if (pages.size() <= page) pages.resize(page + 1, 0);
      pages[page] |= std::uint64_t{1} << (colour % kPerPage);
    }
  }

 private:
  std::vector<std::vector<std::uint64_t>> nodes_;
};

}  // namespace

ColourClasses colour_classes(const std::vector<int>& nodes, int width, int node_count) {
  const int count = width == 0 ? 0 : static_cast<int>(nodes.size()) / width;
  std::vector<int> colour(static_cast<size_t>(count));
  UsedColours used(node_count);
  int colours = 0;
  for (int e = 0; e < count; ++e) {
    const int* own = nodes.data() + static_cast<size_t>(e) * static_cast<size_t>(width);
    const int free = used.first_free(own, width);
    used.take(free, own, width);
    colour[static_cast<size_t>(e)] = free;
    colours = std::max(colours, free + 1);
  }
  ColourClasses classes;
  classes.first.assign(static_cast<size_t>(colours) + 1, 0);
  for (const int c : colour) ++classes.first[static_cast<size_t>(c) + 1];
  for (size_t c = 1; c < classes.first.size(); ++c) classes.first[c] += classes.first[c - 1];
  classes.order.resize(static_cast<size_t>(count));
  std::vector<int> next = classes.first;
  for (int e = 0; e < count; ++e)
    classes.order[static_cast<size_t>(next[static_cast<size_t>(colour[static_cast<size_t>(e)])]++)] = e;
  return classes;
}

}  // namespace coapt
