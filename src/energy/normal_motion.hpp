// A film of constant tension moves along its normals alone: what slides in it is a matter of the mesh.
//
// The area of a film does not change when its nodes slide within it. That of a mesh of it does, by the error
// of discretisation, and is often least where triangles have no area at all: on most meshes the full gradient
// of a mesh's area vanishes nowhere near the film. What the film asks for is that the force along its normal
// vanishes, and that has one answer near each film (Brakke 1992, The Surface Evolver: "normal motion").
#pragma once

#include "energy/term.hpp"

#include <Eigen/SparseCore>

#include <memory>
#include <vector>

namespace coapt {

class NormalMotion {
 public:
  NormalMotion() = default;

  // block: block of unknowns of each node, -1 for none. fixed: 3 x node_count, true = prescribed.
  // Which nodes move along their normals only: those of terms "surface_tension" that feel nothing else but
  // "load_pressure" and contact, where the film around them is a manifold of one orientation and tension. On
  // the film's rim only nodes that slide within one coordinate plane. None of a film that has a rim that is
  // free otherwise, as along a cable: there the nodes within have to go with it. None where loads have no
  // potential.
  NormalMotion(const std::vector<std::unique_ptr<EnergyTerm>>& terms, const std::vector<int>& block,
               const Eigen::Array<bool, 3, Eigen::Dynamic>& fixed);

  bool is_empty() const { return places_.empty(); }

  // Sets the directions to the normals of the film at x (3 x node_count): at each node that of the sum of
  // its triangles' area vectors, along which the volume that it bounds grows fastest.
  void turn_to(const Points& x);

  // Leaves of the gradient its part along the directions. Returns the greatest part of a node that is left
  // out [force].
  double restrict_gradient(Vector& g) const;

  // Leaves of the Hessian (lower triangle, whole diagonal blocks) its part along the directions, and gives
  // the others the stiffness of that part, so that they have no say in what is definite.
  void restrict_hessian(Eigen::SparseMatrix<double>& h);

  // A start from which the film can get anywhere by its normals: x itself, unless a triangle stands nearly
  // across the normal at one of its nodes, as where only a rim was lifted. Then the nodes lie in the middle
  // of their neighbours, a net of equal force densities (Schek 1974). Where the film is later does not depend
  // on it but by the error of discretisation.
  Points smooth_start(const Points& x);

 private:
  struct Place {
    int block;
    Eigen::Array3d is_free;      // 1 or 0
    Vec3 normal = Vec3::Zero();  // within the free directions; of length 1, or 0 where there is none
  };

  bool is_rough(const Points& x);  // pre: turned to x
  void settle(int coordinate, Points& x) const;

  std::vector<Place> places_;
  std::vector<int> place_;                    // of each node, -1 = none
  std::vector<int> place_of_block_;           // of each block of unknowns, -1 = none
  std::vector<int> corners_;                  // of the film's triangles that have such nodes
  std::vector<Eigen::Matrix3d> restriction_;  // of each place's gradient, work space
};

}  // namespace coapt
