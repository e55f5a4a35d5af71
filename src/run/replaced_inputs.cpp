#include "run/replaced_inputs.hpp"

#include "core/error.hpp"
#include "formats/json/named_files.hpp"

#include <algorithm>
#include <utility>

namespace coapt {
namespace {

namespace fs = std::filesystem;

bool fits(const std::string& name, const std::string& pattern) {
  const size_t star = pattern.find('*');
  if (star == std::string::npos) return name == pattern;
  return name.size() + 1 >= pattern.size() && name.starts_with(pattern.substr(0, star)) &&
         name.ends_with(pattern.substr(star + 1));
}

}  // namespace

const std::vector<std::string>& solve_files() {
  static const std::vector<std::string> names = {
      "result.json",         "metrics.csv", "trace.csv",   "closed.vtp",    "closed.obj",
      "coaptation_line.vtp", "orifice.vtp", "report.html", "reference.vtp", "frames.pvd"};
  return names;
}

void refuse_replaced_inputs(const Scene& scene, const fs::path& folder, const std::vector<std::string>& names,
                            std::vector<fs::path> others) {
  std::error_code error;
  std::vector<fs::path> inputs = std::move(others);
  if (fs::is_regular_file(scene.file, error)) {
    for (const fs::path& file : named_files(read_json(scene.file), scene.file.parent_path()))
      inputs.push_back(file);
    inputs.push_back(scene.file);
  }
  std::vector<std::string> defects;
  for (const fs::path& input : inputs)
    if (!input.empty() && fs::equivalent(fs::absolute(input).parent_path(), folder, error) &&
        std::any_of(names.begin(), names.end(),
                    [&](const std::string& name) { return fits(input.filename().string(), name); }))
      defects.push_back(input.string() +
                        ": is read and would be replaced by a result; choose another folder than " +
                        folder.string() + " with -o");
  if (!defects.empty()) throw InputError(defects);
}

}  // namespace coapt
