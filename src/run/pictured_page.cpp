#include "run/pictured_page.hpp"

#include "formats/whole_file.hpp"
#include "report/page_picture.hpp"

namespace coapt {

void write_pictured_page(const RunReport& solved, const std::string& title,
                         const std::vector<PageImage>& pictures) {
  if (!solved.report.has_page) return;
  PageSection section{title, {}};
  for (const PageImage& picture : pictures)
    section.blocks.emplace_back(page_picture(formats::read_whole(picture.file), picture.caption));
  formats::write_whole(solved.folder / "report.html",
                       solve_page_with(solved.model, solved.report, {section}));
}

}  // namespace coapt
