// The page of a comparison without its numbers: what stands before and behind them. Private to this room.
#pragma once

#include <string_view>

namespace coapt {

// A whole page is kPageBegin, the data as JSON without the character `<`, kPageEnd. The data:
//   study     compare.json
//   unit_mm   of all positions, which are whole numbers
//   map_max   distance at the end of the colours [mm]
//   triangles corners, flat; lines: ends, flat
//   shapes    per method with a result: name; points, flat: right, up in the picture and towards the viewer,
//   as
//             seen from the atrium; shades, 0 to 255 of map_max per mesh vertex, none for the reference
extern const std::string_view kPageBegin, kPageEnd;

}  // namespace coapt
