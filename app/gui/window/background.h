// Work on a thread of its own whose words arrive in the window's thread; the newest work alone is
// heard.
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
  // Called in the work's thread: `then` runs in the window's, unless other work has begun by then.
  // last = this was all.
  using Deliver = std::function<void(bool last, std::function<void()> then)>;
  // Must not throw; its last word is delivered with last = true.
  using Work = std::function<void(Progress& progress, const Deliver& deliver)>;

  explicit Background(QObject* parent = nullptr);
  ~Background() override; // cancels, and waits unless resting()

  // Neither call waits: work under way is cancelled, and goes on, unheard, until it notices.
  void start(Work work);
  void silence();
  bool busy() const { return busy_; }
  bool resting() const { return jobs_.empty(); } // no thread is left, heard or not

 signals: // in the thread of this object
  void progressed(double fraction, const QString& what);
  void rested(); // the last thread has ended

 private:
  void deliver(std::uint64_t job, bool last, std::function<void()> then);
  void reap();

  struct Job {
    std::unique_ptr<Progress> progress;
    std::thread thread;
    std::atomic<bool> done{false};
  };
  std::list<Job> jobs_;      // the newest last
  std::uint64_t number_ = 0; // of the newest: a late word of an old one is dropped
  bool busy_ = false;
};

} // namespace patina
