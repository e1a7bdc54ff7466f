// Opening and rebuilding a scene without holding up the window: behind it, signals back.
#pragma once

#include <memory>
#include <optional>

#include <QObject>
#include <QString>
#include <QStringList>

#include "app/gui/background.h"
#include "app/session.h"

namespace patina {

struct LoadRequest {
  std::filesystem::path path; // empty: the toy dinosaur
  OpenOptions options;
  bool unit_chosen = false; // by a person: no question about the size
  // The scene that the file's objects are added to; null: it takes the place of what is open.
  std::shared_ptr<const CompiledScene> onto{};
};

class SceneLoader : public QObject {
  Q_OBJECT
 public:
  explicit SceneLoader(QObject* parent = nullptr);

  // A load that is under way is cancelled; its signals are no longer sent. No call waits.
  void start(const LoadRequest& request);
  // `scene`: that of `from` with other objects or other field values.
  void rebuild(std::shared_ptr<const CompiledScene> from, Scene scene);
  void cancel();
  bool busy() const { return jobs_.busy(); }
  bool resting() const { return jobs_.resting(); }
  const LoadRequest& request() const { return request_; }

 signals: // in the thread of this object; those after meshReady end the load
  void progressed(double fraction, const QString& what);
  void meshReady(std::shared_ptr<const patina::TriangleMesh> mesh, const QString& name);
  void ready(std::shared_ptr<const patina::CompiledScene> scene, const QStringList& warnings);
  void rebuilt(std::shared_ptr<const patina::CompiledScene> scene, const QStringList& warnings);
  void failed(const QString& message);
  void rebuildFailed(const QString& message); // of rebuild() alone
  void cancelled();
  void needsUnit(double longest_side); // in file units, when millimetres give an odd size
  void needsIso(double low, double high);
  void rested(); // the last thread has ended

 private:
  void run(const LoadRequest& request, Progress& progress, const Background::Deliver& deliver);
  // False if a question or an error ends the load.
  bool read(const LoadRequest& request, const Background::Deliver& deliver, OpenedScene& opened);
  // What ends a load that does not come to a scene, in words.
  template <typename Work, typename Failed>
  void guarded(const Background::Deliver& deliver, Work work, Failed failed);

  LoadRequest request_;
  Background jobs_;
};

} // namespace patina
