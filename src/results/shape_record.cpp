#include "results/shape_record.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kVisible = 1e-3;  // of the whole path

double distance(const Vector& a, const Vector& b) { return (a - b).cwiseAbs().maxCoeff(); }

// Of the node farthest away.
double distance(const Points& a, const Points& b) { return (a - b).colwise().norm().maxCoeff(); }

}  // namespace

std::vector<RecordedShape> subsampled(const std::vector<RecordedShape>& given, const Points& result,
                                      size_t most) {
  std::vector<const RecordedShape*> all;
  for (const RecordedShape& shape : given) all.push_back(&shape);
  if (all.empty()) return {};
  std::vector<double> length = {0};  // to each, and to the result
  for (size_t k = 1; k < all.size(); ++k)
    length.push_back(length.back() + distance(all[k]->x, all[k - 1]->x));
  length.push_back(length.back() + distance(result, all.back()->x));

  const auto leave_out = [&](size_t k) {
    all.erase(all.begin() + static_cast<long>(k));
    length.erase(length.begin() + static_cast<long>(k));
  };
  const double least = kVisible * length.back();
  for (size_t k = 1; k < all.size();)
    if (length[k] - length[k - 1] <= least)
      leave_out(k);
    else
      ++k;
  while (all.size() > 1 && length.back() - length[all.size() - 1] <= least) leave_out(all.size() - 1);
  // Again and again the one that leaves the smallest gap.
  while (all.size() > most) {
    size_t least_missed = 1;
    for (size_t k = 2; k < all.size(); ++k)
      if (length[k + 1] - length[k - 1] < length[least_missed + 1] - length[least_missed - 1])
        least_missed = k;
    leave_out(least_missed);
  }
  std::vector<RecordedShape> shapes;
  for (const RecordedShape* shape : all) shapes.push_back(*shape);
  return shapes;
}

ShapeRecord::ShapeRecord(const Model& model, size_t most)
    : model_(model), most_(most), start_{{}, model.objective->positions(model.q0)} {}

void ShapeRecord::see(const Iteration& iteration, const Vector& q) {
  if (q.size() != model_.objective->unknown_count() || q.size() == 0 || !q.allFinite()) return;
  if (!kept_.empty() && distance(q, kept_.back().q) <= spacing_) return;
  // At once: later the prescribed nodes are elsewhere.
  kept_.push_back({{iteration, model_.objective->positions(q)}, q});
  if (kept_.size() > 2 * most_) thin();
}

void ShapeRecord::thin() {
  double length = 0;
  for (size_t k = 1; k < kept_.size(); ++k) length += distance(kept_[k].q, kept_[k - 1].q);
  spacing_ = std::max(2 * spacing_, length / static_cast<double>(2 * most_));
  std::vector<Kept> fewer;
  for (Kept& kept : kept_)
    if (fewer.empty() || distance(kept.q, fewer.back().q) > spacing_) fewer.push_back(std::move(kept));
  kept_ = std::move(fewer);
}

std::vector<RecordedShape> ShapeRecord::shapes(const Points& result) const {
  std::vector<RecordedShape> all = {start_};
  for (const Kept& kept : kept_) all.push_back(kept.shape);
  return subsampled(all, result, most_);
}

}  // namespace coapt
