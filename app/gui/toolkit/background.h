// Runs work on its own thread and posts to the window's thread, unless newer work was started.
#pragma once

#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <thread>

#include <QObject>
#include <QString>

#include "core/progress.h"

namespace patina {

class Background : public QObject {
  Q_OBJECT
 public:
  // Called on the work's thread: runs `then` on the window's. last: the work is done.
  using Post = std::function<void(bool last, std::function<void()> then)>;
  // Must not throw. Its last call of post() has last = true.
  using Work = std::function<void(Progress& progress, const Post& post)>;

  explicit Background(QObject* parent = nullptr) : QObject(parent) {}
  ~Background() override { wait(); } // Cancels, and waits unless isIdle().

  // Neither call waits: running work is cancelled, and its results are discarded.
  void start(Work work);
  void discardResult();
  void wait(); // Cancels and waits.
  bool busy() const { return busy_; }
  bool isIdle() const { return jobs_.empty(); } // No thread is running.

 signals: // In this object's thread.
  void progressed(double fraction, const QString& what);

 private:
  void post(std::uint64_t job, bool last, std::function<void()> then);
  void reap();

  struct Job {
    std::unique_ptr<Progress> progress;
    std::thread thread;
    std::atomic<bool> done{false};
  };
  std::list<Job> jobs_;      // The newest is last.
  std::uint64_t number_ = 0; // Number of the newest job; posts of older ones are dropped.
  bool busy_ = false;
};

} // namespace patina
