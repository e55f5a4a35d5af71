// A scene in other units, elsewhere, turned, or with other numbers: what the rows of the stability matrix do
// to it. Private to this room.
#pragma once

#include "stress/bench.hpp"

#include <functional>
#include <string>

namespace coapt {

// x' = length * turn * x + shift; stresses are multiplied by `stress`, and whatever has a dimension follows.
struct StressFrame {
  double length = 1, stress = 1;
  // A rotation, or one with a mirror: triangles are then turned over, so that their normals point to what was
  // the same side.
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vec3 shift = Vec3::Zero();  // [mm]

  Points back(const Points& x, const Vec3& origin_here, const Vec3& origin_there) const;
};

// Why the scene cannot be put into that frame as a whole: a file gives values that have to change with it.
// Empty: it can.
std::string frame_obstacle(const StressScene& subject, const StressFrame& frame);

// The scene in that frame. Nodes far from zero are brought back, as when a scene is read.
// Pre: frame_obstacle() is empty.
StressScene in_frame(const StressScene& subject, const StressFrame& frame);

// The scene with its triangles turned over and pressures of the other sign: the same forces.
StressScene turned_over(const StressScene& subject);

// Why the scene cannot be renumbered as a whole: a file goes by the numbers that are there. Empty: it can.
std::string numbering_obstacle(const StressScene& subject);

// The scene with the vertices of its mesh and its triangles in another order, by chance but always the same,
// and each triangle beginning with another corner.
struct Renumbered {
  StressScene scene;
  std::vector<int> number;  // there of each node here

  Points back(const Points& x) const { return x(Eigen::all, number); }
};
// Pre: numbering_obstacle() is empty.
Renumbered renumbered(const StressScene& subject);

// The scene with every number of some terms that has the dimension of mass in it (moduli, tensions,
// pressures, forces) times `factor`: the energy of these terms times that factor.
StressScene with_energy_scaled(const StressScene& subject, double factor,
                               const std::function<bool(const TermSpec&)>& is_meant);

// The scene with every length at rest of its networks of chords times `factor`.
StressScene with_chords_scaled(const StressScene& subject, double factor);

// What a term is, by its keys.
bool is_load(const TermSpec& term);
bool is_line(const TermSpec& term);   // cables, chords, tethers
bool is_sheet(const TermSpec& term);  // what is neither of these, no contact and no bending

}  // namespace coapt
