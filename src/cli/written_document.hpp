// The document of a command that makes files.
#pragma once

#include "formats/json/json_text.hpp"

#include <string>
#include <vector>

namespace coapt::cli {

// {"written": [paths], "warnings": [sentences]}
inline std::string written_document(const std::vector<std::string>& paths,
                                    const std::vector<std::string>& warnings) {
  return json_text(OrderedJson{{"written", paths}, {"warnings", warnings}}, 2) + "\n";
}

}  // namespace coapt::cli
