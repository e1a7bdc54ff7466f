// Opening a scene without holding up the window: its own thread, signals back.
#pragma once

#include <atomic>
#include <list>
#include <memory>
#include <optional>
#include <thread>

#include <QObject>
#include <QString>

#include "app/session.h"

namespace patina {

struct LoadRequest {
  std::filesystem::path path; // empty: the toy dinosaur
  OpenOptions options;
  bool unit_chosen = false; // by a person: no question about the size
};

class SceneLoader : public QObject {
  Q_OBJECT
 public:
  explicit SceneLoader(QObject* parent = nullptr);
  ~SceneLoader() override; // cancels, and waits unless resting()

  // A load that is under way is cancelled; its signals are no longer sent. Neither call waits: a
  // cancelled load reads on, unheard, until it notices.
  void start(const LoadRequest& request);
  void cancel();
  bool busy() const { return busy_; }
  bool resting() const { return jobs_.empty(); } // no thread is left, heard or not
  const LoadRequest& request() const { return request_; }

 signals: // in the thread of this object; the five after meshReady end the load
  void progressed(double fraction, const QString& what);
  void meshReady(std::shared_ptr<const patina::TriangleMesh> mesh, const QString& name);
  void ready(std::shared_ptr<const patina::CompiledScene> scene, const QStringList& warnings);
  void failed(const QString& message);
  void cancelled();
  void needsUnit(double longest_side); // in file units, when millimetres give an odd size
  void needsIso(double low, double high);
  void rested(); // the last thread has ended

 private:
  void run(const LoadRequest& request, Progress& progress, std::uint64_t load);
  template <typename Work> void deliver(std::uint64_t load, bool last, Work work);
  void silence(); // whatever is under way
  void reap();

  struct Job {
    std::unique_ptr<Progress> progress;
    std::thread thread;
    std::atomic<bool> done{false};
  };
  std::list<Job> jobs_; // the newest last
  LoadRequest request_;
  std::uint64_t load_ = 0; // numbers the loads: a late signal of an old one is dropped
  bool busy_ = false;
};

} // namespace patina
