// What an equilibrium depends on: one number or several that belong together.
#pragma once

#include "sensitivity/parameters/written_datum.hpp"

#include <string>

namespace coapt {

// x is always 3 x node_count positions, g the nodal gradient of the energy, loads without a potential
// included: minus the out-of-balance force. A parameter changes g through the data of terms or through the
// places of prescribed nodes; derivatives are exact and taken at fixed positions of the free nodes.
//
// A parameter belongs to the terms it was made for and changes them in place. It must not outlive them, and
// nothing else may change the same data meanwhile.
class Parameter {
 public:
  explicit Parameter(std::string name) : name_(std::move(name)) {}
  virtual ~Parameter() = default;
  Parameter(const Parameter&) = delete;
  Parameter& operator=(const Parameter&) = delete;

  const std::string& name() const { return name_; }

  // Its numbers, in internal units (mm, N, MPa); what each means is said where it is made.
  virtual Vector value() const = 0;

  // What is wrong with a value, as a sentence that names the parameter; empty: nothing. Pre: as many numbers
  // as value().
  virtual std::string defect(const Vector& value) const = 0;

  // Changes the terms. Pre: defect(value) is empty.
  virtual void set(const Vector& value) = 0;

  // All that set() writes: no other parameter of the same equilibrium may write it too (clash_of()).
  virtual std::vector<WrittenDatum> written() const = 0;

  // --- through the data of terms ---------------------------------------------------------------------
  // S^T weights and S change, where S = dg/d(value) with 3 node_count rows.
  virtual Vector pull_back(const Points& /*x*/, const Points& /*weights*/) const { return none(); }
  virtual void push_forward(const Points& /*x*/, const Vector& /*change*/, Points& /*g*/) const {}

  // Derivatives of the energy of a term [force x length per unit], and of the axial force of one of its
  // elements [force per unit].
  virtual Vector energy_derivative(const Points& /*x*/, const EnergyTerm& /*term*/) const { return none(); }
  virtual Vector tension_derivative(const Points& /*x*/, const EnergyTerm& /*term*/, int /*element*/) const {
    return none();
  }

  // --- through prescribed nodes ----------------------------------------------------------------------
  // Whether it moves any; writes their places for the present value; P^T weights and P change added to
  // `motion`, where P = dx/d(value).
  virtual bool moves_nodes() const { return false; }
  virtual void place(Points& /*x*/) const {}
  virtual Vector pull_back_motion(const Points& /*weights*/) const { return none(); }
  virtual void push_forward_motion(const Vector& /*change*/, Points& /*motion*/) const {}

 protected:
  Vector none() const { return Vector::Zero(value().size()); }

 private:
  std::string name_;
};

}  // namespace coapt
