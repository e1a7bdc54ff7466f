#include <algorithm>
#include <cmath>
#include <map>

#include "acquisition/files/measured.h"
#include "acquisition/files/registered_file.h"
#include "acquisition/profilometer/measured_heights.h"
#include "acquisition/profilometer/square_area.h"
#include "acquisition/texture/fit_plane.h"
#include "app/cli/commands/commands.h"
#include "app/cli/output/reports.h"
#include "core/csv.h"
#include "core/error.h"
#include "core/numbers.h"
#include "pictures/picture_file.h"
#include "scan/scan_texture.h"
#include "workspace/texture_file.h"

namespace patina::cli {

namespace {

struct FitTextureOptions {
  std::filesystem::path profile, registration, output;
  FitOptions1d fit;
  std::optional<double> length, height; // size of a picture
  PlaneFitOptions plane;
  std::optional<int> harmonics;
  std::optional<double> blend;
  enum class Kind { line, spectrum, crossed, plane, products } kind = Kind::line;
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
    {"rank", "", "rank", "products of a line along x and one along y", Shown::if_any},
    {"lacking", "", "lacking", "of the plane's rms, what the products lack of it", Shown::if_any},
    {"rms", "m", "rms",
     "of the profile's heights from their least-squares line; of a picture's, once blended, from "
     "their mean"},
    {"residual", "m", "residual",
     "rms of what the texture lacks of them, beside what --cutoff leaves out"},
    {"variance_explained", "", "explained",
     "part of the heights' variance that the texture has; --cutoff leaves out its own"},
    {"left_out", "m", "left out", "rms of what --cutoff leaves out", Shown::if_any},
    {"noise", "1/m", "noise", "of a harmonic over the square of its wavelength: the median of all",
     Shown::if_any},
    {"quiet", "", "quiet", "harmonics that --min-snr left out", Shown::if_any},
    {"blended", "m", "blended", "rms of what was changed so that the ends meet", Shown::if_any},
    {"wavelength", "m", "wavelength", "of the strongest harmonic", Shown::if_any},
    {"finest", "m", "finest wave", "that the texture can have, of its period over the harmonics"},
    {"low", "m", "lowest point", "of the texture, from its mean"},
    {"compliance", "m/N", "compliance", "", Shown::if_any}};

// Reads a profilometer's file, which must be an area or a profile.
MeasuredHeights readMeasured(const std::filesystem::path& path, bool is_area, Console& console) {
  std::vector<std::string> warnings;
  MeasuredHeights measured = readMeasuredHeights(path, warnings);
  if (measured.isArea() != is_area)
    throw FileError(path.string(), 0,
                    is_area ? "is a profile, not an area: --kind line makes a texture of it"
                            : "is an area: --kind plane or products makes a texture of it");
  for (const std::string& line : warnings) console.warn(line);
  return measured;
}

std::vector<ProfilePoint> readMeasuredProfile(const FitTextureOptions& options, Console& console) {
  console.warnOfNoEffect({"--interval"}, "on a profilometer's file");
  const MeasuredHeights measured = readMeasured(options.profile, false, console);
  std::vector<ProfilePoint> points;
  for (std::size_t i = 0; i < measured.along.size(); ++i)
    points.push_back({measured.along[i] - measured.along[0], measured.heights[i], 0});
  return points;
}

// The stretch that was asked for, or the one that goes farthest.
std::vector<ProfilePoint> readProfile(FitTextureOptions& options, Console& console) {
  CsvReader reader(options.profile,
                   {{"along [m]", "height [m]"}, {"sigma [m]", "stretch", "speed [m/s]", "t [s]"}});
  const std::vector<std::string>& columns = reader.columns();
  const bool sigma = reader.has("sigma [m]"), stretch = reader.has("stretch"),
             speed = reader.has("speed [m/s]");
  if (stretch && speed && !options.fit.cutoff) options.fit.cutoff = scanFitOptions().cutoff;
  std::map<std::int64_t, std::vector<ProfilePoint>> stretches;
  for (std::vector<double> row; reader.next(row);) {
    for (std::size_t i = 0; i < row.size(); ++i)
      if (reader.has(columns[i]))
        requireMeasured(row[i], columns[i], options.profile.string(), reader.line());
    std::vector<ProfilePoint>& points = stretches[stretch ? std::llround(row[3]) : 0];
    if (!points.empty() && row[0] < points.back().arc_length)
      throw FileError(options.profile.string(), reader.line(), "along [m] runs backwards");
    points.push_back(
        {row[0], row[1], sigma ? row[2] : 0, speed ? std::optional(row[4]) : std::nullopt});
  }
  console.warn(reader.leftOut());
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
        return a.second.back().arc_length - a.second.front().arc_length <
               b.second.back().arc_length - b.second.front().arc_length;
      });
  if (stretches.size() > 1)
    console.warn(options.profile.string() + ": has " + formatCount(stretches.size()) +
                 " stretches, of which " + std::to_string(longest->first) +
                 ", the longest, is fitted; --interval chooses another");
  return longest->second;
}

