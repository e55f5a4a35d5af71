#include "mesh/rim_fan.hpp"

#include <set>
#include <utility>

namespace coapt {

Triangles close_rim(const Points& x, const std::vector<int>& loop) {
  const int m = static_cast<int>(loop.size());
  std::vector<int> before(m), after(m);
  for (int k = 0; k < m; ++k) {
    before[k] = (k + m - 1) % m;
    after[k] = (k + 1) % m;
  }
  const auto diagonal = [&](int k) { return (x.col(loop[before[k]]) - x.col(loop[after[k]])).squaredNorm(); };
  std::set<std::pair<double, int>> ears;  // by the length of the diagonal that would cut them off
  for (int k = 0; k < m; ++k) ears.emplace(diagonal(k), k);

  Triangles fan(3, m - 2);
  for (int t = 0; t < m - 2; ++t) {
    const int k = ears.begin()->second;
    ears.erase(ears.begin());
    const int left = before[k], right = after[k];
    fan.col(t) << loop[right], loop[k], loop[left];
    ears.erase({diagonal(left), left});
    ears.erase({diagonal(right), right});
    after[left] = right;
    before[right] = left;
    ears.emplace(diagonal(left), left);
    ears.emplace(diagonal(right), right);
  }
  return fan;
}

}  // namespace coapt
