// What contact would measure if it kept no distance. Private to this room.
#pragma once

#include "results/fields.hpp"

#include <optional>
#include <vector>

namespace coapt {

// Sheets in contact rest a little apart, and a membrane that lifts off does so with the square of the way. So
// the extent E of what lies within a distance d grows with the root of d beyond the rest, and at the contact
// distance, which shrinks with the mesh, much of it is no contact. Followed back to the rest from there and
// from four times as far beyond it, E is E(near) - weight (E(far) - E(near)), with a weight of 1.
struct ContactLimit {
  double near = 0, far = 0;  // distances [mm]: the contact distance, and the other
  double weight = 1;

  double at_rest(double at_near, double at_far) const { return at_near - weight * (at_far - at_near); }
};

// The rest is the gap that half of the area in contact does not exceed. `far` ends with the reach of the
// gaps; the weight then is greater. Pre: fields of contact.
ContactLimit contact_limit(const Model& model, const Fields& fields);

// Of each closed triangle the area over which the gap, linear between its corners, is at most `distance`;
// corners without a gap count as those at the end of the reach. [mm2]
Vector areas_within(double distance, const Model& model, const Fields& fields);

struct ContactMeasure {
  ContactLimit limit;
  Vector near;   // within the contact distance, of each closed triangle [mm2]
  Vector areas;  // the same followed back to contact itself: the sum of many means something, that of one may
                 // be negative [mm2]
};

// An area in contact that was followed back from `near` within the contact distance [mm2]; empty where the
// mesh is too coarse for it: sheets lie within that distance, and nothing is left of them in contact.
std::optional<double> resolved_area(double near, double in_contact);

// Pre: fields of contact.
ContactMeasure measure_contact(const Model& model, const Fields& fields);

// The vertices of a region, or of all (-1), whose gap is at most `distance`, each once, and the places on its
// edges where the gap, linear along them, is just that.
std::vector<Vec3> places_within(double distance, int region, const Model& model, const Fields& fields);

}  // namespace coapt
