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

// Beside the coaptation area, or in its place: that of the area within the contact distance less than a
// quarter is left in contact itself, where finer meshes show a half and more. One clause; empty where it is
// not so.
std::string coaptation_remark(const Metrics& metrics);

// Which facets and chords have fibres beyond their yield, one sentence; empty where none has.
std::string yield_warning(const Fields& fields);

// Why a closed valve stands open, in one clause; empty where it closes, and for a scene without an annulus:
// its leaflets meet nowhere, or the orifice is as large as the effective orifice of severe regurgitation, 40
// mm2 (Lancellotti et al. 2013, of mitral and tricuspid valves alike).
std::string standing_open(const Metrics& metrics);

// What is doubtful about the surface itself, a clause for each: edges with more than two facets, facets whose
// normals point against their neighbours'. On which side pressure acts is not defined there. Pre: corners in
// range.
std::vector<std::string> surface_doubts(const TriangleMesh& mesh);

// Of an equilibrium: whether it is not stable or that could not be decided.
bool is_in_doubt(const Report& report);

// Why an equilibrium is no plain result, a clause for each reason: it is not stable, facets pass through each
// other, the valve stands open, its leaflets are stretched far beyond what was measured in vivo, most chords
// are slack, its surface is doubtful, it may not be the only one. None where the run did not converge.
std::vector<std::string> doubts(const Report& report);

// Whether one of these doubts() is that of is_in_doubt(), where no report is kept.
bool are_about_stability(const std::vector<std::string>& doubts);

// A state at rest in which facets pass through each other that collisions were to keep apart is not
// converged, whatever its residual: its status becomes Stalled, and its message says why.
void withdraw_penetrated(Report& report);

// The first line of a result.
struct Headline {
  std::string text;          // the message of the solve, which tells of its stability, and all other doubts()
  bool is_in_doubt = false;  // there are some
};

Headline headline(const Report& report);

}  // namespace coapt
