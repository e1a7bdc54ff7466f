// What goes onto the desk Align and off it: files, and scans of the scene.
#pragma once

#include <filesystem>
#include <functional>

#include <QFileDialog>

#include "app/gui/aligning/align_panel.h"
#include "app/gui/aligning/aligned_scan.h"
#include "app/gui/panels/message_panel.h"

namespace patina {

class AlignFiles : public QObject {
  Q_OBJECT
 public:
  // Does what the panel asks for, for the window to which it belongs.
  AlignFiles(QWidget& window, const Alignment& alignment, AlignPanel& panel);

  void setScene(std::shared_ptr<const Scene> scene); // whose paths can be chosen
  void openPath(const std::filesystem::path& file);
  void openScan(const QString& name); // of the scene
  void openFirstScan();               // of those that have a path, if there is one
  void store(const QString& name);    // as a scan of the scene
  bool askKept(const QString& what);  // kept or given up; false: the person goes on
  using Change = std::function<SceneScan(const SceneScan* now)>; // see SceneScans

 signals:
  void opened(const QString& name, const patina::AlignedPath& path);
  void said(const patina::Message& message);
  // `stored` is called when the scene's scan is so, and only then.
  void storeAsked(const std::string& name, const patina::AlignFiles::Change& change,
                  const std::function<void()>& stored);
  void kept(const patina::Pose& pose); // in either way

 private:
  void open(const QString& name, const std::function<AlignedPath()>& read);
  QStringList scansWithPath() const;
  void openDialog();
  QFileDialog* keepDialog();
  void keep(const std::filesystem::path& file);

  QWidget& window_;
  const Alignment& alignment_;
  AlignPanel& panel_;
  std::shared_ptr<const Scene> scene_;
};

} // namespace patina
