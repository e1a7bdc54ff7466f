#include "scene/stroke.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "scene/edit.h"

namespace patina {
namespace {

const char* const kWhole = R"({"version": 1, "strokes": [
  {"tool": "color", "value": [0.1, 0.2, 1], "radius": 0.004, "falloff": 2, "shape": "smooth",
   "mode": "build-up", "front_only": true, "symmetry": "y",
   "radius_per_force": 0.001, "least_radius": 0.002, "most_radius": 0.01,
   "samples": [{"t": 0, "position": [0.01, 0, -0.02], "force": 0.5}, {"t": 0.5, "position": [1, 2, 3]}]},
  {"tool": "friction.static", "value": 0.7, "samples": [{"position": [0, 0, 0]}]},
  {"tool": "erase", "erases": "relief", "samples": [{"position": [0, 0, 0]}]}]})";

std::string textOf(const std::string& stroke) {
  return R"({"version": 1, "strokes": [)" + stroke + "]}";
}

std::string errorOf(const std::string& text) {
  try {
    parseStrokes(text, "hand.json");
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(Strokes, EveryKeyIsRead) {
  const std::vector<Stroke> strokes = parseStrokes(kWhole, "hand.json");
  ASSERT_EQ(strokes.size(), 3U);
  const Brush& brush = strokes[0].brush;
  EXPECT_EQ(brush.tool, Tool::color);
  EXPECT_EQ(brush.color, (std::array<double, 3>{0.1, 0.2, 1}));
  EXPECT_EQ(brush.radius, 0.004);
  EXPECT_EQ(brush.falloff, 2);
  EXPECT_EQ(brush.shape, BrushShape::smooth);
  EXPECT_EQ(brush.mode, StrokeMode::build_up);
  EXPECT_TRUE(brush.front_only);
  EXPECT_EQ(brush.symmetry, Symmetry::y);
  EXPECT_EQ(brush.radius_per_force, 0.001);
  EXPECT_EQ(brush.min_radius, 0.002);
  EXPECT_EQ(brush.max_radius, 0.01);
  ASSERT_EQ(strokes[0].samples.size(), 2U);
  EXPECT_EQ(strokes[0].samples[0].position, Vec3(0.01, 0, -0.02));
  EXPECT_EQ(strokes[0].samples[0].force, 0.5);
  EXPECT_EQ(strokes[0].samples[1].t, 0.5);
  EXPECT_EQ(strokes[0].samples[1].force, 0);
  // Omitted keys have the defaults of Brush.
  Brush usual;
  usual.tool = Tool::material(MaterialChannel::static_friction);
  usual.value = 0.7;
  EXPECT_EQ(strokes[1].brush, usual);
  EXPECT_EQ(strokes[2].brush.erases, "relief");
}

TEST(Strokes, ReadBackBitForBit) {
  std::vector<Stroke> strokes = parseStrokes(kWhole, "hand.json");
  strokes[0].samples[0].position = Vec3(1.0 / 3, -0.1, 1e-17);
  strokes[0].brush.radius = 0.1 / 3;
  for (const Tool tool :
       {Tool::relief, Tool::material(MaterialChannel::stiffness),
        Tool::material(MaterialChannel::damping), Tool::material(MaterialChannel::roughness)}) {
    Stroke stroke;
    stroke.brush.tool = tool;
    stroke.brush.value = 1e-4 / 3;
    stroke.brush.mode = StrokeMode::add;
    stroke.brush.shape = BrushShape::cone;
    stroke.samples.emplace_back();
    strokes.push_back(stroke);
  }
  EXPECT_EQ(parseStrokes(toJson(strokes).dump(-1), "again"), strokes);
  EXPECT_EQ(parseStrokes(toJson(strokes).dump(), "again"), strokes);
}

// The published brush paints colour and haptic properties at once.
TEST(Strokes, SeveralLayersAreOneStrokeAndOneLayerIsTheOldForm) {
  const std::string several = R"({"layers": [
    {"tool": "color", "value": [0.1, 0.2, 1]}, {"value": 900, "tool": "stiffness"},
    {"tool": "friction.static", "value": 0.7}], "radius": 0.004, "seed": "segment",
    "samples": [{"position": [0, 0, 1], "tip": [0.1, 0.2, 0.9]}, {"position": [0, 0, 2]}]})";
  const std::vector<Stroke> strokes = parseStrokes(textOf(several), "hand.json");
  const Brush& brush = strokes.at(0).brush;
  EXPECT_EQ(brush.anchor, DabAnchor::segment);
  ASSERT_EQ(layersOf(brush).size(), 3U);
  EXPECT_EQ(layersOf(brush)[0].color, (std::array<double, 3>{0.1, 0.2, 1}));
  ASSERT_NE(layerOf(brush, Tool::material(MaterialChannel::stiffness)), nullptr);
  EXPECT_EQ(layerOf(brush, Tool::material(MaterialChannel::stiffness))->value, 900);
  EXPECT_EQ(layerOf(brush, Tool::material(MaterialChannel::static_friction))->value, 0.7);
  EXPECT_EQ(layerOf(brush, Tool::relief), nullptr);
  EXPECT_EQ(strokes[0].samples[0].tip, std::optional(Vec3(0.1, 0.2, 0.9)));
  EXPECT_FALSE(strokes[0].samples[1].tip);
  EXPECT_EQ(parseStrokes(toJson(strokes).dump(-1), "again"), strokes);
  EXPECT_EQ(describe(strokes[0]), "color, stiffness 900 N/m, friction.static 0.7, 4 mm");

  const auto one = parseStrokes(
      textOf(
          R"({"layers": [{"tool": "stiffness", "value": 900}], "samples": [{"position": [0, 0, 0]}]})"),
      "hand.json");
  EXPECT_EQ(
      one,
      parseStrokes(
          textOf(R"({"tool": "stiffness", "value": 900, "samples": [{"position": [0, 0, 0]}]})"),
          "hand.json"));
  const std::string text = toJson(one).dump(-1);
  for (const char* key : {"layers", "seed", "tip"}) // files without the key are unchanged
    EXPECT_EQ(text.find(key), std::string::npos) << key;
}

