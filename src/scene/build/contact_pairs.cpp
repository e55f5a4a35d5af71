#include "scene/build/contact_pairs.hpp"

#include "core/error.hpp"
#include "formats/json/read_json.hpp"
#include "formats/whole_file.hpp"

#include <algorithm>
#include <sstream>

namespace coapt {
namespace {

constexpr size_t kListed = 20;  // pairs, or defects of one kind

}  // namespace

Triangles all_facets(const Model& model) {
  Triangles all(3, model.mesh.triangle_count() + model.obstacles.cols());
  all << model.mesh.triangles, model.obstacles;
  return all;
}

FacetPairs membrane_intersections(const Points& x, const Model& model, const IntersectionChecker& checker) {
  FacetPairs pairs = checker.pairs(x, all_facets(model));
  std::erase_if(pairs, [count = model.mesh.triangle_count()](const std::array<int, 2>& pair) {
    return std::min(pair[0], pair[1]) >= count;
  });
  return pairs;
}

FacetPairs read_facet_pairs(const std::string& path, int facet_count) {
  const std::string text = read_text(path);
  FacetPairs pairs;
  std::vector<std::string> defects;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.empty() || line == "\r" || line[0] == '#') continue;
    std::array<int, 2> pair{};
    char comma = 0;
    std::istringstream fields(line);
    if (!(fields >> pair[0] >> comma >> pair[1]) || comma != ',' || !(fields >> std::ws).eof())
      defects.push_back(path + ":" + std::to_string(number) + ": expected two facet numbers, such as 12,345");
    else if (std::min(pair[0], pair[1]) < 0 || std::max(pair[0], pair[1]) >= facet_count)
      defects.push_back(path + ":" + std::to_string(number) + ": facets are numbered from 0 to " +
                        std::to_string(facet_count - 1));
    else
      pairs.push_back({std::min(pair[0], pair[1]), std::max(pair[0], pair[1])});
    if (defects.size() >= kListed) break;
  }
  if (!defects.empty()) throw InputError(defects);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void write_facet_pairs(const std::string& path, const FacetPairs& pairs) {
  std::string text =
      "# pairs of facets that may pass through each other, numbered from 0, obstacles after the mesh\n";
  for (const auto& [s, t] : pairs)
    text.append(std::to_string(s)).append(",").append(std::to_string(t)).append("\n");
  formats::write_whole(path, text);
}

std::string listed(const FacetPairs& pairs, Numbering numbering) {
  std::string list;
  for (size_t k = 0; k < std::min(pairs.size(), kListed); ++k)
    list.append(k > 0 ? ", " : "")
        .append(numbering.of(pairs[k][0]))
        .append("-")
        .append(numbering.of(pairs[k][1]));
  if (pairs.size() > kListed) list += ", ...";
  return list + numbering.note();
}

}  // namespace coapt
