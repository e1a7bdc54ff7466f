#include <chrono>
#include <numbers>

#include "acquisition/files/registered_file.h"
#include "acquisition/files/scan_tables.h"
#include "app/cli/commands/commands.h"
#include "app/cli/input/mesh_input.h"
#include "app/cli/output/reports.h"
#include "core/error.h"
#include "core/file.h"
#include "core/numbers.h"
#include "geometry/io/pose_file.h"
#include "geometry/mesh/mesh_report.h"
#include "geometry/mesh/mesh_unit.h"
#include "geometry/mesh/pose_values.h"
#include "scan/scan_advice.h"
#include "scan/scan_files.h"

namespace patina::cli {

namespace {

using Method = ScanRegistrationOptions::Method;

struct RegisterOptions {
  std::filesystem::path mesh, path, output, report, initial, truth, next_stroke;
  std::vector<std::filesystem::path> also;
  std::optional<PoseValues> align;
  MeshUnit unit = MeshUnit::mm;
  std::optional<double> tip_radius;
  ScanRegistrationOptions fit;
};

const Keys kRegisterKeys = {
    {"rms", "m", "residual", "rms distance of the samples that count from where they should be"},
    {"samples",
     "",
     "samples",
     "in contact; and how many of them count",
     Shown::always,
     {{"all", "", ""}, {"count", "", ""}}},
    {"deviation",
     "",
     "uncertainty",
     "one standard deviation: of the path's points by all observable errors of the pose together, "
     "and of the pose itself, rms of the axes; errors that neighbouring samples share are counted "
     "once",
     Shown::if_any,
     {{"points", "m", ""}, {"turn", "rad", ""}, {"shift", "m", ""}}},
    {"unique", "", "unique",
     "no other place on the mesh fits as well, and no motion is free; absent: not searched"},
    {"rivals",
     "",
     "other places",
     "other poses that fit as well, and how far the samples move to them",
     Shown::never,
     {{"mesh_from_scan", "", ""},
      {"rms", "m", ""},
      {"count", "", ""},
      {"away", "m", ""},
      {"turn", "rad", ""}}},
    {"unobservable",
     "",
     "free",
     "motions that the surface does not see, left where they were",
     Shown::if_any,
     {{"axis", "", ""}, {"kind", "", ""}, {"through", "m", ""}, {"pitch", "m", ""}}},
    {"scans",
     "",
     "scans",
     "of several, each by its own samples",
     Shown::if_any,
     {{"path", "", ""},
      {"rms", "m", ""},
      {"count", "", ""},
      {"compliance", "m/N", ""},
      {"compliance_deviation", "m/N", ""}}},
    {"converged", "", "converged", "residual and pose are at rest, and as small as the noise"},
    {"compliance", "m/N", "gives way",
     "the surface, to a newton: given, or estimated from the forces", Shown::if_any},
    {"compliance_deviation", "m/N", "gives way, deviation",
     "two of them hold the truth in 95 %; 0 if given", Shown::never},
    {"tip",
     "m",
     "tip",
     "added to its place in the probe",
     Shown::if_any,
     {{"added", "m", ""}, {"deviation", "m", ""}}},
    {"clock",
     "s",
     "clock",
     "delay of the probe's samples after the path",
     Shown::if_any,
     {{"added", "s", ""}, {"deviation", "s", ""}}},
    {"frozen", "", "frozen", "parameters that the distances do not determine, left unchanged",
     Shown::if_any},
    {"error", "m", "error", "against the truth: of the samples, rms", Shown::if_any},
    {"known",
     "",
     "known",
     "how well the scan determines the pose, as the mesh's displacement, and the heights of which "
     "share of the area it determines to 0.2 mm; and after the next stroke",
     Shown::if_any,
     {{"pose", "m", ""}, {"area", "", ""}, {"pose_after", "m", ""}, {"area_after", "", ""}}},
    {"mesh_from_scan", "", "mesh from scan", "4 x 4"},
    {"mean_distance", "m", "mean distance"},
    {"roughness", "m", "roughness",
     "of the surface: the part of rms that exceeds the samples' noise", Shown::if_any},
    {"noise", "m", "noise", "that was expected of the samples", Shown::if_any},
    {"together", "", "worth one", "so many samples in a row, as their errors go together",
     Shown::if_any},
    {"last_step",
     "",
     "last step",
     "of the pose",
     Shown::always,
     {{"turn", "rad", ""}, {"shift", "m", ""}}},
    {"iterations", "", "iterations", "of the fit"},
    {"evaluations", "", "evaluations", "of a sample's distance, in the fit", Shown::if_any},
    {"starts", "", "starts", "poses that were fitted from", Shown::if_any},
    {"seconds", "s", "registered in"}};

// Parses X,Y,Z as lengths, then degrees about the fixed axes x, y and z (A09).
PoseValues parseAlignment(const std::string& text) {
  std::size_t third = 0;
  for (int commas = 0; commas < 3 && third != std::string::npos; ++commas)
    third = text.find(',', third + (commas > 0));
  if (third == std::string::npos || third == 0)
    throw Error("'" + text + "' is not X,Y,Z,A,B,C: a shift and three turns");
  PoseValues values;
  values.position_mm = 1000 * parsePoint(text.substr(0, third));
  values.angles_deg = parsePoint(text.substr(third + 1));
  if (values.angles_deg.cwiseAbs().maxCoeff() > 360)
    throw Error("'" + text + "': turns are -360 to 360 degrees");
  return values;
}

Method parseMethod(const std::string& word) {
  if (word == "point-to-surface" || word == "distance") return Method::distance;
  if (word == "icp" || word == "loop") return Method::loop;
  if (word == "icp-affine" || word == "literal") return Method::literal;
  throw Error("'" + word + "' is none of point-to-surface, icp, icp-affine");
}

void addJoint(const JointFit& joint, Report& report) {
  Json tip = Json::object().set("added", vectorJson(joint.tip)),
       clock = Json::object().set("added", joint.clock);
  std::string tip_words = "moved by " + formatLength(joint.tip.norm()),
              clock_words = rounded(1e3 * joint.clock) + " ms";
  if (joint.tip_deviation) {
    tip.set("deviation", *joint.tip_deviation);
    tip_words += ", each axis to " + formatLength(*joint.tip_deviation);
  }
  if (joint.clock_deviation) {
    clock.set("deviation", *joint.clock_deviation);
    clock_words += ", to " + rounded(1e3 * *joint.clock_deviation) + " ms";
  }
  report.set("tip", tip, tip_words).set("clock", clock, clock_words);
  Json list = Json::array();
  std::string words;
  for (const std::string& each : joint.unobservable_parameters) {
    list.push(each);
    words += (words.empty() ? "" : "; ") + each;
  }
  report.set("frozen", list, words);
}

Json freeJson(const std::vector<UnobservableMotion>& motions) {
  Json list = Json::array();
  for (const UnobservableMotion& motion : motions) {
    const bool turns = motion.kind == UnobservableMotion::Kind::rotation;
    Json json = Json::object();
    json.set("axis", vectorJson(motion.axis)).set("kind", turns ? "turn" : "slide");
    if (turns) json.set("through", vectorJson(motion.axis_point)).set("pitch", motion.pitch);
    list.push(json);
  }
  return list;
}

Json alternativesJson(const std::vector<AlternativePose>& alternatives) {
  Json list = Json::array();
  for (const AlternativePose& other : alternatives)
    list.push(Json::object()
                  .set("mesh_from_scan", poseJson(other.mesh_from_path))
                  .set("rms", other.rms)
                  .set("count", other.inliers)
                  .set("away", other.displacement)
                  .set("turn", other.rotation));
  return list;
}

// A compliance that was given has no deviation.
std::string complianceWords(const Registration& found) {
  const double deviation = found.compliance_deviations[0];
  return formatLength(found.compliances[0]) +
         (deviation > 0 ? " ± " + formatLength(deviation) : "") + " a newton";
}

// One row a scan, where there are several.
void addScans(const RegisteredScans& scans, const std::vector<std::string>& names, Report& report) {
  if (names.size() < 2) return;
  Json list = Json::array();
  std::string words;
  for (std::size_t s = 0; s < names.size(); ++s) {
    const Registration own = scans.of(s);
    list.push(Json::object()
                  .set("path", names[s])
                  .set("rms", own.rms)
                  .set("count", static_cast<std::size_t>(
                                    std::count(own.inliers.begin(), own.inliers.end(), true)))
                  .set("compliance", own.compliances[0])
                  .set("compliance_deviation", own.compliance_deviations[0]));
    words += (s > 0 ? "; " : "") + names[s] + ": " + formatLength(own.rms) + " rms, gives way " +
             complianceWords(own);
  }
  report.set("scans", list, words);
}

Report reportOf(const RegisteredScans& scans, const ScanRegistrationOptions& options,
                double seconds, const std::optional<double>& error) {
  const Registration& found = scans.registration;
  Report report(kRegisterKeys);
  const std::size_t all = found.inliers.size();
  const auto count =
      static_cast<std::size_t>(std::count(found.inliers.begin(), found.inliers.end(), true));
  report.set("rms", found.rms, formatLength(found.rms) + " rms, of the samples that count");
  report.set("samples", Json::object().set("all", all).set("count", count),
             formatCount(all) + ", of which " +
                 (count == all ? "none is" : formatCount(all - count) + " are") + " left out");
  if (options.method == Method::distance) {
    const double turns = std::sqrt(found.covariance.topLeftCorner<3, 3>().trace() / 3),
                 shifts = std::sqrt(found.covariance.bottomRightCorner<3, 3>().trace() / 3);
    const double points = pathDeviation(found);
    report.set(
        "deviation", Json::object().set("points", points).set("turn", turns).set("shift", shifts),
        formatLength(points) + " of the path's points (1 sigma); an axis of the pose " +
            formatLength(shifts) + ", " + rounded(turns * 180 / std::numbers::pi) + " degrees");
    std::string words;
    for (const UnobservableMotion& motion : found.free)
      words += (words.empty() ? "" : "; ") + inWords(motion);
    if (found.alternatives) {
      const bool alone = found.alternatives->empty();
      report.set("unique", alone && found.free.empty(),
                 !alone          ? "no: " + inWords(*found.alternatives)
                 : words.empty() ? "yes"
                                 : "no: " + words);
      report.set("rivals", alternativesJson(*found.alternatives));
    }
    report.set("unobservable", freeJson(found.free), words);
    report.set("compliance", found.compliances[0], complianceWords(found));
    report.set("compliance_deviation", found.compliance_deviations[0]);
    report.set("together", found.correlation_length,
               rounded(found.correlation_length) + " samples in a row");
    report.set("evaluations", found.evaluations)
        .set("starts", static_cast<std::size_t>(found.starts));
  }
  report.set("converged", found.converged);
  if (error) report.set("error", *error);
  const Eigen::AngleAxisd turn(found.mesh_from_path.linear());
  report.set("mesh_from_scan", poseJson(found.mesh_from_path),
             "turned by " + rounded(turn.angle() * 180 / std::numbers::pi) +
                 " degrees, shifted by " + formatLength(found.mesh_from_path.translation().norm()));
  report.set("mean_distance", found.mean_distance);
  if (scans.noise > 0 && options.method == Method::distance)
    report.set("roughness", found.roughness);
  if (found.noise > 0) report.set("noise", scans.noise);
  report.set("last_step",
             Json::object().set("turn", found.last_rotation).set("shift", found.last_translation),
             rounded(1e3 * found.last_rotation) + " mrad, " + formatLength(found.last_translation));
  report.set("iterations", static_cast<std::size_t>(found.iterations));
  return report.set("seconds", seconds);
}

// Writes the next stroke; there is none if the scan is complete.
void addAdvice(const ScanAdvice& advice, const RegisterOptions& options, Report& report) {
  Json known = Json::object().set("pose", advice.known.pose).set("area", advice.known.area);
  if (advice.stroke) {
    known.set("pose_after", advice.stroke->pose).set("area_after", advice.stroke->area);
    writeStroke(options.next_stroke, *advice.stroke);
  }
  report.set("known", known, inWords(advice));
}

int runRegister(RegisterOptions options, Console& console) {
  std::vector<std::filesystem::path> inputs = {options.mesh, options.path, options.initial,
                                               options.truth};
  inputs.insert(inputs.end(), options.also.begin(), options.also.end());
  requireWritable(options.output, inputs, FileKind::table);
  if (!options.report.empty()) {
    requireWritable(options.report, inputs, FileKind::json);
    if (areOne(options.report, options.output))
      throw FileError(options.report.string(), 0, "is the path's file too");
  }
  if (!options.next_stroke.empty()) {
    requireWritable(options.next_stroke, inputs, FileKind::table);
    if (areOne(options.next_stroke, options.output) || areOne(options.next_stroke, options.report))
      throw FileError(options.next_stroke.string(), 0, "is another output's file too");
  }
  if (options.align && !options.initial.empty())
    throw Error("--initial-values: --initial is a first guess too; one of them");
  const ScanRegistrationOptions& fit = options.fit;
  std::vector<std::filesystem::path> files = {options.path};
  files.insert(files.end(), options.also.begin(), options.also.end());
  double tip_radius = options.tip_radius.value_or(0);
  if (!options.tip_radius && fit.method == Method::distance) {
    std::vector<std::filesystem::path> folders;
    for (const std::filesystem::path& file : files) folders.push_back(file.parent_path());
    tip_radius = tipRadiusOf(folders);
  }
  if (fit.method != Method::distance) {
    if (tip_radius > 0 || fit.compliance || fit.noise || !fit.search || fit.refine ||
        !options.next_stroke.empty())
      throw Error("--method: --tip-radius, --compliance, --noise, --no-search, --refine and "
                  "--next-stroke are of 'distance'");
    console.warnOfNoEffect({"--roughness", "--outliers"}, "unless --method is distance");
  }
  ScaledMesh scaled = readScaledMesh(options.mesh, options.unit, console);
  TriangleMesh mesh = cleaned(std::move(scaled.mesh)).mesh;
  if (mesh.triangles.empty()) throw FileError(options.mesh.string(), 0, "has no triangle");
  std::vector<std::string> warnings;
  std::vector<std::vector<PathSample>> paths;
  for (const std::filesystem::path& file : files) {
    paths.push_back(readPath(file, &warnings));
    options.fit.names.push_back(file.string());
  }
  for (const std::string& line : warnings) console.warn(line);
  const std::optional<Pose> truth =
      options.truth.empty() ? std::nullopt
                            : std::optional(readPoseAt(options.truth, "mesh_from_camera"));
  if (options.align) options.fit.guess = poseOf(*options.align);
  if (!options.initial.empty()) options.fit.guess = readPose(options.initial);
  const SurfaceTarget target(std::move(mesh), tip_radius, true);

  const auto begin = std::chrono::steady_clock::now();
  const RegisteredScans scans = registerScans(target, std::move(paths), fit, console.progress());
  const Registration& found = scans.registration;
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  console.progress().throwIfCancelled();
  std::optional<double> error;
  if (truth) {
    double squares = 0, samples = 0;
    for (const std::vector<PathSample>& path : scans.paths)
      for (const PathSample& sample : path) {
        squares +=
            (found.mesh_from_path * sample.position - *truth * sample.position).squaredNorm();
        ++samples;
      }
    error = std::sqrt(squares / samples);
  }
  Report report = reportOf(scans, fit, taken.count(), error);
  addScans(scans, fit.names, report);
  if (scans.joint) addJoint(*scans.joint, report);
  if (!options.next_stroke.empty()) addAdvice(adviceFor(target, scans), options, report);
  if (!options.report.empty()) // first: the path completes the command
    writeFileAtomically(options.report, console.published(report).dump() + "\n");
  writeRegisteredPath(options.output, scans.paths[0], scans.of(0));
  for (const std::string& line : warningsOf(scans, options.mesh.string())) console.warn(line);
  return console.report(report, isUnreliable(found) ? kNotSolved : kDone);
}

} // namespace

Command registerCommand() {
  auto options = std::make_shared<RegisterOptions>();
  return {
      .name = "register",
      .summary = "register a scan path to a mesh",
      .description =
          "Finds the pose at which PATH.csv (of `patina filter`) lies on MESH, and writes it in "
          "the mesh's frame with the face and barycentric coordinates of each sample. Samples that "
          "do not fit are left out; only those in contact take part.\n"
          "point-to-surface: Gauss-Newton on the distances; if the fit from --initial is worse "
          "than "
          "the path's sigma allows, many poses near it are tried. icp: iterated closest points "
          "with "
          "a rigid fit (Besl and McKay 1992), as in Andrews and Lang (2007). icp-affine: the same "
          "with their 4 x 4 matrix by least squares.\n"
          "Motions that the surface does not determine are reported and left unchanged. Other "
          "poses on the mesh that fit as well are searched, and the surface's compliance is "
          "estimated from the forces. --refine then fits pose, tip and clock together, so that "
          "calibration errors do not bias the pose. --next-stroke writes the points of the stroke "
          "over the mesh that would most reduce the expected deviation of the pose and the area "
          "whose heights are not known yet; no file if pose (0.1 mm) and heights (0.2 mm over 95 % "
          "of the area) are. Exit code 1 if no pose fits the path, or "
          "several do.",
      .examples = {"patina register dinosaur.obj path.csv -o registered.csv --report r.json",
                   "patina register plate.obj path.csv -o r.csv --initial pose.txt --tip-radius "
                   "0.5mm --json"},
      .keys = kRegisterKeys,
      .arguments =
          {input("MESH", "Mesh.", into(options->mesh)),
           input("PATH", "Scan path.", into(options->path)),
           outputTo(options->output, "REGISTERED.csv", "The path on the mesh."),
           {"--with", "PATH.csv", "", "",
            "Another scan in the same camera's frame, registered with it; its pose is the same.",
            into(options->also), Times::any},
           writtenTo(options->report, "--report", "R.json", "The report as a file."),
           writtenTo(options->next_stroke, "--next-stroke", "STROKE.csv",
                     "Where to scan next: the stroke that would tell most of pose and heights."),
           {"--initial", "T.txt", "", "middle on middle", "First guess of mesh_from_scan, 4 x 4.",
            into(options->initial)},
           {"--initial-values", "X,Y,Z,A,B,C", "", "",
            "First guess by hand: a shift [m] or as 1mm, then degrees about the fixed axes x, y, "
            "z.",
            parsedInto(options->align, parseAlignment)},
           {"--method", "point-to-surface|icp|icp-affine", "", "point-to-surface",
            "How the pose is found.", parsedInto(options->fit.method, parseMethod)},
           tipRadius(options->tip_radius, "that of a rig.json beside PATH"),
           {"--compliance", "M_PER_N", "m/N", "found by the forces",
            "How far the surface yields to a newton.", numberInto(0, 1, options->fit.compliance)},
           {"--noise", "LENGTH", "m", "the path's median sigma", "Deviation of the samples.",
            numberInto(1e-9, 1, options->fit.noise, NumberKind::length)},
           {"--roughness", "LENGTH", "m", "0.2mm",
            "The most that the surface's own relief may add to that.",
            numberInto(0, 1, options->fit.roughness, NumberKind::length)},
           {"--outliers", "SHARE", "", "0.2",
            "Of the samples, as many as may lie elsewhere than on the mesh.",
            numberInto(0, 0.6, options->fit.outliers)},
           {"--refine", "", "", "", "Also the tip's place in the probe and the clocks' offset.",
            into(options->fit.refine)},
           {"--no-search", "", "", "",
            "Fit from the first guess alone, without a search for other poses.",
            [options](const std::string&) { options->fit.search = false; }},
           {"--truth", "TRUTH.json", "", "", "Of a simulated scan, to compare with.",
            into(options->truth)},
           unitOfMesh(options->unit)},
      .run = [options](Console& console) { return runRegister(*options, console); }};
}

} // namespace patina::cli
