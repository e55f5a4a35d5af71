#include "report/report_page.hpp"

#include "core/components.hpp"
#include "core/number_text.hpp"
#include "formats/xml_escaped.hpp"
#include "report/detail/page_plot.hpp"
#include "report/detail/report_files.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

using formats::xml_escaped;

std::string_view tone_class(Tone tone) {
  switch (tone) {
    case Tone::Good:
      return "good";
    case Tone::Caution:
      return "caution";
    case Tone::Bad:
      return "bad";
    default:
      return "plain";
  }
}

std::string element(const std::string& name, const PageText& text) {
  return "<" + name + " class=\"" + std::string(tone_class(text.tone)) + "\">" + xml_escaped(text.text) +
         "</" + name + ">\n";
}

std::string html(const PageText& text) { return element("p", text); }

std::string html(const PageList& list) {
  if (list.items.empty()) return "";
  std::string html = "<ul>\n";
  for (const PageText& item : list.items) html += element("li", item);
  return html + "</ul>\n";
}

std::string cell_html(const PageCell& cell, size_t column, bool is_text) {
  // Long texts to which a narrow screen scrolls must not make what is seen of the row high.
  constexpr size_t kSeen = 4, kLong = 40;
  const bool is_name = column == 0, is_beyond = is_text && column >= kSeen && cell.text.size() > kLong;
  const std::string name = is_name ? "th scope=\"row\"" : "td";
  std::string html = "<" + name + " class=\"" + std::string(tone_class(cell.tone)) +
                     (is_text ? " text" : "") + (is_beyond ? " beyond" : "") + "\">" + xml_escaped(cell.text);
  if (!cell.remark.empty()) html += "<small>" + xml_escaped(cell.remark) + "</small>";
  return html + (is_name ? "</th>" : "</td>");
}

// Widths of the columns, where they are given.
std::string shares(const std::vector<PageColumn>& columns) {
  std::string html;
  for (const PageColumn& column : columns)
    if (column.share > 0) html += "<col style=\"width:" + std::to_string(column.share) + "%\">";
  return html.empty() ? html : "<colgroup>" + html + "</colgroup>\n";
}

std::string html(const PageTable& table) {
  const std::string widths = shares(table.columns);
  std::string html = "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"" +
                     xml_escaped(table.caption) + "\">\n<table" +
                     (widths.empty() ? "" : " class=\"shared\"") + ">\n<caption>" +
                     xml_escaped(table.caption) + "</caption>\n" + widths + "<thead><tr>";
  for (const PageColumn& column : table.columns)
    html += std::string("<th scope=\"col\"") + (column.is_text ? " class=\"text\"" : "") + ">" +
            xml_escaped(column.title) + "</th>";
  html += "</tr></thead>\n<tbody>\n";
  for (const std::vector<PageCell>& row : table.rows) {
    html += "<tr>";
    for (size_t c = 0; c < table.columns.size(); ++c)
      html += cell_html(c < row.size() ? row[c] : PageCell{}, c, table.columns[c].is_text);
    html += "</tr>\n";
  }
  html += "</tbody>\n</table>\n</div>\n";
  if (!table.note.empty()) html += "<p class=\"quiet\">" + xml_escaped(table.note) + "</p>\n";
  return html;
}

std::string html(const PagePlot& plot) {
  std::string html =
      plot_html(plot) + (has_plots() ? "<details>" : "<details open>") + "<summary>Numbers</summary>\n";
  for (const PageTable& numbers : plot_numbers(plot)) html += coapt::html(numbers);
  return html + "</details>\n";
}

std::string html(const PageMarkup& markup) { return markup.html; }

}  // namespace

std::string report_page(const Page& page) {
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      // The browser itself refuses whatever would leave the page.
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
      "script-src 'unsafe-inline'; img-src data: blob:\">\n"
      "<meta name=\"generator\" content=\"coapt " +
      version() + "\">\n<title>" + xml_escaped(page.title) + "</title>\n<style>\n" +
      std::string(report_files::style) + "</style>\n</head>\n<body>\n<header>\n<h1>" +
      xml_escaped(page.title) + "</h1>\n" +
      (page.lead.empty() ? ""
                         : "<p class=\"lead " + std::string(tone_class(page.tone)) + "\">" +
                               xml_escaped(page.lead) + "</p>\n") +
      "</header>\n<main>\n";
  int number = 0;
  bool has_plot = false;
  for (const PageSection& section : page.sections) {
    const std::string id = "section-" + std::to_string(++number);
    text += "<section aria-labelledby=\"" + id + "\">\n<h2 id=\"" + id + "\">" + xml_escaped(section.title) +
            "</h2>\n";
    for (const PageBlock& block : section.blocks) {
      text += std::visit([](const auto& part) { return html(part); }, block);
      has_plot = has_plot || std::holds_alternative<PagePlot>(block);
    }
    text += "</section>\n";
  }
  return text + "</main>\n<footer>" + (page.footer.empty() ? "" : "<p>" + xml_escaped(page.footer) + "</p>") +
         "<p>Written by coapt " + version() + ".</p></footer>\n" + (has_plot ? plot_scripts() : "") +
         "</body>\n</html>\n";
}

std::string spaced(std::string_view name) {
  std::string words(name);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string page_number(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  const double size = std::abs(value);
  // Whole numbers with all their digits: counts are exact.
  if (size < 1e9 && value == std::round(value)) return number_text(value, 9);
  if (size < 1e-3 || size >= 1e6) return number_text(value, std::max(1, digits - 1));
  return number_text(value, std::max(digits, static_cast<int>(std::ceil(std::log10(size)))));
}

}  // namespace coapt
