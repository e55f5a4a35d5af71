// The walls of the two chambers around a valve: half ellipsoids that begin at the annulus and are wide enough
// for what hangs in them.
#pragma once

#include "image/detail/valve_frame.hpp"
#include "image/phantom.hpp"

#include <array>
#include <vector>

namespace coapt {

enum class Tissue { Blood, Wall, Outside };

class HeartWalls {
 public:
  // Throws InputError where the annulus does not go around its centre.
  HeartWalls(const ValveFrame& frame, const PhantomValve& valve, const PhantomOptions& options);

  Tissue at(const Vec3& position) const;

 private:
  // Above the annulus (0) or below it (1): the cavity's radius at the distance s from the annulus along z is
  // (annulus + bulge * smooth(s)) * sqrt(1 - (s / length)^2).
  struct Chamber {
    double length = 0, bulge = 0;  // [mm]
  };
  struct Place {
    double radius = 0, from_annulus = 0;  // [mm]
    int sector = 0, side = 0;
  };

  Place place(const Vec3& position) const;
  double cavity_radius(const Place& place, double grown) const;
  void find_sectors();
  void widen(const PhantomValve& valve, double margin);
  void bring_to(const PhantomValve& valve);

  ValveFrame frame_;
  double wall_ = 0;
  std::vector<double> annulus_radius_, annulus_height_;  // of each sector [mm]
  std::array<Chamber, 2> chambers_;
  std::vector<double> leaflet_radius_;  // of leaflets that lie on the wall, by sector and depth [mm]
};

}  // namespace coapt
