#include "formats/json/valve_json.hpp"

namespace coapt {

std::vector<std::string> vertex_defects(const ValveFile& file, const std::string& name, int vertex_count) {
  std::vector<std::string> defects;
  const auto compare = [&](const std::string& place, int vertex) {
    constexpr size_t kMost = 20;
    if (vertex >= vertex_count && defects.size() < kMost)
      defects.push_back(name + ": " + place + ": vertex " + std::to_string(vertex) +
                        " does not exist; the mesh has " + std::to_string(vertex_count) + ", counted from 0");
  };
  std::vector<std::string> keys = {"annulus", "free_edge", "commissures"};
  for (const Support& support : file.valve.supports) keys.push_back(support.name);
  for (const std::string& key : keys) {
    const auto found = file.sets.find(key);
    if (found == file.sets.end()) continue;
    for (size_t k = 0; k < found->second.size(); ++k)
      compare(key + "[" + std::to_string(k) + "]", found->second[k]);
  }
  const std::vector<Chord>& chords = file.valve.chords.chords;
  for (size_t k = 0; k < chords.size(); ++k) {
    const std::string place = "chords[" + std::to_string(k) + "]";
    if (chords[k].from.kind == ChordEnd::Kind::Leaflet)
      compare(place + ".from.leaflet", chords[k].from.index);
    if (chords[k].to.kind == ChordEnd::Kind::Leaflet) compare(place + ".to.leaflet", chords[k].to.index);
  }
  return defects;
}

}  // namespace coapt
