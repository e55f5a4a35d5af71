#include "exchange/mass_spring_scene.hpp"

#include "core/error.hpp"
#include "formats/json/read_json.hpp"
#include "scene/build/build.hpp"
#include "scene/build/scene_geometry.hpp"
#include "scene/terms/term_types.hpp"

#include <algorithm>

namespace coapt {
namespace {

bool is_bending(const TermSpec& term) { return kind_of(term) == TermKind::Bending; }
bool is_spring(const TermSpec& term) { return kind_of(term) == TermKind::Spring; }

void copy_numbers(const Parameters& from, const std::vector<const char*>& keys, Parameters& to) {
  for (const char* key : keys)
    if (from.has(key)) to.set(key, from.number(key));
}

// Where the term is, and the files with its numbers.
void copy_place(const Parameters& from, Parameters& to) {
  if (from.has("region")) to.set("region", from.texts("region"));
  for (const char* key : {"triangle_values", "vertex_values"})
    if (from.has(key)) to.set(key, from.text(key));
}

// The numbers of its law; false for a law that springs do not have.
bool copy_law(const TermSpec& membrane, Parameters& springs) {
  const Parameters& p = membrane.parameters;
  const std::vector<const char*>& keys = type_of(membrane).spring_keys;
  if (keys.empty()) return false;
  copy_numbers(p, keys, springs);
  copy_numbers(p, {"thickness"}, springs);
  copy_place(p, springs);
  return true;
}

// The window at a membrane's knees is called `smoothing`; that of a spring rounds its onset.
void copy_window(const Parameters& from, Parameters& to) {
  if (to.has("young") || !from.has("smoothing")) return;
  to.set("knee", from.number("smoothing"));
  for (const char* key : {"triangle_values", "vertex_values"})
    if (from.has(key) && read_text(from.text(key)).find("smoothing") != std::string::npos)
      throw InputError(from.where(key) + ": " + from.text(key) +
                       " has a column smoothing, which springs cannot have by triangle; leave it out for "
                       "mass-spring");
}

// Modulus and thickness at small strain, of a law that springs do not have.
void set_small_strain(const TermSpec& membrane, const Scene& scene, const SceneGeometry& geometry,
                      Parameters& springs) {
  Scene alone = scene;
  alone.terms = {membrane};
  const Model model = build(alone, geometry);
  const std::vector<int> triangles = region_triangles(membrane.parameters, model.mesh);
  const MembraneProperties& first = model.membrane[static_cast<size_t>(triangles.front())];
  if (!(first.young > 0))
    throw InputError(
        membrane.parameters.where() +
        ": is held by its prestress alone; springs have none, mass-spring needs a membrane with a "
        "modulus");
  for (const int t : triangles) {
    const MembraneProperties& here = model.membrane[static_cast<size_t>(t)];
    if (here.young != first.young || here.thickness != first.thickness)
      throw InputError(membrane.parameters.where() + ": the numbers of " + membrane.type +
                       " differ from triangle to triangle; mass-spring takes one modulus and one thickness "
                       "from such a law: give the term by regions instead");
  }
  springs.set("young", first.young);
  springs.set("thickness", first.thickness);
  if (membrane.parameters.has("region")) springs.set("region", membrane.parameters.texts("region"));
}

TermSpec springs_of(const TermSpec& membrane, const Scene& scene, std::optional<SceneGeometry>& geometry) {
  const Parameters& p = membrane.parameters;
  if (p.number_or("prestress", 0) != 0)
    throw InputError(p.where("prestress") + ": springs have none; mass-spring needs a membrane without");
  Parameters springs(p.where());
  springs.set("compression", std::string(relaxes(membrane) ? "relaxed" : "resisted"));
  if (copy_law(membrane, springs)) {
    copy_window(p, springs);
  } else {
    if (!geometry) geometry = scene_geometry(scene);
    set_small_strain(membrane, scene, *geometry, springs);
  }
  return {"spring", membrane.name, std::move(springs)};
}

}  // namespace

Scene mass_spring_scene(const Scene& scene) {
  Scene springs = scene;
  springs.terms.clear();
  springs.solver.type = "mass-spring";
  std::optional<SceneGeometry> geometry;  // read when a law asks for it
  std::vector<std::string> defects;
  for (const TermSpec& term : scene.terms) {
    if (is_bending(term) && !has_springs_alone(scene)) continue;
    try {
      springs.terms.push_back(is_membrane(term) ? springs_of(term, scene, geometry) : term);
    } catch (const InputError& error) {
      defects.insert(defects.end(), error.defects().begin(), error.defects().end());
    }
  }
  if (defects.empty() && std::none_of(springs.terms.begin(), springs.terms.end(), is_spring))
    defects.push_back(scene.file.string() + ": terms: no membrane (cst_*) that springs could stand for");
  if (!defects.empty()) throw InputError(defects);
  return springs;
}

bool has_springs_alone(const Scene& scene) {
  return std::none_of(scene.terms.begin(), scene.terms.end(), is_membrane);
}

}  // namespace coapt
