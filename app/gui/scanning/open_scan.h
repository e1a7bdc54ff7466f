// The scan that is open: read, tracked and filtered behind the window, with the one time that is
// looked at. What shows it listens.
#pragma once

#include <functional>
#include <memory>

#include <QObject>

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
  // What is known of it, as it goes into a scene: as it was read, then what was found since, one
  // step after another.
  std::vector<SceneScan> steps() const;
  void keep() const; // poses.tum and path.csv into the folder; throws FileError

  const ScanFiles* files() const { return files_.get(); } // nullptr: none is open
  const std::vector<SeenFrame>& seen() const { return seen_; }
  const ScanPath* path() const { return path_.get(); } // nullptr: not yet
  bool canKeep() const; // something was found that the folder does not hold
  QString name() const;
  FrameQuality qualityOf(std::size_t frame) const;
  // From the first to the last of frames, poses and samples [s].
  Gap span() const;

  double cursor() const { return cursor_; } // [s]
  void setCursor(double t);                 // within the span
  std::size_t frameAt(double t) const;      // nearest; there must be one
  void step(int frames);                    // of frames, or of what there is in place of them
  // The finding that holds the cursor, the shortest first; nullptr: none.
  const Finding* findingAtCursor() const;
  // Where the probe is at the cursor; nullopt: nobody saw it.
  std::optional<Pose> probeAtCursor() const;

 signals:
  void opened();     // another scan, or none
  void framesSeen(); // some more of them
  void pathMade();
  void cursorMoved();
  void progressed(double fraction, const QString& what);
  void finished(); // nothing is under way any more
  void failed(const QString& message);

 private:
  using Read = std::function<ScanFiles(Progress&)>;
  void start(Read read);
  void run(const Read& read, Progress& progress, const Background::Deliver& deliver);
  void take(std::shared_ptr<const ScanFiles> files);
  std::vector<NoPose> without() const;

  Background job_;
  std::shared_ptr<const ScanFiles> files_;
  std::vector<SeenFrame> seen_;
  std::shared_ptr<ScanPath> path_; // no other holds it
  double cursor_ = 0;
  bool grows_ = false;
};

} // namespace patina
