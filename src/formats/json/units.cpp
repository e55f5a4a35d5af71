#include "formats/json/units.hpp"

#include "core/error.hpp"
#include "formats/json/suggestion.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace coapt {
namespace {

// One unit is mantissa x 10^exponent internal units. Powers of ten are kept apart, so that "0.65 mm" is
// the double nearest to 0.65 and no product of rounded factors.
struct Symbol {
  std::string_view name;
  double mantissa;
  int exponent;
  Dimension dimension;
  bool takes_prefix;
};

constexpr std::array kSymbols{
    Symbol{"m", 1, 3, kLength, true},
    Symbol{"g", 1, -6, kMass, true},
    Symbol{"t", 1, 0, kMass, false},
    Symbol{"s", 1, 0, kTime, true},
    Symbol{"N", 1, 0, kForce, true},
    Symbol{"dyn", 1, -5, kForce, false},
    Symbol{"Pa", 1, -6, kPressure, true},
    Symbol{"bar", 1, -1, kPressure, true},
    Symbol{"mmHg", 133.322387415, -6, kPressure, false},  // NIST SP 811
    Symbol{"cmH2O", 98.0665, -6, kPressure, false},       // conventional
    Symbol{"psi", 6894.757293168361, -6, kPressure, false},
    Symbol{"J", 1, 3, kEnergy, true},
    Symbol{"rad", 1, 0, kAngle, true},
    Symbol{"deg", std::numbers::pi / 180, 0, kAngle, false},
    Symbol{"%", 1, -2, kDimensionless, false},
};

struct Prefix {
  std::string_view name;
  int exponent;
};

constexpr std::array kPrefixes{Prefix{"T", 12}, Prefix{"G", 9},  Prefix{"M", 6},       Prefix{"k", 3},
                               Prefix{"h", 2},  Prefix{"d", -1}, Prefix{"c", -2},      Prefix{"m", -3},
                               Prefix{"u", -6}, Prefix{"n", -9}, Prefix{"\u00b5", -6}, Prefix{"\u03bc", -6}};

struct NamedDimension {
  Dimension dimension;
  const char* name;
  const char* unit;
  const char* example;
  const char* units;  // that messages name
};

constexpr std::array kNamed{
    NamedDimension{kDimensionless, "number", "1", "0.45", "%"},
    NamedDimension{kLength, "length", "mm", "0.65 mm", "mm, cm, m, um"},
    NamedDimension{kArea, "area", "mm^2", "0.3 mm^2", "mm^2, cm^2, m^2"},
    NamedDimension{kPressure, "pressure", "MPa", "120 mmHg",
                   "Pa, kPa, MPa, GPa, N/mm^2, mmHg, cmH2O, bar, psi"},
    NamedDimension{kForce, "force", "N", "2 N", "N, mN, kN, dyn"},
    NamedDimension{kForcePerLength, "force per length", "N/mm", "1000 N/m", "N/m, N/mm, mN/mm, dyn/cm"},
    NamedDimension{kForcePerVolume, "force per volume", "N/mm^3", "0.1 N/mm^3", "N/mm^3, N/m^3"},
    NamedDimension{kDensity, "mass density", "t/mm^3", "1060 kg/m^3", "kg/m^3, g/cm^3, t/mm^3"},
    NamedDimension{kAcceleration, "acceleration", "mm/s^2", "9.81 m/s^2", "m/s^2, mm/s^2"},
    NamedDimension{kEnergy, "energy", "mJ", "0.05 N*m", "J, mJ, N*m"},
    NamedDimension{kMass, "mass", "t", "20 g", "g, kg, t"},
    NamedDimension{kTime, "time", "s", "10 ms", "s, ms"},
    NamedDimension{kAngle, "angle", "rad", "30 deg", "deg, rad"},
};

const NamedDimension* named(Dimension dimension) {
  for (const NamedDimension& entry : kNamed)
    if (entry.dimension == dimension) return &entry;
  return nullptr;
}

std::string quoted(std::string_view text) { return "\"" + std::string(text) + "\""; }

// A near one, or else those of the dimension that is expected.
[[noreturn]] void refuse_unit(std::string_view unit, const Dimension* expected) {
  static const std::vector<std::string> kCommon{"mm",  "cm",   "m", "um", "Pa",  "kPa", "MPa", "GPa",
                                                "bar", "mmHg", "N", "mN", "kN",  "dyn", "J",   "mJ",
                                                "kg",  "g",    "s", "ms", "psi", "deg", "rad", "t"};
  const NamedDimension* wanted = expected == nullptr ? nullptr : named(*expected);
  std::string known = suggestion(unit, kCommon);
  if (known.empty() && wanted != nullptr && *expected != kDimensionless)
    known = std::string("; a ") + wanted->name + " has one of " + wanted->units;
  else if (known.empty())
    known = "; known are " + listed(kCommon) + ", their products, quotients and powers";
  throw InputError("unknown unit " + quoted(unit) + known);
}

double scaled(double value, double mantissa, int exponent) {
  const double power = std::pow(10.0, std::abs(exponent));  // exact up to 10^22
  return exponent < 0 ? value * mantissa / power : value * mantissa * power;
}

std::optional<Symbol> find_symbol(std::string_view text) {
  for (const Symbol& symbol : kSymbols)
    if (symbol.name == text) return symbol;
  for (const Prefix& prefix : kPrefixes) {
    if (!text.starts_with(prefix.name)) continue;
    for (Symbol symbol : kSymbols) {
      if (!symbol.takes_prefix || symbol.name != text.substr(prefix.name.size())) continue;
      symbol.exponent += prefix.exponent;
      return symbol;
    }
  }
  return std::nullopt;
}

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Reads one unit text from left to right.
class UnitParser {
 public:
  UnitParser(std::string_view text, const Dimension* expected)
      : text_(text), rest_(text), expected_(expected) {}

