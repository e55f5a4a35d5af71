// Names in CSV files.
#pragma once

#include "formats/text.hpp"

#include <string>

namespace coapt {

// In quotes, those inside doubled, where the text holds a comma, a quote or the end of a line (RFC 4180). A
// text that a spreadsheet would take for a formula (it begins with = + - @, a tab or a carriage return, and
// is no number) gets an apostrophe in front.
inline std::string csv_text(std::string text) {
  double number = 0;
  if (text.find_first_of("=+-@\t\r") == 0 && formats::read_number(text, number)) text.insert(0, 1, '\'');
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + "\"";
}

}  // namespace coapt