constexpr double kUsualSpeed = 0.1; // typical speed of a stroke [m/s]
constexpr const char* kKinds[] = {"line", "spectrum", "crossed", "plane", "products"};
using Kind = FitTextureOptions::Kind;

// Reads heights over a square: a picture of them, or what a profilometer measured.
Picture readSquare(const FitTextureOptions& options, PlaneFitOptions& fit, Console& console) {
  const std::string name = options.profile.string();
  if (!isProfilometerFile(options.profile)) {
    if (!options.length || !options.height)
      throw Error("--kind " + std::string(kKinds[static_cast<std::size_t>(options.kind)]) +
                  ": a picture needs --length, of its side, and --height, of white above black");
    fit.length = *options.length;
    fit.height = *options.height;
    fit.blend = options.blend.value_or(0);
    return readPicture(options.profile);
  }
  console.warnOfNoEffect({"--length", "--height"}, "on a profilometer's file");
  const MeasuredHeights measured = readMeasured(options.profile, true, console);
  SquareArea square;
  std::vector<std::string> warnings;
  try {
    square = squareOf(measured, warnings);
  } catch (const Error& error) {
    throw FileError(name, 0, error.what());
  }
  for (const std::string& line : warnings) console.warn(name + ": " + line);
  fit.length = square.length;
  fit.height = square.height;
  fit.blend = options.blend.value_or(FitOptions1d{}.blend);
  return std::move(square.picture);
}

// PROFILE is heights over x and y.
int runFitPlane(const FitTextureOptions& options, Console& console) {
  PlaneFitOptions fit = options.plane;
  fit.harmonics = options.harmonics.value_or(fit.harmonics);
  if (fit.harmonics > kMaxPlaneHarmonics)
    throw Error("--harmonics: a picture's are at most " + std::to_string(kMaxPlaneHarmonics));
  if (options.kind == Kind::plane && fit.rank) throw Error("--rank: is of --kind products");
  if (options.kind == Kind::products && !fit.rank) fit.rank = 0;
  FittedPlane fitted;
  const Picture picture = readSquare(options, fit, console);
  try {
    fitted = fitPlane(picture, fit, console.progress());
  } catch (const Error& error) {
    throw FileError(options.profile.string(), 0, error.what());
  }
  FourierTexture& texture = fitted.texture;
  texture.name = options.name;
  if (options.stiffness) texture.compliance = 1 / *options.stiffness;
  writeTexture(options.output, texture);
  Report report(kFitKeys);
  report.set("kind", kKinds[static_cast<std::size_t>(options.kind)])
      .set("harmonics", static_cast<std::size_t>(harmonics(texture)))
      .set("length", period(texture))
      .set("omega", texture.omega)
      .set("samples", fitted.samples);
  if (fitted.rank > 0)
    report.set("rank", static_cast<std::size_t>(fitted.rank)).set("lacking", fitted.relative_error);
  report.set("rms", fitted.rms)
      .set("residual", fitted.residual)
      .set("variance_explained", 1 - fitted.residual * fitted.residual / fitted.rms / fitted.rms)
      .set("low", texture.low);
  if (texture.compliance)
    report.set("compliance", *texture.compliance, formatNumber(*texture.compliance) + " m/N");
  return console.report(report);
}

