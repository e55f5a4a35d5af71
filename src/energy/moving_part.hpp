// A few nodes of a scene that move while all others stay where they are.
#pragma once

#include "core/types.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace coapt {

// The nodes are numbered among themselves: first those that move, then the others that their elements couple
// them with, as these are asked for.
class MovingPart {
 public:
  // x: 3 x node_count, where they set out; it must outlive the part. nodes: those that move, each once.
  // reach: how far they may go at most [length].
  MovingPart(const Points& x, std::vector<int> nodes, double reach)
      : x_(x),
        reach_(reach),
        nodes_(std::move(nodes)),
        moving_count_(static_cast<int>(nodes_.size())),
        number_(static_cast<size_t>(x.cols()), -1) {
    for (int k = 0; k < moving_count_; ++k) number_[static_cast<size_t>(nodes_[static_cast<size_t>(k)])] = k;
  }

  const Points& x() const { return x_; }
  double reach() const { return reach_; }
  int moving_count() const { return moving_count_; }
  const std::vector<int>& nodes() const { return nodes_; }  // of the scene, by their numbers in the part

  bool moves(int node) const {
    const int number = number_[static_cast<size_t>(node)];
    return number >= 0 && number < moving_count_;
  }
  template <class Nodes>
  bool moves_any(const Nodes& nodes) const {
    return std::any_of(std::begin(nodes), std::end(nodes), [this](int node) { return moves(node); });
  }

  // Number of a node of the scene in the part, into which it comes with that.
  int number(int node) {
    int& number = number_[static_cast<size_t>(node)];
    if (number < 0) {
      number = static_cast<int>(nodes_.size());
      nodes_.push_back(node);
    }
    return number;
  }

 private:
  const Points& x_;
  double reach_;
  std::vector<int> nodes_;
  int moving_count_;
  std::vector<int> number_;  // by node of the scene, -1: not in the part
};

}  // namespace coapt
