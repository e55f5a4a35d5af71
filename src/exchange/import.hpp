// From a valve to a folder with a ready scene.
#pragma once

#include "formats/valve.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace coapt {

// The linear law of leaflets that state none: a tension field with bending, a membrane that resists
// compression, or springs along the edges of the mesh with bending.
enum class LinearLeaflets { TensionField, ResistsCompression, Springs };

// "tension_field", "stvk", "spring"; nothing for another name.
std::optional<LinearLeaflets> linear_leaflets(const std::string& name);

struct ImportOptions {
  LinearLeaflets membrane = LinearLeaflets::TensionField;
  // Given, a linear law of this modulus takes the place of every law of the leaflets; their thickness stays.
  std::string young = "";  // empty: the valve's laws, and 1 MPa where it has none
  double poisson = 0.45;   // of linear leaflets; springs have none
  // Given, linear chords of this modulus take the place of every law of chords.
  std::string chord_young = "";  // empty: the valve's laws, and 40 MPa where it has none; Hammer et al. 2011
  std::string pressure = "";     // empty: the valve's, else 120 mmHg
  std::string pressure_model = "";  // follower, volume, frozen, or field (toward the commissure line); empty:
                                    // what the file says, else follower
  std::string contact = "";         // none, barrier or facet; empty: barrier, or none where a model has none
  bool bends = true;                // false: no term `bending`, whatever the membrane
  double default_thickness = 0.65;  // where the valve states none [mm]
  double tolerance = 1e-8;
  bool takes_any_size = false;  // also a valve whose sizes no heart has: a unit misread
  bool repairs = true;          // slivers of the leaflets (valve/repair_valve.hpp)
  // Whether membranes keep the bulk modulus that the file states. Without it they are incompressible.
  bool keeps_bulk = false;
  std::filesystem::path annulus_closed = {}, papillary = {}, papillary_closed = {};  // .mrk.json; empty: none
  std::string model = "";  // of import_valve, by name (valve_models.hpp); empty: the file's laws

  // What a published model sets besides; empty: nothing of the kind.
  std::string held = "";           // JSON of a node selection: nodes held besides annulus and tips
  std::string held_remark = "";    // what they are
  std::string contact_range = "";  // of contact_facet, in the place of its default
  std::string solver = "";         // JSON, in the place of newton along a damped path
  std::string notes = "";          // README.md beside the scene
};

// The laws of a valve that other sheets than those of the options were chosen for: linear ones become those
// of options.membrane, others resist compression where it says so and they can.
void apply_membrane_option(const ImportOptions& options, Valve& valve);

// Reads a valve JSON with the meshes beside it, a finite-element model (.inp, .feb) or a mesh, and writes the
// folder. Returns warnings, whole sentences. Of a mesh the rim nearest to annulus_closed, or else the
// longest, is the annulus; its vertices go to the points of the curve at the same part of the length.
// papillary gives a valve without chords tips, and chords to the free edge
// (valve/generators/leaflet_chords.hpp). Slivers are repaired, and the steps listed in repairs.csv; what is
// doubtful about mesh, chords, sizes and pressure is among the warnings. Throws InputError, also for slivers
// that no step repairs, and, before anything is written, for a valve (what has chords, tips, or an annulus
// that the file names) of a size, thickness or pressure that no heart has; of other membranes that is a
// warning.
std::vector<std::string> import_valve(const std::filesystem::path& file, const std::filesystem::path& out_dir,
                                      const ImportOptions& options = {});

// Writes leaflets.obj, valve.json, closed_reference.obj (where the valve has one) and scene.json, a commented
// scene that closes the valve: membrane, chords, pressure on the side that the normals point to, annulus and
// papillary points moved to their closed places where these are known, else fixed; README.md where the
// options have notes. valve: mm, MPa. Makes the folder. Throws InputError for an option that is not known, or
// when a file cannot be written.
void write_valve_scene(const Valve& valve, const std::filesystem::path& out_dir,
                       const ImportOptions& options = {});

}  // namespace coapt