TEST(Strokes, AreRejectedWithTheirPositionIfTheyHaveNoSamples) {
  const std::string whole =
      R"({"tool": "relief", "value": 1e-3, "samples": [{"position": [0, 0, 0]}]})";
  const std::string bare = R"({"tool": "relief", "value": 1e-3, "samples": []})";
  const std::string note = R"({"note \"}[": ["strokes", {}],)";
  const auto list = [&](const std::string& strokes) {
    return "{\"version\": 1,\n \"strokes\": [\n" + strokes + "]}";
  };
  EXPECT_EQ(errorOf(list(whole + ",\n\n" + bare + ",\n" + whole)),
            "hand.json:5: stroke 2: 'samples' is empty: a stroke has one or more");
  EXPECT_EQ(errorOf(list(bare)),
            "hand.json:3: stroke 1: 'samples' is empty: a stroke has one or more");
  EXPECT_EQ(errorOf(note + list(whole + ",\n" + bare).substr(1)),
            "hand.json:4: stroke 2: 'samples' is empty: a stroke has one or more");
  EXPECT_EQ(parseStrokes(list(whole), "hand.json").size(), 1U);
}

TEST(Strokes, FaultsAreNamedByFileStrokeSampleAndKey) {
  const std::pair<std::string, std::vector<std::string>> bad[] = {
      {"{\"version\": 2, \"strokes\": []}", {"version 2", "version 1"}},
      {"{\"strokes\": []}", {"version"}},
      {"{\"version\": 1}", {"strokes"}},
      {"[1]", {"hand.json"}},
      {textOf(R"({"tool": "hammer", "value": 1, "samples": []})"),
       {"stroke 1", "hammer", "relief"}},
      {textOf(R"({"value": 1, "samples": []})"), {"tool"}},
      {textOf(R"({"tool": "relief", "samples": []})"), {"value"}},
      {textOf(R"({"tool": "relief", "value": 1e-3})"), {"samples"}},
      {textOf(R"({"tool": "relief", "value": 1e-3, "colour": 1, "samples": []})"),
       {"colour", "unknown"}},
      {textOf(R"({"tool": "relief", "value": [1, 0, 0], "samples": []})"), {"value", "number"}},
      {textOf(R"({"tool": "color", "value": 1, "samples": []})"), {"value", "[r, g, b]"}},
      {textOf(R"({"tool": "color", "value": [1, 2, 0], "samples": []})"), {"value", "0", "1"}},
      {textOf(R"({"tool": "color", "value": [1, 0, 0], "mode": "add", "samples": []})"), {"add"}},
      {textOf(R"({"tool": "relief", "value": 1e-3, "radius": -1, "samples": []})"),
       {"radius", "-1"}},
      {textOf(R"({"tool": "relief", "value": 1e-3, "falloff": 0, "samples": []})"), {"falloff"}},
      {textOf(R"({"tool": "relief", "value": 1e-3, "falloff": -2, "samples": []})"), {"falloff"}},
      {textOf(R"({"tool": "stiffness", "value": -5, "samples": []})"), {"value", "-5"}},
      {textOf(R"({"tool": "stiffness", "value": 1e300, "samples": []})"), {"value"}},
      {textOf(R"({"tool": "damping", "value": 1, "shape": "round", "samples": []})"),
       {"shape", "round", "cone"}},
      {textOf(R"({"tool": "damping", "value": 1, "mode": "more", "samples": []})"),
       {"mode", "build-up"}},
      {textOf(R"({"tool": "damping", "value": 1, "erases": "relief", "samples": []})"), {"erase"}},
      {textOf(R"({"tool": "erase", "erases": "all", "samples": []})"), {"erases", "all"}},
      {textOf(R"({"tool": "damping", "value": 1, "samples": [{"position": [0, 0, 0]},
                  {"position": [0, 0]}]})"),
       {"sample 2", "3 numbers"}},
      {textOf(R"({"tool": "damping", "value": 1, "samples": [{"t": 1}]})"),
       {"sample 1", "position"}},
      {textOf(
           R"({"tool": "damping", "value": 1, "samples": [{"position": [0, 0, 0], "force": -1}]})"),
       {"force", "-1"}},
      {textOf(R"({"tool": "damping", "value": 1, "samples": [{"t": 2, "position": [0, 0, 0]},
                  {"t": 1, "position": [0, 0, 0]}]})"),
       {"sample 2", "time"}},
      {textOf(R"({"tool": "damping", "value": 1, "samples": [{"position": [0, 0, null]}]})"),
       {"sample 1"}},
      {textOf(R"({"layers": [], "samples": []})"), {"layers", "one"}},
      {textOf(R"({"layers": [{"tool": "relief", "value": 1e-3}, {"tool": "damping"}],
                  "samples": []})"),
       {"layer 2", "value"}},
      {textOf(R"({"layers": [{"tool": "damping", "value": 1, "radius": 1}], "samples": []})"),
       {"layer 1", "radius"}},
      {textOf(R"({"layers": [{"tool": "damping", "value": 1}], "tool": "relief", "samples": []})"),
       {"layers", "tool"}},
      {textOf(R"({"layers": [{"tool": "damping", "value": 1}, {"tool": "damping", "value": 2}],
                  "samples": []})"),
       {"damping", "twice"}},
      {textOf(R"({"layers": [{"tool": "damping", "value": 1}, {"tool": "erase"}],
                  "samples": []})"),
       {"erase"}},
      {textOf(R"({"layers": [{"tool": "relief", "value": 1e-3}, {"tool": "color",
                  "value": [0, 0, 1]}], "mode": "add", "samples": []})"),
       {"add"}},
      {textOf(R"({"tool": "damping", "value": 1, "seed": "far", "samples": []})"),
       {"seed", "far", "segment"}},
      {textOf(R"({"tool": "damping", "value": 1, "samples": [{"position": [0, 0, 0],
                  "tip": [0, 0]}]})"),
       {"sample 1", "3 numbers"}},
      {textOf(R"({"tool": "damping", "value": NaN, "samples": []})"), {"hand.json"}}};
  for (const auto& [text, parts] : bad) {
    const std::string error = errorOf(text);
    EXPECT_TRUE(error.starts_with("hand.json")) << text << ": " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos);
    for (const std::string& part : parts)
      EXPECT_NE(error.find(part), std::string::npos) << part << " in: " << error;
  }
}

