#include "scene/supports.hpp"

#include "mesh/mesh_check.hpp"

#include <algorithm>
#include <numeric>

namespace coapt {
namespace {

// "3, 5, 8" and how many more.
std::string first_few(const std::vector<int>& nodes) {
  constexpr size_t kFew = 5;
  std::string text;
  for (size_t k = 0; k < std::min(kFew, nodes.size()); ++k)
    text.append(k == 0 ? "" : ", ").append(std::to_string(nodes[k]));
  return nodes.size() > kFew ? text + " and " + std::to_string(nodes.size() - kFew) + " more" : text;
}

bool has_term(const Scene& scene, const std::string& type) {
  return std::any_of(scene.terms.begin(), scene.terms.end(),
                     [&](const TermSpec& term) { return term.type == type; });
}

// Union of the nodes that an element couples: each node points to another of its part, roots to themselves.
class Parts {
 public:
  explicit Parts(int node_count) : parent_(static_cast<size_t>(node_count)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  int root(int node) {
    while (parent_[static_cast<size_t>(node)] != node) {
      int& parent = parent_[static_cast<size_t>(node)];
      parent = parent_[static_cast<size_t>(parent)];
      node = parent;
    }
    return node;
  }

  void join(int a, int b) { parent_[static_cast<size_t>(root(a))] = root(b); }

 private:
  std::vector<int> parent_;
};

}  // namespace

void check_surface(const Scene& scene, Model& model, std::vector<std::string>& defects) {
  if (!scene.mesh) return;
  MeshCheckOptions options;
  options.orientation_matters = has_term(scene, "load_pressure");
  options.contact = has_term(scene, "contact_facet");
  for (const MeshDefect& defect : check_mesh(model.mesh, options)) {
    const std::string message = scene.mesh->file.string() + ": " + defect.message;
    if (defect.severity == Severity::Error) {
      defects.push_back(message);
      continue;
    }
    // Said more exactly by the two functions below.
    const bool is_said_elsewhere =
        defect.kind == MeshDefectKind::IsolatedVertex || defect.kind == MeshDefectKind::SeveralComponents;
    if (!is_said_elsewhere) model.warnings.push_back(message);
  }
}

void hold_isolated_nodes(Model& model, const std::map<std::string, PlacedNetwork>& networks,
                         FixedMask& fixed) {
  std::vector<bool> is_used(static_cast<size_t>(model.X.cols()), false);
  for (int t = 0; t < model.mesh.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) is_used[static_cast<size_t>(model.mesh.triangles(k, t))] = true;
  for (const auto& entry : networks)
    for (const Chord& chord : entry.second.network.chords) {
      is_used[static_cast<size_t>(entry.second.node(chord.from))] = true;
      is_used[static_cast<size_t>(entry.second.node(chord.to))] = true;
    }
  std::vector<int> isolated;
  for (int node = 0; node < model.X.cols(); ++node)
    if (!is_used[static_cast<size_t>(node)] && !fixed.col(node).all()) isolated.push_back(node);
  if (isolated.empty()) return;
  for (const int node : isolated) fixed.col(node).setConstant(true);
  model.warnings.push_back("Nodes on no triangle and no chord stay where they are: " + first_few(isolated) +
                           ".");
}

void warn_of_unsupported_parts(Model& model, const std::vector<TermPointer>& terms, const FixedMask& fixed) {
  const int node_count = static_cast<int>(model.X.cols());
  Parts parts(node_count);
  bool is_loaded = false;
  for (const TermPointer& term : terms) {
    is_loaded = is_loaded || term->role() == TermRole::Load;
    if (term->role() != TermRole::Internal) continue;
    const Stencils& stencils = term->stencils();
    for (size_t k = 0; k < stencils.nodes.size(); ++k) {
      const size_t first = k - k % static_cast<size_t>(stencils.width);
      parts.join(stencils.nodes[k], stencils.nodes[first]);
    }
  }
  std::vector<bool> is_held(static_cast<size_t>(node_count), false);
  std::vector<int> size(static_cast<size_t>(node_count), 0);
  for (int node = 0; node < node_count; ++node) {
    const size_t root = static_cast<size_t>(parts.root(node));
    ++size[root];
    if (fixed.col(node).any()) is_held[root] = true;
  }
  std::vector<int> loose;  // one node of each part, and nodes without any stiffness
  for (int node = 0; node < node_count; ++node)
    if (parts.root(node) == node && !is_held[static_cast<size_t>(node)]) loose.push_back(node);
  if (loose.empty()) return;
  int count = 0;
  for (const int node : loose) count += size[static_cast<size_t>(node)];
  model.warnings.push_back(
      "No prescribed node holds " + std::to_string(loose.size()) + " connected part(s) with " +
      std::to_string(count) + " nodes in all, named by one node each: " + first_few(loose) +
      ". Their position is not determined (rigid-body modes)" +
      (is_loaded ? "; under a load that is not in balance there is no equilibrium." : "."));
}

}  // namespace coapt
