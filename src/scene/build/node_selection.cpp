#include "scene/build/node_selection.hpp"

#include "core/error.hpp"
#include "formats/json/point_condition.hpp"
#include "formats/json/suggestion.hpp"

#include <algorithm>

namespace coapt {
namespace {

std::vector<int> named_set(const std::string& name, const Model& model, const std::string& where) {
  const auto found = model.sets.find(name);
  if (found != model.sets.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& entry : model.sets) names.push_back(entry.first);
  throw InputError(where + ": no node set \"" + name + "\"; known sets: " + listed(names) +
                   suggestion(name, names));
}

template <typename Test>
std::vector<int> nodes_where(const Model& model, Test&& test) {
  std::vector<int> nodes;
  for (int node = 0; node < model.X.cols(); ++node)
    if (test(Vec3(model.X.col(node)))) nodes.push_back(node);
  return nodes;
}

std::vector<int> geometric(const NodeSelection& selection, const Model& model) {
  constexpr double kRelativeWithin = 1e-6;
  const double round_off = kRelativeWithin * bounding_box_diagonal(model.X);
  const Vec3 point = selection.point - model.origin;
  const auto height = [&](const Vec3& x) { return selection.normal.dot(x - point); };
  switch (selection.kind) {
    case NodeSelection::Kind::Plane: {
      const double within = selection.within > 0 ? selection.within : round_off;
      return nodes_where(model, [&](const Vec3& x) { return std::abs(height(x)) <= within; });
    }
    case NodeSelection::Kind::HalfSpace:
      return nodes_where(model, [&](const Vec3& x) { return height(x) >= -round_off; });
    case NodeSelection::Kind::Box: {
      const Vec3 high = selection.high - model.origin;
      return nodes_where(model, [&](const Vec3& x) {
        return (x.array() >= point.array()).all() && (x.array() <= high.array()).all();
      });
    }
    case NodeSelection::Kind::Sphere:
      return nodes_where(model, [&](const Vec3& x) { return (x - point).norm() <= selection.within; });
    case NodeSelection::Kind::Condition:
      return nodes_where(model, [&, holds = PointCondition(selection.text)](const Vec3& x) {
        return holds(x + model.origin);
      });
    default: {
      Eigen::Index nearest = 0;
      (model.X.colwise() - point).colwise().squaredNorm().minCoeff(&nearest);
      return {static_cast<int>(nearest)};
    }
  }
}

}  // namespace

std::vector<int> selected_nodes(const NodeSelection& selection, const Model& model,
                                const std::string& where) {
  if (selection.kind == NodeSelection::Kind::Set) return named_set(selection.text, model, where);
  if (selection.kind == NodeSelection::Kind::Indices) {
    for (const int node : selection.indices)
      if (node >= model.X.cols())
        throw InputError(where + ": node " + std::to_string(node) + " does not exist; the scene has " +
                         std::to_string(model.X.cols()) + ", counted from 0");
    return selection.indices;
  }
  std::vector<int> nodes = geometric(selection, model);
  if (nodes.empty()) throw InputError(where + ": selects no node");
  return nodes;
}

}  // namespace coapt
