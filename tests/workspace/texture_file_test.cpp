// Fourier textures as files (A27) and in a workspace.
#include "workspace/texture_file.h"

#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/error.h"
#include "geometry/mesh/shapes.h"
#include "support/fresh_folder.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

FourierTexture someTexture(TextureKind kind, int n = 5) {
  std::mt19937 random(static_cast<unsigned>(kind) + 1);
  std::normal_distribution<double> normal(0, 1e-5);
  const auto numbers = [&](int count) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(normal(random));
    return values;
  };
  FourierTexture texture;
  texture.name = "grain \"7\"";
  texture.kind = kind;
  texture.omega = 2 * std::numbers::pi / 0.0123456789;
  switch (kind) {
  case TextureKind::line:
    texture.series = {0, numbers(n), numbers(n)};
    texture.compliance = 1. / 3;
    break;
  case TextureKind::spectrum:
    texture.series.a = numbers(n);
    for (double& a : texture.series.a) a = std::abs(a);
    texture.seed = 0xfedcba9876543210;
    break;
  case TextureKind::products:
    for (int i = 0; i < 2; ++i)
      texture.products.push_back({{0, numbers(n), numbers(n)}, {0.1 * i, numbers(n), numbers(n)}});
    break;
  case TextureKind::plane:
    texture.plane = numbers((2 * n + 1) * (2 * n + 1));
  }
  texture.low = minHeight(texture);
  return texture;
}

TEST(TextureFile, ReadsBackBitForBit) {
  for (const TextureKind kind :
       {TextureKind::line, TextureKind::spectrum, TextureKind::products, TextureKind::plane}) {
    const FourierTexture texture = someTexture(kind);
    ASSERT_EQ(problemOf(texture), "");
    const std::string text = textureText(texture);
    EXPECT_EQ(parseTexture(text, "t.json"), texture) << text;
    EXPECT_EQ(textureText(parseTexture(text, "t.json")), text);
  }
}

TEST(TextureFile, KeepsNoMeanOfALine) {
  const FourierTexture texture = someTexture(TextureKind::line);
  std::string text = textureText(texture);
  text.insert(text.find("\"a\":"), "\"mean\": 1e-6,\n  ");
  EXPECT_EQ(parseTexture(text, "t.json"), texture) << text;
}

std::string failureOf(std::string text) {
  try {
    parseTexture(text, "t.json");
  } catch (const FileError& error) {
    const std::string said = error.what();
    EXPECT_EQ(said.find('\n'), std::string::npos);
    EXPECT_NE(said.find("t.json"), std::string::npos);
    return said;
  }
  return "";
}

TEST(TextureFile, ReportsTheCauseOfErrors) {
  const std::string whole = textureText(someTexture(TextureKind::line));
  const auto with = [&](const std::string& what, const std::string& instead) {
    std::string text = whole;
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), instead);
  };
  EXPECT_NE(failureOf(with("\"version\": 1", "\"version\": 2")).find("version 2"),
            std::string::npos);
  EXPECT_NE(failureOf(with("patina texture", "something")).find("format"), std::string::npos);
  EXPECT_NE(failureOf(with("\"line\"", "\"cloud\"")).find("cloud"), std::string::npos);
  EXPECT_NE(failureOf(with("\"omega\": 5", "\"ommega\": 5")).find("omega"), std::string::npos);
  EXPECT_NE(failureOf(with("\"harmonics\": 5", "\"harmonics\": 6")).find("not 6"),
            std::string::npos);
  EXPECT_NE(failureOf(with("\"harmonics\": 5", "\"harmonics\": -1")).find("-1"), std::string::npos);
  EXPECT_NE(failureOf(with("\"low\"", "\"lo\"")).find("low"), std::string::npos);
  EXPECT_NE(failureOf(with("\"compliance\": 0.3333333333333333", "\"compliance\": 0")), "");
  EXPECT_NE(failureOf(with("\"omega\": ", "\"omega\": -")), "");
  EXPECT_NE(failureOf(whole.substr(0, whole.size() / 2)), "");
  EXPECT_NE(failureOf(""), "");
  EXPECT_NE(failureOf("[1, 2]"), "");
  EXPECT_NE(failureOf(with("\"a\": [", "\"a\": [null,")), "");
}

Scene texturedScene() {
  Scene scene;
  SceneObject& object = scene.objects.emplace_back();
  object.name = "ball";
  object.mesh = std::make_shared<const TriangleMesh>(icosphere(0.03, 3));
  TextureMappings laid;
  laid.library[2] = hapticTexture(someTexture(TextureKind::line));
  laid.library[7] = hapticTexture(someTexture(TextureKind::spectrum));
  for (std::int32_t f = 0; f < 40; f += 3)
    laid.faces.push_back({f, f % 2 ? 2 : 7, {Vec2(1. / 3, f), Vec2(0.1, -1e-300), Vec2(f, 0.7)}});
  ObjectPaint paint;
  paint.textures = std::make_shared<const TextureMappings>(std::move(laid));
  object.paint = std::make_shared<const ObjectPaint>(std::move(paint));
  return scene;
}

TEST(TextureFile, WorkspaceKeepsFacesAndTextures) {
  const std::filesystem::path root = test::freshFolder("textures"), folder = root / "scene";
  const Scene scene = texturedScene();
  saveWorkspace(scene, folder);
  const OpenedWorkspace opened = openWorkspace(folder);
  ASSERT_TRUE(opened.scene.objects[0].paint && opened.scene.objects[0].paint->textures);
  EXPECT_TRUE(same(*opened.scene.objects[0].paint->textures, *scene.objects[0].paint->textures));
  // This parses the bytes, not the value in memory.
  const TextureMappings& laid = *scene.objects[0].paint->textures;
  EXPECT_TRUE(same(parseLaidTextures(laidTexturesText(laid), "l.json"), laid));
  std::filesystem::remove_all(root);
}

TEST(TextureFile, RefusesFacesBeyondTheMesh) {
  Scene scene = texturedScene();
  scene.objects[0].mesh = std::make_shared<const TriangleMesh>(icosphere(0.03, 1));
  EXPECT_THROW(validate(scene), Error);
  const std::string text = laidTexturesText(*scene.objects[0].paint->textures);
  const auto refused = [&](const std::string& what, const std::string& instead) {
    std::string other = text;
    const std::size_t at = other.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    other.replace(at, what.size(), instead);
    EXPECT_THROW(parseLaidTextures(other, "l.json"), FileError) << instead;
  };
  refused("[0,7,", "[3,7,");
  refused("[0,7,", "[-1,7,");
  refused("[0,7,", "[0,-7,");
  refused("[0,7,", "[7,");
  refused("\"number\":2", "\"number\":7");
}

} // namespace
} // namespace patina
