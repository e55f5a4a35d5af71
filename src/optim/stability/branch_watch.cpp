#include "optim/stability/branch_watch.hpp"

namespace coapt {
namespace {

constexpr double kFarther = 3;  // travel of a step under suspicion, in those of the step before
constexpr double kBack = 0.5;   // share of the travel within which a shape counts as back

// Largest distance that a node lies apart in two states.
double farthest(const Vector& a, const Vector& b) {
  double largest = 0;
  for (Eigen::Index k = 0; k < a.size(); k += 3)
    largest = std::max(largest, (a.segment<3>(k) - b.segment<3>(k)).norm());
  return largest;
}

}  // namespace

std::optional<BranchChange> BranchWatch::arrive(int step, double t, const Vector& q) {
  std::optional<BranchChange> change;
  const double travel = visited_.empty() ? 0 : farthest(q, visited_.back().q);
  if (last_travel_ > 0 && travel > kFarther * last_travel_) {
    change = compare({step, t, q}, travel);
    means_.pose(t);
  }
  if (visited_.size() == 2) visited_.erase(visited_.begin());
  visited_.push_back({step, t, q});
  last_travel_ = travel;
  return change;
}

std::optional<BranchChange> BranchWatch::compare(const Place& now, double travel) {
  for (auto before = visited_.rbegin(); before != visited_.rend(); ++before) {
    means_.pose(now.t);
    Vector returned = now.q, stayed = before->q;
    if (!means_.carry(before->t, returned) || !means_.solve(stayed)) return std::nullopt;
    if (farthest(stayed, before->q) > kBack * travel) continue;
    if (!means_.solve(returned)) return std::nullopt;
    const double distance = farthest(stayed, returned);
    if (distance <= kBack * travel) return std::nullopt;
    return BranchChange{now.step, before->step, distance};
  }
  return std::nullopt;
}

}  // namespace coapt
