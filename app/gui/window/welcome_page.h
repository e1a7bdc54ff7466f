// What stands in the place of the 3D view while nothing is open: ways to begin.
#pragma once

#include <QScrollArea>
#include <QStringList>
#include <QToolButton>
#include <QVBoxLayout>

namespace patina {

class WelcomePage : public QScrollArea {
  Q_OBJECT
 public:
  explicit WelcomePage(QWidget& over); // covers it, and belongs to it

  void setRecent(const QStringList& paths);
  void setShown(bool on); // takes the keys when it comes

 signals:
  void openAsked();
  void presetChosen(const QString& name);
  void recentChosen(const QString& path);
  void guideAsked(); // from a scan to a feel

 protected:
  bool eventFilter(QObject* receiver, QEvent* event) override;

 private:
  void takeKeys(); // or hands them to what it covers
  void addPresets(QVBoxLayout& column);

  QWidget& over_;
  QToolButton* first_ = nullptr; // of the presets
  QWidget* recent_ = nullptr;
  QVBoxLayout* recent_column_;
  QStringList recent_paths_;
};

} // namespace patina
