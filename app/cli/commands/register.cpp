#include <chrono>
#include <numbers>

#include "acquisition/files/registered_file.h"
#include "acquisition/files/scan_files.h"
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
#include "scan/register_scans.h"

namespace patina::cli {

namespace {

using Method = ScanRegistrationOptions::Method;

struct RegisterOptions {
  std::filesystem::path mesh, path, output, report, initial, truth;
  std::vector<std::filesystem::path> also;
  std::optional<PoseValues> align;
  MeshUnit unit = MeshUnit::mm;
  double tip_radius = 0;
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
     "one standard deviation of the pose, rms of the axes; of what is seen, errors that "
     "neighbouring "
     "samples share counted once",
     Shown::if_any,
     {{"turn", "rad", ""}, {"shift", "m", ""}}},
    {"unique", "", "unique",
     "no other place on the mesh fits as well, and no motion is free; absent: nobody looked"},
    {"rivals",
     "",
     "other places",
     "that fit as well: where, and how far from this one the samples lie there",
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
    {"converged", "", "converged", "residual and pose are at rest, and as small as the noise"},
    {"compliance", "m/N", "gives way", "the surface, to a newton: told, or found by the forces",
     Shown::if_any},
    {"tip",
     "m",
     "tip",
     "added to its place in the probe",
     Shown::if_any,
     {{"added", "m", ""}, {"deviation", "m", ""}}},
    {"clock",
     "s",
     "clock",
     "what the probe felt was at the path's place so much later",
     Shown::if_any,
     {{"added", "s", ""}, {"deviation", "s", ""}}},
    {"frozen", "", "frozen", "what the distances do not tell, left as it was", Shown::if_any},
    {"error", "m", "error", "against the truth: of the samples, rms", Shown::if_any},
    {"mesh_from_scan", "", "mesh from scan", "4 x 4"},
    {"mean_distance", "m", "mean distance"},
    {"roughness", "m", "roughness",
     "of the surface: what of rms the samples' noise leaves unexplained", Shown::if_any},
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

// X,Y,Z as lengths, then degrees about the fixed axes x, y and z (A09).
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
  if (word == "distance") return Method::distance;
  if (word == "loop") return Method::loop;
  if (word == "literal") return Method::literal;
  throw Error("'" + word + "' is none of distance, loop, literal");
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
  for (const std::string& each : joint.frozen) {
    list.push(each);
    words += (words.empty() ? "" : "; ") + each;
  }
  report.set("frozen", list, words);
}

Json freeJson(const std::vector<FreeMotion>& motions) {
  Json list = Json::array();
  for (const FreeMotion& motion : motions) {
    const bool turns = motion.kind == FreeMotion::Kind::turn;
    Json json = Json::object();
    json.set("axis", vectorJson(motion.axis)).set("kind", turns ? "turn" : "slide");
    if (turns) json.set("through", vectorJson(motion.through)).set("pitch", motion.pitch);
    list.push(json);
  }
  return list;
}

Json rivalsJson(const std::vector<Rival>& rivals) {
  Json list = Json::array();
  for (const Rival& rival : rivals)
    list.push(Json::object()
                  .set("mesh_from_scan", poseJson(rival.mesh_from_path))
                  .set("rms", rival.rms)
                  .set("count", rival.counts)
                  .set("away", rival.away)
                  .set("turn", rival.turn));
  return list;
}

Report reportOf(const RegisteredScans& scans, const ScanRegistrationOptions& options,
                double seconds, const std::optional<double>& error) {
  const Registration& found = scans.registration;
  Report report(kRegisterKeys);
  const std::size_t all = found.counts.size();
  const auto count =
      static_cast<std::size_t>(std::count(found.counts.begin(), found.counts.end(), true));
  report.set("rms", found.rms, formatLength(found.rms) + " rms, of the samples that count");
  report.set("samples", Json::object().set("all", all).set("count", count),
             formatCount(all) + ", of which " +
                 (count == all ? "none is" : formatCount(all - count) + " are") + " left out");
  if (options.method == Method::distance) {
    const double turns = std::sqrt(found.covariance.topLeftCorner<3, 3>().trace() / 3),
                 shifts = std::sqrt(found.covariance.bottomRightCorner<3, 3>().trace() / 3);
    report.set("deviation", Json::object().set("turn", turns).set("shift", shifts),
               formatLength(shifts) + ", " + rounded(turns * 180 / std::numbers::pi) +
                   " degrees (1 sigma)");
    std::string words;
    for (const FreeMotion& motion : found.free)
      words += (words.empty() ? "" : "; ") + inWords(motion);
    if (found.rivals) {
      const bool alone = found.rivals->empty();
      report.set("unique", alone && found.free.empty(),
                 !alone          ? "no: " + inWords(*found.rivals)
                 : words.empty() ? "yes"
                                 : "no: " + words);
      report.set("rivals", rivalsJson(*found.rivals));
    }
    report.set("unobservable", freeJson(found.free), words);
    report.set("compliance", found.compliances[0],
               formatLength(found.compliances[0]) + " a newton");
    report.set("together", found.together, rounded(found.together) + " samples in a row");
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
             Json::object().set("turn", found.last_turn).set("shift", found.last_shift),
             rounded(1e3 * found.last_turn) + " mrad, " + formatLength(found.last_shift));
  report.set("iterations", static_cast<std::size_t>(found.iterations));
  return report.set("seconds", seconds);
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
  if (options.align && !options.initial.empty())
    throw Error("--align: --initial is a first guess too; one of them");
  const ScanRegistrationOptions& fit = options.fit;
  if (fit.method != Method::distance &&
      (options.tip_radius > 0 || fit.compliance || fit.noise || !fit.search || fit.refine))
    throw Error("--method: --tip-radius, --compliance, --noise, --no-search and --refine are of "
                "'distance'");
  ScaledMesh scaled = readScaledMesh(options.mesh, options.unit, console);
  TriangleMesh mesh = cleaned(std::move(scaled.mesh)).mesh;
  if (mesh.triangles.empty()) throw FileError(options.mesh.string(), 0, "has no triangle");
  std::vector<std::string> warnings;
  std::vector<std::vector<PathSample>> paths = {readPath(options.path, &warnings)};
  for (const std::filesystem::path& file : options.also) paths.push_back(readPath(file, &warnings));
  for (const std::string& line : warnings) console.warn(line);
  const std::optional<Pose> truth =
      options.truth.empty() ? std::nullopt
                            : std::optional(readPoseAt(options.truth, "mesh_from_camera"));
  if (options.align) options.fit.guess = poseOf(*options.align);
  if (!options.initial.empty()) options.fit.guess = readPose(options.initial);
  const SurfaceTarget target(std::move(mesh), options.tip_radius, true);

  const auto begin = std::chrono::steady_clock::now();
  RegisteredScans scans;
  try {
    scans = registerScans(target, std::move(paths), fit, console.progress());
  } catch (const Error& error) {
    throw FileError(options.path.string(), 0, error.what());
  }
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
  if (scans.joint) addJoint(*scans.joint, report);
  for (const std::string& line : scans.warnings) console.warn(options.path.string() + ": " + line);
  writeRegisteredPath(options.output, scans.paths[0], scans.of(0));
  if (!options.report.empty())
    writeFileAtomically(options.report, console.published(report).dump() + "\n");
  for (const std::string& line : scans.doubts) console.warn(options.mesh.string() + ": " + line);
  if (!found.converged)
    console.warn(options.path.string() + ": no pose was found at which it lies on the mesh as its "
                                         "noise lets expect");
  for (const FreeMotion& motion : found.free)
    console.warn(options.path.string() + ": " + inWords(motion) +
                 ": the mesh does not say where along that it lies");
  if (found.rivals && !found.rivals->empty())
    console.warn(options.path.string() + ": its place is not unique: " + inWords(*found.rivals) +
                 "; scan more of the body, add a scan (--also), or, where you know about where it "
                 "lies, --initial with --no-search");
  return console.report(report, isDoubtful(found) ? kNotSolved : kDone);
}

} // namespace

Command registerCommand() {
  auto options = std::make_shared<RegisterOptions>();
  const auto length = [](double& target) {
    return inRange(
        0, 1, [&target](double value) { target = value; }, NumberKind::length);
  };
  return {
      .name = "register",
      .summary = "a scan path finds its place on a mesh",
      .description =
          "Turns and shifts PATH.csv (of `patina filter`) so that it lies on MESH, and writes it "
          "in "
          "the mesh's frame with the face and barycentric coordinates of each sample. Samples that "
          "do not fit are left out; only those in contact take part.\n"
          "distance: Gauss-Newton on the distances; where the fit from --initial is not as good as "
          "the path's sigma lets expect, many poses about it are tried. loop: nearest points and a "
          "fit of points onto points, in turns, as Andrews and Lang have it (2007); literal: its 4 "
          "x 4 matrix by least squares.\n"
          "Motions that the surface does not see are named and left where they were. Other places "
          "all over the mesh that fit as well are looked for, and how far the surface yields to "
          "the forces is found. --refine fits pose, tip and clock together, from there on: what a "
          "wrong calibration explains is not left to the pose. Exit code 1 where no pose explains "
          "the path, or several do.",
      .examples = {"patina register dinosaur.obj path.csv -o registered.csv --report r.json",
                   "patina register plate.obj path.csv -o r.csv --initial pose.txt --tip-radius "
                   "0.5mm --json"},
      .keys = kRegisterKeys,
      .arguments =
          {input("MESH", "Mesh.", into(options->mesh)),
           input("PATH", "Scan path.", into(options->path)),
           outputTo(options->output, "REGISTERED.csv", "The path on the mesh."),
           {"--also", "PATH.csv", "", "",
            "Another scan in the same camera's frame, registered with it; its pose is the same.",
            into(options->also), Times::any},
           writtenTo(options->report, "--report", "R.json", "The report as a file."),
           {"--initial", "T.txt", "", "middle on middle", "First guess of mesh_from_scan, 4 x 4.",
            into(options->initial)},
           {"--align", "X,Y,Z,A,B,C", "", "",
            "First guess by hand: a shift [m] or as 1mm, then degrees about the fixed axes x, y, "
            "z.",
            [options](const std::string& word) { options->align = parseAlignment(word); }},
           {"--method", "distance|loop|literal", "", "distance", "How it is found.",
            parsedInto(options->fit.method, parseMethod)},
           {"--tip-radius", "LENGTH", "m", "0", "Of the probe: its middle stays that far off.",
            length(options->tip_radius)},
           {"--compliance", "M_PER_N", "m/N", "found by the forces",
            "How far the surface yields to a newton.",
            inRange(0, 1, [options](double c) { options->fit.compliance = c; })},
           {"--noise", "LENGTH", "m", "the path's median sigma", "Deviation of the samples.",
            inRange(
                1e-9, 1, [options](double n) { options->fit.noise = n; }, NumberKind::length)},
           {"--roughness", "LENGTH", "m", "0.2mm",
            "The most that the surface's own relief may add to that.",
            inRange(
                0, 1, [options](double r) { options->fit.roughness = r; }, NumberKind::length)},
           {"--outliers", "SHARE", "", "0.2",
            "Of the samples, as many as may lie elsewhere than on the mesh.",
            inRange(0, 0.6, [options](double share) { options->fit.outliers = share; })},
           {"--refine", "", "", "", "Also the tip's place in the probe and the clocks' offset.",
            into(options->fit.refine)},
           {"--no-search", "", "", "",
            "Fit from the first guess alone, and look for no other place.",
            [options](const std::string&) { options->fit.search = false; }},
           {"--truth", "TRUTH.json", "", "", "Of a simulated scan, to compare with.",
            into(options->truth)},
           {"--unit", "UNIT", "", "mm", "Of the mesh: mm, cm, m, in or fit.",
            parsedInto(options->unit, parseMeshUnit)}},
      .run = [options](Console& console) { return runRegister(*options, console); }};
}

} // namespace patina::cli
