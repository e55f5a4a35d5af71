// Dead loads: nodal forces that keep size and direction, W = -sum_i f_i . (x_i - X_i).
// load_field (Burlina et al. 2010, eq. 12: sums of constant force fields, gravity among them) and the
// frozen model of load_pressure are dead loads with different forces.
#pragma once

#include "energy/term.hpp"
#include "energy/term_access.hpp"

namespace coapt {

class LoadDead final : public EnergyTerm, public TermAccess {
 public:
  // forces: 3 x node_count [force]; reference: X, 3 x node_count. Nodes with zero force cost nothing.
  // kind: DeadLoad or, of a pressure that is frozen, Pressure.
  LoadDead(std::string name, std::string type, const Points& forces, const Points& reference,
           TermKind kind = TermKind::DeadLoad);

  std::string_view type() const override { return type_; }
  TermRole role() const override { return TermRole::Load; }
  TermKind kind() const override { return kind_; }
  LoadDead* dead_load() override { return this; }
  const Stencils& stencils() const override { return stencils_; }
  double evaluate(const Points& x, Sink& sink) const override;
  std::unique_ptr<EnergyTerm> part(MovingPart& moving) const override;

  // Of the loaded nodes, in the order of the stencils [force].
  const Points& forces() const { return forces_; }
  // Others on the same nodes, as after a change of a parameter. Pre: as many as there were.
  void set_forces(Points forces) { forces_ = std::move(forces); }
  // X of the same nodes [length].
  const Points& reference() const { return reference_; }

 private:
  std::string type_;
  Stencils stencils_;
  Points forces_;
  Points reference_;
  TermKind kind_;
};

// Nodal forces of a pressure that stays as it is on X: p/3 of each facet's area vector to its corners.
// p > 0 pushes along the normals. [force], 3 x node_count.
Points frozen_pressure_forces(const Points& X, const Triangles& triangles, double p);

// Nodal forces of a constant traction (force per rest area) in a fixed direction: traction vector
// [force/length^2] times nodal area [length^2].
Points area_forces(const Vector& nodal_areas, const Vec3& traction);

// Nodal forces of given magnitudes that point to the nearest point of the line through a and b (the
// commissure line of Burlina et al. 2010, section 3.2). A node on the line gets none.
Points forces_toward_line(const Points& X, const Vector& magnitudes, const Vec3& a, const Vec3& b);

}  // namespace coapt
