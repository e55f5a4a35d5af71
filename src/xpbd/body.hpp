// What xpbd moves: the constraints of a scene as plain data, whatever its terms were called.
#pragma once

#include "core/types.hpp"
#include "energy/kernels/axial.hpp"

#include <array>
#include <functional>
#include <vector>

namespace coapt {

// Two nodes at a distance; k (l - L)^2 / 2.
struct XpbdEdge {
  int a = 0, b = 0;
  double length = 0;          // L [length]
  double stiffness = 0;       // k [force/length]
  bool only_tension = false;  // it does not resist shortening
};

// Two triangles at an angle; k (theta - theta0)^2 / 2. Nodes and sign of the angle: BendingHinge.
struct XpbdHinge {
  std::array<int, 4> nodes{};
  double angle = 0;      // theta0
  double stiffness = 0;  // k [force x length]
};

// The area of a triangle; k (A - A0)^2 / 2.
struct XpbdArea {
  std::array<int, 3> nodes{};
  double area = 0;           // A0 [length^2]
  double stiffness = 0;      // k [force/length^3]
  bool only_growth = false;  // it does not resist shrinking
};

// A film of constant tension on a triangle; sigma A.
struct XpbdFilm {
  std::array<int, 3> nodes{};
  double tension = 0;  // sigma [force/length]
};

// What a tether stands for, where that makes a difference to the paper's model or to contact.
enum class TetherKind {
  Chord,  // cable, chord or tether
  Edge,   // of the membrane: the paper's stiffness of edges is meant
  Link    // holds two nodes of leaflets together, whose features then do not meet
};

// A chord, cable or tether of any law.
struct XpbdTether {
  int a = 0, b = 0;
  double length = 0;         // at which it begins to pull [length]
  double stiffness = 0;      // of a straight law; ignored where there is a law [force/length]
  bool only_tension = true;  // slack below its length
  TetherKind kind = TetherKind::Chord;
  bool is_clip = false;  // a link without a length of its own, which the paper gives zero (section 3.8)
  std::function<AxialLaw(double distance)> law;  // force and stiffness at a distance; empty: straight
};

// A triangle of any energy that is never negative.
struct XpbdTriangle {
  std::array<int, 3> nodes{};
  std::function<double(const double* x, double* g)> energy;  // node after node, with its gradient
};

struct XpbdBody {
  Points rest = Points(3, 0);             // 3 x node_count [length]
  Triangles triangles = Triangles(3, 0);  // of the membrane
  std::vector<XpbdEdge> edges;
  std::vector<XpbdHinge> hinges;
  std::vector<XpbdArea> areas;
  std::vector<XpbdFilm> films;
  std::vector<XpbdTether> tethers;
  std::vector<XpbdTriangle> others;

  bool has_contact = false;
  Triangles obstacles = Triangles(3, 0);  // meet the membrane and not each other
  // Pairs of triangles that may pass through each other, obstacles following the membrane.
  std::vector<std::array<int, 2>> excluded;

  // Whether the constraints are the energies of the scene, all of them and exactly: what comes to rest under
  // them, with the scene's forces, is an equilibrium of the scene as far as the sweeps converge.
  bool is_exact = false;

  double pressure = 0;       // that acts on the membrane, its size [force/length^2]; 0: none
  std::vector<int> annulus;  // ordered loop of nodes; empty: none
};

}  // namespace coapt
