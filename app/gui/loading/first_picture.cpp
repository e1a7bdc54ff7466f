#include "app/gui/loading/first_picture.h"

#include <ctime>
#include <fstream>
#include <sstream>

#include <unistd.h>

#include "app/gui/window/wait.h"
#include "core/error.h"

namespace patina {
namespace {

// Field 22 of /proc/self/stat, in clock ticks since boot; the name before it may hold spaces.
double processStart() {
  std::ifstream stat("/proc/self/stat");
  std::string text((std::istreambuf_iterator<char>(stat)), {});
  std::istringstream rest(text.substr(text.rfind(')') + 2));
  std::string word;
  for (int field = 3; field <= 22; ++field) rest >> word;
  return std::stod(word) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double now() {
  timespec time{};
  clock_gettime(CLOCK_BOOTTIME, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

} // namespace

double firstPictureSeconds(MainWindow& window, const LoadRequest& request) {
  bool mesh_shown = false;
  double presented = 0;
  QString problem;
  DocumentController& documents = window.controllers().documents;
  QObject::connect(&documents, &DocumentController::previewed, &window, [&] { mesh_shown = true; });
  QObject::connect(&documents, &DocumentController::failed, &window,
                   [&](const QString& message) { problem = message; });
  QObject::connect(window.findChild<SceneWidget*>(), &QOpenGLWidget::frameSwapped, &window, [&] {
    if (mesh_shown && presented == 0) presented = now();
  });
  documents.open(request);
  waitUntil([&] { return presented != 0 || !problem.isEmpty(); }, 120000);
  if (!problem.isEmpty()) throw Error(problem.toStdString());
  if (presented == 0) throw Error("no frame was presented within two minutes");
  documents.cancel();
  return presented - processStart();
}

} // namespace patina