  Symbol parse() {
    Symbol product{"", 1, 0, kDimensionless, false};
    for (bool first = true;; first = false) {
      const bool divides = skip_separators(first);
      if (rest_.empty()) {
        if (divides) refuse_unit(text_, expected_);
        return product;
      }
      const Symbol symbol = next_symbol();
      multiply(product, symbol, divides ? -next_power() : next_power());
    }
  }

 private:
  // Skips blanks, "*" and the middle dot; returns whether a "/" was among them.
  bool skip_separators(bool first) {
    bool divides = false;
    int operators = 0;
    while (!rest_.empty()) {
      if (is_blank(rest_[0])) {
        rest_.remove_prefix(1);
      } else if (rest_[0] == '*' || rest_[0] == '/') {
        divides = rest_[0] == '/';
        ++operators;
        rest_.remove_prefix(1);
      } else if (rest_.starts_with("\u00b7")) {
        ++operators;
        rest_.remove_prefix(2);
      } else {
        break;
      }
    }
    if (operators > 1 || (first && operators > 0 && !divides) || (operators > 0 && rest_.empty()))
      refuse_unit(text_, expected_);
    return divides;
  }

  Symbol next_symbol() {
    size_t size = 0;
    if (rest_.starts_with("cmH2O")) {
      size = 5;
    } else {
      while (size < rest_.size() && is_symbol(rest_.substr(size))) ++size;
    }
    const std::string_view word = rest_.substr(0, size);
    const std::optional<Symbol> symbol = find_symbol(word);
    if (!symbol) refuse_unit(word.empty() ? text_ : word, expected_);
    rest_.remove_prefix(size);
    return *symbol;
  }

  static bool is_symbol(std::string_view at) {
    const unsigned char c = static_cast<unsigned char>(at[0]);
    if (at.starts_with("\u00b7") || at.starts_with("\u00b2") || at.starts_with("\u00b3")) return false;
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%' || c >= 0x80;
  }

