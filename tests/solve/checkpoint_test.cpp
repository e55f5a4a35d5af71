#include "solve/checkpoint.hpp"

#include "core/error.hpp"
#include "formats/json/checksummed_cbor.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <iterator>

namespace coapt {
namespace {

const RunIdentity kOwn{"0.1.0", "0123456789abcdef", "newton", 1e-6, {}};

RunRecord some_record() {
  RunRecord record;
  record.ends.push_back({Points::Random(3, 7), Status::Stalled, false, "after 3 steps"});
  record.ends.push_back({Points::Random(3, 4), Status::Converged, true, ""});
  record.order = KeptOrder({{2, 0, 1}, {0, 2, 3}, {1, -1}}, 6);
  record.iterate = Vector::Random(9);
  record.iterations = 12;
  record.seconds = 3.25;
  return record;
}

std::string read(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// What reading the bytes is refused with; empty where it is not.
std::string refusal(const TemporaryFolder& folder, const std::string& bytes, const RunIdentity& own = kOwn) {
  try {
    read_checkpoint(folder.write("damaged", bytes), own);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

class Checkpoint : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "run";
};

TEST_F(Checkpoint, GivesBackTheRecordToTheLastBit) {
  const RunRecord record = some_record();
  write_checkpoint(file_, kOwn, RunRecord());
  EXPECT_TRUE(read_checkpoint(file_, kOwn).ends.empty());
  write_checkpoint(file_, kOwn, record);
  const RunRecord back = read_checkpoint(file_, kOwn);
  ASSERT_EQ(back.ends.size(), 2u);
  for (size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(back.ends[k].x, record.ends[k].x);
    EXPECT_EQ(back.ends[k].status, record.ends[k].status);
    EXPECT_EQ(back.ends[k].is_at_rest, record.ends[k].is_at_rest);
    EXPECT_EQ(back.ends[k].remark, record.ends[k].remark);
  }
  EXPECT_EQ(back.order.found().order, record.order.found().order);
  EXPECT_EQ(back.order.found().first, record.order.found().first);
  EXPECT_EQ(back.order.found().parent, record.order.found().parent);
  EXPECT_EQ(back.order.entries(), 6);
  EXPECT_EQ(back.iterate, record.iterate);
  EXPECT_EQ(back.iterations, 12);
  EXPECT_EQ(back.seconds, 3.25);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1) << "nothing beside it";
}

TEST_F(Checkpoint, RefusesOneThatIsDamagedOrCutOffAnywhere) {
  write_checkpoint(file_, kOwn, some_record());
  const std::string whole = read(file_);
  for (size_t k = 0; k < whole.size(); k += 11) {
    std::string changed = whole;
    changed[k] = static_cast<char>(changed[k] ^ 4);
    EXPECT_NE(refusal(folder_, changed), "") << "byte " << k;
    EXPECT_NE(refusal(folder_, whole.substr(0, k)), "") << "cut off at " << k;
  }
  EXPECT_NE(refusal(folder_, whole + "x").find("damaged or cut off"), std::string::npos);
  EXPECT_NE(refusal(folder_, "{}").find("is no checkpoint"), std::string::npos);
  std::string other = whole;
  other.replace(other.find(" 3 "), 3, " 2 ");
  EXPECT_NE(refusal(folder_, other).find("of format 2"), std::string::npos);
  EXPECT_THROW(read_checkpoint(folder_.path() / "none", kOwn), InputError);
  EXPECT_THROW(write_checkpoint(folder_.path(), kOwn, RunRecord()), InputError);
  EXPECT_THROW(write_checkpoint(folder_.path() / "no" / "file", kOwn, RunRecord()), InputError);
}

TEST_F(Checkpoint, RefusesWhatNoRunLeavesThoughItsChecksumIsGood) {
  write_checkpoint(file_, kOwn, some_record());
  const std::string whole = read(file_);
  const Json good = Json::from_cbor(whole.substr(whole.find('\n') + 1));
  const auto resealed = [](const std::string& body) {
    return "coapt checkpoint 3 " + fingerprint(body) + "\n" + body;
  };
  const auto refusal_with = [&](const std::string& key, const Json& value) {
    Json json = good;
    json["record"][key] = value;
    const std::vector<std::uint8_t> body = Json::to_cbor(json);
    return refusal(folder_, resealed({body.begin(), body.end()}));
  };
  EXPECT_EQ(refusal_with("iterations", 13), "");
  for (const Json& value : {Json(1e300), Json(-1), Json(12.5), Json(1LL << 40), Json("12")})
    EXPECT_NE(refusal_with("iterations", value).find("--resume"), std::string::npos) << value;
  const auto order = [](const Json& nodes, const Json& entries) {
    return Json{{"nodes", nodes}, {"first_columns", {0, 2}}, {"parents", {-1}}, {"entries", entries}};
  };
  EXPECT_EQ(refusal_with("order", order({1, 0}, 3)), "");
  for (const Json& value :
       {order({1, 1}, 3), order({1, 0.5}, 3), order({1, 1e300}, 3), order({1, 1LL << 32}, 3),
        order({1, true}, 3), order({1, 0}, -3), order({1, 0}, 5), order({1, 0}, kNaN), Json("none")})
    EXPECT_NE(refusal_with("order", value).find("--resume"), std::string::npos) << value;
  EXPECT_EQ(refusal_with("seconds", 0.5), "");
  for (const Json& value : {Json(-0.5), Json(kNaN), Json(kInfinity)})
    EXPECT_NE(refusal_with("seconds", value).find("--resume"), std::string::npos) << value;
  const std::string nested(1'000'000, '\x81');  // each a list of one
  EXPECT_NE(refusal(folder_, resealed(nested)).find("nested too deep"), std::string::npos);
}

TEST_F(Checkpoint, NamesAllThatDiffersFromTheRun) {
  write_checkpoint(file_, kOwn, some_record());
  const std::string whole = read(file_);
  EXPECT_EQ(refusal(folder_, whole), "");
  const std::string reason = refusal(folder_, whole, {"0.2.0", "fedcba9876543210", "lbfgs", 1e-8, 0.1});
  for (const char* piece :
       {"another scene", "coapt 0.1.0", "0.2.0", "newton", "lbfgs", "1e-06", "1e-08", "--accuracy"})
    EXPECT_NE(reason.find(piece), std::string::npos) << piece << " in\n" << reason;
}

TEST_F(Checkpoint, KnowsASceneByItsContentsAndFiles) {
  const auto fingerprint = [&](const std::string& text) {
    Scene scene;
    scene.file = folder_.write("scene.json", text);
    return scene_fingerprint(scene);
  };
  folder_.write("m.obj", "v 0 0 0\n");
  const std::string text = R"({"mesh": {"file": "m.obj"}, "solver": {"type": "newton", "memory": 3}})";
  const std::string own = fingerprint(text);
  EXPECT_EQ(own.size(), 16u);
  EXPECT_EQ(fingerprint("// a note\n" + text), own);
  EXPECT_EQ(
      fingerprint(R"({"solver": {"memory": 3, "max_seconds": 5, "threads": 2}, "mesh": {"file": "m.obj"},
                            "name": "x", "output": {"frames": 3}})"),
      own);
  EXPECT_NE(fingerprint(R"({"mesh": {"file": "m.obj"}, "solver": {"type": "newton", "memory": 4}})"), own);
  folder_.write("m.obj", "v 0 0 1\n");
  EXPECT_NE(fingerprint(text), own);
}

}  // namespace
}  // namespace coapt
