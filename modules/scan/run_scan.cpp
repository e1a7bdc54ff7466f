#include "scan/run_scan.h"

#include <algorithm>
#include <chrono>

#include "acquisition/files/registered_file.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json.h"
#include "core/numbers.h"
#include "core/sha256.h"
#include "geometry/io/mesh_io.h"
#include "geometry/io/pose_file.h"
#include "geometry/mesh/mesh_report.h"
#include "scan/filter_scan.h"
#include "scan/scan_files.h"
#include "scan/scan_texture.h"
#include "scan/track_scan.h"
#include "session/edit/editor.h"
#include "workspace/texture_file.h"

namespace patina {
namespace {

struct Run {
  std::filesystem::path folder;
  bool textured = false;
  ScanFiles files{};
  ScanStep from = ScanStep::track; // track or filter
  std::optional<FilteredScan> filtered{};
};

bool areOne(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code none;
  return std::filesystem::equivalent(a, b, none);
}

class Runner {
 public:
  Runner(const RunScanOptions& options, Progress& progress)
      : options_(options), progress_(progress) {
    for (const auto& folder : options.folders) runs_.push_back({folder, true});
    for (const auto& folder : options.also) runs_.push_back({folder, false});
    if (options.folders.empty()) throw Error("a scan needs a folder");
    for (std::size_t i = 0; i < runs_.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (areOne(runs_[i].folder, runs_[k].folder))
          throw Error(runs_[i].folder.string() + ": is named twice");
    if (!options.workspace.empty() && std::filesystem::exists(options.workspace))
      throw FileError(options.workspace.string(), 0,
                      "exists already; choose another, or remove it");
    if (areOne(options.mesh, options.folders[0] / "textured.obj"))
      throw FileError(options.mesh.string(), 0,
                      "is what the scan's mesh is written to; name another");
  }

  RunScanReport run() {
    readMeshFile();
    for (Run& one : runs_) {
      one.files = readScanFolder(one.folder, progress_);
      warn(one.files.warnings);
      one.from = options_.from.value_or(firstToRun(one));
    }
    std::vector<std::filesystem::path> folders;
    for (const Run& one : runs_) folders.push_back(one.folder);
    tip_radius_ = options_.tip_radius ? *options_.tip_radius : tipRadiusOf(folders);
    target_.emplace(cleaned(mesh_).mesh, tip_radius_, true);
    for (Run& one : runs_)
      if (one.from <= ScanStep::track) track(one);
    if (options_.to >= ScanStep::filter && !filterAll()) return std::move(report_);
    if (options_.to >= ScanStep::register_paths && registers() && !registerAll())
      return std::move(report_);
    if (options_.to >= ScanStep::texture) fitAndLay();
    report_.done = true;
    return std::move(report_);
  }

 private:
  using Clock = std::chrono::steady_clock;

  void warn(const std::vector<std::string>& lines, const std::string& of = "") {
    for (const std::string& line : lines) report_.warnings.push_back(of + line);
  }

  void note(ScanStep step, const std::filesystem::path& folder, Clock::time_point begin,
            const std::string& found, const Json& json) {
    report_.steps.push_back(
        {step, folder, found, std::chrono::duration<double>(Clock::now() - begin).count()});
    const std::filesystem::path file = folder / "scan.json";
    Json all =
        std::filesystem::exists(file) ? parseJson(readFile(file), file.string()) : Json::object();
    all.set(scanStepNames()[static_cast<std::size_t>(step)], json);
    writeFileAtomically(file, all.dump() + "\n");
  }

  void readMeshFile() {
    in_file_ = readMesh(options_.mesh, &report_.warnings);
    ScaledMesh scaled = inMetres(in_file_, options_.unit);
    if (!scaled.warning.empty())
      report_.warnings.push_back(options_.mesh.string() + ": " + scaled.warning);
    scale_ = scaled.scale;
    mesh_ = std::move(scaled.mesh);
    if (cleaned(mesh_).mesh.triangles.empty())
      throw FileError(options_.mesh.string(), 0, "has no triangle");
  }

  static ScanStep firstToRun(const Run& one) {
    if (std::filesystem::exists(one.folder / "path.csv") && !hasWrongPath(one))
      return ScanStep::register_paths;
    return one.files.poses.empty() ? ScanStep::track : ScanStep::filter;
  }

  // Returns true if path.csv is what an earlier run filtered and found wrong.
  static bool hasWrongPath(const Run& one) {
    const std::filesystem::path file = one.folder / "scan.json";
    if (!std::filesystem::exists(file)) return false;
    const Json json = parseJson(readFile(file), file.string());
    const Json* filtered = json.find(scanStepNames()[static_cast<std::size_t>(ScanStep::filter)]);
    const Json* wrong = filtered ? filtered->find("wrong_path") : nullptr;
    return wrong && wrong->asString() == sha256OfFile(one.folder / "path.csv");
  }

  // Returns true if an earlier run has registered the scan and was certain of its pose.
  static bool isCertain(const Run& one) {
    const std::filesystem::path file = one.folder / "registration.json";
    if (!std::filesystem::exists(file) || !std::filesystem::exists(one.folder / "registered.csv"))
      return false;
    const Json json = parseJson(readFile(file), file.string());
    const Json* certain = json.find("certain");
    return certain && certain->asBool();
  }

  // Hash of the registration's inputs.
  std::string inputs() const {
    std::vector<std::string> parts;
    for (const Run& one : runs_) parts.push_back(sha256OfFile(one.folder / "path.csv"));
    std::sort(parts.begin(), parts.end());
    std::string all = sha256OfFile(options_.mesh) + std::string(name(options_.unit));
    if (tip_radius_ > 0) all += formatNumber(tip_radius_);
    for (const std::string& part : parts) all += part;
    return sha256(all);
  }

  bool registers() const {
    if (options_.from) return *options_.from <= ScanStep::register_paths;
    const std::string now = inputs();
    return std::any_of(runs_.begin(), runs_.end(), [&](const Run& one) {
      if (!isCertain(one)) return true;
      const std::filesystem::path file = one.folder / "registration.json";
      const Json json = parseJson(readFile(file), file.string());
      const Json* before = json.find("inputs");
      return !before || before->asString() != now;
    });
  }

  void track(Run& one) {
    const auto begin = Clock::now();
    if (!one.files.canTrack())
      throw FileError(one.folder.string(), 0,
                      "has no frames with a camera.yml and a rig.json that names markers");
    const TrackScanReport found = trackScan(
        {one.folder.string(), *one.files.camera, one.files.markers, one.folder / "rig.json"},
        progress_);
    progress_.throwIfCancelled();
    warn(found.warnings);
    if (found.poses.empty())
      throw FileError(one.folder.string(), 0, "no frame shows a pose of the markers");
    writePoses(one.folder / "poses.tum", found.poses, found.without, found.rig_doubt);
    one.files.poses = readPoses(one.folder / "poses.tum").values;
    note(ScanStep::track, one.folder, begin,
         formatCount(found.poses.size()) + " of " + formatCount(found.frames) +
             " frames with a pose",
         Json::object()
             .set("frames", found.frames)
             .set("frames_with_pose", found.poses.size())
             .set("reprojection_rms_px", found.rms));
  }

  // Filters all scans before it returns false if a path is wrong.
  bool filterAll() {
    bool right = true;
    for (Run& one : runs_)
      if (one.from <= ScanStep::filter) right = filter(one, true) && right;
    return right;
  }

  // Returns false if the path is wrong.
  bool filter(Run& one, bool writes) {
    const auto begin = Clock::now();
    if (one.files.poses.empty()) throw FileError(one.folder.string(), 0, "has no poses.tum");
    try {
      one.filtered = contactPath({one.files.poses, one.files.probe, one.files.rates}, one.files.rig,
                                 progress_);
    } catch (const Error& error) {
      throw FileError(one.folder.string(), 0, error.what());
    }
    if (!writes) return true;
    warn(one.filtered->warnings, one.folder.string() + ": ");
    writePath(one.folder / "path.csv", one.filtered->path);
    Json json = Json::object();
    json.set("samples", one.filtered->path.size()).set("nis_mean", one.filtered->track.nis_mean);
    if (one.filtered->is_wrong) json.set("wrong_path", sha256OfFile(one.folder / "path.csv"));
    note(ScanStep::filter, one.folder, begin, formatCount(one.filtered->path.size()) + " samples",
         json);
    return !one.filtered->is_wrong;
  }

  // Returns false if the pose is uncertain.
  bool registerAll() {
    const auto begin = Clock::now();
    std::vector<std::vector<PathSample>> paths;
    ScanRegistrationOptions options = options_.registration;
    for (const Run& one : runs_) {
      paths.push_back(readPath(one.folder / "path.csv"));
      options.names.push_back((one.folder / "path.csv").string());
    }
    try {
      report_.registered = registerScans(*target_, std::move(paths), options, progress_);
    } catch (const FileError&) {
      throw;
    } catch (const Error& error) {
      throw FileError(options_.mesh.string(), 0, error.what());
    }
    const RegisteredScans& found = *report_.registered;
    warn(warningsOf(found, options_.mesh.string()));
    if (isUnreliable(found.registration) &&
        std::all_of(runs_.begin(), runs_.end(), [](const Run& one) { return isCertain(one); })) {
      report_.warnings.push_back((runs_[0].folder / "registration.json").string() +
                                 ": the certain pose of an earlier run is kept; remove the file to "
                                 "have this one");
      return false;
    }
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      const Registration own = found.of(i);
      writeRegisteredPath(runs_[i].folder / "registered.csv", found.paths[i], own);
      const auto counts =
          static_cast<std::size_t>(std::count(own.inliers.begin(), own.inliers.end(), true));
      const Json json =
          Json::object()
              .set("mesh_from_scan", poseJson(own.mesh_from_path))
              .set("compliance", own.compliances[0])
              .set("compliance_deviation", own.compliance_deviations[0])
              .set("rms", own.rms)
              .set("samples", Json::object().set("all", own.inliers.size()).set("count", counts))
              .set("converged", own.converged)
              .set("certain", !isUnreliable(found.registration))
              .set("inputs", inputs());
      writeFileAtomically(runs_[i].folder / "registration.json", json.dump() + "\n");
      note(ScanStep::register_paths, runs_[i].folder, begin,
           formatLength(own.rms) + " rms off the mesh, " + formatLength(own.compliances[0]) +
               " ± " + formatLength(own.compliance_deviations[0]) + " a newton",
           json);
    }
    return !isUnreliable(found.registration);
  }

