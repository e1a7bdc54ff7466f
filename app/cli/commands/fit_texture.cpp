#include <algorithm>
#include <cmath>
#include <map>

#include "acquisition/texture/fit_texture.h"
#include "app/cli/commands/commands.h"
#include "app/cli/output/reports.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "workspace/texture_file.h"

namespace patina::cli {

namespace {

struct FitTextureOptions {
  std::filesystem::path profile, output;
  FitOptions1d fit;
  TextureKind kind = TextureKind::line;
  std::uint64_t seed = 1;
  std::optional<double> stiffness;
  std::optional<std::size_t> stretch;
  std::string name;
};

const Keys kFitKeys = {
    {"kind", "", "kind"},
    {"harmonics", "", "harmonics"},
    {"length", "m", "length", "of the profile, the texture's period"},
    {"omega", "rad/m", "fundamental"},
    {"samples", "", "samples", "even ones, in a period"},
    {"rms", "m", "rms", "of the profile's heights from its best line"},
    {"residual", "m", "residual", "rms of what the texture lacks of them"},
    {"variance_explained", "", "explained", "of the profile's variance"},
    {"left_out", "m", "left out", "rms of the waves longer than --cutoff", Shown::if_any},
    {"noise", "1/m", "noise", "of a harmonic over the square of its wavelength: the median of all"},
    {"quiet", "", "quiet", "harmonics that --over-noise left out", Shown::if_any},
    {"blended", "m", "blended", "rms of what was changed so that the ends meet"},
    {"wavelength", "m", "wavelength", "of the strongest harmonic"},
    {"low", "m", "lowest point", "of the texture, from its mean"},
    {"compliance", "m/N", "compliance", "", Shown::if_any}};

// The stretch that was asked for, or the one that goes farthest.
std::vector<ProfilePoint> readProfile(const FitTextureOptions& options, Console& console) {
  const std::string text = readFile(options.profile);
  const std::size_t first = text.starts_with("t [s]") ? 1 : 0;
  std::vector<std::string> expected = {"along [m]", "height [m]"};
  if (first) expected.insert(expected.begin(), "t [s]");
  const CsvTable table = parseCsv(text, options.profile.string(), expected);
  const auto column = [&](const char* name) {
    const auto found = std::find(table.columns.begin(), table.columns.end(), name);
    return found == table.columns.end()
               ? std::nullopt
               : std::optional(static_cast<std::size_t>(found - table.columns.begin()));
  };
  const auto sigma = column("sigma [m]"), stretch = column("stretch");
  std::map<std::int64_t, std::vector<ProfilePoint>> stretches;
  for (const auto& row : table.rows)
    stretches[stretch ? std::llround(row[*stretch]) : 0].push_back(
        {row[first], row[first + 1], sigma ? row[*sigma] : 0});
  if (stretches.empty()) throw FileError(options.profile.string(), 0, "has no height");
  if (options.stretch) {
    const auto found = stretches.find(static_cast<std::int64_t>(*options.stretch));
    if (found == stretches.end())
      throw FileError(options.profile.string(), 0,
                      "has no stretch " + std::to_string(*options.stretch));
    return found->second;
  }
  const auto longest =
      std::max_element(stretches.begin(), stretches.end(), [](const auto& a, const auto& b) {
        return a.second.back().along - a.second.front().along <
               b.second.back().along - b.second.front().along;
      });
  if (stretches.size() > 1)
    console.warn(options.profile.string() + ": has " + formatCount(stretches.size()) +
                 " stretches, of which " + std::to_string(longest->first) +
                 ", the longest, is fitted; --stretch chooses another");
  return longest->second;
}

int runFitTexture(const FitTextureOptions& options, Console& console) {
  requireWritable(options.output, {options.profile}, FileKind::json);
  FittedTexture fitted;
  try {
    fitted = fitTexture(readProfile(options, console), options.fit);
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(options.profile.string(), 0, error.what());
  }
  FourierTexture texture = fitted.texture;
  const FourierSeries line = texture.series;
  texture.name = options.name;
  if (options.stiffness) texture.compliance = 1 / *options.stiffness;
  const int harmonics = patina::harmonics(texture);
  if (options.kind == TextureKind::spectrum) texture = spectrumOf(texture, options.seed);
  if (options.kind == TextureKind::products) texture = crossCorrelation(texture, texture);
  writeTexture(options.output, texture);
  if (harmonics < options.fit.harmonics)
    console.warn(options.profile.string() + ": " + formatCount(fitted.samples) + " samples have " +
                 formatCount(static_cast<std::size_t>(harmonics)) + " harmonics, not " +
                 formatCount(static_cast<std::size_t>(options.fit.harmonics)));

  std::size_t strongest = 0;
  for (std::size_t j = 1; j < line.a.size(); ++j)
    if (std::hypot(line.a[j], line.b[j]) > std::hypot(line.a[strongest], line.b[strongest]))
      strongest = j;
  const double rms = std::sqrt(fitted.variance);
  Report report(kFitKeys);
  report
      .set("kind", options.kind == TextureKind::line       ? "line"
                   : options.kind == TextureKind::spectrum ? "spectrum"
                                                           : "products")
      .set("harmonics", static_cast<std::size_t>(harmonics))
      .set("length", fitted.length)
      .set("omega", texture.omega)
      .set("samples", fitted.samples)
      .set("rms", rms)
      .set("residual", fitted.residual)
      .set("variance_explained", 1 - fitted.residual * fitted.residual / fitted.variance)
      .set("left_out", fitted.left_out)
      .set("noise", fitted.noise,
           formatLength(fitted.noise * 1e-6) + " at a wavelength of 1 mm, growing as its square")
      .set("quiet", fitted.quiet)
      .set("blended", fitted.blended)
      .set("wavelength", fitted.length / static_cast<double>(strongest + 1))
      .set("low", texture.low);
  if (texture.compliance)
    report.set("compliance", *texture.compliance, formatNumber(*texture.compliance) + " m/N");
  console.report(report);
  return kDone;
}

TextureKind parseKind(const std::string& word) {
  if (word == "line") return TextureKind::line;
  if (word == "spectrum") return TextureKind::spectrum;
  if (word == "crossed") return TextureKind::products;
  throw Error("'" + word + "' is none of line, spectrum, crossed");
}

} // namespace

Command fitTextureCommand() {
  auto options = std::make_shared<FitTextureOptions>();
  return {
      .name = "fit-texture",
      .summary = "a profile of heights becomes a Fourier texture",
      .description =
          "PROFILE.csv has the columns along [m],height [m], or those of patina filter --heights, "
          "with sigmas and stretches of contact. The best line is taken off, the end is blended "
          "into the beginning with one slope, and the rest becomes harmonics of a fundamental of "
          "one period a profile.\n"
          "line: a height along x. spectrum: its amplitudes with phases that a seed draws. "
          "crossed: its cross-correlation with itself, a height over x and y.",
      .examples = {"patina fit-texture heights.csv -o grain.json --cutoff 8mm --stiffness 2900",
                   "patina fit-texture profile.csv -o grain.json --harmonics 64 --kind crossed"},
      .keys = kFitKeys,
      .arguments =
          {input("PROFILE", "Heights along a way.", into(options->profile)),
           outputTo(options->output, "T.json", "The texture."),
           {"--harmonics", "N", "", "128", "At most.",
            inRange(
                1, kMostHarmonics,
                [options](double n) { options->fit.harmonics = static_cast<int>(n); },
                NumberKind::whole)},
           {"--kind", "line|spectrum|crossed", "", "line", "What the heights are.",
            parsedInto(options->kind, parseKind)},
           {"--seed", "N", "", "1", "Of a spectrum's phases.",
            inRange(
                0, 1e9, [options](double n) { options->seed = static_cast<std::uint64_t>(n); },
                NumberKind::whole)},
           {"--blend", "PART", "", "0.01", "Of the profile, at its end.",
            inRange(1e-6, 0.5, [options](double part) { options->fit.blend = part; })},
           {"--step", "LENGTH", "m", "the points' median", "Of the even samples.",
            inRange(
                1e-9, 1, [options](double step) { options->fit.step = step; }, NumberKind::length)},
           {"--cutoff", "LENGTH", "m", "",
            "Leave out longer waves: the shape of what was scanned, which its mesh has.",
            inRange(
                1e-9, 1, [options](double length) { options->fit.cutoff = length; },
                NumberKind::length)},
           {"--over-noise", "RATIO", "", "0",
            "Leave out harmonics that are not so many times as high as the noise.",
            inRange(0, 1e3, [options](double ratio) { options->fit.over_noise = ratio; })},
           {"--stretch", "N", "", "the longest", "Of contact.",
            inRange(
                0, 1e9, [options](double n) { options->stretch = static_cast<std::size_t>(n); },
                NumberKind::whole)},
           {"--stiffness", "K", "N/m", "", "Of the material, where it was measured.",
            inRange(1e-3, 1e9, [options](double k) { options->stiffness = k; })},
           {"--name", "NAME", "", "", "Of the texture.",
            [options](const std::string& name) { options->name = name; }}},
      .run = [options](Console& console) { return runFitTexture(*options, console); }};
}

} // namespace patina::cli
