// region_tuning.json and region_tuning.csv.
#include "formats/csv_table.hpp"
#include "formats/whole_file.hpp"
#include "results/study_files.hpp"
#include "tuning/region_tuning.hpp"

namespace coapt {

Table factor_table(const RegionTuning& tuning) {
  Table table{.columns = {text_column("name"), {"triangles"}, {"factor", "", "", 4, 4}, text_column("of")}};
  for (const TunedFactor& region : tuning.regions)
    table.rows.push_back({region.name, region.triangles, region.factor,
                          region.is_tuned ? "the stiffness" : "not tuned: no term with a modulus"});
  for (const TunedFactor& chord : tuning.chords)
    table.rows.push_back({chord.name, {}, chord.factor, "the cross-sections"});
  return table;
}

void write_region_tuning(const std::filesystem::path& folder, const RegionTuning& tuning) {
  const auto state = [](const TuningState& s) -> OrderedJson {
    return {{"max_chord_strain", number_json(s.max_chord_strain)},
            {"max_yield_ratio", number_json(s.max_yield_ratio)},
            {"strained_chords", s.strained_chords},
            {"strained_facets", s.strained_facets},
            {"orifice_area_mm2", number_json(s.orifice_area_mm2)},
            {"doubts", s.doubts}};
  };
  OrderedJson json = {{"scene", tuning.scene_file},
                      {"reached", tuning.is_reached},
                      {"message", tuning.message},
                      {"yield_strain", number_json(tuning.yield_strain)},
                      {"orifice_limit_mm2", number_json(tuning.orifice_limit_mm2)},
                      {"before", state(tuning.before)},
                      {"after", state(tuning.after)},
                      {"rounds", tuning.rounds},
                      {"solves", tuning.solves},
                      {"failed_solves", tuning.failed_solves},
                      {"wall_s", tuning.wall_s},
                      {"regions", OrderedJson::array()},
                      {"chords", OrderedJson::array()}};
  for (const TunedFactor& region : tuning.regions)
    json["regions"].push_back({{"name", region.name},
                               {"triangles", region.triangles},
                               {"tuned", region.is_tuned},
                               {"factor", region.factor}});
  for (const TunedFactor& chord : tuning.chords)
    json["chords"].push_back({{"name", chord.name}, {"area_scale", chord.factor}});
  Table triangles{.columns = {{"triangle"}, text_column("region"), {"factor"}}};
  for (const int number : tuning.region_of_triangle) {
    const TunedFactor& region = tuning.regions[static_cast<size_t>(number)];
    triangles.rows.push_back({triangles.rows.size(), region.name, region.factor});
  }
  write_study(folder, "region_tuning", json, without(factor_table(tuning), {"of"}));
  formats::write_whole(folder / "triangle_factors.csv", csv_table(triangles));
}

}  // namespace coapt
