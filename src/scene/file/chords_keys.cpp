#include "scene/file/chords_keys.hpp"

namespace coapt {
namespace {

KeySpec tips_key() {
  return {
      .name = "tips",
      .kind = KeyKind::Objects,
      .object = {.keys = {{.name = "at",
                           .kind = KeyKind::Triple,
                           .dimension = kLength,
                           .required = true,
                           .doc = "Where it is in the open valve."},
                          {.name = "closed_at",
                           .kind = KeyKind::Triple,
                           .dimension = kLength,
                           .doc =
                               "Where it is in the closed valve; for all tips or none. `boundary` moves them "
                               "by \"move_to\": \"papillary_closed\"."}}},
      .doc = "Papillary tips; default: `papillary` (and `papillary_closed`) of the file of `mesh.sets`."};
}

KeySpec lengths_key() {
  return {.name = "lengths",
          .kind = KeyKind::Choice,
          .fallback = "\"coapted\"",
          .choices = {"coapted", "plane", "sum"},
          .doc =
              "Rest lengths. plane: from the tip to where the end is expected in the closed valve, "
              "`depth` below the annulus plane; coapted: the same, with free edges as far below as "
              "leaflets hang where they meet; sum: of the distances of the open valve's vertex from "
              "plane and tip."};
}

KeySpec scale_key() {
  return {
      .name = "scale", .fallback = "1", .min = 0, .excludes_min = true, .doc = "Factor on all rest lengths."};
}

KeySpec depth_key() {
  return {.name = "depth",
          .dimension = kLength,
          .fallback = "0",
          .min = 0,
          .doc =
              "How far below the annulus plane the ends are expected in the closed valve, free edges "
              "lower still where `lengths` is coapted: a rest length is the scale times the distance "
              "from the tip to there."};
}

}  // namespace

KeySpec chords_key() {
  return {
      .name = "chords",
      .kind = KeyKind::Object,
      .object =
          {.keys =
               {tips_key(),
                {.name = "zones",
                 .kind = KeyKind::Texts,
                 .fallback = "\"free_edge\"",
                 .doc = "Where chords end, some of \"free_edge\" (material primary), \"rough\" (secondary, "
                        "at 0.65 "
                        "of the way from annulus to free edge) and \"basal\" (tertiary, at 0.25)."},
                {.name = "count",
                 .kind = KeyKind::Integer,
                 .fallback = "24",
                 .min = 1,
                 .max = 10000,
                 .doc = "Chords of each zone that leave the tips, over all tips together."},
                {.name = "levels",
                 .kind = KeyKind::Integer,
                 .fallback = "1",
                 .min = 1,
                 .max = 4,
                 .doc = "1: straight from tip to leaflet; 2: a trunk and its fan; and so on."},
                {.name = "branches",
                 .kind = KeyKind::Integer,
                 .fallback = "3",
                 .min = 2,
                 .max = 6,
                 .doc = "Into how many a chord splits at each branch point."},
                lengths_key(),
                scale_key(),
                depth_key(),
                {.name = "level_areas",
                 .kind = KeyKind::Texts,
                 .doc = "Cross-section of one chord at each level, such as [\"0.4 mm2\", \"0.15 mm2\"]; "
                        "default: 0.4, "
                        "0.8, 1.2 mm2 by zone, shared out at each branch point."},
                {.name = "seed",
                 .kind = KeyKind::Integer,
                 .fallback = "0",
                 .min = 0,
                 .doc = "0: ends at equal steps; any other number shifts each by up to a third of a step."}}},
      .doc =
          "Chords made from papillary tips, annulus plane and free edge where an image shows none (Walczak "
          "et "
          "al. 2019), for terms with \"network\": \"generated\". The sets \"annulus\" and \"free_edge\" name "
          "the "
          "rims; without them the boundary loop farthest from the tips is the annulus."};
}

}  // namespace coapt
