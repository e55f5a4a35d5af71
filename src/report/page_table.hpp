// A table as one of a page.
#pragma once

#include "formats/table.hpp"
#include "report/report_page.hpp"
#include "results/changed_figures.hpp"
#include "results/standing.hpp"

#include <span>
#include <string>
#include <vector>

namespace coapt {

// Nothing is a dash; tones, remarks and shares are the caller's to add.
PageTable page_table(const Table& table, const std::string& caption, const std::string& note = "");

// The figures that one of two states defines, with their meanings in small print.
PageTable change_page_table(const std::vector<ChangedFigure>& figures);

// Good where it is plain, Caution where it is in doubt, Bad where it did not converge.
Tone tone_of(const Standing& of);

// The status of a result, with its doubts or why it did not converge in small print.
PageCell status_cell(const Standing& of);

// "before: converged ...; the valve stands open: ..."
PageText message_line(const Standing& of);

// Puts into the lead of a page what is in doubt, and gives it the tone of the worst. `bad`: of what did not
// converge.
void lead_with(Page& page, const std::string& text, std::span<const Standing> all, bool has_converged,
               Tone bad = Tone::Bad);

}  // namespace coapt
