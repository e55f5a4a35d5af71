// Metrics of energies, forces and single nodes.
#pragma once

#include "energy/objective.hpp"
#include "sensitivity/metrics/metric.hpp"

#include <memory>
#include <vector>

namespace coapt {

// Elastic energy of all terms that are neither load nor contact [force x length]. objective must outlive it.
std::unique_ptr<Metric> make_strain_energy(std::string name, const Objective& objective);

// Axial force of one line of a term of cables or tethers [force], 0 of a slack one. The term must outlive it.
// Throws InputError for a term of another kind or an element out of range.
std::unique_ptr<Metric> make_line_force(std::string name, EnergyTerm& term, int element);

// Smooth greatest axial force: (mean of F^p)^(1/p) over the lines, p >= 2 [force]; 0 where all are slack.
// Throws InputError as above and for an exponent below 2.
std::unique_ptr<Metric> make_line_force_norm(std::string name, EnergyTerm& term, std::vector<int> elements,
                                             double exponent);

// sum of weights . x over the nodes: a coordinate, a mean place, a distance along a direction [length times
// weight]. nodes as many as columns of weights; in range of x.
std::unique_ptr<Metric> make_node_position(std::string name, std::vector<int> nodes, Points weights);

}  // namespace coapt
