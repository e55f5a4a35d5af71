// Films, prestress, bending, springs, lines, loads and contact far from rest (stretched_states.hpp), with the
// parameters of the models that come with the shared data beside those of the other tests.
#include "energy/contact_barrier.hpp"
#ifdef COAPT_HAS_NANOFLANN
#include "energy/contact_facet.hpp"
#endif
#include "energy/kernels/bending.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/kernels/cst_prestress.hpp"
#include "energy/kernels/link.hpp"
#include "energy/kernels/surface_tension.hpp"
#include "energy/kernels/tether_cubic.hpp"
#include "energy/load_dead.hpp"
#include "energy/load_pressure.hpp"
#include "stretched_states.hpp"
#include "support/spring_sheet.hpp"
#include "support/tissue_laws.hpp"

#include <numbers>

namespace coapt {
namespace {

Kind prestressed(double warp, double weft) {
  Kind kind{
      "prestress " + std::to_string(weft), [=](const Frame& f, const Points& X, const Triangles& triangles) {
        const double unit = f.force / f.length;
        return on_triangles<CstPrestress>(X, triangles, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
          return CstPrestress::rest(a, b, c, f.rotation * kFibre, warp * unit, weft * unit);
        });
      }};
  kind.is_zero_at_rest = false;
  return kind;
}

Kind bending() {
  Kind kind{"bending", [](const Frame& f, const Points& X, const Triangles& t) {
              // The edge that both triangles share, then the corners opposite.
              std::vector<int> nodes;
              for (int k = 0; k < 3; ++k) {
                const int a = t(k, 0), b = t((k + 1) % 3, 0);
                for (int m = 0; m < 3; ++m)
                  if (t(m, 1) == b && t((m + 1) % 3, 1) == a)
                    nodes = {a, b, t((k + 2) % 3, 0), t((m + 2) % 3, 1)};
              }
              return std::make_unique<ElementTerm<BendingHinge>>(
                  "bending", nodes,
                  std::vector{BendingHinge::rest(X.col(nodes[0]), X.col(nodes[1]), X.col(nodes[2]),
                                                 X.col(nodes[3]), 0.7 * f.force * f.length)});
            }};
  kind.mesh.vertices(2, 3) = 0.2;
  return kind;
}

std::vector<Kind> other_surfaces() {
  Kind film{
      "film", [](const Frame& f, const Points&, const Triangles& t) {
        return std::make_unique<ElementTerm<SurfaceTension>>(
            "film", triangle_nodes(t),
            std::vector<SurfaceTension::Rest>(static_cast<size_t>(t.cols()), {1.3 * f.force / f.length}));
      }};
  film.is_zero_at_rest = false;
  std::vector<Kind> kinds{film, prestressed(1.7, 0.6), prestressed(1, 1),
                          bending()};  // 1, 1: that of the tent
  for (const bool resists : {false, true}) {
    const auto springs = [&](const std::string& label, SpringSheet sheet) {
      sheet.resists = resists;
      sheet.direction = kFibre;
      kinds.push_back({label, [sheet](const Frame& f, const Points& X, const Triangles& t) {
                         SpringSheet scaled = sheet;
                         for (BilinearLine* line : {&scaled.fibre, &scaled.cross}) {
                           line->young *= stress_unit(f);
                           line->knee.modulus *= stress_unit(f);
                         }
                         scaled.thickness *= f.length;
                         scaled.direction = f.rotation * sheet.direction;
                         return spring_term(X, t, scaled);
                       }});
      kinds.back().can_be_slack = !resists;
    };
    springs(resists ? "springs" : "slack springs", linear_springs(2, 0.4));
    SpringSheet curved = linear_springs(1, 0.4);
    curved.fibre.knee = {9, 0.2, 0.05};
    curved.cross = {0.3, {1.7, 0.3, 0.04}};
    springs(resists ? "bilinear springs" : "bilinear slack springs", curved);
  }
  return kinds;
}

std::vector<Kind> loads_and_contact() {
  std::vector<Kind> kinds;
  for (const bool is_follower : {false, true}) {
    Kind pressure{
        is_follower ? "follower" : "volume", [=](const Frame& f, const Points& X, const Triangles& t) {
          const auto make = is_follower ? make_follower_pressure : make_volume_pressure;
          return make("pressure", X, t, 0.8 * stress_unit(f), FixedMask::Constant(3, X.cols(), false));
        }};
    pressure.mesh = sphere_mesh(0);
    pressure.is_zero_at_rest = false;
    kinds.push_back(pressure);
  }
  Kind dead{"dead load", [](const Frame& f, const Points& X, const Triangles&) {
              return std::make_unique<LoadDead>("load", "load_field",
                                                f.forces(shaken(Points::Zero(3, 4), 1, 12)), X);
            }};
  dead.is_zero_at_rest = dead.ignores_rigid_motion = dead.has_hessian = false;
  kinds.push_back(dead);
  // Two sheets, at rest far apart.
  Kind contact{"contact barrier", [](const Frame& f, const Points& X, const Triangles& t) {
                 ContactBarrierOptions options;
                 options.gap = 0.3 * f.length;
                 options.pressure = 1.3 * stress_unit(f);
                 return make_contact_barrier("contact", X, t, options);
               }};
  // Turned, so that no edges are parallel: what takes those out of the energy has a scale of its own.
  TriangleMesh upper = Kind::two_triangles();
  upper.vertices = Eigen::AngleAxisd(0.5, Vec3::UnitZ()).toRotationMatrix() * upper.vertices;
  contact.mesh = joined(Kind::two_triangles(), moved(upper, Vec3(0.25, -0.2, 2)));
  contact.above = 0.12;
  kinds.push_back(contact);
#ifdef COAPT_HAS_NANOFLANN
  contact.label = "contact of facets";
  contact.make = [](const Frame& f, const Points& X, const Triangles& t) {
    ContactFacetOptions options;
    options.range = 0.3 * f.length;
    options.exponent = 3;
    options.strength = 1.7 * stress_unit(f) / f.length;
    return make_contact_facet("contact", X, t, options);
  };
  kinds.push_back(contact);
#endif
  return kinds;
}

// --- Lines --------------------------------------------------------------------------------------------

// On three edges of the mesh.
template <typename Kernel, typename RestOf>
Kind on_lines(const std::string& label, const RestOf& rest_of, bool can_be_slack) {
  Kind kind{label, [rest_of](const Frame& f, const Points& X, const Triangles&) {
              const std::vector<int> nodes = f.nodes({0, 1, 0, 2, 0, 3});
              std::vector<typename Kernel::Rest> rest;
              for (size_t k = 0; k < nodes.size(); k += 2)
                rest.push_back(rest_of(f, (X.col(nodes[k + 1]) - X.col(nodes[k])).norm()));
              return std::make_unique<ElementTerm<Kernel>>("lines", nodes, rest);
            }};
  kind.can_be_slack = can_be_slack;
  return kind;
}

template <typename LawOf>
void add_chord(std::vector<Kind>& kinds, const std::string& label, const LawOf& law_of) {
  using Kernel = CableLaw<decltype(law_of(1.0))>;
  kinds.push_back(on_lines<Kernel>(
      label,
      [=](const Frame& f, double length) {
        return Kernel::rest(length, 0.3 * f.length * f.length, 0.002, law_of(stress_unit(f)));
      },
      true));
}

std::vector<Kind> lines() {
  std::vector<Kind> kinds;
  kinds.push_back(on_lines<Link>(
      "link",
      [](const Frame& f, double length) {
        return Link::Rest{2 * f.force / f.length, length};
      },
      false));
  kinds.push_back(on_lines<TetherCubic>(
      "tether",
      [](const Frame& f, double length) {
        return TetherCubic::Rest{2 * f.force * f.length, length, length};
      },
      true));
  // The second with the lines of the parachute, in their units.
  for (const double stiffness : {3.0, 2.07e9 * 1.3e-4 * 1.3e-4 * 0.25 * std::numbers::pi})
    kinds.push_back(on_lines<Cable>(
        "cable " + std::to_string(stiffness),
        [=](const Frame& f, double length) {
          return Cable::Rest{stiffness * f.force / length, length, 0.002 * length, 0};
        },
        true));
  add_chord(kinds, "bilinear chord", laws::BilinearChord::law);
  add_chord(kinds, "Ogden chord", laws::OgdenChord::law);
  add_chord(kinds, "toe chord", laws::ToeChord::law);
  add_chord(kinds, "crimped chord", laws::CrimpedChord::law);
  add_chord(kinds, "crimped chord in matrix", laws::CrimpedChordInMatrix::law);
  add_chord(kinds, "yielding chord", laws::YieldingChord::law);
  // Of the shared data: fibres and chords of the mitral valve, then chords of the three tricuspid leaflets.
  add_chord(kinds, "mitral fibre", [](double s) { return ToeLine{32.5 * s, 0.125, 0.145, 49.9643}; });
  add_chord(kinds, "anterior chord", [](double s) {
    return OgdenLine{{18.884147787 * s, 22.682992286 * s, 19.502933935 * s},
                     {98.253655, 98.251894, 98.253229}};
  });
  add_chord(kinds, "posterior chord", [](double s) {
    return OgdenLine{{4.241553985 * s, 2.724796147 * s, 3.7265674e-5 * s}, {55.914887, 55.915477, 70.715073}};
  });
  add_chord(kinds, "septal chord", [](double s) {
    return OgdenLine{{33.753478488 * s, 1.4596286e-5 * s, 0.020343017 * s},
                     {1.531671e-4, 3.48813e-4, 113.447387}};
  });
  return kinds;
}

// A line with a millionth too much beyond a length.
struct Jumping {
  static constexpr int kNodes = 2;
  static constexpr std::string_view kType = "jumping";
  static constexpr TermRole kRole = TermRole::Internal;
  using Rest = Link::Rest;
  static double evaluate(const Rest& rest, const Eigen::Vector<double, 6>& x, Eigen::Vector<double, 6>* g,
                         Eigen::Matrix<double, 6, 6>* H) {
    const double energy = Link::evaluate(rest, x, g, H);
    return energy * ((x.tail<3>() - x.head<3>()).norm() > 1.3 ? 1 + 1e-6 : 1);
  }
};

TEST(StretchedTerms, AJumpIsFoundWhereItIs) {
  Points from(3, 2), to(3, 2);
  from << 0, 1, 0, 0, 0, 0;
  to << 0, 2, 0, 0, 0, 0;
  ElementTerm<Jumping> jumping("jumping", {0, 1}, {{2, 0.7}});
  ElementTerm<Link> right("right", {0, 1}, {{2, 0.7}});
  Way over(jumping, from, to), along(right, from, to);
  EXPECT_NEAR(over.jump(over.at(0.29), over.at(0.31), 0), 0.3, 1e-6);
  EXPECT_LT(along.jump(along.at(0.29), along.at(0.31), 0), 0);
}

TEST(StretchedTerms, FilmsBendingAndSpringsPassTheSuite) { examine_and_follow(other_surfaces()); }
TEST(StretchedTerms, LinesPassTheSuite) { examine_and_follow(lines()); }
TEST(StretchedTerms, LoadsAndContactPassTheSuite) { examine_and_follow(loads_and_contact()); }

}  // namespace
}  // namespace coapt
