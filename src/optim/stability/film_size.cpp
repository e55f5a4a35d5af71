#include "optim/stability/film_size.hpp"

#include "energy/connected_parts.hpp"
#include "energy/film_net.hpp"
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

// All films of the objective; is_free: whatever is not prescribed.
FilmNet net_of_films(const Objective& objective) {
  FilmNet net;
  for (const auto& term : objective.terms()) {
    if (kind_of(*term) != TermKind::Film) continue;
    const std::vector<int>& nodes = term->stencils().nodes;
    net.corners.insert(net.corners.end(), nodes.begin(), nodes.end());
  }
  net.is_free = !objective.fixed();
  return net;
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

Points rounded_films(const Objective& objective, const Points& x) {
  const FilmNet all = net_of_films(objective);
  Points round = x;
  for (const auto& part : connected_parts(objective.terms(), x, objective.fixed())) {
    const auto centre = centre_of_growth(part.nodes, x, objective.fixed());
    if (!centre) continue;
    FilmNet net{{}, all.is_free};
    for (size_t k = 0; k < all.corners.size(); k += 3)
      if (std::binary_search(part.nodes.begin(), part.nodes.end(), all.corners[k]))
        net.corners.insert(net.corners.end(), all.corners.begin() + static_cast<std::ptrdiff_t>(k),
                           all.corners.begin() + static_cast<std::ptrdiff_t>(k) + 3);
    Vec3 shift = Vec3::Zero(), middle = *centre;
    // A node that alone is prescribed along an axis moves with the others, and is brought back with them.
    std::array<int, 3> held{-1, -1, -1};
    for (int c = 0; c < 3; ++c) {
      const auto is_held = [&](int node) { return objective.fixed()(c, node); };
      if (std::count_if(part.nodes.begin(), part.nodes.end(), is_held) != 1) continue;
      held[static_cast<size_t>(c)] = *std::find_if(part.nodes.begin(), part.nodes.end(), is_held);
      net.is_free(c, held[static_cast<size_t>(c)]) = true;
      middle[c] = x(c, part.nodes).mean();
    }
    round_net(net, middle, round);
    for (int c = 0; c < 3; ++c)
      if (const int node = held[static_cast<size_t>(c)]; node >= 0) shift[c] = x(c, node) - round(c, node);
    for (const int node : part.nodes) round.col(node) += shift;
  }
  return round;
}

std::optional<Points> spanned_films(const Objective& objective, const Points& x) {
  const auto is_film = [](const auto& term) { return kind_of(*term) == TermKind::Film; };
  if (!std::all_of(objective.terms().begin(), objective.terms().end(), is_film) || free_films(objective, x))
    return std::nullopt;
  const FilmNet net = net_of_films(objective);
  Points film = x;
  for (int coordinate = 0; coordinate < 3; ++coordinate) relax_net(net, coordinate, film);
  if (!lessen_area(net, film)) return std::nullopt;
  return film;
}

}  // namespace coapt
