#include "scene/build/supports.hpp"

#include "energy/connected_parts.hpp"
#include "formats/file_numbering.hpp"
#include "mesh/mesh_check.hpp"

#include <algorithm>

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

bool has_pressure(const Scene& scene) {
  return std::any_of(scene.terms.begin(), scene.terms.end(),
                     [](const TermSpec& term) { return kind_of(term) == TermKind::Pressure; });
}

// A barrier looks for what touches at the start by itself.
bool has_finite_contact(const Scene& scene) {
  return std::any_of(scene.terms.begin(), scene.terms.end(), [](const TermSpec& term) {
    return kind_of(term) == TermKind::Contact && !is_barrier(term);
  });
}

}  // namespace

void check_surface(const Scene& scene, Model& model, std::vector<std::string>& defects) {
  if (!scene.mesh) return;
  MeshCheckOptions options;
  options.orientation_matters = has_pressure(scene);
  options.contact = has_finite_contact(scene);
  options.numbering = file_numbering(scene.mesh->file);
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
                           " (numbers of nodes count from 0).");
}

void warn_of_unsupported_parts(Model& model, const std::vector<TermPointer>& terms, const FixedMask& fixed) {
  std::vector<int> loose;  // one node of each part
  int count = 0;
  for (const Part& part : connected_parts(terms, model.X, fixed)) {
    if (!part.can_shift_at_all()) continue;
    loose.push_back(part.nodes.front());
    count += static_cast<int>(part.nodes.size());
  }
  if (loose.empty()) return;
  const bool is_loaded = std::any_of(terms.begin(), terms.end(),
                                     [](const TermPointer& term) { return term->role() == TermRole::Load; });
  model.warnings.push_back(
      "No prescribed coordinate keeps " + std::to_string(loose.size()) + " connected part(s) with " +
      std::to_string(count) + " nodes in all, named by one node each, from shifting along an axis: " +
      first_few(loose) + " (counted from 0). Their position is not determined (rigid-body modes)" +
      (is_loaded ? "; under a load that is not in balance there is no equilibrium." : "."));
}

}  // namespace coapt
