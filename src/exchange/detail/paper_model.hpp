// A published model of a valve: what it makes of a valve and its scene, and what is to be said of it. Private
// to this room.
#pragma once

#include "exchange/import.hpp"
#include "formats/valve.hpp"

#include <string>

namespace coapt::detail {

struct PaperModel {
  std::string name;   // of --model: author and year
  std::string title;  // behind the valve's name in its scene
  // Changes the valve and the options of its scene. Throws InputError with all that the model needs and the
  // valve has not, each with what to give.
  void (*apply)(const PaperModel&, Valve&, ImportOptions&);
  // Markdown: what the paper states, where it is not followed, what it leaves open and what was chosen.
  std::string (*notes)(const Valve&);
};

PaperModel hammer_2008_model();
PaperModel hammer_2011_model();
PaperModel burlina_2010_model();
PaperModel toma_2016_model();
PaperModel walczak_2019_model();

// Leaflets without regions become one region of this name.
void name_whole_leaflets(Valve& valve);

}  // namespace coapt::detail
