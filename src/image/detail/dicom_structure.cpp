#include "image/detail/dicom_structure.hpp"

#include "core/error.hpp"
#include "formats/whole_file.hpp"

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace coapt {
namespace {

constexpr std::size_t kPreamble = 128;            // bytes before the four letters DICM
constexpr std::uint32_t kUndefined = 0xffffffff;  // length of what a delimiter ends
constexpr int kDeepestSequence = 32;              // sequences within sequences that are followed

// Kinds of values (VR, DICOM PS3.5, table 6.2-1): those whose length has 4 bytes, and the others.
constexpr std::string_view kLongKinds = "OB OD OF OL OV OW SQ SV UC UN UR UT UV";
constexpr std::string_view kShortKinds = "AE AS AT CS DA DS DT FD FL IS LO LT PN SH SL SS ST TM UI UL US";

constexpr std::uint32_t kTransferSyntax = 0x00020010, kPixels = 0x7fe00010;
constexpr std::uint32_t kItem = 0xfffee000, kEndOfItem = 0xfffee00d, kEndOfSequence = 0xfffee0dd;

std::uint32_t number_at(std::string_view bytes, std::size_t at, int size) {
  std::uint32_t number = 0;
  for (int k = size - 1; k >= 0; --k)
    number = number << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(k)]);
  return number;
}

bool is_among(std::string_view kinds, std::string_view kind) {
  const std::size_t at = kinds.find(kind);
  return at != std::string_view::npos && at % 3 == 0;
}

struct DicomElement {
  std::uint32_t tag = 0, length = 0;
};

// A place in the bytes that only goes on over what is there.
class DicomWalk {
 public:
  DicomWalk(std::string_view bytes, std::size_t at) : bytes_(bytes), at_(at) {}

  bool is_explicit = true;  // elements say their kind
  bool is_whole = true;     // so far
  bool has_kind = true;     // the pixels, where elements say theirs
  bool ends() const { return at_ >= bytes_.size() || !is_whole; }
  std::uint32_t next_group() const { return bytes_.size() - at_ < 2 ? 0 : number_at(bytes_, at_, 2); }

  void skip(std::size_t count) {
    is_whole = is_whole && count <= bytes_.size() - at_;
    if (is_whole) at_ += count;
  }

  // Of an element, an item or a delimiter; stands behind it.
  DicomElement head() {
    if (!has(8)) return {};
    DicomElement element;
    element.tag = number_at(bytes_, at_, 2) << 16 | number_at(bytes_, at_ + 2, 2);
    const std::string_view kind = bytes_.substr(at_ + 4, 2);
    const bool is_item = element.tag >> 16 == kItem >> 16;
    const bool is_long = is_among(kLongKinds, kind);
    if (is_explicit && element.tag == kPixels) has_kind = is_long || is_among(kShortKinds, kind);
    if (is_item || !is_explicit) {
      element.length = number_at(bytes_, at_ + 4, 4);
    } else if (!is_long) {
      element.length = number_at(bytes_, at_ + 6, 2);
    } else {
      if (!has(12)) return {};
      element.length = number_at(bytes_, at_ + 8, 4);
      skip(4);
    }
    skip(8);
    return element;
  }

  // Over the items of a sequence, or the fragments of packed pixels, whose length is not stated.
  void skip_items(int depth) {
    while (is_whole) {
      const DicomElement item = head();
      if (item.tag == kEndOfSequence) return;
      is_whole = is_whole && item.tag == kItem && depth < kDeepestSequence;
      if (item.length == kUndefined)
        skip_item(depth + 1);
      else
        skip(item.length);
    }
  }

  std::string_view text(std::size_t length) const { return bytes_.substr(at_, length); }

 private:
  bool has(std::size_t count) { return is_whole = is_whole && count <= bytes_.size() - at_; }

  void skip_item(int depth) {
    while (is_whole) {
      const DicomElement element = head();
      if (element.tag == kEndOfItem) return;
      if (element.length == kUndefined)
        skip_items(depth);
      else
        skip(element.length);
    }
  }

  std::string_view bytes_;
  std::size_t at_;
};

// Of the group of elements with which every file begins; empty where it ends too early.
std::string transfer_syntax(DicomWalk& walk) {
  std::string syntax;
  while (walk.next_group() == 2 && !walk.ends()) {
    const DicomElement element = walk.head();
    const std::string_view value = walk.text(element.length);
    walk.skip(element.length);
    if (element.tag == kTransferSyntax && walk.is_whole) syntax = value.substr(0, value.find('\0'));
  }
  return syntax;
}

// Empty: none.
std::string defect_of(std::string_view bytes) {
  const std::string cut = "the DICOM file ends too early, or holds no image";
  DicomWalk walk(bytes, kPreamble + 4);
  const std::string syntax = transfer_syntax(walk);
  if (!walk.is_whole || syntax.empty()) return cut;
  if (syntax == "1.2.840.10008.1.2.2" || syntax == "1.2.840.10008.1.2.1.99") return "";
  walk.is_explicit = syntax != "1.2.840.10008.1.2";
  while (!walk.ends()) {
    const DicomElement element = walk.head();
    if (!walk.has_kind) return "the DICOM file does not say what kind of numbers its pixels are (no VR)";
    if (element.length == kUndefined)
      walk.skip_items(0);
    else
      walk.skip(element.length);
    if (element.tag == kPixels) return walk.is_whole ? "" : cut;
  }
  return cut;
}

}  // namespace

bool begins_as_dicom(const std::filesystem::path& path) {
  std::string start(kPreamble + 4, '\0');
  return std::ifstream(path, std::ios::binary)
             .read(start.data(), static_cast<std::streamsize>(start.size())) &&
         start.ends_with("DICM");
}

void check_dicom_structure(const std::filesystem::path& path) {
  if (!begins_as_dicom(path))
    throw InputError(path.string() + ": is no DICOM file, whatever its name says; export it again");
  const std::string defect = defect_of(formats::read_whole(path));
  if (!defect.empty())
    throw InputError(path.string() + ": its voxels cannot be read: " + defect + "; copy or export it again");
}

}  // namespace coapt