  void fitAndLay() {
    std::vector<ScannedTexture> textures;
    std::vector<TexturedFace> faces;
    for (Run& one : runs_) {
      if (!one.textured) continue;
      if (!one.filtered) filter(one, false);
      textures.push_back(fit(one));
      LayOptions options;
      options.texture = static_cast<std::int32_t>(textures.size());
      try {
        textures.back().laid = layScanTexture(mesh_, textures.back().strokes, options, progress_);
      } catch (const Error& error) {
        throw FileError((one.folder / "registered.csv").string(), 0, error.what());
      }
      faces = laidOver(textures.back().laid.faces, faces);
    }
    writeTexturedMesh(runs_[0].folder / "textured.obj", in_file_, faces, scale_);
    Editor(texturedScene(mesh_, options_.mesh.stem().string(), textures), progress_)
        .saveAs(options_.workspace);
  }

  ScannedTexture fit(const Run& one) {
    const auto begin = Clock::now();
    if (!one.files.rig) throw FileError(one.folder.string(), 0, "has no rig.json");
    const std::filesystem::path registration = one.folder / "registration.json";
    const RegistrationReport placed = readRegistrationReport(registration);
    const Json said = parseJson(readFile(registration), registration.string());
    if (const Json* certain = said.find("certain"); certain && !certain->asBool())
      report_.warnings.push_back(registration.string() +
                                 ": its pose is uncertain, but the texture is mapped there");
    ScanPlace place{placed.mesh_from_scan, placed.compliance, {}};
    for (const PathSample& sample : readPath(one.folder / "registered.csv"))
      place.points.push_back({sample.t, sample.position});
    ScannedTexture texture;
    try {
      texture = fitScanTexture(*target_, *one.filtered, one.files.poses, *one.files.rig, place);
    } catch (const FileError&) {
      throw;
    } catch (const Error& error) {
      throw FileError(one.folder.string(), 0, error.what());
    }
    FourierTexture& fitted = texture.fitted.texture;
    fitted.name = one.files.scan.name;
    writeHeights(one.folder / "heights.csv", texture.heights);
    writeTexture(one.folder / "texture.json", fitted);
    note(ScanStep::texture, one.folder, begin,
         formatLength(texture.fitted.rms) + " rms along " + formatLength(texture.fitted.length),
         Json::object()
             .set("length", texture.fitted.length)
             .set("rms", texture.fitted.rms)
             .set("residual", texture.fitted.residual));
    return texture;
  }

  const RunScanOptions& options_;
  Progress& progress_;
  RunScanReport report_;
  std::vector<Run> runs_;
  TriangleMesh in_file_, mesh_; // the latter in metres
  double scale_ = 1, tip_radius_ = 0;
  std::optional<SurfaceTarget> target_;
};

} // namespace

const std::vector<std::string>& scanStepNames() {
  static const std::vector<std::string> kNames = {"track", "filter", "register", "texture"};
  return kNames;
}

RunScanReport runScan(const RunScanOptions& options, Progress& progress) {
  return Runner(options, progress).run();
}

} // namespace patina
