// What extended position-based dynamics may be told.
//
// Sources: Macklin et al. 2016, "XPBD: Position-Based Simulation of Compliant Constrained Dynamics"; Walczak
// et al. 2019, "Using Position-Based Dynamics for Simulating the Mitral Valve in a Decision Support System"
// (eq. 7-19), whose numbers are the defaults where nothing else is said.
#pragma once

namespace coapt {

// Where compliances and masses come from.
enum class XpbdStiffness {
  Material,  // moduli, thickness and density of the scene, so that the result can be compared with others
  Paper      // every node has the mass 1, every constraint the compliance and stiffness of XpbdPaper; edges
             // and areas resist both ways
};

// What drives the motion.
enum class XpbdForces {
  Scene,  // the loads of the scene
  Paper   // flow field and pressure of Walczak et al., see heart_forces.hpp
};

// The sign of the forces: + closes the valve, - opens it.
enum class HeartPhase { Systole, Diastole };

// Numbers of Walczak et al. 2019, in mm, s and a mass of 1 for every node. Stiffness is the share of a
// correction that is applied in one sweep. The share of areas is not given: that of edges is taken, and the
// whole of a contact.
struct XpbdPaper {
  static constexpr double kStretch = 0.1, kBending = 0.1, kArea = 0.1, kTether = 1, kContact = 1;
  static constexpr double kCompliance = 1e-5;  // alpha
  static constexpr double kFlow = 50;          // w, weight of the flow field
  static constexpr double kPressure = 100;     // p, weight of the pressure
  static constexpr double kTimeStep = 0.005;   // [s]
};

// With true masses the pressure of a closed valve moves a free node by half a metre in the paper's time step,
// and by a fifth of a millimetre in this one [s].
inline constexpr double kXpbdMaterialTimeStep = 1e-4;

struct XpbdOptions {
  double time_step = 0;    // [s]; 0: that of its stiffness, see xpbd_time_step()
  int iterations = 20;     // sweeps over all constraints in a step; the paper has 3 and 20
  int steps = 2000;        // greatest number of time steps at each place of the prescribed motion
  double damping = 0.05;   // share of its velocity that a node loses in a step
  double thickness = 0.5;  // h: distance that contact keeps [mm]
  XpbdStiffness stiffness = XpbdStiffness::Material;
  XpbdForces forces = XpbdForces::Scene;
  HeartPhase phase = HeartPhase::Systole;
  int threads = 1;  // that may project constraints of one colour; the result does not depend on them
};

// The time step that is meant [s].
inline double xpbd_time_step(const XpbdOptions& options) {
  if (options.time_step > 0) return options.time_step;
  return options.stiffness == XpbdStiffness::Paper ? XpbdPaper::kTimeStep : kXpbdMaterialTimeStep;
}

}  // namespace coapt
