// A number as text, for messages, tables and files; with a point, whatever the locale.
#pragma once

#include <string>

namespace coapt {

// Rounded to this many significant digits, from 1 to 17, without zeros behind them; in powers of ten below
// 1e-4 and where more digits stand before the point, as printf's %g does it: "0.125", "1.3e-07", "inf".
std::string number_text(double value, int digits = 3);

// With this many digits behind the point, from 0 to 17: "0.12"; as number_text() does it from 1e15 on.
std::string fixed_text(double value, int decimals);

// The fewest digits that read back to the same bits.
std::string exact_text(double value);

}  // namespace coapt
