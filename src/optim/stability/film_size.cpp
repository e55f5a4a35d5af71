#include "optim/stability/film_size.hpp"

#include "energy/connected_parts.hpp"
#include "energy/term_access.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kSamePlace = 1e-9;  // of a coordinate, relative to the extent

// About which the nodes may grow or shrink without leaving their supports.
std::optional<Vec3> centre_of_growth(const std::vector<int>& nodes, const Points& x, const FixedMask& fixed) {
  const Points part = x(Eigen::all, nodes);
  const double extent = (part.rowwise().maxCoeff() - part.rowwise().minCoeff()).maxCoeff();
  Vec3 centre = part.rowwise().mean();
  for (int c = 0; c < 3; ++c) {
    const auto first = std::find_if(nodes.begin(), nodes.end(), [&](int node) { return fixed(c, node); });
    if (first == nodes.end()) continue;
    centre[c] = x(c, *first);
    for (const int node : nodes)
      if (fixed(c, node) && std::abs(x(c, node) - centre[c]) > kSamePlace * extent) return std::nullopt;
  }
  return centre;
}

}  // namespace

std::optional<FreeFilms> free_films(const Objective& objective, const Points& x) {
  if (objective.has_circulatory_force()) return std::nullopt;
  FreeFilms films;
  bool has_film = false;
  Points tension = Points::Zero(3, x.cols()), pressure = tension;
  for (const auto& term : objective.terms()) {
    const TermKind kind = kind_of(*term);
    const bool is_film = kind == TermKind::Film;
    if (!is_film && kind != TermKind::Pressure) return std::nullopt;
    (is_film ? has_film : films.has_pressure) = true;
    (is_film ? tension : pressure) += nodal_forces(*term, x);
  }
  if (!has_film) return std::nullopt;
  bool is_balanced = films.has_pressure;
  Points balanced = x;
  for (const auto& part : connected_parts(objective.terms(), x, objective.fixed())) {
    const auto centre = centre_of_growth(part.nodes, x, objective.fixed());
    if (!centre) return std::nullopt;
    double work = 0, work_of_pressure = 0;
    for (const int node : part.nodes) {
      const Vec3 arm = x.col(node) - *centre;
      work -= tension.col(node).dot(arm);
      work_of_pressure += pressure.col(node).dot(arm);
    }
    const double factor = work / work_of_pressure;
    is_balanced = is_balanced && work > 0 && work_of_pressure > 0;
    for (const int node : part.nodes) balanced.col(node) = *centre + factor * (x.col(node) - *centre);
  }
  if (is_balanced) films.balanced = std::move(balanced);
  return films;
}

}  // namespace coapt
