#include "app/gui/window/wait.h"

#include <QApplication>
#include <QElapsedTimer>
#include <QTimer>

namespace patina {

bool waitUntil(const std::function<bool()>& done, int milliseconds) {
  QElapsedTimer clock;
  clock.start();
  // processEvents with a time limit returns as soon as nothing is left, so it would spin.
  QTimer wake;
  wake.setTimerType(Qt::PreciseTimer);
  wake.start(5);
  while (!done()) {
    if (clock.elapsed() > milliseconds) return false;
    QApplication::processEvents(QEventLoop::AllEvents | QEventLoop::WaitForMoreEvents);
  }
  return true;
}

void wait(int milliseconds) {
  waitUntil([] { return false; }, milliseconds);
}

} // namespace patina
