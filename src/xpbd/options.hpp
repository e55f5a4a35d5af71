// What extended position-based dynamics may be told.
//
// Sources: Macklin et al. 2016, "XPBD: Position-Based Simulation of Compliant Constrained Dynamics"; Walczak
// et al. 2019, "Using Position-Based Dynamics for Simulating the Mitral Valve in a Decision Support System"
// (eq. 4-19, table 1). The defaults of XpbdOptions are Coapt's own, so that the result can be compared with
// that of other methods; walczak_2019() is the paper. The defaults of XpbdPaper are the paper's.
#pragma once

namespace coapt {

// Where compliances and masses come from.
enum class XpbdStiffness {
  Material,  // moduli, thickness and density of the scene, so that the result can be compared with others
  Paper      // every node has the mass 1, every constraint the compliance and stiffness of XpbdPaper; edges
             // and areas resist both ways, areas by their square (eq. 14), hinges by an angle without sign
};

// What drives the motion.
enum class XpbdForces {
  Scene,  // the loads of the scene
  Paper   // flow field and pressure of Walczak et al., see heart_forces.hpp
};

// The sign of the forces: + closes the valve, - opens it. Prescribed nodes move along their path in systole
// and back in diastole, which begins from a closed shape: a start in the shape at rest is closed first.
enum class HeartPhase { Systole, Diastole };

// To what hinges want to fold (eq. 13).
enum class HingeRest { Initial, Flat };

// What contact keeps apart: vertices from triangles (the paper), or edges from edges too (ours).
enum class XpbdContactFeatures { VerticesAndEdges, Vertices };

// Numbers of Walczak et al. 2019 (table 1, eq. 15, section 3.3), in mm, s and a mass of 1 for every node.
// Stiffness is the share of a correction that is applied in one sweep.
struct XpbdPaper {
  double stretch = 0.1, bending = 0.1, area = 1;         // k0, k1, k2
  double tether = 1, contact = 1;                        // k of cords (eq. 15), k3
  double compliance = 1e-5;                              // alpha0 = alpha1 = alpha2; 0: plain PBD
  double tether_compliance = 0, contact_compliance = 0;  // alpha of cords, alpha3
  HingeRest rest_angle = HingeRest::Initial;             // the paper allows both
  double flow = 50;                                      // w, weight of the flow field
  double pressure = 100;                                 // p, weight of the pressure
  double radial = 0;                                     // ours: weight of a force towards the axis
};
inline constexpr double kXpbdPaperTimeStep = 0.005;  // the paper's [s]

// With true masses the pressure of a closed valve moves a free node by half a metre in the paper's time step,
// and by a fifth of a millimetre in this one [s].
inline constexpr double kXpbdMaterialTimeStep = 1e-4;

struct XpbdOptions {
  double time_step = 0;  // [s]; 0: that of its stiffness, see xpbd_time_step()
  int iterations = 20;   // sweeps over all constraints in a step; the paper has 3 and 20
  int steps = 2000;      // greatest number of time steps in a phase
  double motion_time =
      0;  // in which the prescribed nodes move along their path; 0: half the time of all steps [s]
  double damping = 0.05;   // share of its velocity that a node loses in a step; the paper has 0
  double thickness = 0.5;  // h: distance that contact keeps [mm]
  double rest_move = 0;    // at rest where the moves of nodes in a step, root mean square, are less [mm];
                           // 0: where no node moves any more
  XpbdStiffness stiffness = XpbdStiffness::Material;
  XpbdForces forces = XpbdForces::Scene;
  HeartPhase phase = HeartPhase::Systole;
  XpbdContactFeatures features = XpbdContactFeatures::VerticesAndEdges;
  XpbdPaper paper = {};
  int threads = 1;  // that may project constraints of one colour; the result does not depend on them
};

// The model of Walczak et al. 2019 with 3 sweeps in a step, which is what table 2 counts convergence with:
// eq. 8-10 lose no velocity, and contact is that of vertices with triangles (section 3.3). Ours, as the paper
// does not say: when a closure has converged, and that the annulus moves in 2 s, half of its shortest
// closure.
inline XpbdOptions walczak_2019() {
  XpbdOptions options;
  options.iterations = 3;
  options.steps = 5000;
  options.motion_time = 2;
  options.rest_move = 0.01;
  options.damping = 0;
  options.stiffness = XpbdStiffness::Paper;
  options.forces = XpbdForces::Paper;
  options.features = XpbdContactFeatures::Vertices;
  return options;
}

// The time step that is meant [s].
inline double xpbd_time_step(const XpbdOptions& options) {
  if (options.time_step > 0) return options.time_step;
  return options.stiffness == XpbdStiffness::Paper ? kXpbdPaperTimeStep : kXpbdMaterialTimeStep;
}

// The time that the prescribed motion takes [s].
inline double xpbd_motion_time(const XpbdOptions& options) {
  return options.motion_time > 0 ? options.motion_time : 0.5 * options.steps * xpbd_time_step(options);
}

}  // namespace coapt
