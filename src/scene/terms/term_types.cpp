#include "scene/terms/term_types.hpp"

#include "core/error.hpp"
#include "formats/json/suggestion.hpp"

#include <algorithm>

namespace coapt {

const std::vector<TermType>& term_types() {
  static const std::vector<TermType> kTypes = [] {
    std::vector<TermType> all;
    for (auto family : {membrane_term_types, tissue_term_types, spring_term_types, bending_term_types,
                        line_term_types, link_term_types, load_term_types, contact_term_types})
      for (TermType& type : family()) all.push_back(std::move(type));
    return all;
  }();
  return kTypes;
}

const TermType* find_term_type(const std::string& name) {
  for (const TermType& type : term_types())
    if (type.name == name) return &type;
  return nullptr;
}

const TermType& type_of(const TermSpec& term) { return *find_term_type(term.type); }

TermKind kind_of(const TermSpec& term) { return type_of(term).kind; }

bool is_membrane(const TermSpec& term) { return kind_of(term) == TermKind::Membrane; }

bool is_barrier(const TermSpec& term) { return type_of(term).is_barrier; }

bool relaxes(const TermSpec& membrane) {
  const Parameters& p = membrane.parameters;
  return p.has("compression") ? p.text("compression") == "relaxed" : type_of(membrane).is_relaxed;
}

bool takes_material(const Parameters& parameters, const std::string& material) {
  const auto names = [&](const char* key) {
    if (!parameters.has(key)) return false;
    const std::vector<std::string>& all = parameters.texts(key);
    return std::find(all.begin(), all.end(), material) != all.end();
  };
  return !names(kAddedChords) && (!parameters.has("materials") || names("materials"));
}

KeySpec region_key() {
  return {.name = "region",
          .kind = KeyKind::Texts,
          .doc = "Region of the mesh, or a list of them, that the term covers; default: all triangles."};
}

KeySpec yield_strain_key() {
  return {.name = "yield_strain",
          .min = 0,
          .excludes_min = true,
          .doc =
              "Strain of the straight fibres, stretch over that at which they are straight, less 1, at which "
              "they yield; results name what is beyond. Without it they never do."};
}

KeySpec failure_key() {
  return {
      .name = "failure",
      .fallback = "0",
      .min = 0,
      .max = 1,
      .doc = "Share of their stiffness that the fibres lose where they yield; 0: none, yield is only told."};
}

std::vector<std::string> check_yield(const Parameters& p) {
  if (p.number("failure") == 0 || p.has("yield_strain") || p.has("triangle_values") || p.has("vertex_values"))
    return {};
  return {"failure: says nothing without yield_strain; give the strain from which on it counts"};
}

std::vector<int> region_triangles(const Parameters& parameters, const TriangleMesh& mesh) {
  std::vector<bool> is_wanted(mesh.region_names.size(), false);
  const bool takes_all = !parameters.has("region");
  if (!takes_all)
    for (const std::string& name : parameters.texts("region")) {
      const auto found = std::find(mesh.region_names.begin(), mesh.region_names.end(), name);
      if (found == mesh.region_names.end())
        throw InputError(parameters.where("region") + ": the mesh has no region \"" + name +
                         "\"; its regions: " + listed(mesh.region_names) +
                         suggestion(name, mesh.region_names));
      is_wanted[static_cast<size_t>(found - mesh.region_names.begin())] = true;
    }
  std::vector<int> triangles;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    if (takes_all || is_wanted[static_cast<size_t>(mesh.regions[static_cast<size_t>(t)])])
      triangles.push_back(t);
  if (triangles.empty()) throw InputError(parameters.where() + ": covers no triangle");
  return triangles;
}

std::vector<int> membrane_triangles(const TermSpec& spec, const BuildContext& context) {
  std::vector<int> triangles = region_triangles(spec.parameters, context.model.mesh);
  const bool is_patch = context.patches.contains(spec.name);
  for (const auto& [name, patch] : context.patches) {
    if (is_patch && name != spec.name) continue;
    const Vector here = context.on_triangles(patch);
    std::erase_if(triangles, [&](int t) { return (here[t] > 0.5) != is_patch; });
  }
  if (triangles.empty())
    throw InputError(spec.parameters.where() + (is_patch ? ": no triangle of this mesh is in the patch"
                                                         : ": patches leave it no triangle"));
  return triangles;
}

}  // namespace coapt
