#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "acquisition/files/registered_file.h"
#include "acquisition/files/scan_tables.h"
#include "acquisition/profile/roughness.h"
#include "acquisition/simulation/path_error.h"
#include "app/cli/commands/commands.h"
#include "app/cli/framework/report.h"
#include "app/cli/input/mesh_input.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/numbers.h"
#include "core/percentiles.h"
#include "geometry/io/pose_file.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/mesh_unit.h"
#include "scan/filter_scan.h"
#include "scan/scan_texture.h"

namespace patina::cli {
namespace {

// Path part of `patina filter`'s report.

Json gapsJson(const FilteredScan& scan) {
  Json list = Json::array();
  for (const auto& [stream, gaps] :
       {std::pair("poses", &scan.without_pose), {"probe", &scan.without_sample}})
    for (const Gap& gap : *gaps)
      list.push(Json::object().set("stream", stream).set("from", gap.from).set("to", gap.to));
  return list;
}

void reportSigma(const std::vector<PathSample>& path, Report& report) {
  std::vector<double> sigmas;
  for (const PathSample& sample : path) sigmas.push_back(sample.sigma);
  const double median = percentiles(sigmas).p50, most = percentiles(sigmas).max;
  report.set("sigma", Json::object().set("median", median).set("max", most),
             formatLength(median) + " (median), " + formatLength(most) + " (max)");
}

// Sets clock_offset, clock_skew and clock_deviation.
void reportClock(const ProbeClock& found, Report& report) {
  const ProbeClock clock = found.is_significant ? found : ProbeClock();
  report.set("clock_offset", clock.offset,
             found.is_significant
                 ? "the probe's is " + rounded(1e3 * clock.offset) + " ms ahead, +- " +
                       rounded(1e3 * clock.offset_deviation) + ", and " +
                       rounded(1e6 * clock.skew) + " us a second faster, +- " +
                       rounded(1e6 * clock.skew_deviation) + "; corrected"
                 : "as the camera's, within " + rounded(1e3 * found.offset_deviation) + " ms");
  report.set("clock_skew", clock.skew);
  report.set(
      "clock_deviation",
      Json::object().set("offset", found.offset_deviation).set("skew", found.skew_deviation));
}

// Heights part of `patina filter`'s report.

// Sets normal, stretches, height_sigma, and roughness and stiffness if known.
void reportHeights(const ScanHeights& scan, Report& report) {
  report.set("normal", vectorJson(scan.plane.normal));
  report.set("stretches", scan.heights.back().stretch + 1);
  std::vector<double> sigmas;
  for (const ScanHeight& height : scan.heights) sigmas.push_back(height.point.sigma);
  report.set("height_sigma", percentiles(sigmas).p50);
  if (const auto found = roughnessOf(scan.heights))
    report.set("roughness",
               Json::object()
                   .set("rq", found->rq)
                   .set("ra", found->ra)
                   .set("rq_deviation", found->rq_deviation)
                   .set("ra_deviation", found->ra_deviation)
                   .set("cutoff", kRoughnessCutoff)
                   .set("lengths", found->lengths),
               "Rq " + formatLength(found->rq) + " +- " + formatLength(found->rq_deviation) +
                   ", Ra " + formatLength(found->ra) + " +- " + formatLength(found->ra_deviation) +
                   ", waves up to " + formatLength(kRoughnessCutoff));
  if (const auto& found = scan.compliance) {
    const std::string presses =
        ", from " + formatCount(found->loadings) + (found->loadings == 1 ? " press" : " presses");
    if (found->isSignificant())
      report.set("stiffness",
                 Json::object()
                     .set("value", found->stiffness)
                     .set("deviation", found->stiffness_deviation)
                     .set("presses", found->loadings),
                 rounded(found->stiffness) + " N/m, deviation " +
                     rounded(found->stiffness_deviation) + " N/m" + presses);
    else {
      const double least = 1 / (found->compliance + 2 * found->compliance_deviation);
      report.set("stiffness", Json::object().set("least", least).set("presses", found->loadings),
                 "more than " + rounded(least) + " N/m" + presses +
                     ": it may be rigid, and heights are those of a rigid surface");
    }
  }
}

struct FilterOptions {
  std::filesystem::path input, probe, rig, truth, output, heights, over, registration;
  MeshUnit unit = MeshUnit::mm;
  std::optional<double> tip_radius;
  std::optional<Vec3> normal;
  std::optional<PathModel> model;
  bool forward = false, lifted = false;
  PoseSigmas sigmas;
};

const Keys kGapParts = {{"stream", "", ""}, {"from", "s", ""}, {"to", "s", ""}};
const Keys kFilterKeys = {
    {"samples", "", "samples", "of the path"},
    {"model", "", "model"},
    {"poses", "", "poses", "", Shown::never},
    {"rejected", "", "rejected", "poses", Shown::if_any},
    {"restarts", "", "restarts", "after jumps of the poses, or 1.5 s without any", Shown::if_any},
    {"nis_mean", "", "NIS",
     "squared innovations of the poses over their variance, about 1: the motion's noise is fitted "
     "to them, which hides sigmas that are too small"},
    {"nis_probe", "", "NIS of the probe",
     "the same of the accelerometers, a1u a1v a2u a2v; far above 1 where rig, gravity, units or "
     "clock are wrong",
     Shown::if_any},
    {"rms_innovation", "m", "innovation", "of the tip, rms of an axis"},
    {"sigma",
     "m",
     "sigma",
     "of the path's samples: median and largest",
     Shown::always,
     {{"median", "", ""}, {"max", "", ""}}},
    {"gaps", "", "gaps", "without a pose or a sample of the probe", Shown::if_any, kGapParts},
    {"clock_offset", "s", "clock",
     "by how much the probe's is ahead at its first sample; corrected"},
    {"clock_skew", "", "clock skew", "by how much it runs faster", Shown::never},
    {"clock_deviation",
     "",
     "clock",
     "standard deviations",
     Shown::never,
     {{"offset", "s", ""}, {"skew", "", ""}}},
    {"bias", "m/s^2", "biases", "of the accelerometers, a1u a1v a2u a2v", Shown::if_any},
    {"error",
     "",
     "error",
     "against the truth",
     Shown::always,
     {{"rms", "m", ""}, {"max", "m", ""}, {"nees", "", "1 if sigmas hold"}, {"samples", "", ""}}},
    {"normal", "", "normal", "from which side heights are, in the camera's frame", Shown::if_any},
    {"stretches", "", "stretches", "of contact whose heights were found", Shown::if_any},
    {"height_sigma", "m", "sigma of heights", "median", Shown::if_any},
    {"roughness",
     "m",
     "roughness",
     "of heights, in waves shorter than `cutoff`; absent along less than four cutoffs",
     Shown::if_any,
     {{"rq", "m", "", "their rms"},
      {"ra", "m", "", "their mean size"},
      {"rq_deviation", "m", ""},
      {"ra_deviation", "m", ""},
      {"cutoff", "m", ""},
      {"lengths", "", "", "of a cutoff"}}},
    {"stiffness",
     "N/m",
     "stiffness",
     "from presses while standing; absent without any",
     Shown::if_any,
     {{"value", "N/m", ""},
      {"deviation", "N/m", ""},
      {"least", "N/m", "", "in place of both, if presses do not distinguish it from rigid"},
      {"presses", "", ""}}},
    {"seconds", "s", "filtered in"}};

PathModel parseModel(const std::string& word) {
  if (word == "fused") return PathModel::fused;
  if (word == "acceleration") return PathModel::acceleration;
  if (word == "velocity") return PathModel::velocity;
  throw Error("'" + word + "' is none of fused, acceleration, velocity");
}

Vec3 parseNormal(const std::string& word) {
  const Vec3 normal = parsePoint(word);
  if (!(normal.norm() > 0)) throw Error("'" + word + "' is no direction");
  return normal;
}

std::string nameOf(PathModel model) {
  return model == PathModel::fused          ? "fused"
         : model == PathModel::acceleration ? "acceleration"
                                            : "velocity";
}

// Finds the files of a scan folder; options that name a file override them.
void findFiles(FilterOptions& options) {
  const bool folder = std::filesystem::is_directory(options.input);
  const std::filesystem::path place = folder ? options.input : options.input.parent_path();
  const auto use = [&](std::filesystem::path& path, const char* name) {
    if (path.empty() && std::filesystem::exists(place / name)) path = place / name;
  };
  use(options.rig, "rig.json");
  if (!folder) return;
  use(options.probe, "probe.csv");
  use(options.truth, "truth.csv");
  options.input /= "poses.tum";
}

struct Inputs {
  OnFile<CameraPose> poses;
  OnFile<ProbeSample> samples;
  std::vector<RateSample> rates; // gyroscope; empty without one
  Rig rig;
  std::vector<PathSample> truth;
};

Inputs read(const FilterOptions& options, Console& console) {
  Inputs in;
  std::vector<std::string> warnings;
  in.poses = readPoses(options.input, options.sigmas, &warnings);
  if (!options.probe.empty()) in.samples = readProbeStream(options.probe, &warnings, &in.rates);
  if (!options.truth.empty()) in.truth = readPath(options.truth, &warnings);
  for (const std::string& line : warnings) console.warn(line);
  in.rig.probe.tip = Vec3::Zero();
  if (!options.rig.empty())
    in.rig = readRig(options.rig);
  else
    console.warn(options.input.string() +
                 ": no rig.json beside it and no --rig: the path is that of the poses' origin, "
                 "not of a tip");
  for (ProbeSample& sample : in.samples.values) sample.force = forceOf(in.rig, sample.force);
  return in;
}

PathModel chosenModel(const FilterOptions& options, const Inputs& in) {
  const bool heard = !in.samples.values.empty();
  const PathModel able = options.forward ? PathModel::acceleration : filterOf(in.rig, heard).model;
  const PathModel model = options.model.value_or(able);
  if (model != PathModel::fused) return model;
  if (options.forward)
    throw Error("--no-smoother: the fused path is smoothed; choose another --model");
  if (!heard) throw Error("--model: fused needs the probe's stream, --probe");
  if (!in.rig.accelerometers)
    throw Error("--model: fused needs 'accelerometers' and 'gravity' in the rig, --rig");
  return model;
}

// The end of a gap is a sample of the file; its time in the scan may differ by the clock's fit.
template <class Value>
std::string placeOf(const std::filesystem::path& path, const OnFile<Value>& file,
                    const ProbeClock* clock, const Gap& gap) {
  const auto after = std::find_if(file.values.begin(), file.values.end(), [&](const Value& value) {
    return (clock ? clock->onCamera(value.t) : value.t) >= gap.to;
  });
  const auto at = static_cast<std::size_t>(after - file.values.begin());
  return path.string() + ":" + std::to_string(file.lines.at(std::min(at, file.lines.size() - 1)));
}

template <class Value>
void warnOf(const std::vector<Gap>& gaps, const std::filesystem::path& path,
            const OnFile<Value>& file, const ProbeClock* clock, const std::string& what,
            Console& console) {
  if (gaps.empty()) return;
  const Gap& longest = *std::max_element(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) {
    return a.to - a.from < b.to - b.from;
  });
  console.warn(placeOf(path, file, clock, longest) + ": before this line " +
               rounded(longest.to - longest.from) + " s without " + what +
               (gaps.size() > 1 ? ", the longest of " + formatCount(gaps.size()) + " gaps" : ""));
}

// Heights over a mesh to which the scan is registered.
struct Over {
  Over(TriangleMesh mesh, double tip_radius, const std::filesystem::path& registration)
      : target(std::move(mesh), tip_radius, true), found(readRegistrationReport(registration)) {}
  SurfaceTarget target;
  RegistrationReport found;
};

std::optional<Over> readOver(const FilterOptions& options, const Rig& rig, Console& console) {
  if (options.over.empty() != options.registration.empty())
    throw Error(
        "--reference-mesh and --registration go together: the mesh, and where the scan lies on it");
  if (options.over.empty()) return std::nullopt;
  if (options.heights.empty())
    throw Error("--reference-mesh: is of heights; name a file with --heights");
  if (options.normal) throw Error("--normal: over a mesh its own normals count");
  ScaledMesh scaled = readScaledMesh(options.over, options.unit, console);
  return std::optional<Over>(std::in_place, cleaned(std::move(scaled.mesh)).mesh,
                             options.tip_radius.value_or(rig.tip_radius), options.registration);
}

void requireTouch(const FilteredScan& scan, const FilterOptions& options) {
  if (scan.path.empty())
    throw FileError(options.probe.string(), 0,
                    "the probe never touches, its largest force is " + rounded(scan.largest_force) +
                        " N; --keep-air keeps what is in the air");
}

// Returns heights over the mesh, or over a plane if there is none.
ScanHeights heightsOf(const FilteredScan& scan, const std::optional<Over>& over, const Inputs& in,
                      const FilterOptions& options) {
  const std::vector<CameraPose>& poses = in.poses.values;
  if (!over) return heightsOverPlane(scan, poses, in.rig, options.normal);
  try {
    return heightsOverMesh(over->target, scan, poses, in.rig, over->found.mesh_from_scan,
                           over->found.compliance);
  } catch (const Error& error) {
    throw FileError(options.over.string(), 0, error.what());
  }
}

// Names the poses in errors of the filter, which knows no files.
FilteredScan filteredOf(const Inputs& in, const FilterOptions& options, const ScanFilter& filter,
                        Progress& progress) {
  try {
    return filterStreams({in.poses.values, in.samples.values, in.rates}, in.rig, filter, progress);
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(options.input.string(), 0, error.what());
  }
}

int runFilter(FilterOptions options, Console& console) {
  findFiles(options);
  if (options.over.empty())
    console.warnOfNoEffect({"--registration", "--tip-radius", "--unit"},
                           "without --reference-mesh");
  std::vector<std::filesystem::path> inputs = {options.input, options.probe, options.rig,
                                               options.truth, options.over,  options.registration};
  inputs.push_back(options.input.parent_path() / "frames.csv"); // frames of the same scan
  requireWritable(options.output, inputs, FileKind::table);
  if (options.normal && options.heights.empty())
    throw Error("--normal: is that of heights; name a file for them with --heights");
  if (!options.heights.empty()) {
    requireWritable(options.heights, inputs, FileKind::table);
    if (areOne(options.heights, options.output))
      throw FileError(options.heights.string(), 0, "is the path's file too");
  }
  const Inputs in = read(options, console);
  const std::optional<Over> over = readOver(options, in.rig, console);
  ScanFilter filter;
  filter.model = chosenModel(options, in);
  filter.smooth = !options.forward;
  filter.touching_only = !options.lifted;
  filter.gravity = in.rig.gravity;
  const bool with_heights = !options.heights.empty();
  if (with_heights && filter.model != PathModel::fused)
    throw Error("--heights: come from the accelerometers of the fused --model");
  const auto begin = std::chrono::steady_clock::now();
  const FilteredScan scan = filteredOf(in, options, filter, console.progress());
  requireTouch(scan, options);
  std::optional<ScanHeights> heights;
  if (with_heights) heights = heightsOf(scan, over, in, options);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  console.progress().throwIfCancelled();
  if (heights)
    writePath(options.output, scan.path, options.heights, heights->heights);
  else
    writePath(options.output, scan.path);

  const std::size_t rejected = in.poses.values.size() - scan.track.used();
  Report report(kFilterKeys);
  report.set("samples", scan.path.size()).set("model", nameOf(filter.model));
  report.set("poses", in.poses.values.size());
  report.set("rejected", rejected,
             formatCount(rejected) + " of " + formatCount(in.poses.values.size()) + " poses");
  report.set("restarts", scan.track.restarts);
  report.set("nis_mean", scan.track.nis_mean, rounded(scan.track.nis_mean));
  report.set("rms_innovation", scan.track.rms_innovation);
  reportSigma(scan.path, report);
  const Json gaps = gapsJson(scan);
  report.set("gaps", gaps, formatCount(gaps.asArray().size()) + "; sigma grows in them");
  if (filter.model == PathModel::fused) {
    report.set("nis_probe", Json(Json::Array(scan.axis_nis.begin(), scan.axis_nis.end())));
    report.set("bias", Json(Json::Array(scan.bias.begin(), scan.bias.end())));
  }
  if (scan.clock) reportClock(*scan.clock, report);
  if (!in.truth.empty()) {
    const PathError error = errorOf(scan.path, in.truth);
    Json json = Json::object();
    json.set("rms", error.rms).set("max", error.most).set("nees", error.nees);
    report.set("error", json.set("samples", error.samples),
               formatLength(error.rms) + " (rms), " + formatLength(error.most) + " (max); NEES " +
                   rounded(error.nees));
  }
  if (heights) reportHeights(*heights, report);
  report.set("seconds", taken.count());
  for (const std::string& doubt : scan.warnings)
    console.warn(options.input.string() + ": " + doubt);
  warnOf(scan.without_pose, options.input, in.poses, nullptr, "a pose", console);
  warnOf(scan.without_sample, options.probe, in.samples,
         scan.clock && scan.clock->is_significant ? &*scan.clock : nullptr, "a sample", console);
  return console.report(report, scan.is_wrong ? kNotSolved : kDone);
}

} // namespace

