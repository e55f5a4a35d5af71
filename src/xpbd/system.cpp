#include "xpbd/system.hpp"

#include <cmath>

namespace coapt {
namespace {

constexpr double kUsualElongation = 0.01;  // at which the slope of a law is taken before it was taut

ConstraintSense pulls(bool only) { return only ? ConstraintSense::PullsOnly : ConstraintSense::BothWays; }

// Compliance and stiffness of a constraint: its own, or the paper's.
struct Hardness {
  bool is_paper = false;
  XpbdPaper paper = {};

  double alpha(double stiffness) const { return is_paper ? paper.compliance : 1 / stiffness; }
  double alpha(const XpbdTether& tether) const {
    return is_paper && tether.kind != TetherKind::Edge ? paper.tether_compliance : alpha(tether.stiffness);
  }
  double length(const XpbdTether& tether) const { return is_paper && tether.is_clip ? 0 : tether.length; }
  double share(double of_paper) const { return is_paper ? of_paper : 1; }
};

std::vector<StretchConstraint> stretch_constraints(const XpbdBody& body, const Hardness& hardness) {
  std::vector<StretchConstraint> all;
  for (const XpbdEdge& e : body.edges)
    if (e.stiffness > 0)
      all.push_back({{e.a, e.b},
                     e.length,
                     hardness.alpha(e.stiffness),
                     hardness.share(hardness.paper.stretch),
                     pulls(e.only_tension && !hardness.is_paper)});
  return all;
}

std::vector<AreaConstraint> area_constraints(const XpbdBody& body, const Hardness& hardness) {
  std::vector<AreaConstraint> all;
  if (hardness.is_paper) return all;
  for (const XpbdArea& a : body.areas)
    if (a.stiffness > 0)
      all.push_back({a.nodes, a.area, hardness.alpha(a.stiffness), 1, pulls(a.only_growth)});
  return all;
}

std::vector<SquaredAreaConstraint> squared_area_constraints(const XpbdBody& body, const Hardness& hardness) {
  std::vector<SquaredAreaConstraint> all;
  if (!hardness.is_paper) return all;
  for (const XpbdArea& a : body.areas)
    if (a.stiffness > 0)
      all.push_back({a.nodes, 4 * a.area * a.area, hardness.paper.compliance, hardness.paper.area});
  return all;
}

std::vector<FilmConstraint> film_constraints(const XpbdBody& body, const Hardness& hardness) {
  std::vector<FilmConstraint> all;
  if (hardness.is_paper) return all;  // the paper has none
  for (const XpbdFilm& film : body.films)
    if (film.tension > 0) all.push_back({film.nodes, film.tension});
  return all;
}

std::vector<TriangleEnergyConstraint> energy_constraints(const XpbdBody& body, const Hardness& hardness) {
  std::vector<TriangleEnergyConstraint> all;
  if (hardness.is_paper) return all;
  for (const XpbdTriangle& triangle : body.others) all.push_back({triangle.nodes, triangle.energy});
  return all;
}

std::vector<BendingConstraint> bending_constraints(const XpbdBody& body, const Hardness& hardness) {
  std::vector<BendingConstraint> all;
  for (const XpbdHinge& hinge : body.hinges)
    if (hinge.stiffness > 0)
      all.push_back(
          {hinge.nodes, hardness.is_paper && hardness.paper.rest_angle == HingeRest::Flat ? 0 : hinge.angle,
           hardness.alpha(hinge.stiffness), hardness.share(hardness.paper.bending), hardness.is_paper});
  return all;
}

std::vector<StretchConstraint> tether_constraints(const XpbdBody& body, const Hardness& hardness) {
  std::vector<StretchConstraint> all;
  for (const XpbdTether& t : body.tethers) {
    const bool is_edge = t.kind == TetherKind::Edge;
    // What has a law and no length is a constant tension, which the paper has not.
    if ((hardness.is_paper && t.length > 0) || (!t.law && t.stiffness > 0))
      all.push_back({{t.a, t.b},
                     hardness.length(t),
                     hardness.alpha(t),
                     hardness.share(is_edge ? hardness.paper.stretch : hardness.paper.tether),
                     pulls(t.only_tension && !(hardness.is_paper && is_edge))});
  }
  return all;
}

// What contact must not push apart again.
std::vector<std::array<int, 2>> held_together(const XpbdBody& body, const Hardness& hardness,
                                              double thickness) {
  std::vector<std::array<int, 2>> all;
  for (const XpbdTether& t : body.tethers)
    if (t.kind == TetherKind::Link && hardness.length(t) < thickness) all.push_back({t.a, t.b});
  return all;
}

std::vector<LineConstraint> line_constraints(const XpbdBody& body, const Hardness& hardness) {
  std::vector<LineConstraint> all;
  if (hardness.is_paper) return all;
  for (const XpbdTether& t : body.tethers)
    if (t.law)
      all.push_back({{t.a, t.b},
                     t.length,
                     t.law,
                     t.law((1 + kUsualElongation) * t.length).stiffness,
                     pulls(t.only_tension)});
  return all;
}

}  // namespace

XpbdSystem::XpbdSystem(const XpbdBody& body, const Points& x,
                       const Eigen::Array<bool, 3, Eigen::Dynamic>& fixed, const Vector& masses,
                       const XpbdOptions& options)
    : options_(options),
      team_(options.threads),
      dt2_(std::pow(xpbd_time_step(options), 2)),
      w_(3, x.cols()),
      x_(x),
      before_(x) {
  const Hardness hardness{options.stiffness == XpbdStiffness::Paper, options.paper};
  for (Eigen::Index node = 0; node < x.cols(); ++node)
    for (int c = 0; c < 3; ++c) w_(c, node) = fixed(c, node) ? 0 : hardness.is_paper ? 1 : 1 / masses[node];
  const int count = static_cast<int>(x.cols());
  stretches_ = {stretch_constraints(body, hardness), count};
  areas_ = {area_constraints(body, hardness), count};
  squared_areas_ = {squared_area_constraints(body, hardness), count};
  films_ = {film_constraints(body, hardness), count};
  others_ = {energy_constraints(body, hardness), count};
  bends_ = {bending_constraints(body, hardness), count};
  tethers_ = {tether_constraints(body, hardness), count};
  lines_ = {line_constraints(body, hardness), count};
  if (body.has_contact)
    contact_.emplace(body, ContactOptions{options.thickness, options.features,
                                          hardness.is_paper ? hardness.paper.contact_compliance : 0,
                                          hardness.share(hardness.paper.contact),
                                          held_together(body, hardness, options.thickness)});
}

void XpbdSystem::step(const Points& force, const Points& prescribed) {
  const Points start = x_;
  x_ += (1 - options_.damping) * (x_ - before_) + dt2_ * w_.cwiseProduct(force);
  if (contact_)
    for (Eigen::Index node = 0; node < x_.cols(); ++node) {
      const Vec3 move = x_.col(node) - start.col(node);
      const double length = move.norm(), most = contact_->longest_move();
      if (length > most) x_.col(node) = start.col(node) + most / length * move;
    }
  x_ = (w_.array() > 0).select(x_, prescribed);
  before_ = start;
  const auto each = [&](const auto& act) {
    act(stretches_);
    act(areas_);
    act(squared_areas_);
    act(films_);
    act(others_);
    act(bends_);
    act(tethers_);
    act(lines_);
  };
  each([](auto& constraints) { constraints.begin_step(); });
  if (contact_) contact_->begin_step(start, x_);
  for (int k = 0; k < options_.iterations; ++k) {
    each([&](auto& constraints) { constraints.sweep(dt2_, w_, x_, team_); });
    if (contact_) contact_->sweep(dt2_, w_, x_, team_);
  }
}

double XpbdSystem::largest_move() const {
  return x_.cols() == 0 ? 0 : std::sqrt((x_ - before_).colwise().squaredNorm().maxCoeff());
}

double XpbdSystem::mean_move() const {
  return x_.cols() == 0 ? 0 : (x_ - before_).norm() / std::sqrt(static_cast<double>(x_.cols()));
}

double XpbdSystem::kinetic_energy() const {
  double twice = 0;
  for (Eigen::Index k = 0; k < w_.size(); ++k)
    if (const double w = w_.data()[k]; w > 0) twice += std::pow(x_.data()[k] - before_.data()[k], 2) / w;
  return 0.5 * twice / dt2_;
}

size_t XpbdSystem::constraint_count() const {
  return stretches_.size() + areas_.size() + squared_areas_.size() + films_.size() + others_.size() +
         bends_.size() + tethers_.size() + lines_.size();
}

}  // namespace coapt
