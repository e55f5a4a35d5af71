#include "sensitivity/parameters/joint_parameter.hpp"

#include "core/error.hpp"

namespace coapt {
namespace {

class JointParameter final : public Parameter {
 public:
  JointParameter(std::string name, Vector value, std::vector<JointPart> parts)
      : Parameter(std::move(name)), value_(std::move(value)), parts_(std::move(parts)) {}

  Vector value() const override { return value_; }

  std::string defect(const Vector& value) const override {
    for (const JointPart& part : parts_)
      if (std::string defect = part.parameter->defect(value(part.numbers)); !defect.empty()) return defect;
    return {};
  }

  void set(const Vector& value) override {
    value_ = value;
    for (const JointPart& part : parts_) part.parameter->set(value(part.numbers));
  }

  std::vector<WrittenDatum> written() const override {
    std::vector<WrittenDatum> data;
    for (const JointPart& part : parts_) {
      const std::vector<WrittenDatum> own = part.parameter->written();
      data.insert(data.end(), own.begin(), own.end());
    }
    return data;
  }

  Vector pull_back(const Points& x, const Points& weights) const override {
    return sum([&](const Parameter& part) { return part.pull_back(x, weights); });
  }
  void push_forward(const Points& x, const Vector& change, Points& g) const override {
    for (const JointPart& part : parts_) part.parameter->push_forward(x, change(part.numbers), g);
  }

  Vector energy_derivative(const Points& x, const EnergyTerm& term) const override {
    return sum([&](const Parameter& part) { return part.energy_derivative(x, term); });
  }
  Vector tension_derivative(const Points& x, const EnergyTerm& term, int element) const override {
    return sum([&](const Parameter& part) { return part.tension_derivative(x, term, element); });
  }

  bool moves_nodes() const override {
    for (const JointPart& part : parts_)
      if (part.parameter->moves_nodes()) return true;
    return false;
  }
  void place(Points& x) const override {
    for (const JointPart& part : parts_) part.parameter->place(x);
  }
  Vector pull_back_motion(const Points& weights) const override {
    return sum([&](const Parameter& part) { return part.pull_back_motion(weights); });
  }
  void push_forward_motion(const Vector& change, Points& motion) const override {
    for (const JointPart& part : parts_) part.parameter->push_forward_motion(change(part.numbers), motion);
  }

 private:
  template <typename OfPart>
  Vector sum(const OfPart& of_part) const {
    Vector result = Vector::Zero(value_.size());
    for (const JointPart& part : parts_) {
      const Vector own = of_part(*part.parameter);
      for (size_t k = 0; k < part.numbers.size(); ++k)
        result[part.numbers[k]] += own[static_cast<Eigen::Index>(k)];
    }
    return result;
  }

  Vector value_;
  std::vector<JointPart> parts_;
};

}  // namespace

std::unique_ptr<Parameter> make_joint_parameter(std::string name, int count, std::vector<JointPart> parts) {
  const std::string where = "parameter \"" + name + "\": ";
  std::vector<std::string> defects;
  Vector value = Vector::Constant(count, kNaN);
  for (size_t k = 0; k < parts.size(); ++k)
    for (size_t other = 0; other < k; ++other)
      if (std::string clash = clash_of(*parts[k].parameter, *parts[other].parameter); !clash.empty())
        defects.push_back(where + "of its parts, " + clash);
  for (const JointPart& part : parts) {
    const Vector own = part.parameter->value();
    const std::string what = where + "\"" + part.parameter->name() + "\" ";
    if (own.size() != static_cast<Eigen::Index>(part.numbers.size())) {
      defects.push_back(what + "has " + std::to_string(own.size()) + " numbers and is assigned " +
                        std::to_string(part.numbers.size()));
      continue;
    }
    for (size_t k = 0; k < part.numbers.size(); ++k) {
      const int number = part.numbers[k];
      const double own_value = own[static_cast<Eigen::Index>(k)];
      if (number < 0 || number >= count)
        defects.push_back(what + "is assigned the number " + std::to_string(number) + "; there are " +
                          std::to_string(count));
      else if (value[number] == value[number] && value[number] != own_value)
        defects.push_back(what + "begins with another value than a part before it that shares number " +
                          std::to_string(number));
      else
        value[number] = own_value;
    }
  }
  for (int number = 0; number < count; ++number)
    if (value[number] != value[number])
      defects.push_back(where + "number " + std::to_string(number) + " sets nothing");
  if (!defects.empty()) throw InputError(defects);
  return std::make_unique<JointParameter>(std::move(name), std::move(value), std::move(parts));
}

}  // namespace coapt
