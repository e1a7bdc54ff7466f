#include "app/gui/scanning/open_scan.h"

#include "app/gui/toolkit/words.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace patina {
namespace {

constexpr double kSameMoment = 1e-4; // [s]

constexpr std::size_t kBatch = 16;

using Seen = std::vector<SeenFrame>;

SeenFrame seenFrame(const SeenRig& rig, const std::string& why) {
  SeenFrame frame;
  frame.looked = true;
  frame.verdict = rig.verdict;
  // A verdict refers to a readable picture; otherwise the cause is the file.
  frame.readable = why.empty() || why == reasonOf(rig);
  frame.markers = rig.markers;
  frame.rms = rig.rms;
  frame.why = why;
  return frame;
}

// Returns the tip of an unfiltered pose.
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

void ScanCursor::set(double time) {
  const Gap all = scan_.span();
  time = std::clamp(time, all.from, all.to);
  if (time == time_) return;
  time_ = time;
  emit moved();
}

void ScanCursor::rewind() {
  time_ = scan_.span().from;
}

void ScanCursor::step(int frames) {
  if (scan_.files() == nullptr) return;
  const std::vector<Frame>& all = scan_.files()->frames;
  if (all.empty()) return set(time_ + frames / 30.);
  const int last = static_cast<int>(all.size()) - 1;
  set(all[static_cast<std::size_t>(std::clamp(static_cast<int>(frame()) + frames, 0, last))].t);
}

std::size_t ScanCursor::frame() const {
  const std::vector<Frame>& frames = scan_.files()->frames;
  const auto after =
      std::lower_bound(frames.begin(), frames.end(), time_,
                       [](const Frame& frame, double when) { return frame.t < when; });
  if (after == frames.begin()) return 0;
  const auto i = static_cast<std::size_t>(after - frames.begin());
  return after == frames.end() || time_ - frames[i - 1].t <= after->t - time_ ? i - 1 : i;
}

const Finding* ScanCursor::finding() const {
  const Finding* found = nullptr;
  if (scan_.path() != nullptr)
    for (const Finding& each : scan_.path()->findings)
      if (time_ >= each.from - kSameMoment && time_ <= each.to + kSameMoment &&
          (found == nullptr || each.to - each.from < found->to - found->from))
        found = &each;
  return found;
}

std::optional<Pose> ScanCursor::probe() const {
  const ScanPath* path = scan_.path();
  if (path == nullptr) return std::nullopt;
  const CameraTrack& track = path->filtered.track;
  if (track.empty()) {
    const auto pose = poseAt(path->poses, time_);
    return pose ? std::optional(poseOf(path->poses[*pose])) : std::nullopt;
  }
  const TipMotion motion = motionAt(track, time_);
  Pose pose = Pose::Identity();
  pose.linear() = motion.orientation.toRotationMatrix();
  pose.translation() = motion.position - motion.orientation * scan_.files()->tip();
  return pose;
}

OpenScan::OpenScan(QObject* parent) : QObject(parent), job_(this), cursor_(*this) {
  connect(&job_, &Background::progressed, this, &OpenScan::progressed);
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
  job_.start([this, read](Progress& progress, const Background::Post& post) {
    try {
      run(read, progress, post);
      post(true, [this] { emit finished(); });
    } catch (const Cancelled&) {
      post(true, [this] { emit finished(); });
    } catch (const std::exception& error) {
      post(true, [this, words = shownText(error.what())] {
        emit finished();
        emit failed(words);
      });
    }
  });
}

void OpenScan::run(const Read& read, Progress& progress, const Background::Post& post) {
  const auto files = std::make_shared<const ScanFiles>(read(progress));
  post(false, [this, files] { take(files); });
  const auto filter = [&](const std::vector<CameraPose>& poses, const Seen& seen) {
    Progress part(progress, [&](double, std::string_view) { progress.report(0.99, "filter"); });
    const auto path = std::make_shared<ScanPath>(pathOf(*files, poses, seen, part));
    post(false, [this, path] {
      path_ = path;
      emit pathMade();
    });
  };
  if (!files->poses.empty() || !files->path.empty()) filter(files->poses, {});
  if (!files->canTrack()) return;
  Seen all(files->frames.size());
  std::size_t reported = 0;
  const auto report = [&](std::size_t end) {
    post(false, [this, reported,
                 part = Seen(all.begin() + static_cast<std::ptrdiff_t>(reported),
                             all.begin() + static_cast<std::ptrdiff_t>(end))] {
      std::copy(part.begin(), part.end(), seen_.begin() + static_cast<std::ptrdiff_t>(reported));
      emit framesSeen();
    });
    reported = end;
  };
  const TrackedFrames found =
      trackScan({files->folder.string(), *files->camera, files->markers, "rig.json"}, progress,
                [&](std::size_t i, const SeenRig& rig, const std::string& why) {
                  if (i >= all.size()) return; // come since, to a scan that is being recorded
                  all[i] = seenFrame(rig, why);
                  if (i + 1 - reported == kBatch) report(i + 1);
                });
  report(all.size());
  std::vector<std::string> notes = found.notes;
  if (!found.rig_doubt.empty()) notes.push_back("rig.json: " + found.rig_doubt);
  post(false, [this, notes = std::move(notes)] {
    for (const std::string& line : notes) emit noted(shownText(line));
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

QString OpenScan::name() const {
  if (!files_) return {};
  if (files_->of_scene) return shownText(files_->scan.name);
  const std::filesystem::path folder = files_->folder.lexically_normal();
  return shownText((folder.has_filename() ? folder : folder.parent_path()).filename().string());
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
