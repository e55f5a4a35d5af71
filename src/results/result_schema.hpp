// The JSON Schema of result.json, made from one table.
#pragma once

#include <string>

namespace coapt {

// JSON Schema (draft 2020-12) as text, two spaces of indent, newline at the end.
std::string result_schema();

}  // namespace coapt