Command filterCommand() {
  auto options = std::make_shared<FilterOptions>();
  const auto degrees = [options](double angle) {
    options->sigmas.angle = angle * std::numbers::pi / 180;
  };
  return {
      .name = "filter",
      .summary = "poses and the probe's stream become a path with error bars",
      .description =
          "SCAN is a scan folder (poses.tum, probe.csv, rig.json; truth.csv where it was "
          "simulated) or a file of poses, beside which rig.json is looked for.\n"
          "fused: camera and accelerometers together, a sample of the path for each of the probe. "
          "acceleration, velocity: poses alone, whose motion is taken to have a steady "
          "acceleration or velocity. Poses that do not fit are rejected and counted.\n"
          "--heights writes the surface's height along the path, from the accelerometers, with its "
          "sigma, above the plane through the contact points, or along --normal. Details below the "
          "camera's noise come from the accelerometers, slow shape from the camera. If the probe "
          "was pressed while it stood still, the surface's stiffness is reported and its "
          "indentation removed. With --reference-mesh and --registration heights are relative to a "
          "mesh, and "
          "the arc length is along the mesh.\n"
          "With a probe the path has only samples in contact, by their force. Gaps are bridged, "
          "reported, and sigma grows in them. Where streams or poses contradict one another, the "
          "path is written, a warning says so and the exit code is 1. Where there is a truth, the "
          "error against it is reported.",
      .examples = {"patina filter scan -o path.csv",
                   "patina filter poses.tum --probe probe.csv -o path.csv --json"},
      .keys = kFilterKeys,
      .arguments =
          {input("SCAN", "Scan folder, or poses as TUM.", into(options->input)),
           outputTo(options->output, "PATH.csv", "The path, with sigma."),
           {"--probe", "PROBE.csv", "", "", "The probe's stream.", into(options->probe)},
           {"--rig", "RIG.json", "", "", "Tip, accelerometers, gravity.", into(options->rig)},
           {"--truth", "TRUTH.csv", "", "", "A path to compare with.", into(options->truth)},
           {"--model", "fused|acceleration|velocity", "", "what the files allow",
            "How motion is modelled.", parsedInto(options->model, parseModel)},
           {"--no-smoother", "", "", "", "Each sample uses only the poses before it.",
            into(options->forward)},
           writtenTo(options->heights, "--heights", "HEIGHTS.csv",
                     "Heights along the path, with sigma."),
           {"--normal", "X,Y,Z", "", "of the plane that was touched",
            "Outwards, in the camera's frame.", parsedInto(options->normal, parseNormal)},
           {"--reference-mesh", "MESH", "", "",
            "Heights over a mesh, along its normals, in place of a plane.", into(options->over)},
           {"--registration", "R.json", "", "", "Where the scan lies on it: of patina register.",
            into(options->registration)},
           tipRadius(options->tip_radius, "that of rig.json"),
           unitOfMesh(options->unit),
           {"--keep-air", "", "", "", "Keep what the probe did in the air.", into(options->lifted)},
           {"--sigma", "LENGTH", "m", "0.2mm", "Deviation of poses that do not tell their own.",
            numberInto(1e-9, 1, options->sigmas.position, NumberKind::length)},
           {"--sigma-angle", "DEG", "deg", "0.27", "The same of their angles.",
            inRange(1e-6, 90, degrees)}},
      .run = [options](Console& console) { return runFilter(*options, console); }};
}

} // namespace patina::cli
