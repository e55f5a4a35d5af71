// The history of a result in a few shapes, for its page.
#pragma once

#include "scene/build/model.hpp"

#include <vector>

namespace coapt {

struct RecordedShape {
  Iteration iteration;
  Points x;  // 3 x node_count, relative to the model's origin [mm]
};

// Of the shapes before a result, the start first and the result not among them, at most `most` (at least
// 1), spread over the path as evenly as they allow; the start stays. One that is nearer than a thousandth of
// the path to the one before it, or to the result, shows nothing new and is left out.
std::vector<RecordedShape> subsampled(const std::vector<RecordedShape>& history, const Points& result,
                                      size_t most);

// Keeps accepted iterates of the model's own mesh, never more than twice `most`, so far apart that the whole
// path is covered: those of the coarser meshes of a cascade are left out. An iterate that is not kept costs
// one pass over its unknowns.
class ShapeRecord {
 public:
  // The model, which must outlive the record, stands at its start. most: at least 2.
  ShapeRecord(const Model& model, size_t most);

  // Call it at each accepted iterate.
  void see(const Iteration& iteration, const Vector& q);

  // Those before a result (3 x node_count, relative to the model's origin), in the order of the run,
  // the start of the model first; see subsampled().
  std::vector<RecordedShape> shapes(const Points& result) const;

 private:
  void thin();

  struct Kept {
    RecordedShape shape;
    Vector q;
  };
  const Model& model_;
  size_t most_;
  double spacing_ = 0;  // least change of an unknown from one kept to the next [mm]
  RecordedShape start_;
  std::vector<Kept> kept_;
};

}  // namespace coapt
