#include "sensitivity/parameters/line_lengths.hpp"

#include "core/error.hpp"

#include <cmath>
#include <numeric>

namespace coapt {
namespace {

constexpr double kSame = 1e-9;  // share by which lengths of a group may differ and count as one

class LineLengths final : public Parameter {
 public:
  LineLengths(std::string name, EnergyTerm& term, std::unique_ptr<LineAccess> lines,
              std::vector<std::vector<int>> groups, LengthMeasure measure)
      : Parameter(std::move(name)),
        term_(term),
        lines_(std::move(lines)),
        groups_(std::move(groups)),
        measure_(measure),
        first_(term.stencils().count()),
        value_(Vector::Constant(static_cast<Eigen::Index>(groups_.size()),
                                measure == LengthMeasure::Factor ? 1 : 0)) {
    for (int e = 0; e < first_.size(); ++e) first_[e] = lines_->rest_length(e);
    if (measure != LengthMeasure::Length) return;
    for (size_t k = 0; k < groups_.size(); ++k) value_[index(k)] = first_[groups_[k].front()];
  }

  Vector value() const override { return value_; }

  std::string defect(const Vector& value) const override {
    for (size_t k = 0; k < groups_.size(); ++k)
      for (const int e : groups_[k])
        if (const double l = length(e, value[index(k)]); !(l > 0) || !std::isfinite(l))
          return "parameter \"" + name() + "\", number " + std::to_string(k) + ": line " + std::to_string(e) +
                 " of term \"" + term_.name() + "\" would have the length " + std::to_string(l) +
                 "; it must stay positive";
    return {};
  }

  void set(const Vector& value) override {
    value_ = value;
    Vector lengths(first_.size());
    for (int e = 0; e < lengths.size(); ++e) lengths[e] = lines_->rest_length(e);
    for (size_t k = 0; k < groups_.size(); ++k)
      for (const int e : groups_[k]) lengths[e] = length(e, value[index(k)]);
    lines_->set_rest_lengths(lengths);
  }

  std::vector<WrittenDatum> written() const override {
    std::vector<WrittenDatum> data;
    for (const std::vector<int>& group : groups_)
      for (const int e : group) data.push_back({WrittenDatum::Kind::Length, &term_, e});
    return data;
  }

  Vector pull_back(const Points& x, const Points& weights) const override {
    return sum([&](int e) {
      const int* ends = nodes(e);
      return force_by_rest(e, x) * direction(e, x).dot(weights.col(ends[1]) - weights.col(ends[0]));
    });
  }

  void push_forward(const Points& x, const Vector& change, Points& g) const override {
    for (size_t k = 0; k < groups_.size(); ++k)
      for (const int e : groups_[k]) {
        const Vec3 pull = change[index(k)] * slope(e) * force_by_rest(e, x) * direction(e, x);
        g.col(nodes(e)[0]) -= pull;
        g.col(nodes(e)[1]) += pull;
      }
  }

  Vector energy_derivative(const Points& x, const EnergyTerm& term) const override {
    if (&term != &term_) return none();
    return sum([&](int e) { return lines_->at(e, line_length(term_, e, x)).energy_by_rest; });
  }

  Vector tension_derivative(const Points& x, const EnergyTerm& term, int element) const override {
    if (&term != &term_) return none();
    return sum([&](int e) { return e == element ? force_by_rest(e, x) : 0; });
  }

 private:
  static Eigen::Index index(size_t k) { return static_cast<Eigen::Index>(k); }
  const int* nodes(int e) const { return &term_.stencils().nodes[2 * static_cast<size_t>(e)]; }

  double length(int e, double value) const {
    switch (measure_) {
      case LengthMeasure::Length:
        return value;
      case LengthMeasure::Change:
        return first_[e] + value;
      case LengthMeasure::Factor:
        return first_[e] * value;
    }
    return kNaN;
  }
  double slope(int e) const { return measure_ == LengthMeasure::Factor ? first_[e] : 1; }

  double force_by_rest(int e, const Points& x) const {
    return lines_->at(e, line_length(term_, e, x)).force_by_rest;
  }
  Vec3 direction(int e, const Points& x) const {
    return (x.col(nodes(e)[1]) - x.col(nodes(e)[0])).stableNormalized();
  }

  // Of what is asked for each line, times the derivative of its rest length.
  template <typename OfLine>
  Vector sum(const OfLine& of_line) const {
    Vector result = Vector::Zero(value_.size());
    for (size_t k = 0; k < groups_.size(); ++k)
      for (const int e : groups_[k]) result[index(k)] += slope(e) * of_line(e);
    return result;
  }

  EnergyTerm& term_;
  std::unique_ptr<LineAccess> lines_;
  std::vector<std::vector<int>> groups_;
  LengthMeasure measure_;
  Vector first_;  // rest lengths when the parameter was made
  Vector value_;
};

}  // namespace

std::unique_ptr<Parameter> make_line_lengths(std::string name, EnergyTerm& term,
                                             std::vector<std::vector<int>> groups, LengthMeasure measure) {
  const std::string where = "parameter \"" + name + "\": ";
  std::unique_ptr<LineAccess> lines = line_access(term);
  if (lines == nullptr)
    throw InputError(where + "term \"" + term.name() + "\" (" + std::string(term.type()) +
                     ") has no lines with a rest length; name a term of cables or tethers");
  std::vector<std::string> defects;
  std::vector<bool> is_taken(static_cast<size_t>(term.stencils().count()), false);
  for (size_t k = 0; k < groups.size(); ++k) {
    const std::string group = where + "group " + std::to_string(k) + ": ";
    if (groups[k].empty()) defects.push_back(group + "has no line");
    for (const int e : groups[k]) {
      const std::string line = "line " + std::to_string(e);
      if (e < 0 || e >= term.stencils().count()) {
        defects.push_back(group + "there is no " + line + "; the term has " +
                          std::to_string(term.stencils().count()));
        continue;
      }
      if (is_taken[static_cast<size_t>(e)]) defects.push_back(group + line + " is in a group already");
      is_taken[static_cast<size_t>(e)] = true;
      const double length = lines->rest_length(e);
      if (!(length > 0)) defects.push_back(group + line + " has no rest length, its force is constant");
      if (measure == LengthMeasure::Length &&
          std::abs(length - lines->rest_length(groups[k].front())) > kSame * length)
        defects.push_back(group + line + " has another length than the first; measure by Change or Factor");
    }
  }
  if (!defects.empty()) throw InputError(defects);
  return std::make_unique<LineLengths>(std::move(name), term, std::move(lines), std::move(groups), measure);
}

std::vector<std::vector<int>> single_lines(const EnergyTerm& term) {
  std::vector<std::vector<int>> groups;
  for (int e = 0; e < term.stencils().count(); ++e) groups.push_back({e});
  return groups;
}

std::vector<std::vector<int>> all_lines(const EnergyTerm& term) {
  std::vector<int> all(static_cast<size_t>(term.stencils().count()));
  std::iota(all.begin(), all.end(), 0);
  return {all};
}

}  // namespace coapt
