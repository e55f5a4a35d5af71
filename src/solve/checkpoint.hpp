// The file in which a run is kept while it goes on, and from which it is taken up again.
#pragma once

#include "optim/run_record.hpp"
#include "scene/file/scene.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace coapt {

// What a run has to have in common with one that takes it up.
struct RunIdentity {
  std::string version;  // of the library
  std::string scene;    // fingerprint
  std::string solver;   // name
  double tolerance = 0;
  std::optional<double> accuracy_mm;  // where one is wanted
  int damped_steps = 0;               // of its continuation
};

// 16 hexadecimal digits, of the scene file and of every file that it names; but not of what has no influence
// on the way of a run: name, output, reference, limit of time, threads and certificate. Method, tolerance and
// damped steps, which may be given from outside, stand apart in the identity. Throws InputError where the
// scene was not read from a file.
std::string scene_fingerprint(const Scene& scene);

// 16 hexadecimal digits of all that the files hold which the text of a scene in `folder` names. Throws
// InputError for what is no JSON.
std::string named_files_fingerprint(const std::string& scene, const std::filesystem::path& folder);

// The file appears whole or not at all, and is on the disk when this returns. Throws InputError where it
// cannot be written.
void write_checkpoint(const std::filesystem::path& path, const RunIdentity& identity,
                      const RunRecord& record);

// Throws InputError where there is no file, where it is no checkpoint, damaged, cut off or of another format,
// and, with all that differs, where it is of another run.
RunRecord read_checkpoint(const std::filesystem::path& path, const RunIdentity& identity);

}  // namespace coapt
