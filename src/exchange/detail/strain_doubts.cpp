#include "exchange/detail/strain_doubts.hpp"

#include "core/number_text.hpp"
#include "scene/terms/term_types.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <set>

namespace coapt::detail {
namespace {

constexpr double kKilopascals = 1000;  // in one MPa

// Between them lie all scenes of the examples, from 9e-4 to 0.08, and valves of any heart.
constexpr double kGreatStrain = 0.5, kSmallStrain = 1e-4;

// Half of the second greatest extent along the mesh's own axes: of a disc or a sphere its radius, of a tube
// or a strip half of the width. [mm]
double radius_of(const Model& model) {
  const Points x = model.X.leftCols(model.mesh.vertex_count());
  const Points centred = x.colwise() - Vec3(x.rowwise().mean());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(Eigen::Matrix3d(centred * centred.transpose()));
  const Points turned = axes.eigenvectors().transpose() * centred;
  std::array<double, 3> extents;
  for (int axis = 0; axis < 3; ++axis)
    extents[static_cast<size_t>(axis)] = turned.row(axis).maxCoeff() - turned.row(axis).minCoeff();
  std::sort(extents.begin(), extents.end());
  return 0.5 * extents[1];
}

class Membranes {
 public:
  Membranes(const Scene& scene, const Model& model) : model_(model) {
    std::set<std::string> names;
    for (const TermSpec& term : scene.terms)
      if (const TermKind kind = kind_of(term); kind == TermKind::Membrane || kind == TermKind::Spring)
        names.insert(term.name);
    for (const auto& term : model.objective->terms())
      if (names.contains(term->name())) terms_.push_back(term.get());
    for (Eigen::Index t = 0; t < model.mesh.triangles.cols(); ++t)
      area_ += area_vector(model.X, model.mesh.triangles.col(t)).norm();
  }

  bool has_any() const { return !terms_.empty() && area_ > 0; }

  // Over a length of the stretched surface, in the mean over both directions and all triangles [N/mm].
  double tension(double stretch) const {
    Points gradient = Points::Zero(3, model_.X.cols());
    Sink sink(gradient.data());
    for (const EnergyTerm* term : terms_) term->evaluate(stretch * model_.X, sink);
    return gradient.cwiseProduct(model_.X).sum() / (2 * area_ * stretch);
  }

 private:
  const Model& model_;
  std::vector<const EnergyTerm*> terms_;
  double area_ = 0;
};

}  // namespace

std::vector<std::string> strain_doubts(const Scene& scene, const Model& model, bool is_valve) {
  if (!(model.applied_pressure > 0) || model.film_tension > 0 || model.mesh.triangle_count() == 0) return {};
  const Membranes membranes(scene, model);
  if (!membranes.has_any()) return {};
  const double wanted = 0.5 * model.applied_pressure * radius_of(model);
  const auto bears = [&](double strain) { return membranes.tension(1 + strain); };
  const auto doubt = [&](const std::string& what, double strain) {
    return "the pressure of " + number_text(kKilopascals * model.applied_pressure) +
           " kPa stretches the membrane by " + what + " " + number_text(100 * strain) +
           " %, by a rough estimate: a surface of radius " + number_text(radius_of(model)) + " mm takes " +
           number_text(wanted) + " N/mm, and the membrane, stretched that far both ways, bears " +
           number_text(bears(strain)) + " N/mm. Check the units of pressure, stiffness and thickness.";
  };
  if (bears(kGreatStrain) < wanted) return {doubt("more than", kGreatStrain)};
  if (is_valve && bears(kSmallStrain) > wanted) return {doubt("less than", kSmallStrain)};
  return {};
}

}  // namespace coapt::detail
