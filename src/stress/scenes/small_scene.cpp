#include "stress/scenes/small_scene.hpp"

#include "core/number_text.hpp"

#include <array>
#include <cmath>
#include <cstdint>

namespace coapt {
namespace {

class Choices {
 public:
  explicit Choices(std::string_view bytes) : bytes_(bytes) {}

  int below(int bound) { return next() % bound; }
  bool one_in(int n) { return below(n) == n - 1; }
  double between(double least, double greatest) { return least + (greatest - least) * next() / 255.0; }
  std::string decade(int least, int greatest) {
    return number_text(std::pow(10, between(least, greatest)), 6);
  }

 private:
  int next() {
    if (at_ == bytes_.size()) return 0;
    return static_cast<std::uint8_t>(bytes_[at_++]);
  }

  std::string_view bytes_;
  size_t at_ = 0;
};

// A grid of cells of 5 mm, its inner vertices shaken; now and then one falls onto another.
std::string mesh_text(Choices& choose) {
  const int columns = 1 + choose.below(3), rows = 1 + choose.below(3);
  const double shake = choose.one_in(8) ? 6 : choose.between(0, 2), rise = choose.between(0, 3);
  std::string text;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      text += "v " + number_text(5 * i + choose.between(-shake, shake), 6) + " " +
              number_text(5 * j + choose.between(-shake, shake), 6) + " " +
              number_text(choose.between(-rise, rise), 6) + "\n";
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = 1 + j * (columns + 1) + i, b = a + 1, d = a + columns + 1, c = d + 1;
      const std::array<int, 6> cut =
          choose.one_in(2) ? std::array{a, b, d, b, c, d} : std::array{a, b, c, a, c, d};
      for (int k = 0; k < 6; ++k)
        text += (k % 3 == 0 ? "f " : " ") + std::to_string(cut[static_cast<size_t>(k)]) +
                (k % 3 == 2 ? "\n" : "");
    }
  return text;
}

std::string support(Choices& choose) {
  switch (choose.below(5)) {
    case 0:
      return R"({"nodes": "boundary", "fix": true})";
    case 1:
      return R"({"nodes": [0, 1], "fix": true})";
    case 2:
      return R"({"nodes": [0, 1, 2], "fix": true}, {"nodes": [3], "fix": ["x", "z"]})";
    case 3:
      return R"({"nodes": "all", "fix": ["y"]}, {"nodes": [0, 1], "fix": true})";
    default:
      return R"({"nodes": [0], "fix": true})";
  }
}

std::string membrane(Choices& choose) {
  const std::string young = "\"young\": \"" + choose.decade(-3, 6) + " MPa\"",
                    thickness = ", \"thickness\": \"" + choose.decade(-4, 1) + " mm\"",
                    poisson = ", \"poisson\": " + number_text(choose.between(-0.5, 0.4999), 6);
  switch (choose.below(8)) {
    case 0:
      return R"({"type": "cst_tension_field", )" + young + thickness + poisson + "}";
    case 1:
      return R"({"type": "cst_stvk", )" + young + thickness + poisson + R"(, "prestress": ")" +
             choose.decade(-6, 1) + R"( N/mm"})";
    case 2:
      return R"({"type": "surface_tension", "tension": ")" + choose.decade(-4, 3) + R"( N/mm"})";
    case 3:
      return R"({"type": "cst_bilinear", "young_post": ")" + choose.decade(0, 4) +
             R"( MPa", "transition_strain": )" + number_text(choose.between(0.001, 0.5), 6) + thickness +
             poisson + "}";
    case 4:
      return R"({"type": "cst_neo_hookean", "shear_modulus": ")" + choose.decade(-3, 4) + R"( MPa")" +
             thickness + "}";
    case 5:
      return R"({"type": "cst_exponential", "c0": ")" + choose.decade(-4, 1) + R"( MPa", "c1": ")" +
             choose.decade(-5, 0) + R"( MPa", "c2": )" + number_text(choose.between(0, 50), 6) + thickness +
             "}";
    case 6:
      return R"({"type": "spring", )" + young + thickness + "}";
    default:
      return R"({"type": "cst_orthotropic", "fibre_young_pre": "1 MPa", "fibre_young_post": ")" +
             choose.decade(0, 3) + R"( MPa", "fibre_transition": 0.1, "cross_young_pre": "0.1 MPa",
             "cross_young_post": "1 MPa", "cross_transition": 0.2)" +
             thickness + "}";
  }
}

std::string line(Choices& choose) {
  const std::string edges = choose.one_in(2) ? R"(, "edges": "all")" : R"(, "edges": "boundary")";
  switch (choose.below(3)) {
    case 0:
      return R"({"type": "cable", "tension": ")" + choose.decade(-4, 3) + R"( N")" + edges + "}";
    case 1:
      return R"({"type": "cable", "young": ")" + choose.decade(-1, 6) + R"( MPa", "area": "0.4 mm^2")" +
             edges + "}";
    default:
      return R"({"type": "tether_cubic", "strength": ")" + choose.decade(-3, 6) + R"( mJ", "scale": ")" +
             choose.decade(-2, 1) + R"( mm")" + edges + "}";
  }
}

}  // namespace

SmallScene small_scene(std::string_view bytes) {
  Choices choose(bytes);
  SmallScene small;
  small.mesh = mesh_text(choose);
  std::string terms = membrane(choose);
  const std::string supports = support(choose);
  if (choose.one_in(2)) terms += R"(, {"type": "bending"})";
  if (choose.one_in(3)) terms += ", " + line(choose);
  const bool has_kinks =
      terms.find("cable") != std::string::npos || terms.find("spring") != std::string::npos;
  const bool has_contact = choose.one_in(4);
  if (has_contact) terms += R"(, {"type": "contact_barrier"})";
  const int pressure = choose.below(4);
  const bool is_follower = pressure == 0 && choose.one_in(2);
  if (pressure < 3)
    terms += R"(, {"type": "load_pressure", "value": ")" + choose.decade(-6, 3) + R"( kPa", "model": ")" +
             (is_follower ? "follower" : "frozen") + R"("})";
  static constexpr std::array<const char*, 3> kSolvers = {"newton", "lbfgs", "bfgs"};
  const std::string solver = kSolvers[static_cast<size_t>(choose.below(3))];
  small.has_one_potential = !is_follower && !has_contact && !(solver == "newton" && has_kinks);
  small.scene = R"({"mesh": {"file": "mesh.obj"}, "boundary": [)" + supports + R"(], "terms": [)" + terms +
                R"(], "solver": {"type": ")" + solver + R"(", "tolerance": 1e-8, "max_iterations": 200)" +
                (solver == "newton" && choose.one_in(2) ? R"(, "globalisation": "trust_region")" : "") + "}}";
  return small;
}

}  // namespace coapt
