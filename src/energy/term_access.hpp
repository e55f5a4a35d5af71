// What may be known and changed of a term beside its energy, whatever its law: for parameters with
// derivatives, fields and solvers that want more than forces. Every answer has a default, "there is no such
// thing"; an ElementTerm gives those that its kernel knows of (energy/element_term.hpp), a load or contact
// its own.
#pragma once

#include "energy/kernels/axial.hpp"
#include "energy/kernels/cst.hpp"
#include "energy/term.hpp"
#include "energy/term_kind.hpp"

#include <functional>
#include <optional>

namespace coapt {

class LoadDead;

class TermAccess {
 public:
  virtual ~TermAccess() = default;
  virtual TermKind kind() const = 0;

  // --- Elements, in the order of EnergyTerm::stencils() -------------------------------------------------
  // Whether there are any of an internal energy, so that the next three may be called.
  virtual bool has_elastic_elements() const { return false; }

  // Energy of one of them at positions x of its nodes, node after node; gradient and Hessian (column after
  // column) where they are not null.
  virtual double evaluate_element(int /*element*/, const double* /*x*/, double* /*g*/, double* /*H*/) const {
    return 0;
  }

  // The same of one of them, energy and gradient, for good: whatever becomes of the term.
  virtual std::function<double(const double* x, double* g)> element_energy(int /*element*/) const {
    return {};
  }

  // Takes the data of the elements of another term. Returns false where that is of another law. Pre: both
  // have the same elements.
  virtual bool take_elements(const EnergyTerm& /*from*/) { return false; }

  // --- Elements that are stiff --------------------------------------------------------------------------
  // Whether all moduli of an element can be multiplied, and its energy with them.
  virtual bool has_stiffness() const { return false; }

  // is_size: by a thickness or a diameter, which leaves stresses as they are.
  virtual void multiply_stiffness(int /*element*/, double /*factor*/, bool /*is_size*/) {}

  // Whether the element has energy that no modulus multiplies.
  virtual bool has_prestress(int /*element*/) const { return false; }

  // --- Lines: the energy of an element is one of the distance of its two nodes ---------------------------
  virtual bool has_lines() const { return false; }
  virtual LineTraits line(int /*element*/) const { return {}; }
  virtual std::function<AxialLaw(double distance)> line_law(int /*element*/) const { return {}; }

  // Whether they have rest lengths that may change, so that the next two may be called.
  virtual bool has_rest_lengths() const { return false; }

  // All else stays: sections, moduli, and the rounding of the onset as a share of the length. Pre: length >
  // 0.
  virtual void set_rest_length(int /*element*/, double /*length*/) {}

  // law: of the element at the distance l.
  virtual RestSlope slope_by_rest(int /*element*/, const AxialLaw& /*law*/, double /*l*/) const { return {}; }

  // --- Elements with a shape at rest, triangles and hinges ------------------------------------------------
  virtual bool has_rest_shape() const { return false; }

  // Of a triangle, the inverse of its edges at rest (cst_shape()); null for anything else.
  virtual const Eigen::Matrix2d* rest_frame(int /*element*/) const { return nullptr; }

  // Moves the nodes at rest; material and thickness stay.
  virtual void reshape(int /*element*/, const Corners& /*from*/, const Corners& /*to*/) {}

  // --- What a kind has of its own -----------------------------------------------------------------------
  // Of a membrane that does not resist compression; nothing for any other.
  virtual std::optional<MembraneRegime> regime(int /*element*/, const double* /*x*/) const { return {}; }
  virtual double film_tension(int /*element*/) const { return 0; }     // [force/length]
  virtual double hinge_stiffness(int /*element*/) const { return 0; }  // [force x length]

  // Along the normals, of a pressure that follows the surface [force/length^2]; nothing for any other.
  virtual std::optional<double> pressure() const { return {}; }
  virtual void set_pressure(double /*p*/) {}
  virtual LoadDead* dead_load() { return nullptr; }
};

// Null for a term that gives no access, such as one of a program.
const TermAccess* access_of(const EnergyTerm& term);
TermAccess* access_of(EnergyTerm& term);

// Other where there is no access.
TermKind kind_of(const EnergyTerm& term);

}  // namespace coapt
