// Numbers as indices and counts.
#pragma once

namespace coapt {

// The number without its fraction, within lowest .. highest; NaN gives lowest. A plain cast of a number that
// no int holds, such as a place on a grid of what has run away, is undefined. Pre: lowest <= highest.
constexpr int bounded_int(double number, int lowest, int highest) {
  if (!(number > lowest)) return lowest;
  return number < highest ? static_cast<int>(number) : highest;
}

}  // namespace coapt
