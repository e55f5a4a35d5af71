#include "exchange/valve_doubts.hpp"

#include "exchange/detail/law_doubts.hpp"
#include "exchange/detail/strain_doubts.hpp"
#include "formats/file_numbering.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/lower_extension.hpp"

#include <algorithm>

namespace coapt {
namespace {

Vec3 end_of_path(int node, const SceneGeometry& geometry) {
  const auto path = geometry.prescribed.paths.find(node);
  return path == geometry.prescribed.paths.end() ? Vec3(geometry.model.X.col(node)) : path->second.back();
}

// By the term that makes a line of the chord.
double length_scale(const Scene& scene, const std::string& network, const Chord& chord) {
  for (const TermSpec& term : scene.terms) {
    const Parameters& p = term.parameters;
    if (p.has("network") && p.text("network") == network && p.has("length_scale") &&
        takes_material(p, chord.material))
      return p.number("length_scale");
  }
  return 1;
}

// All networks as one, at the positions of the model, with the lengths that the terms make of theirs.
ChordNetwork joined_networks(const Scene& scene, const SceneGeometry& geometry) {
  ChordNetwork all;
  std::vector<int> tips, junctions;  // nodes
  for (const auto& [path, placed] : geometry.networks) {
    const auto first_tip = static_cast<int>(tips.size()), first_junction = static_cast<int>(junctions.size());
    for (int k = 0; k < placed.network.papillary.cols(); ++k) tips.push_back(placed.first_papillary + k);
    for (int k = 0; k < placed.network.junctions.cols(); ++k) junctions.push_back(placed.first_junction + k);
    for (Chord chord : placed.network.chords) {
      for (ChordEnd* end : {&chord.from, &chord.to}) {
        if (end->kind == ChordEnd::Kind::Papillary) end->index += first_tip;
        if (end->kind == ChordEnd::Kind::Junction) end->index += first_junction;
      }
      chord.rest_length *= length_scale(scene, path, chord);
      all.chords.push_back(std::move(chord));
    }
  }
  all.papillary = geometry.model.X(Eigen::all, tips);
  all.junctions = geometry.model.X(Eigen::all, junctions);
  all.papillary_closed.resize(3, all.papillary.cols());
  for (size_t k = 0; k < tips.size(); ++k)
    all.papillary_closed.col(static_cast<Eigen::Index>(k)) = end_of_path(tips[k], geometry);
  return all;
}

// Greatest pressure [MPa] that fills a ventricle through a valve, 30 mmHg: a lower one on the back of the
// leaflets may well be there to open them.
constexpr double kFillingPressure = 0.004;

// Whether more than this pressure acts on this side of the leaflets: "front", to which the normals point, or
// "back".
bool presses(const Scene& scene, const std::string& side, double least) {
  return std::any_of(scene.terms.begin(), scene.terms.end(), [&](const TermSpec& term) {
    return kind_of(term) == TermKind::Pressure && term.parameters.text("side") == side &&
           term.parameters.number("value") > least;
  });
}

// A scene whose valve JSON has tips, and maybe chords, of which no term makes anything.
void find_unused_chords(const Scene& scene, std::vector<std::string>& doubts) {
  if (!scene.mesh || !scene.mesh->sets || formats::lower_extension(*scene.mesh->sets) != ".json") return;
  const ChordNetwork chords = read_valve(*scene.mesh->sets).valve.chords;
  if (chords.papillary.cols() == 0) return;
  doubts.push_back(scene.file.string() + ": no term makes chords, while " + scene.mesh->sets->string() +
                   " has " + std::to_string(chords.papillary.cols()) + " papillary tips and " +
                   std::to_string(chords.chords.size()) +
                   " chords: nothing holds the free edge, and pressure will turn the leaflets over. " +
                   (chords.chords.empty() ? "`coapt chords` makes some from the tips."
                                          : "Add a term such as { \"type\": \"cable\", \"network\": ... }."));
}

}  // namespace

std::vector<std::string> valve_doubts(const Valve& valve, const std::string& file, Numbering numbering,
                                      const ChordLimits& limits) {
  std::vector<std::string> doubts;
  for (const std::vector<std::string>& list : {chord_doubts(valve, limits, true, numbering),
                                               size_doubts(valve), pressure_side_doubts(valve, numbering)})
    for (const std::string& doubt : list) doubts.push_back(file + ": " + doubt);
  return doubts;
}

std::vector<std::string> valve_doubts(const Scene& scene, const SceneGeometry& geometry, const Model& model,
                                      bool names_repeated) {
  const std::string file = scene.file.string();
  std::vector<std::string> doubts;
  const auto add = [&](const std::string& place, const std::vector<std::string>& list) {
    for (const std::string& doubt : list) doubts.push_back(place + ": " + doubt);
  };
  const auto annulus = geometry.model.sets.find("annulus");
  const bool is_valve = scene.mesh && annulus != geometry.model.sets.end() && !annulus->second.empty();
  add(file, detail::strain_doubts(scene, model, is_valve));
  if (!is_valve) return doubts;
  const Numbering numbering = file_numbering(scene.mesh->file);
  Valve valve;
  valve.leaflets = geometry.model.mesh;
  valve.closed_reference = geometry.model.closed_reference;
  valve.annulus = annulus->second;
  valve.chords = joined_networks(scene, geometry);
  valve.pressure = model.applied_pressure;
  double greatest_thickness = 0;
  for (const MembraneProperties& membrane : model.membrane) {
    greatest_thickness = std::max(greatest_thickness, membrane.thickness);
    if (membrane.thickness > 0 && (valve.thickness == 0 || membrane.thickness < valve.thickness))
      valve.thickness = membrane.thickness;
  }
  // Cut and shortened chords hang loose or are overstretched by intention.
  if (scene.interventions.empty()) {
    add(file, chord_doubts(valve, detail::chord_limits(scene), names_repeated, numbering));
    if (geometry.networks.empty()) find_unused_chords(scene, doubts);
  }
  std::vector<std::string> sizes = size_doubts(valve);
  valve.thickness = greatest_thickness;
  for (const std::string& doubt : size_doubts(valve))
    if (std::find(sizes.begin(), sizes.end(), doubt) == sizes.end()) sizes.push_back(doubt);
  add(file, sizes);
  if (presses(scene, "front", 0)) add(file, pressure_side_doubts(valve, numbering));
  if (presses(scene, "back", kFillingPressure)) add(file, pressure_side_doubts(valve, numbering, true));
  for (const std::string& doubt : detail::load_doubts(scene)) doubts.push_back(doubt);
  add(file, detail::law_doubts(scene, model));
  add(scene.mesh->file.string(), fold_doubts(valve.leaflets, numbering));
  return doubts;
}

}  // namespace coapt
