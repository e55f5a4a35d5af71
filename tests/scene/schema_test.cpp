#include "scene/file/schema.hpp"

#include "exchange/reference_page.hpp"
#include "formats/json/suggestion.hpp"
#include "scene/terms/term_types.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace coapt {
namespace {

// The committed file; with COAPT_UPDATE_GENERATED set in the environment it is written first.
std::string committed(const std::string& name, const std::string& generated) {
  const std::string path = std::string(COAPT_SOURCE_DIR) + "/" + name;
  if (std::getenv("COAPT_UPDATE_GENERATED") != nullptr) std::ofstream(path, std::ios::binary) << generated;
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

TEST(SceneSchema, IsTheOneInTheRepository) {
  EXPECT_EQ(committed("schema/scene.schema.json", json_schema()), json_schema())
      << "run this test once with COAPT_UPDATE_GENERATED=1 and commit the file";
}

TEST(SceneSchema, HasTheReferencePageInTheRepository) {
  EXPECT_EQ(committed("docs/scene.md", reference_page()), reference_page())
      << "run this test once with COAPT_UPDATE_GENERATED=1 and commit the file";
}

void expect_documented(const std::vector<KeySpec>& keys, const std::string& where) {
  for (const KeySpec& key : keys) {
    EXPECT_TRUE(key.doc.ends_with(".")) << where << "." << key.name << " has no sentence";
    expect_documented(key.object.keys, where + "." + key.name);
  }
}

TEST(SceneSchema, SaysOneSentenceOfEveryKey) {
  expect_documented(scene_spec().keys, "scene");
  ASSERT_GE(term_types().size(), 7u);
  for (const TermType& type : term_types()) {
    EXPECT_FALSE(type.summary.empty()) << type.name;
    expect_documented(type.spec.keys, type.name);
  }
}

TEST(Suggestion, CountsASwapOfNeighboursAsOneEdit) {
  EXPECT_EQ(edit_distance("yuong", "young"), 1);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("thickness", "thicknes"), 1);
  EXPECT_EQ(edit_distance("same", "same"), 0);
}

TEST(Suggestion, NamesTheNearestOnlyWhereItIsNear) {
  EXPECT_EQ(suggestion("poissn", {"young", "poisson"}), "; did you mean \"poisson\"?");
  EXPECT_EQ(suggestion("quite_other", {"young", "poisson"}), "");
  EXPECT_EQ(suggestion(std::string(100000, 'a'), {"young"}), "");
}

}  // namespace
}  // namespace coapt
