// What a reader of a result must know before its figures.
#pragma once

#include "results/results.hpp"

#include <string>
#include <vector>

namespace coapt {

// Whole sentences: the warnings of the solve; why its stability is in doubt; that other equilibria were found
// near by; how many nodes have no determined place.
std::vector<std::string> result_warnings(const Report& report);

// Which facets are stretched by more than 100 %, and which chords and cables by more than 20 %, numbered as
// in closed.vtp, one sentence; empty where none is. Tissue and sailcloth bear neither: the data is at fault.
std::string stretch_warning(const Fields& fields);

// Which facets and chords have fibres beyond their yield, one sentence; empty where none has.
std::string yield_warning(const Fields& fields);

// Why a closed valve stands open, in one clause; empty where it closes, and for a scene without an annulus:
// its leaflets meet nowhere, or the orifice is as large as the effective orifice of severe regurgitation, 40
// mm2 (Lancellotti et al. 2013, of mitral and tricuspid valves alike).
std::string standing_open(const Metrics& metrics);

// Of an equilibrium: whether it is not stable or that could not be decided.
bool is_in_doubt(const Report& report);

// A state at rest in which facets pass through each other that collisions were to keep apart is not
// converged, whatever its residual: its status becomes Stalled, and its message says why.
void withdraw_penetrated(Report& report);

// The first line of a result.
struct Headline {
  // The message of the solve and, of an equilibrium, facets that pass through each other, a valve that stands
  // open, chords of which most are slack, and whether it may not be the only one.
  std::string text;
  // Of an equilibrium: see is_in_doubt(); any of these.
  bool is_in_doubt = false;
};

Headline headline(const Report& report);

}  // namespace coapt
