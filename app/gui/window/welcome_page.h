// The page with ways to begin, shown instead of the 3D view while nothing is open.
#pragma once

#include <QScrollArea>
#include <QStringList>
#include <QToolButton>
#include <QVBoxLayout>

namespace patina {

class WelcomePage : public QScrollArea {
  Q_OBJECT
 public:
  explicit WelcomePage(QWidget& over); // Covers `over`, which owns it.

  void setRecent(const QStringList& paths);
  void setShown(bool on); // Takes the keys when shown.

 signals:
  void openRequested();
  void presetChosen(const QString& name);
  void recentChosen(const QString& path);
  void guideRequested(); // Opens the guide from a scan to haptic rendering.

 protected:
  bool eventFilter(QObject* receiver, QEvent* event) override;

 private:
  void takeKeys();
  void addPresets(QVBoxLayout& column);

  QWidget& over_;
  QToolButton* first_ = nullptr;
  QWidget* recent_ = nullptr;
  QVBoxLayout* recent_column_;
  QStringList recent_paths_;
};

} // namespace patina
