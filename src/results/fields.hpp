// What a solved state looks like, point by point: displacement, strain, stress, gap, contact, distance to
// a reference, force in each line.
#pragma once

#include "scene/build/model.hpp"

#include <optional>

namespace coapt {

constexpr double kKilopascals = 1000;  // in one MPa

struct Fields {
  Points x;                             // positions, 3 x node_count, relative to the model's origin [mm]
  Points displacement;                  // x - X, 3 x node_count [mm]
  Eigen::Matrix2Xd principal_strain;    // engineering strain (stretch - 1), largest first, per triangle
  Eigen::Matrix2Xd principal_stress;    // second Piola-Kirchhoff [MPa], largest first, per triangle; no
                                        // columns for a model without membrane stress, or with springs
  std::vector<MembraneRegime> regime;   // per triangle; empty where there is no stress
  Eigen::Matrix2Xd cauchy_stress;       // principal values in the deformed plane [MPa], largest first, per
                                        // triangle; no columns either where no membrane has a thickness
  Vector von_mises_stress;              // of these two, with none across the membrane [MPa]; empty like them
  Eigen::Matrix2Xd first_piola_stress;  // principal values [MPa], largest first, per triangle; no columns
                                        // where the model does not want it
  Vector gap;  // per mesh vertex, see mesh/distance/vertex_gaps.hpp [mm]; empty where nobody
               // asks for contact, see looks_for_contact
  std::vector<char> is_contact;        // per mesh vertex: gap <= contact_distance; empty like gap
  std::vector<char> is_contact_facet;  // per triangle: all its corners are in contact; empty like gap
  double contact_distance = 0;         // [mm]
  double gap_reach = 0;                // how far gaps were looked for [mm]
  Vector reference_distance;           // per mesh vertex [mm]; empty without a reference
  std::optional<TriangleMesh> registered_reference;  // moved, relative to the origin; none where it was not
  Vector registered_distance;                        // per vertex of that one, to the result [mm]
  Vector method_distance;          // per mesh vertex to the shape that the reference method of a comparison
                                   // found [mm]; empty outside of one
  Vector branch_spread;            // per node, Branches::spread_mm [mm]; empty where nothing was looked for
  std::vector<char> undetermined;  // per node, see undetermined_flags; empty before that is known
  Vector yield_ratio;       // elongation of the fibres over that at which they yield, per triangle; NaN
                            // where nothing yields, empty where nothing does at all
  Vector line_yield_ratio;  // the same of each line
  Vector line_force;        // tension of each line of the model [N]; negative for compression
  Vector line_strain;       // of each line, see line_strain(); NaN where there is none
  Vector line_stress;       // Cauchy, of each line, see line_stress() [MPa]; NaN where there is none
};

// Strains are those of the constant-strain triangle from X to x; stresses are those of the membrane term that
// covers the triangle, the prestress included (energy/kernels/cst_state.hpp), zero where none does. The
// regime of a membrane that resists compression is that in which a tension field would be. reach: in
// mean edges, how far gaps are looked for, at least over twice the contact distance.
Fields compute_fields(const Model& model, const Points& x, double reach = 3);

// Length of a line at positions x over its rest length, less 1; empty for a constant-force cable, which has
// no rest length.
std::optional<double> line_strain(const Line& line, const Points& x);

// Cauchy stress of a line of that tension at positions x: tension over the deformed cross-section, that of a
// line of constant volume, A r/l. [MPa] Empty where the cross-section A or the rest length r is not known.
std::optional<double> line_stress(const Line& line, double tension, const Points& x);

// Of principal stresses in a plane, with none across it: sqrt(s1^2 - s1 s2 + s2^2).
double von_mises(const Eigen::Vector2d& principal);

// Whether contact means anything to the model: it has an annulus or a contact term. Others pay nothing for
// it.
bool looks_for_contact(const Model& model);

// The annulus of the model, an ordered loop of at least three vertices; null without one.
const std::vector<int>* annulus_of(const Model& model);

// The distance below which a vertex counts as in contact: the range of the contact term, or, in a model
// without one, half the mean edge length of the reference mesh [mm].
double contact_distance(const Model& model);

}  // namespace coapt
