// Smoothed repulsion of facets that come close (Burlina et al. 2010, eq. 16-17):
//   W = sum over facet pairs of the double integral of e(|r_j - r_k|),  e(d) = C (1 - d/delta)^n, d < delta
// by quadrature on each facet over its rest area; each unordered pair counts once. Facets that share a
// vertex, or are joined by an edge, are excluded by topology.
//
// It is a finite barrier. Two parallel sheets feel the pressure 2 pi C delta s (1-s)^n, s = gap/delta:
// greatest at s = 1/(n+1), zero at contact. Pressed harder, they pass through each other: the
// caller chooses C by the applied pressure (contact_facet_strength), and intersections are counted at the
// end.
#pragma once

#include "energy/term.hpp"

#include <memory>
#include <string>
#include <vector>

namespace coapt {

struct ContactFacetOptions {
  double range = 0;     // delta [length]
  int exponent = 3;     // n; the stiffness is continuous at d = delta from n = 3 on, the source names none
  double strength = 0;  // C [force/length^3]
  int quadrature = 3;   // points per (sub)triangle: 1, 3 or 6 (exact to degree 1, 2, 4)
  int subdivision = 1;  // the rule is applied to subdivision^2 congruent parts of each facet
};

// The greatest pressure that two parallel sheets can carry, 2 pi C delta n^n/(n+1)^(n+1) [force/length^2].
double contact_facet_capacity(double strength, double range, int exponent);

// The strength whose capacity is margin times the applied pressure.
double contact_facet_strength(double pressure, double range, int exponent, double margin);

// X: 3 x node_count rest positions; triangles: the facets. Needs nanoflann; a build without it throws
// InputError. Throws InputError when an option is out of range, naming it.
std::unique_ptr<EnergyTerm> make_contact_facet(std::string name, const Points& X, const Triangles& triangles,
                                               const ContactFacetOptions& options);

// Two facets of which some quadrature points are within range of each other.
struct FacetContact {
  int first = 0, second = 0;  // numbers of the facets, ascending
  int point_pairs = 0;        // within range
  bool is_smooth = true;      // the repulsion begins with two continuous derivatives: from exponent 3 on
};

// All of them at x (3 x node_count), in ascending order; none for a term that make_contact_facet() has not
// made. Pre: the term was prepared for positions near x.
std::vector<FacetContact> facet_contacts(const EnergyTerm& term, const Points& x);

}  // namespace coapt