TEST(Strokes, InvalidNumbersAreRejected) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double Brush::*> numbers = {&Brush::value,      &Brush::radius,
                                                &Brush::falloff,    &Brush::radius_per_force,
                                                &Brush::min_radius, &Brush::max_radius};
  for (double Brush::*value : numbers) {
    Brush brush;
    brush.tool = Tool::relief;
    EXPECT_NO_THROW(validate(brush));
    brush.*value = nan;
    EXPECT_THROW(validate(brush), Error);
    brush.*value = std::numeric_limits<double>::infinity();
    EXPECT_THROW(validate(brush), Error);
  }
  Stroke stroke;
  stroke.samples.push_back({0, Vec3(0, nan, 0), 0});
  EXPECT_THROW(validate(stroke), Error);
}

// K17: r = 0 paints nothing and is no error.
TEST(Strokes, RadiusOfZeroIsAllowed) {
  Brush brush;
  brush.radius = 0;
  EXPECT_NO_THROW(validate(brush));
}

TEST(Edits, AreDescribedInAFewWords) {
  Stroke stroke;
  stroke.brush.tool = Tool::relief;
  stroke.brush.value = 3e-4;
  EXPECT_EQ(describe(stroke), "relief 0.3 mm, 5 mm");
  stroke.brush.tool = Tool::material(MaterialChannel::stiffness);
  stroke.brush.value = 900;
  EXPECT_EQ(describe(stroke), "stiffness 900 N/m, 5 mm");
  stroke.brush.mode = StrokeMode::smooth;
  EXPECT_EQ(describe(stroke), "stiffness smoothed, 5 mm");
  stroke.brush.tool = Tool::erase;
  stroke.brush.erases = "color";
  EXPECT_EQ(describe(stroke), "erase color, 5 mm");
  EXPECT_EQ(describe(ValueEdit{{{"stiffness", "800"}, {"damping", "1"}}}),
            "stiffness = 800, damping = 1");
  EXPECT_EQ(describe(SceneEdit{"add pot", nullptr}), "add pot");
}

} // namespace
} // namespace patina
