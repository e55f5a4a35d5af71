// What can be said of a state beyond its residual: whether it is a minimum, what its supports leave free,
// whether reactions balance the loads, and where it is farthest from equilibrium.
#pragma once

#include "energy/objective.hpp"
#include "optim/stability/stability.hpp"

#include <optional>
#include <string>
#include <vector>

namespace coapt {

// A connected part that its supports do not hold in every way.
struct FreePart {
  int node = 0;  // its first
  int node_count = 0;
  int free_motions = 0;  // rigid motions, to first order: 1 ... 6
};

// x: 3 x node_count positions.
std::vector<FreePart> free_parts(const Objective& objective, const Points& x);

// Where the out-of-balance force is largest.
struct Imbalance {
  int node = 0;
  Vec3 position = Vec3::Zero();
  double force = 0;  // [force]
  std::string term;  // that contributes most to it
  double share = 0;  // force of that term in its direction [force]
};

struct Certificate {
  bool is_made = false;
  double residual = 0;  // relative, exact loads
  Balance balance;      // of reactions and loads

  // There are loads, or reactions that stand clear of round-off. Otherwise the balance is that of round-off.
  bool is_balance_clear = false;

  // Of the exact Hessian; with a load that has no potential of the exact tangent, whose symmetric part is
  // looked at first: a positive definite one is enough. Not checked for a state that is no equilibrium.
  StabilityReport stability;
  bool is_conservative = true;

  // Nodes whose place is not determined, ascending: they can be moved, alone or with others, at no cost.
  std::vector<int> free_nodes;

  std::vector<FreePart> free_parts;
  std::optional<Imbalance> imbalance;  // of a state that is no equilibrium
};

// The certificate of a state. Stiffnesses below a millionth, or ten times the tolerance, of the reference
// force over the extent count as none: what rests on less is moved by forces that the tolerance lets pass, by
// a hundredth, or a tenth, of the scene. With a load that has no potential, the objective follows the path
// from q on afterwards. checks_stability: otherwise Stability::NotKnown, and no Hessian is evaluated. Cost
// where all is well: one Hessian, one factorisation, some gradients.
Certificate certify(Objective& objective, const Vector& q, double tolerance, const StabilityOptions& options,
                    bool checks_stability = true);

// "strict minimum (smallest pivot ratio 3e-06), 2 free nodes, reactions balance to 2e-13".
std::string summary(const Certificate& certificate);

// Why an equilibrium may not be stable, such as "a saddle with 2 negative modes"; empty: it is, or is flat,
// or no certificate was asked for. Pre: the state is an equilibrium.
std::string stability_doubt(const Certificate& certificate);

}  // namespace coapt
