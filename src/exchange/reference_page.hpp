// The scene file for its readers.
#pragma once

#include <string>

namespace coapt {

// Reference page of the scene file, in Markdown: docs/scene.md.
std::string reference_page();

}  // namespace coapt
