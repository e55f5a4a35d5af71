// Energy, gradient and Hessian of many elements, shared by the threads of a sink.
#pragma once

#include "energy/sink.hpp"

#include <algorithm>
#include <vector>

namespace coapt {

// evaluate(e, out): everything of element e; scatter(e, out, sink): its gradient, returns its energy;
// scatter_blocks(e, out, sink): its Hessian. Threads evaluate a batch of elements, and then each scatters all
// of it into its own part of the Hessian: every sum runs in the order of the elements, the same bits whatever
// their number.
template <class Evaluated, class Evaluate, class Scatter, class ScatterBlocks>
double pour_elements(size_t count, Sink& sink, const Evaluate& evaluate, const Scatter& scatter,
                     const ScatterBlocks& scatter_blocks) {
  constexpr size_t kBatch = 4096;  // elements: worth waking a thread for, and few enough for the cache
  constexpr size_t kWorthThreads = 512, kShare = 128;
  double energy = 0;
  if (!sink.is_shared() || count < kWorthThreads) {
    Evaluated element;
    for (size_t e = 0; e < count; ++e) {
      evaluate(e, element);
      energy += scatter(e, element, sink);
      scatter_blocks(e, element, sink);
    }
    return energy;
  }
  const int threads = sink.team().size();
  std::vector<Evaluated> batch(std::min(kBatch, count));
  for (size_t first = 0; first < count; first += kBatch) {
    const size_t size = std::min(kBatch, count - first);
    sink.team().run_ranges(size, kShare, [&](size_t from, size_t to) {
      for (size_t k = from; k < to; ++k) evaluate(first + k, batch[k]);
    });
    sink.team().run(threads, [&](int part, int) {
      Sink own = sink.part(part, threads);
      for (size_t k = 0; k < size; ++k) scatter_blocks(first + k, batch[k], own);
      for (size_t k = 0; part == 0 && k < size; ++k) energy += scatter(first + k, batch[k], own);
    });
  }
  return energy;
}

}  // namespace coapt
