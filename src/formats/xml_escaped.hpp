// Text as an attribute or the content of an XML element. Private to formats and writers.
#pragma once

#include <string>
#include <string_view>

namespace coapt::formats {

inline std::string xml_escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

}  // namespace coapt::formats
