#include "core/json.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "core/error.h"

namespace patina {
namespace {

std::string jsonError(const std::string& text) {
  try {
    parseJson(text, "scene.json");
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(Json, KeepsTheOrderOfMembers) {
  Json json = Json::object();
  json.set("zebra", 1).set("ant", 2).set("zebra", 3);
  EXPECT_EQ(json.dump(-1), R"({"zebra":3,"ant":2})");
}

TEST(Json, DoublesReadBackBitForBit) {
  std::mt19937_64 random(7);
  std::vector<double> list{0.1, -0.0, 2.0, 1e22, 5e-324, std::numeric_limits<double>::max()};
  for (int i = 0; i < 2000; ++i) {
    double value;
    const std::uint64_t bits = random();
    std::memcpy(&value, &bits, sizeof value);
    if (std::isfinite(value)) list.push_back(value);
  }
  for (const double value : list) {
    const double back = parseJson(Json(value).dump(), "x").asNumber();
    EXPECT_EQ(std::memcmp(&back, &value, sizeof value), 0) << Json(value).dump();
  }
}

TEST(Json, DoublesStayDoublesAfterOthersInTheSameText) {
  Json json = Json::array();
  json.push(0.5);
  json.push(2.0);
  EXPECT_EQ(json.dump(-1), "[0.5,2.0]");
}

TEST(Json, IntegersReadBackExactly) {
  for (const std::int64_t value :
       {std::int64_t{0}, std::int64_t{-1}, (std::int64_t{1} << 53) + 1,
        std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()})
    EXPECT_EQ(parseJson(Json(value).dump(), "x").asInteger(), value);
}

TEST(Json, NonFiniteNumbersAreWrittenAsNull) {
  EXPECT_EQ(Json(std::nan("")).dump(), "null");
  EXPECT_EQ(Json(-INFINITY).dump(), "null");
}

TEST(Json, StringsWithEveryByteReadBack) {
  std::string text;
  for (int c = 1; c < 128; ++c) text += static_cast<char>(c);
  text += "\xC3\xA9\xE2\x82\xAC";
  EXPECT_EQ(parseJson(Json(text).dump(), "x").asString(), text);
}

TEST(Json, InvalidUtf8IsReplacedAndNotThrown) {
  EXPECT_EQ(parseJson(Json(std::string("a\xFF z")).dump(), "x").asString(), "a\xEF\xBF\xBD z");
}

TEST(Json, NestedValuesReadBack) {
  const std::string text = R"({"a":[1,2.5,{"b":null}],"c":{},"d":[],"e":true})";
  EXPECT_EQ(parseJson(text, "x").dump(-1), text);
  EXPECT_EQ(parseJson(parseJson(text, "x").dump(2), "x").dump(-1), text);
}

TEST(Json, WrongKindIsNamed) {
  const Json json = parseJson(R"({"a": "text"})", "x");
  try {
    json.at("a").asNumber();
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "expected number, found string");
  }
  EXPECT_THROW(json.at("b"), Error);
  EXPECT_THROW(json.asArray(), Error);
  EXPECT_THROW(Json(2.5).asInteger(), Error);
  EXPECT_THROW(Json(1e19).asInteger(), Error);
  EXPECT_EQ(Json(2.0).asInteger(), 2);
  EXPECT_EQ(json.find("b"), nullptr);
}

TEST(Json, ErrorsNameFileAndLine) {
  EXPECT_TRUE(jsonError("{\n  \"a\": 1,\n  oops\n}").starts_with("scene.json:3: "));
  EXPECT_TRUE(jsonError("{\"a\": [1, 2").find("ends too early") != std::string::npos);
}

TEST(Json, AKeyThatStandsTwiceInAnObjectIsAnError) {
  for (const char* text : {R"({"a": 1, "b": 2, "a": 3})", R"({"x": [{"a": 1, "a": 1}]})"}) {
    try {
      (void)parseJson(text, "f.json");
      ADD_FAILURE() << text;
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("the key 'a' stands twice"), std::string::npos);
    }
  }
  EXPECT_EQ(parseJson(R"([{"a": 1}, {"a": 2}])", "f.json").asArray().size(), 2u);
}

TEST(Json, EveryTruncationOfAFileIsAnError) {
  const std::string text = R"({"version": 1, "list": [1.5, "a", true, null], "m": {"k": -2e3}})";
  for (std::size_t size = 0; size < text.size(); ++size)
    EXPECT_NE(jsonError(text.substr(0, size)), "") << size;
  EXPECT_EQ(jsonError(text), "");
}

TEST(Json, HostileDepthIsAnErrorAndNotACrash) {
  EXPECT_NE(jsonError(std::string(1000000, '[')), "");
  EXPECT_NE(jsonError(std::string(201, '[') + std::string(201, ']')), "");
  EXPECT_EQ(jsonError(std::string(200, '[') + std::string(200, ']')), "");
}

TEST(Json, RejectsOtherTexts) {
  for (const char* text : {"", "nul", "{'a': 1}", "[1,]", "01", "1 2", "[1e999]", "{\"a\" 1}",
                           "\x01\x02", "[1.5,2,5", "// note\n1"})
    EXPECT_NE(jsonError(text), "") << text;
}

} // namespace
} // namespace patina
