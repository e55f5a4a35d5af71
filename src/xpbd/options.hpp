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

// The sign of the forces: + closes the valve, - opens it. Prescribed nodes go their way in systole and back
// in diastole, which begins from a closed shape: a start in the shape at rest is closed first.
enum class HeartPhase { Systole, Diastole };

// Numbers of Walczak et al. 2019, in mm, s and a mass of 1 for every node. Stiffness is the share of a
// correction that is applied in one sweep. The share of areas is not given: that of edges is taken, and the
// whole of a contact.
struct XpbdPaper {
  double stretch = 0.1, bending = 0.1, area = 0.1, tether = 1, contact = 1;  // shares
  double compliance = 1e-5;                                                  // alpha; 0: plain PBD
  double flow = 50;                                                          // w, weight of the flow field
  double pressure = 100;                                                     // p, weight of the pressure
};
inline constexpr double kXpbdPaperTimeStep = 0.005;  // the paper's [s]

// With true masses the pressure of a closed valve moves a free node by half a metre in the paper's time step,
// and by a fifth of a millimetre in this one [s].
inline constexpr double kXpbdMaterialTimeStep = 1e-4;

struct XpbdOptions {
  double time_step = 0;    // [s]; 0: that of its stiffness, see xpbd_time_step()
  int iterations = 20;     // sweeps over all constraints in a step; the paper has 3 and 20
  int steps = 2000;        // greatest number of time steps in a phase
  double motion_time = 0;  // in which the prescribed nodes go their way; 0: half the time of all steps [s]
  double damping = 0.05;   // share of its velocity that a node loses in a step
  double thickness = 0.5;  // h: distance that contact keeps [mm]
  XpbdStiffness stiffness = XpbdStiffness::Material;
  XpbdForces forces = XpbdForces::Scene;
  HeartPhase phase = HeartPhase::Systole;
  XpbdPaper paper = {};
  int threads = 1;  // that may project constraints of one colour; the result does not depend on them
};

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
