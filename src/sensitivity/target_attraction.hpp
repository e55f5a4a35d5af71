// A term that draws a surface to a target: what brings a fit near the answer before it searches there.
#pragma once

#include "energy/term.hpp"
#include "mesh/triangle_mesh.hpp"

#include <memory>

namespace coapt {

// Springs from the vertices of a surface to the closest points of a target, which slide along it freely:
//   U = sum_v k A_v d_v^2 / 2,   A_v: area of the vertex at the start, d_v: its distance from the target.
// The energy has continuous first derivatives but where two points of the target are equally close.
class TargetAttraction final : public EnergyTerm {
 public:
  // x_start: 3 x node_count. The target may face either way; that which fits at x_start is taken.
  // Pre: surface and target have an area, the target's vertices are finite.
  TargetAttraction(std::string name, const Triangles& triangles, const Points& x_start, TriangleMesh target);
  ~TargetAttraction() override;

  std::string_view type() const override { return "target_attraction"; }
  TermRole role() const override { return TermRole::Internal; }
  const Stencils& stencils() const override { return stencils_; }
  double evaluate(const Points& x, Sink& sink) const override;

  // k, not negative [force/length^3]; 0 from the start.
  void set_stiffness(double stiffness) { stiffness_ = stiffness; }

  // Where two sheets of the target lie against each other a vertex is drawn to that which faces as the
  // surface does at x around it; as at x_start from the start.
  void face(const Points& x);

 private:
  struct Target;

  Triangles triangles_;
  Stencils stencils_;  // one node each
  Vector areas_;
  double stiffness_ = 0;
  std::unique_ptr<const Target> target_;
  Points directions_;  // of the elements
};

}  // namespace coapt