int runFitTexture(FitTextureOptions options, Console& console) {
  requireWritable(options.output, {options.profile, options.registration}, FileKind::json);
  if (options.stiffness && !options.registration.empty())
    throw Error("--stiffness: --registration contains it too; give one of them");
  if (options.kind != Kind::spectrum) console.warnOfNoEffect({"--seed"}, "without --kind spectrum");
  if (options.kind == Kind::plane || options.kind == Kind::products) {
    console.warnOfNoEffect({"--step", "--cutoff", "--min-snr", "--interval", "--registration"},
                           "on a picture or an area");
    return runFitPlane(options, console);
  }
  if (options.length || options.height || options.plane.rank)
    throw Error("--length, --height and --rank: are of --kind plane or products");
  options.fit.harmonics = options.harmonics.value_or(options.fit.harmonics);
  options.fit.blend = options.blend.value_or(options.fit.blend);
  FittedTexture fitted;
  try {
    fitted = fitTexture(isProfilometerFile(options.profile) ? readMeasuredProfile(options, console)
                                                            : readProfile(options, console),
                        options.fit);
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(options.profile.string(), 0, error.what());
  }
  FourierTexture texture = fitted.texture;
  const FourierSeries line = texture.series;
  texture.name = options.name;
  if (options.stiffness) texture.compliance = 1 / *options.stiffness;
  if (!options.registration.empty())
    if (const auto found = readRegistrationReport(options.registration).compliance; found > 0)
      texture.compliance = found;
  const int harmonics = patina::harmonics(texture);
  if (options.kind == Kind::spectrum) texture = spectrumOf(texture, options.seed);
  if (options.kind == Kind::crossed) texture = crossCorrelation(texture, texture);
  writeTexture(options.output, texture);
  if (harmonics < options.fit.harmonics)
    console.warn(options.profile.string() + ": " + formatCount(fitted.samples) + " samples have " +
                 formatCount(static_cast<std::size_t>(harmonics)) + " harmonics, not " +
                 formatCount(static_cast<std::size_t>(options.fit.harmonics)));

  std::size_t strongest = 0;
  for (std::size_t j = 1; j < line.a.size(); ++j)
    if (std::hypot(line.a[j], line.b[j]) > std::hypot(line.a[strongest], line.b[strongest]))
      strongest = j;
  const double finest = fitted.length / harmonics;
  const double lacking = std::hypot(fitted.residual, fitted.removed_rms);
  const double explained = std::max(0., 1 - lacking * lacking / fitted.variance);
  Report report(kFitKeys);
  report.set("kind", kKinds[static_cast<std::size_t>(options.kind)])
      .set("harmonics", static_cast<std::size_t>(harmonics))
      .set("length", fitted.length)
      .set("omega", texture.omega)
      .set("samples", fitted.samples)
      .set("rms", fitted.rms)
      .set("residual", fitted.residual)
      .set("variance_explained", explained)
      .set("left_out", fitted.removed_rms)
      .set("noise", fitted.noise,
           formatLength(fitted.noise * 1e-6) + " at a wavelength of 1 mm, growing as its square")
      .set("quiet", fitted.suppressed_harmonics)
      .set("blended", fitted.blended)
      .set("wavelength", fitted.length / static_cast<double>(strongest + 1))
      .set("finest", finest,
           formatLength(finest) + ", felt as " + rounded(kUsualSpeed / finest) + " Hz at " +
               rounded(1e3 * kUsualSpeed) + " mm/s")
      .set("low", texture.low);
  if (texture.compliance)
    report.set("compliance", *texture.compliance, formatNumber(*texture.compliance) + " m/N");
  return console.report(report);
}

Kind parseKind(const std::string& word) {
  std::string list;
  for (std::size_t i = 0; i < std::size(kKinds); ++i) {
    if (word == kKinds[i]) return static_cast<Kind>(i);
    list += (i > 0 ? ", " : "") + std::string(kKinds[i]);
  }
  throw Error("'" + word + "' is none of " + list);
}

} // namespace

