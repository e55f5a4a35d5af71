// Names in CSV files.
#pragma once

#include <string>

namespace coapt {

// In quotes, those inside doubled, where the text holds a comma, a quote or the end of a line (RFC 4180).
inline std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + "\"";
}

}  // namespace coapt
