// The history of a result as an animation, for ParaView: shapes in the folder `frames`, listed by
// `frames.pvd`.
#pragma once

#include "core/output_error.hpp"
#include "optim/solver.hpp"
#include "scene/build/model.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace coapt {

// Those of an earlier solve, which would be taken for this one's.
void remove_frames(const std::filesystem::path& folder);

// Writes the mesh and the lines of every so-many-th accepted iterate of the model's own mesh (those of the
// coarser ones of a cascade are left out), the start among them, with the displacement of each node. The time
// of a frame is the simulated one, of methods that have none the number of the iterate. Positions are in mm,
// in the coordinates of the input.
class FrameWriter {
 public:
  // every: at least 1. The model must outlive the writer. Throws InputError where nothing can be written.
  FrameWriter(const std::filesystem::path& folder, int every, const Model& model);

  // Call it at each accepted iterate. Once a frame cannot be written no more are.
  void see(const Iteration& iteration, const Vector& q);

  // Writes frames.pvd. Throws OutputError where it, or a frame before, cannot be written.
  void finish() const;

 private:
  std::filesystem::path folder_;
  int every_;
  const Model& model_;
  long seen_ = 0;
  int count_ = 0;
  double last_time_ = 0;
  std::string entries_;
  std::optional<OutputError> failure_;
};

}  // namespace coapt
