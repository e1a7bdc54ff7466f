#include "workspace/texture_file.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/file.h"
#include "core/json.h"

namespace patina {
namespace {

constexpr int kTextureVersion = 1;
constexpr const char* kFormat = "patina texture";
constexpr const char* kLaidFormat = "patina laid textures";
constexpr const char* kConvention =
    "h(x) = sum over j = 1 .. harmonics of a[j] cos(j omega x) + b[j] sin(j omega x)";
constexpr std::array<std::pair<TextureKind, const char*>, 4> kKinds = {
    {{TextureKind::line, "line"},
     {TextureKind::spectrum, "spectrum"},
     {TextureKind::products, "products"},
     {TextureKind::plane, "plane"}}};

Json numbersJson(const std::vector<double>& values) {
  return Json(Json::Array(values.begin(), values.end()));
}

Json seriesJson(const FourierSeries& series) {
  Json json = Json::object();
  if (series.mean != 0) json.set("mean", series.mean);
  return json.set("a", numbersJson(series.a)).set("b", numbersJson(series.b));
}

Json toJson(const FourierTexture& texture) {
  Json json = Json::object();
  json.set("format", kFormat).set("version", kTextureVersion);
  json.set("units",
           Json::object().set("omega", "rad/m").set("height", "m").set("compliance", "m/N"));
  json.set("convention", kConvention);
  if (!texture.name.empty()) json.set("name", texture.name);
  for (const auto& [kind, word] : kKinds)
    if (kind == texture.kind) json.set("kind", word);
  json.set("harmonics", static_cast<std::size_t>(harmonics(texture)));
  json.set("omega", texture.omega).set("low", texture.low);
  if (texture.compliance) json.set("compliance", *texture.compliance);
  switch (texture.kind) {
  case TextureKind::line:
    json.set("a", numbersJson(texture.series.a)).set("b", numbersJson(texture.series.b));
    break;
  case TextureKind::spectrum:
    json.set("amplitudes", numbersJson(texture.series.a));
    json.set("seed",
             std::to_string(texture.seed)); // text, because JSON numbers do not hold 64 bits
    break;
  case TextureKind::products: {
    Json list = Json::array();
    for (const FourierProduct& product : texture.products)
      list.push(Json::object()
                    .set("along_x", seriesJson(product.along_x))
                    .set("along_y", seriesJson(product.along_y)));
    json.set("products", list);
    break;
  }
  case TextureKind::plane:
    json.set("plane", numbersJson(texture.plane));
  }
  return json;
}

double finite(const Json& json, const char* key) {
  const double value = json.at(key).asNumber();
  if (!std::isfinite(value)) throw Error(std::string("'") + key + "' is not finite");
  return value;
}

std::vector<double> numbersOf(const Json& json, const char* key, std::size_t due) {
  std::vector<double> values;
  for (const Json& value : json.at(key).asArray()) values.push_back(value.asNumber());
  if (values.size() != due)
    throw Error(std::string("'") + key + "' has " + std::to_string(values.size()) +
                " numbers, not " + std::to_string(due));
  return values;
}

FourierSeries seriesOf(const Json& json, std::size_t due) {
  FourierSeries series{0, numbersOf(json, "a", due), numbersOf(json, "b", due)};
  if (json.find("mean")) series.mean = finite(json, "mean");
  return series;
}

std::uint64_t seedOf(const std::string& word) {
  std::uint64_t seed = 0;
  const char* end = word.data() + word.size();
  if (const auto [stop, error] = std::from_chars(word.data(), end, seed);
      word.empty() || error != std::errc() || stop != end)
    throw Error("'seed' is not a whole number in quotes");
  return seed;
}

void requireFormat(const Json& json, const char* format) {
  if (const Json* told = json.find("format");
      !told || !told->isString() || told->asString() != format)
    throw Error(std::string("is not a file of the format '") + format + "'");
  if (const std::int64_t version = json.at("version").asInteger(); version != kTextureVersion)
    throw Error("version " + std::to_string(version) +
                " is unknown; supported: " + std::to_string(kTextureVersion));
}

FourierTexture textureFrom(const Json& json) {
  requireFormat(json, kFormat);
  FourierTexture texture;
  if (const Json* name = json.find("name")) texture.name = name->asString();
  const std::string& kind = json.at("kind").asString();
  bool known = false;
  for (const auto& [value, word] : kKinds)
    if (kind == word) {
      texture.kind = value;
      known = true;
    }
  if (!known) throw Error("kind '" + kind.substr(0, 32) + "' is unknown");
  const std::int64_t count = json.at("harmonics").asInteger();
  if (count < 1 || count > kMaxHarmonics)
    throw Error("'harmonics' is " + std::to_string(count) + ", not between 1 and " +
                std::to_string(kMaxHarmonics));
  const auto due = static_cast<std::size_t>(count);
  texture.omega = finite(json, "omega");
  texture.low = finite(json, "low");
  if (json.find("compliance")) texture.compliance = finite(json, "compliance");
  switch (texture.kind) {
  case TextureKind::line:
    texture.series = seriesOf(json, due);
    texture.series.mean = 0; // A height has none, and none is written.
    break;
  case TextureKind::spectrum:
    texture.series.a = numbersOf(json, "amplitudes", due);
    texture.seed = seedOf(json.at("seed").asString());
    break;
  case TextureKind::products:
    for (const Json& product : json.at("products").asArray())
      texture.products.push_back(
          {seriesOf(product.at("along_x"), due), seriesOf(product.at("along_y"), due)});
    break;
  case TextureKind::plane:
    texture.plane = numbersOf(json, "plane", (2 * due + 1) * (2 * due + 1));
  }
  if (const std::string problem = problemOf(texture); !problem.empty()) throw Error(problem);
  return texture;
}

template <typename Make>
auto parsed(std::string_view text, const std::string& name, const Make& make) try {
  return make(parseJson(text, name));
} catch (const FileError&) {
  throw;
} catch (const Error& error) {
  throw FileError(name, 0, error.what());
}

std::int32_t indexFrom(const Json& json) {
  const std::int64_t index = json.asInteger();
  if (index < 0 || index > std::numeric_limits<std::int32_t>::max())
    throw Error(std::to_string(index) + " is not the number of a face or texture");
  return static_cast<std::int32_t>(index);
}

} // namespace

std::string textureText(const FourierTexture& texture) {
  return toJson(texture).dump() + "\n";
}

FourierTexture parseTexture(std::string_view text, const std::string& name) {
  return parsed(text, name, textureFrom);
}

FourierTexture readTexture(const std::filesystem::path& path) {
  return parseTexture(readFile(path), path.string());
}

void writeTexture(const std::filesystem::path& path, const FourierTexture& texture) {
  writeFileAtomically(path, textureText(texture));
}

std::string laidTexturesText(const TextureMappings& laid) {
  Json library = Json::array(), faces = Json::array();
  for (const auto& [number, texture] : laid.library)
    library.push(
        Json::object().set("number", std::int64_t{number}).set("texture", toJson(texture->value)));
  for (const TexturedFace& face : laid.faces) {
    Json row = Json::array();
    row.push(std::int64_t{face.face});
    row.push(std::int64_t{face.texture});
    for (const Vec2& at : face.coords)
      for (int k = 0; k < 2; ++k) row.push(at[k]);
    faces.push(row);
  }
  return Json::object()
             .set("format", kLaidFormat)
             .set("version", kTextureVersion)
             .set("library", library)
             .set("faces", faces)
             .dump(-1) +
         "\n";
}

TextureMappings parseLaidTextures(std::string_view text, const std::string& name) {
  return parsed(text, name, [](const Json& json) {
    requireFormat(json, kLaidFormat);
    TextureMappings laid;
    for (const Json& entry : json.at("library").asArray()) {
      const std::int32_t number = indexFrom(entry.at("number"));
      if (!laid.library.emplace(number, hapticTexture(textureFrom(entry.at("texture")))).second)
        throw Error("texture " + std::to_string(number) + " occurs twice");
    }
    for (const Json& entry : json.at("faces").asArray()) {
      const Json::Array& row = entry.asArray();
      if (row.size() != 8)
        throw Error("a face has " + std::to_string(row.size()) + " numbers, not 8");
      TexturedFace face{indexFrom(row[0]), indexFrom(row[1]), {}};
      for (std::size_t k = 0; k < 6; ++k)
        face.coords[k / 2][static_cast<Eigen::Index>(k % 2)] = row[2 + k].asNumber();
      laid.faces.push_back(face);
    }
    validate(laid, std::numeric_limits<std::int32_t>::max());
    return laid;
  });
}

} // namespace patina
