#include "app/gui/scanning/open_scan.h"

#include <algorithm>
#include <cmath>

#include "acquisition/tracking/track_frames.h"
#include "core/error.h"

namespace patina {
namespace {

constexpr std::size_t kBatch = 16; // frames that are told of at once

using Seen = std::vector<SeenFrame>;

SeenFrame seenFrame(const SeenRig& rig, const std::string& why) {
  SeenFrame frame;
  frame.looked = true;
  frame.verdict = rig.verdict;
  // A verdict speaks of a picture; without one the cause is the file's.
  frame.readable = why.empty() || why == reasonOf(rig);
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

OpenScan::OpenScan(QObject* parent) : QObject(parent), job_(this), cursor_(*this) {
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
    std::string left_out;
    files.frames = framesOf(folder, 1, &left_out);
    if (!left_out.empty()) files.warnings.push_back(left_out);
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
  deliver(false, [this, notes = found.notes] {
    for (const std::string& line : notes) emit noted(QString::fromStdString(line));
  });
  filter(files->poses.empty() ? found.poses : files->poses, all);
}

void OpenScan::take(std::shared_ptr<const ScanFiles> files) {
  files_ = std::move(files);
  seen_.assign(files_->frames.size(), {});
  path_.reset();
  grows_ = false;
  cursor_.rewind();
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
  if (!poses.empty()) cursor_.set(poses.back().t);
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

QString OpenScan::name() const {
  if (!files_) return {};
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

} // namespace patina