  int next_power() {
    for (const auto& [superscript, power] : {std::pair{"\u00b2", 2}, std::pair{"\u00b3", 3}})
      if (rest_.starts_with(superscript)) {
        rest_.remove_prefix(2);
        return power;
      }
    const bool caret = rest_.starts_with('^');
    if (caret) rest_.remove_prefix(1);
    int power = 1;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), power);
    if (error != std::errc{}) {
      if (caret) refuse_unit(text_, expected_);
      return 1;
    }
    constexpr int kGreatestPower = 9;
    if (std::abs(power) > kGreatestPower) refuse_unit(text_, expected_);
    rest_.remove_prefix(static_cast<size_t>(end - rest_.data()));
    return power;
  }

  static void multiply(Symbol& product, const Symbol& factor, int power) {
    product.mantissa *= std::pow(factor.mantissa, power);
    product.exponent += factor.exponent * power;
    product.dimension.length += factor.dimension.length * power;
    product.dimension.mass += factor.dimension.mass * power;
    product.dimension.time += factor.dimension.time * power;
    product.dimension.angle += factor.dimension.angle * power;
  }

  std::string_view text_, rest_;
  const Dimension* expected_;  // null: any
};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

namespace {

Quantity parse(std::string_view text, const Dimension* expected) {
  std::string_view rest = trimmed(text);
  if (rest.starts_with('+') && !rest.starts_with("+-")) rest.remove_prefix(1);
  const size_t first = rest.starts_with('-') ? 1 : 0;
  // from_chars would take "nan" and "inf" for numbers.
  const bool is_number = rest.size() > first && (is_digit(rest[first]) || rest[first] == '.');
  double value = 0;
  const char* end = rest.data();
  if (is_number) {
    const auto result = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (result.ec == std::errc::result_out_of_range)
      throw InputError("read " + quoted(text) + ": the number is out of range");
    if (result.ec == std::errc{}) end = result.ptr;
  }
  if (end == rest.data())
    throw InputError("read " + quoted(text) + ", which does not start with a finite number");
  const Symbol unit = UnitParser(rest.substr(static_cast<size_t>(end - rest.data())), expected).parse();
  value = scaled(value, unit.mantissa, unit.exponent);
  if (!std::isfinite(value)) throw InputError("read " + quoted(text) + ": the number is out of range");
  return {value, unit.dimension};
}

}  // namespace

Quantity parse_quantity(std::string_view text) { return parse(text, nullptr); }

double quantity_value(std::string_view text, Dimension expected) {
  const Quantity quantity = parse(text, &expected);
  if (quantity.dimension == expected) return quantity.value;
  if (quantity.dimension == kDimensionless && quantity.value == 0) return 0;
  const std::string wanted =
      "expected a " + dimension_name(expected) + " such as \"" + dimension_example(expected) + "\"";
  if (quantity.dimension == kDimensionless)
    throw InputError("read " + quoted(text) + ", which has no unit; " + wanted);
  throw InputError("read " + quoted(text) + ", a " + dimension_name(quantity.dimension) + "; " + wanted);
}

double unit_factor(std::string_view unit, Dimension expected) {
  const Symbol symbol = UnitParser(trimmed(unit), &expected).parse();
  if (symbol.dimension != expected)
    throw InputError("read " + quoted(unit) + ", a unit of " + dimension_name(symbol.dimension) +
                     "; expected a unit of " + dimension_name(expected) + " such as \"" +
                     internal_unit(expected) + "\"");
  return scaled(1, symbol.mantissa, symbol.exponent);
}

std::string dimension_name(Dimension dimension) {
  const NamedDimension* entry = named(dimension);
  return entry != nullptr ? entry->name : "quantity in " + internal_unit(dimension);
}

std::string internal_unit(Dimension dimension) {
  if (const NamedDimension* entry = named(dimension)) return entry->unit;
  std::string text;
  const std::array<std::pair<const char*, int>, 4> powers{
      {{"mm", dimension.length}, {"t", dimension.mass}, {"s", dimension.time}, {"rad", dimension.angle}}};
  for (const auto& [unit, power] : powers)
    if (power != 0)
      text.append(text.empty() ? "" : "*").append(unit).append("^").append(std::to_string(power));
  return text;
}

std::string dimension_example(Dimension dimension) {
  const NamedDimension* entry = named(dimension);
  return entry != nullptr ? entry->example : "1 " + internal_unit(dimension);
}

}  // namespace coapt
