// Parameters of several terms that share their numbers.
#pragma once

#include "sensitivity/parameters/parameter.hpp"

#include <memory>
#include <vector>

namespace coapt {

struct JointPart {
  std::unique_ptr<Parameter> parameter;
  std::vector<int> numbers;  // of the whole, one for each of the parameter's own
};

// A parameter of `count` numbers, each of which sets those numbers of the parts that are assigned to it: one
// factor on chords of two terms. Throws InputError, all defects in one pass: a part with another count of
// numbers than it is assigned, a number out of range, one that sets nothing, parts whose values differ where
// they share a number, parts that change the same datum.
std::unique_ptr<Parameter> make_joint_parameter(std::string name, int count, std::vector<JointPart> parts);

}  // namespace coapt
