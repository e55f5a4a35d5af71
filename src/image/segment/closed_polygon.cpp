#include "image/segment/closed_polygon.hpp"

#include "core/types.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace coapt {
namespace {

constexpr int kLeastCorners = 8;  // of a polygon

// Costs and predecessors of a state of a corner, and of the rise that led there: states x rises.
struct Corner {
  Eigen::MatrixXd least;
  Eigen::MatrixXi rise_before;
};

class Polygon {
 public:
  Polygon(const Eigen::MatrixXd& costs, const ClosedPolygonOptions& options)
      : costs_(costs), options_(options), rises_(2 * options.greatest_rise + 1) {
    const auto columns = static_cast<int>(costs.cols());
    corners_ = std::min(std::max(kLeastCorners, columns / options.columns), columns);
    for (int corner = 0; corner <= corners_; ++corner) places_.push_back(corner * columns / corners_);
    for (int corner = 0; corner < corners_; ++corner) pieces_.push_back(piece_costs(corner));
  }

  int corners() const { return corners_; }
  int place(int corner) const { return places_[static_cast<size_t>(corner)]; }

  // States of the corners of two rounds.
  std::vector<int> cheapest() const {
    const Eigen::Index states = costs_.rows();
    const int count = 2 * corners_ + 1;
    std::vector<Corner> table(static_cast<size_t>(count));
    table[0].least = Eigen::MatrixXd::Zero(states, rises_);
    for (int n = 1; n < count; ++n)
      table[static_cast<size_t>(n)] = next(table[static_cast<size_t>(n - 1)], (n - 1) % corners_);
    Eigen::Index state = 0, rise = 0;
    table.back().least.minCoeff(&state, &rise);
    std::vector<int> found(static_cast<size_t>(count));
    for (int n = count - 1; n >= 0; --n) {
      found[static_cast<size_t>(n)] = static_cast<int>(state);
      if (n == 0) break;
      const int before = table[static_cast<size_t>(n)].rise_before(state, rise);
      state -= rise - options_.greatest_rise;
      rise = before;
    }
    return found;
  }

 private:
  // Of the straight pieces from each state of a corner, by how far they rise: states x rises.
  Eigen::MatrixXd piece_costs(int corner) const {
    const Eigen::Index states = costs_.rows();
    Eigen::MatrixXd piece = Eigen::MatrixXd::Constant(states, rises_, kInfinity);
    const int first = place(corner), length = place(corner + 1) - first;
    for (Eigen::Index state = 0; state < states; ++state)
      for (int rise = 0; rise < rises_; ++rise) {
        const double end = static_cast<double>(state) + rise - options_.greatest_rise;
        if (end < 0 || end > static_cast<double>(states - 1)) continue;
        double sum = 0;
        for (int k = 0; k < length; ++k) {
          const double at =
              static_cast<double>(state) + (end - static_cast<double>(state)) * k / double(length);
          const auto below = std::min(static_cast<Eigen::Index>(at), states - 2);
          const double part = at - static_cast<double>(below);
          sum += (1 - part) * costs_(below, first + k) + part * costs_(below + 1, first + k);
        }
        piece(state, rise) = sum;
      }
    return piece;
  }

  Corner next(const Corner& before, int corner) const {
    const Eigen::Index states = costs_.rows();
    Corner here{Eigen::MatrixXd::Constant(states, rises_, kInfinity), Eigen::MatrixXi::Zero(states, rises_)};
    const Eigen::MatrixXd& piece = pieces_[static_cast<size_t>(corner)];
    for (Eigen::Index from = 0; from < states; ++from)
      for (int rise = 0; rise < rises_; ++rise) {
        if (!std::isfinite(piece(from, rise))) continue;
        const Eigen::Index state = from + rise - options_.greatest_rise;
        for (int other = 0; other < rises_; ++other) {
          const double cost =
              before.least(from, other) + options_.bend_cost * std::abs(other - rise) + piece(from, rise);
          if (cost >= here.least(state, rise)) continue;
          here.least(state, rise) = cost;
          here.rise_before(state, rise) = other;
        }
      }
    return here;
  }

  const Eigen::MatrixXd& costs_;
  const ClosedPolygonOptions& options_;
  int rises_ = 0, corners_ = 0;
  std::vector<int> places_;
  std::vector<Eigen::MatrixXd> pieces_;
};

}  // namespace

Eigen::VectorXd closed_polygon(const Eigen::MatrixXd& costs, const ClosedPolygonOptions& options) {
  const Polygon polygon(costs, options);
  const std::vector<int> states = polygon.cheapest();
  const int corners = polygon.corners();
  Eigen::VectorXd path(costs.cols());
  for (int n = corners / 2; n < corners / 2 + corners; ++n) {
    const int first = polygon.place(n % corners), last = polygon.place(n % corners + 1);
    const double from = states[static_cast<size_t>(n)], to = states[static_cast<size_t>(n + 1)];
    for (int column = first; column < last; ++column)
      path[column] = from + (to - from) * (column - first) / double(last - first);
  }
  return path;
}

}  // namespace coapt
