// The open scan, read, tracked and filtered in the background. Widgets follow its signals.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <QObject>

#include "app/gui/scanning/scan_path.h"
#include "app/gui/toolkit/background.h"

namespace patina {

class OpenScan;

// The current time of the open scan, and the frame, finding and pose at it.
class ScanCursor : public QObject {
  Q_OBJECT
 public:
  explicit ScanCursor(const OpenScan& scan) : scan_(scan) {}

  double time() const { return time_; } // [s]
  void set(double time);                // Clamped to the span of the scan.
  void step(int frames);                // Steps by frames, or by an equivalent time.
  void rewind();                        // Goes to the start without moved().
  std::size_t frame() const;            // The nearest; there must be one.
  // Returns the shortest finding at this time; nullptr: none.
  const Finding* finding() const;
  // Returns the probe's pose; nullopt: not tracked.
  std::optional<Pose> probe() const;

 signals:
  void moved();

 private:
  const OpenScan& scan_;
  double time_ = 0;
};

class OpenScan : public QObject {
  Q_OBJECT
 public:
  explicit OpenScan(QObject* parent);

  // Returns at once. If the new scan cannot be read, the old one stays open.
  void open(const std::filesystem::path& folder) {
    start([folder](Progress& progress) { return readScanFolder(folder, progress); });
  }
  void open(const SceneScan& scan);
  void openPictures(const std::filesystem::path& folder); // Frames without times, taken as 1 Hz.
  void close();
  void cancel() { // Frames that are already tracked stay.
    job_.discardResult();
    emit finished();
  }
  // Opens a scan that is being recorded; grow() adds to it.
  void begin(ScanFiles files);
  void grow(const std::vector<CameraPose>& poses, const std::vector<ProbeSample>& samples);
  bool grows() const { return grows_; }
  bool busy() const { return job_.busy(); }

  const ScanFiles* files() const { return files_.get(); } // nullptr: none is open.
  const std::vector<SeenFrame>& seen() const { return seen_; }
  const ScanPath* path() const { return path_.get(); } // nullptr: not computed yet.
  QString name() const;                                // Empty: none is open.
  FrameQuality qualityOf(std::size_t frame) const {
    return patina::qualityOf(*files_, seen_, path_.get(), frame);
  }
  // Times from the first to the last of frames, poses and samples [s].
  Gap span() const;

  ScanCursor& cursor() { return cursor_; }

 signals:
  void opened();     // Another scan, or none.
  void framesSeen(); // More frames are tracked.
  void pathMade();
  void noted(const QString& line); // A note about its frames, after tracking.
  void progressed(double fraction, const QString& what);
  void finished(); // The background task has ended.
  void failed(const QString& message);

 private:
  using Read = std::function<ScanFiles(Progress&)>;
  void start(Read read);
  void run(const Read& read, Progress& progress, const Background::Post& post);
  void take(std::shared_ptr<const ScanFiles> files);

  Background job_;
  std::shared_ptr<const ScanFiles> files_;
  std::vector<SeenFrame> seen_;
  std::shared_ptr<ScanPath> path_; // Not shared with other owners.
  bool grows_ = false;
  ScanCursor cursor_;
};

} // namespace patina
