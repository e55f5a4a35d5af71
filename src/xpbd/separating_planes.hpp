// Moves of nodes that let nothing pass through anything, decided node by node: what is held off in one place
// holds up nothing elsewhere.
//
// Between two features that may meet lies a plane across their closest points, with the room between them
// shared by how much of it each wants. Whoever stays on its side of all its planes meets nothing on the
// straight way there, and no node has to know what another does. A node that wants to cross slides along the
// plane, then what is left is shortened.
// Source: the idea of bounds by node in place of one step for all is that of Chen et al. 2025 (Offset
// geometric contact, ACM Trans. Graph. 44); the planes are those of collision_detection.hpp.
#pragma once

#include "energy/contact/contact_surface.hpp"
#include "xpbd/body.hpp"
#include "xpbd/projection.hpp"

#include <vector>

namespace coapt {

class SeparatingPlanes {
 public:
  // thickness: of contact, as in XpbdContact [length].
  SeparatingPlanes(const XpbdBody& body, double thickness);

  // Makes moves d from x (3 x node_count) admissible: at x + s d, 0 <= s <= 1, every pair of features that
  // may not meet keeps a quarter of its distance at x, and never comes nearer than a tenth of the thickness
  // (of half its distance at rest, where that is less) unless it is already. No move gets longer, and none is
  // longer than longest_move(). A prescribed coordinate (w = 0) is shortened and does not slide. Returns how
  // many moves had to be changed. Pre: nothing meets at x.
  int admit(const Points& x, const InverseMasses& w, Points& d);

  double longest_move() const { return longest_; }
  long search_count() const { return searches_; }

 private:
  struct Pair {
    PairKind kind;
    std::array<int, 4> nodes;
    double least;  // distance below which it may not fall [length]
  };
  struct Plane {
    int node;
    Vec3 normal;  // unit, to the node's side
    double room;  // that the node has towards the plane, >= 0 [length]
  };

  void search(const Points& x);
  void place_planes(const Points& x, const Points& d);
  void sort_planes(Eigen::Index node_count);

  ContactSurface surface_;
  double thickness_;
  double longest_;  // move [length]
  std::vector<Pair> pairs_;
  Points searched_at_;
  long searches_ = 0;
  std::vector<Plane> planes_, sorted_;
  std::vector<size_t> first_;  // of each node in sorted_
};

}  // namespace coapt
