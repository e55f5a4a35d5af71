// Changes of a scene file as text: what a study varies and a repair adds. The text need not be a valid scene,
// only JSON; parse_scene() says what is wrong with the outcome.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace coapt {

// The text of a scene file. Throws InputError.
std::string scene_text(const std::filesystem::path& file);

// Without the key `interventions`. file: for messages, here and below. Throws InputError for what is no JSON.
std::string without_interventions(const std::string& scene, const std::string& file);

// With more interventions behind those that it has: each entry is the text of one object, or of a list of
// them; `source` is named where one is neither.
std::string with_interventions(const std::string& scene, const std::vector<std::string>& more,
                               const std::string& file, const std::string& source = "--edit");

// The interventions of a scene, each as the text of its object.
std::vector<std::string> intervention_texts(const std::string& scene, const std::string& file);

// With another value at a key path: `ring.size`, where `ring` is the name (or type) of an intervention or a
// term, or the path in the file, `solver.tolerance`, `terms[1].young`, `interventions[0].at[0]`. The
// object must be there; the key may be new. A number without a unit gets that of the text it replaces.
// Throws InputError naming the path, with what there is in its place.
std::string with_value(const std::string& scene, const std::string& path, const std::string& value,
                       const std::string& file);

}  // namespace coapt
