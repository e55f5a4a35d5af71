// Conditions on the coordinates of a point: "z > 2 mm && x^2 + y^2 < 100".
#pragma once

#include "core/types.hpp"

#include <string>
#include <vector>

namespace coapt {

// A condition in x, y, z, read once and tested at many points:
//   + - * / and ^ with a whole exponent, parentheses, sqrt(a), abs(a), min(a, b), max(a, b);
//   comparisons < <= > >=; these joined by !, && and ||, in this order of precedence.
// A number may have a unit of length or of a power of it ("2 mm", "1 cm^2"); without one it counts in mm or
// in powers of mm, as the coordinates do. Lengths, areas and volumes are neither added to nor compared with
// one another where coordinates and units tell them apart. What is no number (0/0, sqrt(-1)) meets no
// comparison.
class PointCondition {
 public:
  // Throws InputError that names the column (from 1) and what is expected there.
  explicit PointCondition(const std::string& text);

  // Whether the point x [mm] meets the condition.
  bool operator()(const Vec3& x) const;

  // A step of a stack machine: Constant and X, Y, Z push a number, the others replace theirs by their result.
  enum class Op {
    Constant,
    X,
    Y,
    Z,  // numbers
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,  // arithmetic
    Sqrt,
    Abs,
    Min,
    Max,  // functions
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    And,
    Or,
    Not  // 1 where it holds, else 0
  };
  struct Step {
    Op op = Op::Constant;
    double value = 0;  // Constant: [mm and its powers]; Power: the exponent
  };

 private:
  std::vector<Step> steps_;
};

}  // namespace coapt
