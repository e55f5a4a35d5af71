#include "fuzz/changed_tree.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <set>

namespace coapt::fuzz {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kScene = R"({"mesh": {"file": "mesh.obj"}, // with a comment
  "terms": [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3}, {"type": "cable", "nodes": [0, 1]}]})";
constexpr int kSeeds = 2000;

TEST(ChangedTree, OfJsonIsJsonEachTimeAndMostlyAnother) {
  std::set<std::string> found;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const std::string text = changed_tree(kScene, static_cast<std::size_t>(seed));
    ASSERT_TRUE(Json::accept(text)) << text;
    EXPECT_EQ(text, changed_tree(kScene, static_cast<std::size_t>(seed)));
    found.insert(text);
  }
  EXPECT_GT(found.size(), kSeeds / 2);
}

// What takes the place of the values, and that entries go, come and change their names.
TEST(ChangedTree, ReachesEveryKindOfChange) {
  int lost = 0, doubled = 0, renamed = 0, wrapped = 0, replaced = 0, negative = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Json tree = Json::parse(changed_tree(kScene, static_cast<std::size_t>(seed)));
    if (!tree.is_object()) continue;
    lost += !tree.contains("mesh");
    renamed += tree.contains("poisson");
    replaced += tree.contains("mesh") && !tree["mesh"].is_object();
    if (!tree.contains("terms") || !tree["terms"].is_array() || tree["terms"].empty()) continue;
    const Json& terms = tree["terms"];
    doubled += terms.size() == 3;
    wrapped += terms.size() == 1 && terms[0].is_array();
    negative += terms[0].is_object() && terms[0].value("poisson", Json()) == Json(-0.3);
  }
  for (const int count : {lost, doubled, renamed, wrapped, replaced, negative}) EXPECT_GT(count, 0);
}

TEST(ChangedTree, OfCborIsCbor) {
  std::string bytes;
  Json::to_cbor(Json{{"x", Json::array({1.5, 2, nullptr})}, {"name", "run"}}, bytes);
  for (std::size_t seed = 0; seed < 200; ++seed) {
    const std::string changed = changed_tree(bytes, seed);
    EXPECT_FALSE(Json::from_cbor(changed, true, false).is_discarded()) << seed;
  }
}

TEST(ChangedTree, LeavesWhatIsNoTreeAndWhatIsTooDeepAlone) {
  for (const std::string& text : {std::string(), std::string("v 0 0 0\nf 1 2 3\n"), std::string("{\"a\": "),
                                  std::string(18000, '['), std::string(200, '[') + std::string(200, ']'),
                                  "\x9b" + std::string(8, '\x9b')})  // CBOR: an array of more than there are
    EXPECT_EQ(changed_tree(text, 1), "") << text.substr(0, 20);
}

}  // namespace
}  // namespace coapt::fuzz
