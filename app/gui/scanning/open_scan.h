// The scan that is open: read, tracked and filtered behind the window. What shows it listens.
#pragma once

#include <functional>
#include <memory>

#include <QObject>

#include "app/gui/scanning/scan_cursor.h"
#include "app/gui/scanning/scan_path.h"
#include "app/gui/window/background.h"

namespace patina {

class OpenScan : public QObject {
  Q_OBJECT
 public:
  explicit OpenScan(QObject* parent);

  // Of a scan that cannot be read the one before stays. Returns at once.
  void open(const std::filesystem::path& folder);
  void open(const SceneScan& scan);                       // of the scene
  void openPictures(const std::filesystem::path& folder); // frames without times, one a second
  void close();
  void cancel(); // what is tracked so far stays
  // A scan that is being recorded takes the place of what is open, and grows.
  void begin(ScanFiles files);
  void grow(const std::vector<CameraPose>& poses, const std::vector<ProbeSample>& samples);
  bool grows() const { return grows_; }
  bool busy() const { return job_.busy(); }

  const ScanFiles* files() const { return files_.get(); } // nullptr: none is open
  const std::vector<SeenFrame>& seen() const { return seen_; }
  const ScanPath* path() const { return path_.get(); } // nullptr: not yet
  QString name() const;                                // empty: none is open
  FrameQuality qualityOf(std::size_t frame) const;
  // From the first to the last of frames, poses and samples [s].
  Gap span() const;

  ScanCursor& cursor() { return cursor_; }

 signals:
  void opened();     // another scan, or none
  void framesSeen(); // some more of them
  void pathMade();
  void noted(const QString& line); // of its frames, once they are tracked
  void progressed(double fraction, const QString& what);
  void finished(); // nothing is under way any more
  void failed(const QString& message);

 private:
  using Read = std::function<ScanFiles(Progress&)>;
  void start(Read read);
  void run(const Read& read, Progress& progress, const Background::Deliver& deliver);
  void take(std::shared_ptr<const ScanFiles> files);

  Background job_;
  std::shared_ptr<const ScanFiles> files_;
  std::vector<SeenFrame> seen_;
  std::shared_ptr<ScanPath> path_; // no other holds it
  bool grows_ = false;
  ScanCursor cursor_;
};

} // namespace patina