Command fitTextureCommand() {
  auto options = std::make_shared<FitTextureOptions>();
  return {
      .name = "fit-texture",
      .summary = "heights become a Fourier texture",
      .description =
          "PROFILE has the columns along [m],height [m], or those of patina filter --heights, "
          "with sigmas and stretches of contact. A line is taken off, the best one beside the "
          "lowest harmonics, so that no whole wave passes for a slope; the end is blended "
          "into the beginning with one slope, and the rest becomes harmonics of a fundamental of "
          "one period a profile.\n"
          "line: a height along x. spectrum: its amplitudes with phases that a seed draws. "
          "crossed: its cross-correlation with itself, a height over x and y.\n"
          "plane, products: PROFILE is a square picture of heights, which repeats itself or is "
          "blended so that it does, or an area that a profilometer measured. plane keeps every "
          "harmonic over x and y; products is its best sum of products of a line along x and one "
          "along y, the fewest that lack a hundredth of its rms, or --rank of them.\n"
          "A profilometer's file, of a profile or an area, is an X3P, an SDF, a text of Gwyddion, "
          "or a table with the columns x and z, or x, y and z, with their units. Of an area the "
          "square in its middle is taken, without its slope. Lengths are those of the file.",
      .examples = {"patina fit-texture heights.csv -o grain.json --registration r.json",
                   "patina fit-texture profile.csv -o grain.json --harmonics 64 --kind crossed",
                   "patina fit-texture leather.x3p -o leather.json --kind products",
                   "patina fit-texture cloth.png -o cloth.json --kind products --length 20mm "
                   "--height 0.3mm"},
      .keys = kFitKeys,
      .arguments =
          {input("PROFILE", "Heights along a way, a picture of heights, or a profilometer's file.",
                 into(options->profile)),
           outputTo(options->output, "T.json", "The texture."),
           {"--harmonics", "N", "", "128, of a picture 32", "At most.",
            numberInto(1, kMaxHarmonics, options->harmonics, NumberKind::whole)},
           {"--kind", "line|spectrum|crossed|plane|products", "", "line", "What the heights are.",
            parsedInto(options->kind, parseKind)},
           {"--seed", "N", "", "1", "Of a spectrum's phases.",
            numberInto(0, 1e9, options->seed, NumberKind::whole)},
           {"--blend", "PART", "", "0.01, of a picture 0", "Of the profile, at its end.",
            numberInto(1e-6, 0.5, options->blend)},
           {"--length", "LENGTH", "m", "", "Of a picture's side.",
            numberInto(1e-6, 10, options->length, NumberKind::length)},
           {"--height", "LENGTH", "m", "", "Of a picture's white above its black.",
            numberInto(1e-9, 1, options->height, NumberKind::length)},
           {"--rank", "R", "", "as few as serve", "Of products.",
            numberInto(1, 2 * kMaxPlaneHarmonics + 1, options->plane.rank, NumberKind::whole)},
           {"--step", "LENGTH", "m", "the points' median", "Of the even samples.",
            numberInto(1e-9, 1, options->fit.step, NumberKind::length)},
           {"--cutoff", "LENGTH", "m", "of a scan 8mm",
            "Leave out longer waves: the shape of what was scanned, which its mesh has. Of a scan, "
            "what the tip was drawn over too slowly to be known, too.",
            numberInto(1e-9, 1, options->fit.cutoff, NumberKind::length)},
           {"--min-snr", "RATIO", "", "0",
            "Leave out harmonics that are not so many times as high as the noise.",
            numberInto(0, 1e3, options->fit.min_snr)},
           {"--interval", "N", "", "the longest", "Of contact.",
            numberInto(0, 1e9, options->stretch, NumberKind::whole)},
           {"--stiffness", "K", "N/m", "", "Of the material, where it was measured.",
            numberInto(1e-3, 1e9, options->stiffness)},
           {"--registration", "R.json", "", "",
            "In its place: of the scan, whose compliance patina register has found.",
            into(options->registration)},
           {"--name", "NAME", "", "", "Of the texture.",
            [options](const std::string& name) { options->name = name; }}},
      .run = [options](Console& console) { return runFitTexture(*options, console); }};
}

} // namespace patina::cli
