// The nodes of a film of constant tension move along lines across it alone: what slides in it is a matter of
// the mesh.
//
// The area of a film does not change when its nodes slide within it. That of a mesh of it does, by the error
// of discretisation, and is often least where triangles have no area at all: on most meshes the full gradient
// of a mesh's area vanishes nowhere near the film. What is left is the same energy on a linear subspace, with
// one answer near each film, whatever the path there (compare "normal motion" in Brakke 1992, The Surface
// Evolver).
#pragma once

#include "energy/term.hpp"

#include <Eigen/SparseCore>

#include <memory>
#include <vector>

namespace coapt {

class NormalMotion {
 public:
  NormalMotion() = default;

  // start: 3 x node_count; the lines are along the normals of its smooth_start(). block: block of unknowns of
  // each node, -1 for none. fixed: 3 x node_count, true = prescribed.
  // Which nodes move along lines only: those of terms "surface_tension" that feel nothing else but
  // "load_pressure" and contact, where the film around them is a manifold of one orientation and tension. On
  // the film's rim only nodes that slide within one coordinate plane. None of a film that has a rim that is
  // free otherwise, as along a cable: there the nodes within have to go with it. None where loads have no
  // potential.
  NormalMotion(const std::vector<std::unique_ptr<EnergyTerm>>& terms, const Points& start,
               const std::vector<int>& block, const Eigen::Array<bool, 3, Eigen::Dynamic>& fixed);

  bool is_empty() const { return places_.empty(); }

  // Turns all lines to the normals of the film at x if one has come to lie within 30 degrees of it, and says
  // so: from then on the energy is that of other shapes. A normal is that of the sum of the area vectors
  // around a node, along which the volume that it bounds grows fastest.
  bool turn_where_needed(const Points& x);

  // Leaves of the gradient its part along the lines. Returns the greatest part of a node that is left
  // out [force].
  double restrict_gradient(Vector& g) const;

  // Leaves of the Hessian (lower triangle, whole diagonal blocks) its part along the lines, and gives
  // the others the stiffness of that part, so that they have no say in what is definite.
  void restrict_hessian(Eigen::SparseMatrix<double>& h);

  // A start that the film can leave along its normals: x itself, unless a triangle stands nearly
  // across the normal at one of its nodes, as where only a rim was lifted. Then the nodes first lie in the
  // middle of their neighbours, and go from there to a film of less area (energy/film_net.hpp): lines from
  // far off would cross where the film is. Where it is later does not depend on the start but by the error of
  // discretisation.
  Points smooth_start(const Points& x) const;

 private:
  struct Place {
    int block;
    Eigen::Array3d is_free;  // 1 or 0
    Vec3 normal;             // the line, within the free directions; of length 1, or 0: the node moves freely
  };

  std::vector<Vec3> normals_at(const Points& x) const;
  bool is_rough(const Points& x, const std::vector<Vec3>& normals) const;

  std::vector<Place> places_;
  std::vector<int> place_;                    // of each node, -1 = none
  std::vector<int> place_of_block_;           // of each block of unknowns, -1 = none
  std::vector<int> corners_;                  // of the film's triangles that have such nodes
  std::vector<Eigen::Matrix3d> restriction_;  // of each place's gradient, work space
};

}  // namespace coapt
