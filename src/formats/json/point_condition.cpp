#include "formats/json/point_condition.hpp"

#include "core/error.hpp"
#include "formats/json/units.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace coapt {
namespace {

using Op = PointCondition::Op;
using Step = PointCondition::Step;

constexpr int kDeepest = 100;      // parentheses within parentheses: each costs a few calls
constexpr size_t kLongest = 4000;  // characters; so no stack grows beyond that
constexpr int kGreatestPower = 12;

// What a part of the text stands for.
struct Part {
  bool is_condition = false;
  std::optional<int> power = {};  // of mm; none for a number without unit, and what is made of it
};

struct Word {
  std::string_view name;
  Op op;
};
constexpr std::array kCoordinates{Word{"x", Op::X}, Word{"y", Op::Y}, Word{"z", Op::Z}};
constexpr std::array kFunctions{Word{"sqrt", Op::Sqrt}, Word{"abs", Op::Abs}, Word{"min", Op::Min},
                                Word{"max", Op::Max}};
// The longer ones first: "<" begins "<=".
constexpr std::array kComparisons{Word{"<=", Op::LessEqual}, Word{">=", Op::GreaterEqual},
                                  Word{"<", Op::Less}, Word{">", Op::Greater}};

bool begins_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '%' || (c & 0x80) != 0;
}
bool is_decimal(char c) { return c >= '0' && c <= '9'; }

// Recursive descent, a function for each level of precedence, which writes the steps of a stack machine.
class ConditionParser {
 public:
  explicit ConditionParser(std::string_view text) : text_(text) {}

  std::vector<Step> parse() {
    if (text_.size() > kLongest) refuse(kLongest, "is too long for a condition");
    const Part whole = any_of();
    if (!at_end()) refuse(at_, "read " + read_here() + "; expected an operator or the end");
    if (!whole.is_condition) refuse(0, "is a number; a condition compares, as \"z > 2 mm\" does");
    return std::move(steps_);
  }

 private:
  [[noreturn]] void refuse(size_t at, const std::string& reason) const {
    throw InputError("column " + std::to_string(at + 1) + ": " + reason);
  }

