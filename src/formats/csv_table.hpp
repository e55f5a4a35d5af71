// A table as a CSV file (RFC 4180, but with lines that end as those of text files do).
#pragma once

#include "formats/table.hpp"

#include <string>

namespace coapt {

// In place of a number of digits: as many as read back to the same bits.
inline constexpr int kAllDigits = 0;

// The names of the columns, then the rows; nothing is an empty cell. digits: significant, of each number.
std::string csv_table(const Table& table, int digits = 12);

// In quotes, those inside doubled, where the text holds a comma, a quote or the end of a line. A text that a
// spreadsheet would take for a formula (it begins with = + - @, a tab or a carriage return, and is no number)
// gets an apostrophe in front.
std::string csv_text(std::string text);

}  // namespace coapt
