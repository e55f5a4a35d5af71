// JSON values as texts.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace coapt {

using OrderedJson = nlohmann::ordered_json;  // keys in the order in which they were written

// The text of a value; bytes that are not UTF-8, as a path may have, become U+FFFD. indent -1: on one line.
template <class AnyJson>
std::string json_text(const AnyJson& json, int indent = -1) {
  return json.dump(indent, ' ', false, AnyJson::error_handler_t::replace);
}

// The same for the inside of a script element, which ends at the first `</script`, wherever it stands: no `<`
// is left in it.
template <class AnyJson>
std::string script_text(const AnyJson& json) {
  std::string text;
  for (const char c : json_text(json))
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  return text;
}

}  // namespace coapt
