// A scene whose membrane is split into regions, each with a factor on its moduli. Private to this room.
#pragma once

#include "scene/build/scene_geometry.hpp"
#include "tuning/region_tuning.hpp"

namespace coapt {

class TunedScene {
 public:
  // Throws InputError where there is nothing to tune: no chords, no annulus, no moduli.
  TunedScene(const Scene& scene, SceneGeometry own, const RegionTuningOptions& options);

  Eigen::Index factor_count() const { return static_cast<Eigen::Index>(region_count_ + cables_.size()); }

  // With factors on the moduli of each region, then on the cross-sections of each cable term.
  Scene scene(const Vector& factors) const;
  // The terms that a factor is on: those of its region, or a cable.
  std::vector<std::string> terms_of(Eigen::Index factor) const;
  bool is_region(Eigen::Index factor) const { return factor < static_cast<Eigen::Index>(region_count_); }
  void name_factors(const Vector& factors, std::vector<TunedFactor>& regions,
                    std::vector<TunedFactor>& chords) const;

  SceneGeometry geometry;  // the mesh's regions are those that are tuned

 private:
  struct Part {
    size_t term, region;  // the latter among the tuned ones
  };
  void number_tuned_regions();

  Scene split_;                                          // a membrane term for each of its regions
  std::vector<Part> parts_;                              // of the split membrane terms
  std::vector<size_t> cables_;                           // terms
  std::vector<std::optional<size_t>> factor_of_region_;  // of the mesh; none where no term can be tuned
  size_t region_count_ = 0;                              // tuned ones
};

}  // namespace coapt
