#include "formats/febio/febio_materials.hpp"

#include "core/number_text.hpp"
#include "formats/text.hpp"
#include "formats/tissue_laws.hpp"

#include <algorithm>
#include <cmath>

namespace coapt::formats {
namespace {

constexpr double kGreatestPoisson = 0.4999;     // of the scene's linear membranes
constexpr double kLargestBelowHalf = 0.499999;  // where the bulk modulus is still a number to work with

// Twelve digits: what a product and a quotient leave of a number that somebody wrote.
double rounded(double value) {
  double result = 0;
  read_number(number_text(value, 12), result);
  return result;
}

// One point of a force curve: elongation from the distance of the nodes, and the force.
struct CurvePoint {
  double elongation = 0, force = 0;
};

std::vector<CurvePoint> curve(const pugi::xml_node& material, double distance, const FebioPlaces& places) {
  const double scale = places.number_or(material, "scale", 1);
  const std::string measure = trimmed(material.child("measure").text().as_string("elongation")).data();
  std::vector<CurvePoint> points;
  for (const pugi::xml_node& pt : material.child("force").child("points").children("pt")) {
    const auto pair = places.numbers(pt, pt.text().get());
    if (!pair || pair->size() != 2) return {};
    double elongation = (*pair)[0];
    if (measure.starts_with("strain"))
      elongation *= distance;
    else if (measure.starts_with("stretch"))
      elongation = (elongation - 1) * distance;
    points.push_back({elongation, scale * (*pair)[1]});
  }
  return points;
}

bool grows(const std::vector<CurvePoint>& points) {
  for (size_t k = 1; k < points.size(); ++k)
    if (!(points[k].elongation > points[k - 1].elongation)) return false;
  return true;
}

std::optional<FebioSpring> nonlinear(const pugi::xml_node& material, double distance,
                                     const FebioPlaces& places) {
  const std::string form = material.child("force").attribute("type").as_string();
  const std::vector<CurvePoint> points = curve(material, distance, places);
  const bool fits = form == "point" && points.size() >= 3 && grows(points) && points[0].force == 0 &&
                    points[1].force == 0 && points[2].force > 0;
  if (!fits) {
    places.add(material,
               "the curve of a nonlinear spring can be read where it has at least three points: zero at the "
               "first two, then tension");
    return std::nullopt;
  }
  FebioSpring spring;
  spring.rest_length = distance + points[1].elongation;
  spring.area = places.number_or(material, "scale", 1);
  if (spring.rest_length <= 0 || spring.area <= 0) {
    places.add(material, "the rest length and the scale of a spring must be positive");
    return std::nullopt;
  }
  const auto modulus = [&](size_t k) {
    const double slope =
        (points[k + 1].force - points[k].force) / (points[k + 1].elongation - points[k].elongation);
    return pressure_text(rounded(slope * spring.rest_length / spring.area));
  };
  if (points.size() == 3) {
    spring.law = {"cable", {{"young", modulus(1)}}};
  } else if (points.size() == 4) {
    const double strain = (points[2].elongation - points[1].elongation) / spring.rest_length;
    spring.law = {"cable_bilinear",
                  {{"young_pre", modulus(1)},
                   {"young_post", modulus(2)},
                   {"transition_strain", exact_text(rounded(strain))}}};
  }
  return spring;
}

}  // namespace

void FebioPlaces::add(const pugi::xml_node& node, const std::string& what) const {
  const auto offset = static_cast<size_t>(std::max<ptrdiff_t>(node.offset_debug(), 0));
  const auto line =
      1 + std::count(bytes_.begin(), bytes_.begin() + static_cast<ptrdiff_t>(std::min(offset, bytes_.size())),
                     '\n');
  defects_.add("line", line, "<" + std::string(node.name()) + ">: " + what);
}

std::optional<std::vector<double>> FebioPlaces::numbers(const pugi::xml_node& node,
                                                        const std::string& text) const {
  std::string blanks = text;
  std::replace(blanks.begin(), blanks.end(), ',', ' ');
  std::string_view rest = blanks;
  std::vector<double> values;
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
    double value = 0;
    if (const auto reason = read_number(word, value)) {
      add(node, *reason);
      return std::nullopt;
    }
    values.push_back(value);
  }
  return values;
}

