// Tells a run that cannot end, because there is no equilibrium, from one that takes long.
#pragma once

#include "energy/connected_parts.hpp"

#include <string>
#include <vector>

namespace coapt {

class EquilibriumWatch {
 public:
  // q: where the run starts. Cost: about that of a gradient.
  EquilibriumWatch(const Objective& objective, const Vector& q);

  // Why there can be no equilibrium, whatever the shape: a part that nothing holds along an axis, and on
  // which dead loads have a resultant along it that no other load and no contact can meet; a film that no
  // load and no support holds open. Empty: nothing of that kind.
  const std::string& obstacle() const { return obstacle_; }

  // Call it at each accepted iterate, with the relative residual there. Returns true once a part that nothing
  // holds has gone a hundred times the extent of the start, or a fiftieth of a film of constant tension
  // has shrunk to next to no area and stayed so far from equilibrium: it pinches off. That takes some 200
  // iterates, as nodes may slide together for a while, but some ten where they move along lines across the
  // film. Looks every 50 or 5 iterates, and only where the scene has such parts or films.
  bool has_no_equilibrium(const Objective& objective, const Vector& q, double residual);

  bool sees_films() const { return !film_.empty(); }
  // The iterate with the least residual so far; empty where there are no films.
  const Vector& nearest() const { return nearest_; }

  // What has_no_equilibrium() saw; before it did, that the shape grows without bound and which part is not
  // held.
  std::string reason() const { return reason_; }

 private:
  struct Adrift {
    std::vector<int> nodes;
    Vec3 start;  // centre
    std::string name;
  };
  struct Facet {
    int a, b, c;
    double area;  // at the start
  };

  void find_obstacle(const Objective& objective, const Points& x, const std::vector<Part>& parts);
  bool has_drifted(const Points& x);
  bool has_collapsed(const Points& x);

  std::string obstacle_, reason_;
  std::vector<Adrift> adrift_;
  std::vector<Facet> film_;
  bool slides_ = true;  // nodes may slide within the film
  Vector nearest_;
  double least_residual_ = kInfinity;
  double extent_ = 0;  // at the start
  int iterates_ = 0, collapsed_ = 0;
};

}  // namespace coapt
