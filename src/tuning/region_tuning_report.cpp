// region_tuning.json and region_tuning.csv.
#include "formats/csv_table.hpp"
#include "formats/whole_file.hpp"
#include "results/study_files.hpp"
#include "tuning/region_tuning.hpp"

namespace coapt {

void write_region_tuning(const std::filesystem::path& folder, const RegionTuning& tuning) {
  const auto state = [](const TuningState& s) -> OrderedJson {
    return {{"max_chord_strain", number_json(s.max_chord_strain)},
            {"strained_chords", s.strained_chords},
            {"orifice_area_mm2", number_json(s.orifice_area_mm2)}};
  };
  OrderedJson json = {{"scene", tuning.scene_file},
                      {"reached", tuning.is_reached},
                      {"message", tuning.message},
                      {"yield_strain", tuning.yield_strain},
                      {"orifice_limit_mm2", number_json(tuning.orifice_limit_mm2)},
                      {"before", state(tuning.before)},
                      {"after", state(tuning.after)},
                      {"rounds", tuning.rounds},
                      {"solves", tuning.solves},
                      {"failed_solves", tuning.failed_solves},
                      {"wall_s", tuning.wall_s},
                      {"regions", OrderedJson::array()},
                      {"chords", OrderedJson::array()}};
  std::ostringstream csv = csv_with_header("name,triangles,factor"),
                     triangles = csv_with_header("triangle,region,factor");
  for (const TunedFactor& region : tuning.regions) {
    json["regions"].push_back({{"name", region.name},
                               {"triangles", region.triangles},
                               {"tuned", region.is_tuned},
                               {"factor", region.factor}});
    csv << csv_text(region.name) << ',' << region.triangles << ',' << region.factor << '\n';
  }
  for (const TunedFactor& chord : tuning.chords) {
    json["chords"].push_back({{"name", chord.name}, {"area_scale", chord.factor}});
    csv << csv_text(chord.name) << ",," << chord.factor << '\n';
  }
  for (size_t t = 0; t < tuning.region_of_triangle.size(); ++t) {
    const TunedFactor& region = tuning.regions[static_cast<size_t>(tuning.region_of_triangle[t])];
    triangles << t << ',' << csv_text(region.name) << ',' << region.factor << '\n';
  }
  write_study(folder, "region_tuning", json, csv.str());
  formats::write_whole(folder / "triangle_factors.csv", triangles.str());
}

}  // namespace coapt