std::optional<double> FebioPlaces::number(const pugi::xml_node& node) const {
  const auto values = numbers(node, node.text().get());
  if (!values) return std::nullopt;
  if (values->size() == 1) return (*values)[0];
  add(node, "expected one number");
  return std::nullopt;
}

double FebioPlaces::number_or(const pugi::xml_node& parent, const char* name, double otherwise) const {
  const pugi::xml_node node = parent.child(name);
  return node ? number(node).value_or(otherwise) : otherwise;
}

double FebioPlaces::required(const pugi::xml_node& parent, const char* name) const {
  if (!parent.child(name)) add(parent, std::string("<") + name + "> is missing");
  return number_or(parent, name, 0);
}

pugi::xml_node febio_named(const pugi::xml_node& parent, const char* tag, const std::string& name) {
  for (const pugi::xml_node& node : parent.children(tag))
    if (name == node.attribute("name").as_string() || name == node.attribute("id").as_string()) return node;
  return {};
}

std::optional<Material> febio_shell_law(const pugi::xml_node& material, double thickness,
                                        const FebioPlaces& places) {
  const std::string type = material.attribute("type").as_string();
  bool is_sound = true;
  const auto value = [&](const char* name) { return places.required(material, name); };
  const auto positive = [&](const char* name) {
    const double number = places.required(material, name);
    if (number > 0 || !material.child(name)) return number;
    places.add(material.child(name), "must be positive");
    is_sound = false;
    return 1.0;
  };
  const auto not_negative = [&](const char* name) {
    const double number = value(name);
    if (number >= 0) return number;
    places.add(material.child(name), "must not be negative");
    is_sound = false;
    return 0.0;
  };
  const auto poisson_up_to = [&](double greatest) {
    const double number = value("v");
    if (number > -1 && number <= greatest) return number;
    places.add(material.child("v"), "Poisson's ratio must lie above -1 and up to " + exact_text(greatest));
    is_sound = false;
    return 0.0;
  };
  Material law;
  if (type == "isotropic elastic") {
    const double young = positive("E"), poisson = std::min(poisson_up_to(0.5), kGreatestPoisson);
    law = {"cst_stvk", {{"young", pressure_text(young)}, {"poisson", exact_text(poisson)}}};
  } else if (type == "neo-Hookean") {
    const double young = positive("E"), poisson = poisson_up_to(kLargestBelowHalf);
    law = {"cst_neo_hookean",
           {{"shear_modulus", pressure_text(rounded(young / (2 * (1 + poisson))))},
            {"bulk", pressure_text(rounded(young / (3 * (1 - 2 * poisson))))}}};
  } else if (type == "incomp neo-Hookean") {
    law = {"cst_neo_hookean", {{"shear_modulus", pressure_text(positive("G"))}}};
  } else if (type == "Mooney-Rivlin" && places.number_or(material, "c2", 0) == 0) {
    law = {"cst_neo_hookean", {{"shear_modulus", pressure_text(2 * positive("c1"))}}};
  } else if (type == "isotropic Lee-Sacks" || type == "uncoupled isotropic Lee-Sacks") {
    law = {"cst_exponential",
           {{"c0", pressure_text(positive("c0"))},
            {"c1", pressure_text(not_negative("c1"))},
            {"c2", exact_text(not_negative("c2"))}}};
    if (type == "isotropic Lee-Sacks") law.keys.emplace_back("bulk", pressure_text(positive("k")));
  } else {
    places.add(material, "no law of a scene is like " + formats::quoted(type));
    return std::nullopt;
  }
  if (!is_sound) return std::nullopt;
  law.keys.emplace_back("thickness", length_text(thickness));
  return law;
}

std::optional<FebioSpring> febio_spring(const pugi::xml_node& material, double distance,
                                        const FebioPlaces& places) {
  const std::string type = material.attribute("type").as_string();
  if (type == "nonlinear spring") return nonlinear(material, distance, places);
  if (type != "linear spring" && type != "tension-only linear spring") {
    places.add(material, "no law of a scene is like " + formats::quoted(type));
    return std::nullopt;
  }
  // A stiffness alone: the cross-section that a cable of 1 MPa needs for it.
  const double stiffness = places.required(material, "E");
  if (stiffness <= 0) {
    places.add(material, "E must be positive");
    return std::nullopt;
  }
  return FebioSpring{
      distance, stiffness * distance, {"cable", {{"young", pressure_text(1)}}}, type[0] == 'l'};
}

}  // namespace coapt::formats