  bool at_end() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    return at_ == text_.size();
  }

  std::string read_here() {
    if (at_end()) return "the end";
    return "\"" + std::string(text_.substr(at_, 20)) + "\"";
  }

  bool accept(std::string_view token) {
    if (at_end() || !text_.substr(at_).starts_with(token)) return false;
    at_ += token.size();
    return true;
  }

  void expect(std::string_view token) {
    if (!accept(token)) refuse(at_, "read " + read_here() + "; expected \"" + std::string(token) + "\"");
  }

  // Where the next part begins, for messages.
  size_t here() {
    at_end();
    return at_;
  }

  std::string_view word() {
    const size_t begin = at_;
    while (at_ < text_.size() && (begins_word(text_[at_]) || (at_ > begin && is_decimal(text_[at_])))) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  void require_condition(const Part& part, size_t at) const {
    if (!part.is_condition) refuse(at, "expected a comparison, as \"z > 2 mm\"; this is a number");
  }
  void require_number(const Part& part, size_t at) const {
    if (part.is_condition)
      refuse(at,
             "expected a number; this is a condition (two comparisons are joined by &&: \"0 < z && z < 2\")");
  }

  // Of two numbers that are added or compared.
  Part alike(const Part& a, const Part& b, size_t at) const {
    if (a.power && b.power && *a.power != *b.power)
      refuse(at, "adds to or compares with mm^" + std::to_string(*a.power) + " what is in mm^" +
                     std::to_string(*b.power));
    return {false, a.power ? a.power : b.power};
  }

  Part any_of() {
    return joined("||", Op::Or, [this] { return all_of(); });
  }
  Part all_of() {
    return joined("&&", Op::And, [this] { return comparison(); });
  }

  template <typename Next>
  Part joined(std::string_view token, Op op, Next&& next) {
    size_t at = here();
    const Part first = next();
    while (accept(token)) {
      require_condition(first, at);
      at = here();
      require_condition(next(), at);
      steps_.push_back({op});
    }
    return first;
  }

  Part comparison() {
    const size_t left_at = here();
    const Part left = sum();
    for (const Word& word : kComparisons) {
      if (!accept(word.name)) continue;
      require_number(left, left_at);
      const size_t right_at = here();
      const Part right = sum();
      require_number(right, right_at);
      alike(left, right, right_at);
      steps_.push_back({word.op});
      return {true};
    }
    const size_t at = here();
    if (accept("=") || accept("!="))
      refuse(at, "coordinates are compared by <, <=, > and >=; for those on a plane: abs(z - 2) < 0.01");
    return left;
  }

  Part sum() {
    size_t at = here();
    Part total = product();
    while (true) {
      const bool adds = accept("+");
      if (!adds && !accept("-")) return total;
      require_number(total, at);
      at = here();
      const Part next = product();
      require_number(next, at);
      total = alike(total, next, at);
      steps_.push_back({adds ? Op::Add : Op::Subtract});
    }
  }

  Part product() {
    size_t at = here();
    Part total = signed_power();
    while (true) {
      const bool multiplies = accept("*");
      if (!multiplies && !accept("/")) return total;
      require_number(total, at);
      at = here();
      const Part next = signed_power();
      require_number(next, at);
      if (!total.power || !next.power)
        total.power.reset();
      else
        *total.power += multiplies ? *next.power : -*next.power;
      steps_.push_back({multiplies ? Op::Multiply : Op::Divide});
    }
  }

  // A sign binds less than ^: -x^2 is -(x^2).
  Part signed_power() {
    const size_t at = here();
    if (++depth_ > kDeepest) refuse(at, "is nested too deeply");
    Part part;
    if (accept("-") || accept("+")) {
      const bool negates = text_[at_ - 1] == '-';
      part = signed_power();
      require_number(part, at);
      if (negates) steps_.push_back({Op::Negate});
    } else if (!text_.substr(at).starts_with("!=") && accept("!")) {
      part = signed_power();
      require_condition(part, at);
      steps_.push_back({Op::Not});
    } else {
      part = power();
    }
    --depth_;
    return part;
  }

  Part power() {
    const size_t at = here();
    Part base = operand();
    if (!accept("^")) return base;
    require_number(base, at);
    const size_t exponent_at = here();
    int exponent = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), exponent);
    if (error != std::errc() || exponent < 0 || exponent > kGreatestPower)
      refuse(exponent_at, "read " + read_here() + "; expected a whole exponent from 0 to " +
                              std::to_string(kGreatestPower));
    at_ = static_cast<size_t>(end - text_.data());
    if (base.power) *base.power *= exponent;
    steps_.push_back({Op::Power, static_cast<double>(exponent)});
    return base;
  }

  Part operand() {
    const size_t at = here();
    if (accept("(")) {
      const Part part = any_of();
      expect(")");
      return part;
    }
    if (at < text_.size() && (is_decimal(text_[at]) || text_[at] == '.')) return number();
    const std::string_view name = word();
    for (const Word& coordinate : kCoordinates)
      if (coordinate.name == name) {
        steps_.push_back({coordinate.op});
        return {false, 1};
      }
    for (const Word& function : kFunctions)
      if (function.name == name) return call(function, at);
    at_ = at;
    refuse(at, "read " + read_here() + "; expected x, y, z, a number, \"(\" or one of sqrt, abs, min, max");
  }

  Part call(const Word& function, size_t at) {
    expect("(");
    const size_t first_at = here();
    Part part = any_of();
    require_number(part, first_at);
    if (function.op == Op::Min || function.op == Op::Max) {
      expect(",");
      const size_t second_at = here();
      const Part second = any_of();
      require_number(second, second_at);
      part = alike(part, second, second_at);
    } else if (function.op == Op::Sqrt && part.power) {
      if (*part.power % 2 != 0) refuse(at, "takes the root of what is in mm^" + std::to_string(*part.power));
      *part.power /= 2;
    }
    expect(")");
    steps_.push_back({function.op});
    return part;
  }

  // A number and, where letters follow it, its unit with a power: "1 cm^2".
  Part number() {
    const size_t begin = at_;
    double value = 0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc() || !std::isfinite(value))
      refuse(begin, "read " + read_here() + "; expected a number");
    at_ = static_cast<size_t>(end - text_.data());
    const size_t number_end = at_;
    if (at_end() || !begins_word(text_[at_])) {
      steps_.push_back({Op::Constant, value});
      return {};
    }
    const size_t unit_at = at_;
    word();
    if (at_ + 1 < text_.size() && text_[at_] == '^' && is_decimal(text_[at_ + 1])) at_ += 2;
    return quantity(text_.substr(begin, number_end - begin), text_.substr(unit_at, at_ - unit_at), unit_at);
  }

  Part quantity(std::string_view number, std::string_view unit, size_t unit_at) {
    Quantity read;
    try {
      read = parse_quantity(std::string(number) + " " + std::string(unit));
    } catch (const InputError& error) {
      refuse(unit_at, std::string(error.what()) + "; a product is written with *");
    }
    const int power = read.dimension.length;
    if (read.dimension != Dimension{power, 0, 0, 0} || power == 0)
      refuse(unit_at, "\"" + std::string(unit) + "\" is no unit of length, area or volume");
    steps_.push_back({Op::Constant, read.value});
    return {false, power};
  }

  std::string_view text_;
  size_t at_ = 0;
  int depth_ = 0;
  std::vector<Step> steps_;
};

double result(Op op, double a, double b) {
  switch (op) {
    case Op::Add:
      return a + b;
    case Op::Subtract:
      return a - b;
    case Op::Multiply:
      return a * b;
    case Op::Divide:
      return a / b;
    case Op::Min:
      return std::min(a, b);
    case Op::Max:
      return std::max(a, b);
    case Op::Less:
      return a < b ? 1 : 0;
    case Op::LessEqual:
      return a <= b ? 1 : 0;
    case Op::Greater:
      return a > b ? 1 : 0;
    case Op::GreaterEqual:
      return a >= b ? 1 : 0;
    case Op::And:
      return a * b;
    default:
      return std::max(a, b);  // Or
  }
}

double result(const Step& step, double a) {
  switch (step.op) {
    case Op::Negate:
      return -a;
    case Op::Power:
      return std::pow(a, step.value);
    case Op::Sqrt:
      return std::sqrt(a);
    case Op::Abs:
      return std::abs(a);
    default:
      return 1 - a;  // Not
  }
}

bool takes_one(Op op) {
  return op == Op::Negate || op == Op::Power || op == Op::Sqrt || op == Op::Abs || op == Op::Not;
}

}  // namespace

PointCondition::PointCondition(const std::string& text) : steps_(ConditionParser(text).parse()) {}

bool PointCondition::operator()(const Vec3& x) const {
  std::vector<double> stack;
  for (const Step& step : steps_) {
    if (step.op == Op::Constant) {
      stack.push_back(step.value);
    } else if (step.op == Op::X || step.op == Op::Y || step.op == Op::Z) {
      stack.push_back(x[static_cast<int>(step.op) - static_cast<int>(Op::X)]);
    } else if (takes_one(step.op)) {
      stack.back() = result(step, stack.back());
    } else {
      const double b = stack.back();
      stack.pop_back();
      stack.back() = result(step.op, stack.back(), b);
    }
  }
  return stack.back() != 0;
}

}  // namespace coapt
