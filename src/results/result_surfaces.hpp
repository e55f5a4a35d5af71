// The surfaces and lines of a result folder. All in the coordinates of the input, in mm.
#pragma once

#include "formats/vtk/vtp_writer.hpp"
#include "results/closure.hpp"

namespace coapt {

// The closed mesh with its lines and fields: closed.vtp.
VtpSurface closed_surface(const Model& model, const Fields& fields);

// coaptation_line.vtp: the pieces of the line, with the leaflets on both sides of each stretch (numbers of
// regions, the smaller first) and the coaptation height there, -1 where none is known.
VtpSurface coaptation_line(const Model& model, const Closure& closure);

// orifice.vtp: closed outlines, with the area, the regurgitant area and the perimeter of each.
VtpSurface orifice_outlines(const Model& model, const Closure& closure);

}  // namespace coapt
