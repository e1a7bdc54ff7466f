#include "app/gui/scanning/open_scan.h"

#include <algorithm>
#include <cmath>

#include "acquisition/tracking/track_frames.h"
#include "core/error.h"

namespace patina {
namespace {

constexpr std::size_t kBatch = 16;   // frames that are told of at once
constexpr double kSameMoment = 1e-4; // [s]

using Seen = std::vector<SeenFrame>;

SeenFrame seenFrame(const SeenRig& rig, const std::string& why) {
  SeenFrame frame;
  frame.looked = true;
  frame.verdict = rig.verdict;
  // A verdict speaks of a picture; without one the cause is the file's.
  frame.readable = why.empty() || why == nameOf(rig.verdict);
  frame.markers = rig.markers;
  frame.dropped = rig.dropped;
  frame.rms = rig.rms;
  frame.why = why;
  return frame;
}

// What a pose says of the tip, before anything is filtered.
PathSample sampleOf(const CameraPose& pose, const Vec3& tip) {
  PathSample sample;
  sample.t = pose.t;
  sample.position = pose.position + pose.orientation * tip;
  sample.orientation = pose.orientation;
  const double lever = pose.sigma_angle * tip.norm();
  sample.sigma = std::sqrt(pose.sigma_position * pose.sigma_position + 2. / 3 * lever * lever);
  sample.sigma_angle = pose.sigma_angle;
  return sample;
}

} // namespace

OpenScan::OpenScan(QObject* parent) : QObject(parent), job_(this) {
  connect(&job_, &Background::progressed, this, &OpenScan::progressed);
}

void OpenScan::open(const std::filesystem::path& folder) {
  start([folder](Progress& progress) { return readScanFolder(folder, progress); });
}

void OpenScan::open(const SceneScan& scan) {
  start([scan](Progress& progress) { return readScan(scan, progress); });
}

void OpenScan::openPictures(const std::filesystem::path& folder) {
  start([folder](Progress&) {
    ScanFiles files;
    files.pictures = true;
    files.folder = folder;
    files.scan.name = scanNameOf(folder);
    files.frames = framesOf(folder, 1);
    return files;
  });
}

void OpenScan::start(Read read) {
  job_.start([this, read](Progress& progress, const Background::Deliver& deliver) {
    try {
      run(read, progress, deliver);
      deliver(true, [this] { emit finished(); });
    } catch (const Cancelled&) {
      deliver(true, [this] { emit finished(); });
    } catch (const std::exception& error) {
      deliver(true, [this, words = QString::fromStdString(error.what())] {
        emit finished();
        emit failed(words);
      });
    }
  });
}

void OpenScan::run(const Read& read, Progress& progress, const Background::Deliver& deliver) {
  const auto files = std::make_shared<const ScanFiles>(read(progress));
  deliver(false, [this, files] { take(files); });
  const auto filter = [&](const std::vector<CameraPose>& poses, const Seen& seen) {
    Progress part(progress, [&](double, std::string_view) { progress.report(0.99, "filter"); });
    const auto path = std::make_shared<ScanPath>(pathOf(*files, poses, seen, part));
    deliver(false, [this, path] {
      path_ = path;
      emit pathMade();
    });
  };
  if (!files->poses.empty() || !files->path.empty()) filter(files->poses, {});
  if (!files->canTrack()) return;
  Seen all(files->frames.size());
  std::size_t told = 0;
  const auto tell = [&](std::size_t end) {
    deliver(false, [this, told,
                    part = Seen(all.begin() + static_cast<std::ptrdiff_t>(told),
                                all.begin() + static_cast<std::ptrdiff_t>(end))] {
      std::copy(part.begin(), part.end(), seen_.begin() + static_cast<std::ptrdiff_t>(told));
      emit framesSeen();
    });
    told = end;
  };
  const std::unique_ptr<FrameSource> source = openFrames(files->folder.string(), 0);
  const TrackedFrames found =
      trackFrames(*source, *files->camera, files->markers, {}, progress,
                  [&](std::size_t i, const SeenRig& rig, const std::string& why) {
                    if (i >= all.size()) return; // come since, to a scan that is being recorded
                    all[i] = seenFrame(rig, why);
                    if (i + 1 - told == kBatch) tell(i + 1);
                  });
  tell(all.size());
  filter(files->poses.empty() ? found.poses : files->poses, all);
}

void OpenScan::take(std::shared_ptr<const ScanFiles> files) {
  files_ = std::move(files);
  seen_.assign(files_->frames.size(), {});
  path_.reset();
  grows_ = false;
  cursor_ = span().from;
  emit opened();
}

void OpenScan::begin(ScanFiles files) {
  cancel();
  take(std::make_shared<const ScanFiles>(std::move(files)));
  grows_ = true;
  grow({}, {});
}

void OpenScan::grow(const std::vector<CameraPose>& poses, const std::vector<ProbeSample>& samples) {
  if (!path_) path_ = std::make_shared<ScanPath>();
  for (ProbeSample sample : samples) {
    if (files_->rig) sample.force = forceOf(*files_->rig, sample.force);
    path_->probe.push_back(sample);
  }
  for (const CameraPose& pose : poses) {
    path_->poses.push_back(pose);
    path_->path.push_back(sampleOf(pose, files_->tip()));
    if (!path_->probe.empty()) path_->path.back().force = path_->probe.back().force;
  }
  emit pathMade();
  if (!poses.empty()) setCursor(poses.back().t);
}

void OpenScan::close() {
  cancel();
  grows_ = false;
  files_.reset();
  seen_.clear();
  path_.reset();
  emit opened();
}

void OpenScan::cancel() {
  job_.silence();
  emit finished();
}

bool OpenScan::canKeep() const {
  return path_ && !grows_ && !files_->of_scene && !path_->poses.empty() && !path_->path.empty() &&
         !job_.busy() && (files_->poses.empty() || files_->path.empty());
}

std::vector<NoPose> OpenScan::without() const {
  std::vector<NoPose> without;
  for (std::size_t i = 0; i < seen_.size(); ++i)
    if (!seen_[i].why.empty()) without.push_back({files_->frames[i].t, seen_[i].why});
  return without;
}

std::vector<SceneScan> OpenScan::steps() const {
  std::vector<SceneScan> steps;
  if (files_->scan.files.empty()) return steps;
  steps.push_back(files_->scan);
  const auto add = [&](const char* file, const auto& text) {
    if (files_->scan.text(file)) return;
    SceneScan next = steps.back();
    next.files[file] = std::make_shared<const std::string>(text());
    steps.push_back(std::move(next));
  };
  if (!path_ || grows_ || job_.busy()) return steps;
  if (!path_->poses.empty()) add("poses.tum", [&] { return posesText(path_->poses, without()); });
  if (!path_->path.empty()) add("path.csv", [&] { return pathText(path_->path); });
  return steps;
}

void OpenScan::keep() const {
  if (files_->poses.empty()) writePoses(files_->folder / "poses.tum", path_->poses, without());
  if (files_->path.empty()) writePath(files_->folder / "path.csv", path_->path);
}

QString OpenScan::name() const {
  if (files_->of_scene) return QString::fromStdString(files_->scan.name);
  const std::filesystem::path folder = files_->folder.lexically_normal();
  return QString::fromStdString(
      (folder.has_filename() ? folder : folder.parent_path()).filename().string());
}

FrameQuality OpenScan::qualityOf(std::size_t frame) const {
  return patina::qualityOf(*files_, seen_, path_.get(), frame);
}

Gap OpenScan::span() const {
  Gap span{INFINITY, -INFINITY};
  const auto hold = [&](const auto& values) {
    if (values.empty()) return;
    span.from = std::min(span.from, values.front().t);
    span.to = std::max(span.to, values.back().t);
  };
  if (files_) {
    hold(files_->frames);
    hold(files_->poses);
    hold(files_->path);
    hold(files_->probe);
  }
  if (path_) {
    hold(path_->poses);
    hold(path_->probe);
  }
  return span.from <= span.to ? span : Gap{0, 0};
}

void OpenScan::setCursor(double t) {
  const Gap all = span();
  t = std::clamp(t, all.from, all.to);
  if (t == cursor_) return;
  cursor_ = t;
  emit cursorMoved();
}

std::size_t OpenScan::frameAt(double t) const {
  const std::vector<Frame>& frames = files_->frames;
  const auto after =
      std::lower_bound(frames.begin(), frames.end(), t,
                       [](const Frame& frame, double when) { return frame.t < when; });
  if (after == frames.begin()) return 0;
  const auto i = static_cast<std::size_t>(after - frames.begin());
  return after == frames.end() || t - frames[i - 1].t <= after->t - t ? i - 1 : i;
}

void OpenScan::step(int frames) {
  if (!files_) return;
  if (files_->frames.empty()) return setCursor(cursor_ + frames / 30.);
  const auto now = static_cast<int>(frameAt(cursor_));
  const int last = static_cast<int>(files_->frames.size()) - 1;
  setCursor(files_->frames[static_cast<std::size_t>(std::clamp(now + frames, 0, last))].t);
}

const Finding* OpenScan::findingAtCursor() const {
  const Finding* found = nullptr;
  if (path_)
    for (const Finding& each : path_->findings)
      if (cursor_ >= each.from - kSameMoment && cursor_ <= each.to + kSameMoment &&
          (found == nullptr || each.to - each.from < found->to - found->from))
        found = &each;
  return found;
}

std::optional<Pose> OpenScan::probeAtCursor() const {
  if (!path_) return std::nullopt;
  const CameraTrack& track = path_->filtered.track;
  if (track.empty()) {
    const auto pose = poseAt(path_->poses, cursor_);
    return pose ? std::optional(poseOf(path_->poses[*pose])) : std::nullopt;
  }
  const TipMotion motion = motionAt(track, cursor_);
  Pose pose = Pose::Identity();
  pose.linear() = motion.orientation.toRotationMatrix();
  pose.translation() = motion.position - motion.orientation * files_->tip();
  return pose;
}

} // namespace patina
