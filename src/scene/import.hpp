// From a valve to a folder with a ready scene.
#pragma once

#include "mesh/valve.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace coapt {

struct ImportOptions {
  std::string membrane = "tension_field";  // tension_field with bending, or stvk for comparison
  std::string young = "1 MPa";             // of the leaflets, as written into the scene
  double poisson = 0.45;
  std::string chord_young = "40 MPa";       // Hammer et al. 2011
  std::string pressure = "";                // empty: the valve's, else 120 mmHg
  std::string pressure_model = "follower";  // follower, volume, frozen, or field (toward the commissure line)
  std::string contact = "barrier";          // none, barrier or facet
  double default_thickness = 0.65;          // where the valve states none [mm]
  double tolerance = 1e-8;
};

// Reads a valve JSON and the meshes beside it and writes the folder. Returns warnings, whole sentences.
// Throws InputError.
std::vector<std::string> import_valve(const std::filesystem::path& valve_json,
                                      const std::filesystem::path& out_dir,
                                      const ImportOptions& options = {});

// Writes leaflets.obj, valve.json, closed_reference.obj (where the valve has one) and scene.json, a commented
// scene that closes the valve: membrane, chords, pressure on the side that the normals point to, annulus and
// papillary points moved to their closed places where these are known, else fixed. valve: mm, MPa.
// Makes the folder. Throws InputError for an option that is not known, or when a file cannot be written.
void write_valve_scene(const Valve& valve, const std::filesystem::path& out_dir,
                       const ImportOptions& options = {});

}  // namespace coapt
