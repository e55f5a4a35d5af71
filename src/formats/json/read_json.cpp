#include "formats/json/read_json.hpp"

#include "core/error.hpp"
#include "formats/whole_file.hpp"

#include <regex>
#include <set>
#include <vector>

namespace coapt {
namespace {

constexpr int kGreatestDepth = 64;
constexpr std::uintmax_t kGreatestSize = 64u << 20;

// Follows the parser to know the path of each key and which keys an object has had.
class KeyWatch {
 public:
  explicit KeyWatch(std::string file) : file_(std::move(file)) {}

  bool operator()(int depth, Json::parse_event_t event, Json& parsed) {
    using Event = Json::parse_event_t;
    if (event == Event::object_start || event == Event::array_start) {
      if (depth >= kGreatestDepth)
        throw InputError(file_ + ": nested deeper than " + std::to_string(kGreatestDepth) + " levels at " +
                         path().substr(0, 200));
      count_item();
      frames_.push_back({event == Event::array_start, -1, "", {}});
    } else if (event == Event::object_end || event == Event::array_end) {
      frames_.pop_back();
    } else if (event == Event::key) {
      Frame& frame = frames_.back();
      frame.key = parsed.get<std::string>();
      if (!frame.keys.insert(frame.key).second)
        repeated_.push_back(file_ + ": " + path() + ": given twice; keep one of them");
    } else {
      count_item();
    }
    return true;
  }

  const std::vector<std::string>& repeated() const { return repeated_; }

 private:
  struct Frame {
    bool is_array;
    long index;
    std::string key;
    std::set<std::string> keys;
  };

  void count_item() {
    if (!frames_.empty() && frames_.back().is_array) ++frames_.back().index;
  }

  std::string path() const {
    std::string text;
    for (const Frame& frame : frames_) {
      if (frame.is_array)
        text.append("[").append(std::to_string(frame.index)).append("]");
      else
        text.append(text.empty() ? "" : ".").append(frame.key);
    }
    return text;
  }

  std::string file_;
  std::vector<Frame> frames_;
  std::vector<std::string> repeated_;
};

// The library's message is "[json.exception...] parse error at line L, column C: REASON".
std::string readable(const std::string& message, const std::string& file) {
  static const std::regex kPlace("line ([0-9]+), column ([0-9]+): ([^]*)");
  std::smatch match;
  if (!std::regex_search(message, match, kPlace)) return file + ": not valid JSON: " + message;
  return file + ":" + match[1].str() + ":" + match[2].str() + ": not valid JSON: " + match[3].str();
}

}  // namespace

Json parse_json(const std::string& text, const std::string& file) {
  KeyWatch watch(file);
  Json json;
  try {
    json = Json::parse(text, std::ref(watch), true, true);
  } catch (const Json::exception& error) {
    constexpr size_t kLongestReason = 300;  // the message quotes the token, however long it is
    std::string message = error.what();
    if (message.size() > kLongestReason) message = message.substr(0, kLongestReason) + " ...";
    throw InputError(readable(message, file));
  }
  if (!watch.repeated().empty()) throw InputError(watch.repeated());
  return json;
}

std::string read_text(const std::filesystem::path& path) { return formats::read_whole(path, kGreatestSize); }

Json read_json(const std::filesystem::path& path) { return parse_json(read_text(path), path.string()); }

}  // namespace coapt
