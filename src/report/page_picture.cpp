#include "report/page_picture.hpp"

#include "formats/json/base64.hpp"
#include "formats/xml_escaped.hpp"

namespace coapt {

PageMarkup page_picture(const std::string& png, const std::string& caption) {
  const std::string text = formats::xml_escaped(caption);
  const std::span bytes(reinterpret_cast<const std::int8_t*>(png.data()), png.size());
  return {"<figure>\n<figcaption>" + text + "</figcaption>\n<img style=\"max-width: 100%\" alt=\"" + text +
          "\" src=\"data:image/png;base64," + base64(bytes) + "\">\n</figure>\n"};
}

}  // namespace coapt
