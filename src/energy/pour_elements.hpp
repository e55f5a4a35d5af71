// Energy, gradient and Hessian of many elements, shared by the threads of a sink.
#pragma once

#include "energy/sink.hpp"
#include "energy/term.hpp"

#include <algorithm>
#include <memory>
#include <vector>

namespace coapt {

// Whether the parts of a sink have few elements in common, which all of them evaluate: so it is where nodes
// are numbered as they lie. Looks at some of the elements.
inline bool parts_are_apart(const Stencils& stencils, const std::vector<Sink>& parts) {
  constexpr size_t kLooks = 256;       // elements that are looked at
  constexpr double kMostShared = 0.3;  // of them that touch a second part
  const size_t count = static_cast<size_t>(stencils.count()), step = std::max<size_t>(1, count / kLooks);
  size_t seen = 0, touched = 0;
  for (size_t e = 0; e < count; e += step, ++seen)
    for (const Sink& part : parts) {
      const int* nodes = &stencils.nodes[e * static_cast<size_t>(stencils.width)];
      touched += std::any_of(nodes, nodes + stencils.width, [&](int node) { return part.has_node(node); });
    }
  return static_cast<double>(touched) <= (1 + kMostShared) * static_cast<double>(seen);
}

// All elements, some at a time: evaluated by shares first, then poured into each part in their order. For
// elements that lie across the parts, as pairs in contact do.
template <class Evaluated, class Evaluate, class Scatter>
void pour_across(std::vector<Sink>& parts, ThreadTeam& team, const Evaluate& evaluate, const Scatter& scatter,
                 std::vector<double>& energies) {
  constexpr size_t kAtOnce = 2048;  // elements; pairs in contact take 2.5 MB then
  constexpr size_t kShare = 128;    // elements that a thread evaluates at once
  const size_t count = energies.size();
  const auto out = std::make_unique_for_overwrite<Evaluated[]>(std::min(kAtOnce, count));
  for (size_t first = 0; first < count; first += kAtOnce) {
    const size_t some = std::min(kAtOnce, count - first);
    team.run_ranges(some, kShare, [&](size_t from, size_t to) {
      for (size_t k = from; k < to; ++k) energies[first + k] = evaluate(first + k, out[k]);
    });
    team.run(static_cast<int>(parts.size()), [&](int p, int) {
      for (size_t k = 0; k < some; ++k) scatter(first + k, out[k], parts[static_cast<size_t>(p)]);
    });
  }
}

// evaluate(e, out): everything of element e, returns its energy; scatter(e, out, sink): its gradient and
// Hessian. Each thread pours one part of the sink, so that every sum runs in the order of the elements: the
// same bits whatever their number.
template <class Evaluated, class Evaluate, class Scatter>
double pour_elements(const Stencils& stencils, Sink& sink, const Evaluate& evaluate, const Scatter& scatter) {
  constexpr size_t kWorthThreads = 4000;  // elements; with fewer, two took up to 1.2 of the time of one
  const auto count = static_cast<size_t>(stencils.count());
  double energy = 0;
  std::vector<Sink> parts;
  for (int k = 0; sink.is_shared() && count >= kWorthThreads && k < sink.team().size(); ++k)
    parts.push_back(sink.part(k));
  if (parts.empty()) {
    Evaluated out;
    for (size_t e = 0; e < count; ++e) {
      energy += evaluate(e, out);
      scatter(e, out, sink);
    }
    return energy;
  }
  std::vector<double> energies(count);
  if (!parts_are_apart(stencils, parts)) {
    pour_across<Evaluated>(parts, sink.team(), evaluate, scatter, energies);
  } else {
    sink.team().run(static_cast<int>(parts.size()), [&](int k, int) {
      Sink& part = parts[static_cast<size_t>(k)];
      Evaluated out;
      for (size_t e = 0; e < count; ++e) {
        const int* nodes = &stencils.nodes[e * static_cast<size_t>(stencils.width)];
        if (std::none_of(nodes, nodes + stencils.width, [&](int node) { return part.has_node(node); }))
          continue;
        const double own = evaluate(e, out);
        if (part.has_node(nodes[0])) energies[e] = own;
        scatter(e, out, part);
      }
    });
  }
  for (const double own : energies) energy += own;
  return energy;
}

}  // namespace coapt
