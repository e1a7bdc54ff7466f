// patina-gui: the window.
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <unistd.h>

#include <QApplication>
#include <QEventLoop>
#include <QIcon>
#include <QSurfaceFormat>
#include <QTimer>

#include "app/gui/loading/up_choice.h"
#include "app/gui/toolkit/system_theme.h"
#include "app/gui/window/main_window.h"
#include "core/error.h"
#include "core/numbers.h"
#include "core/ownership.h"
#include "core/version.h"
#include "visualization/view/display.h"

namespace {

constexpr const char* kHelp =
    "Usage: patina-gui [FILE] [options]\n\n"
    "Opens a mesh (.obj .ply .stl), a volume (.vti), a workspace folder or a scan folder in a\n"
    "window; surfaces are felt with the mouse. Without FILE: a page to begin\n"
    "from; with --log or --first-picture-time the toy dinosaur.\n\n"
    "  --unit UNIT               of a mesh: mm (default), cm, m, in, or fit (longest side 100 mm)\n"
    "  --up AXIS                 of a mesh file: z (default), or y, which is turned to z\n"
    "  --iso VALUE               of a volume from elsewhere: where its surface is\n"
    "  --log FILE.csv            record every tick, on disk within a second\n"
    "  --demo                    from a scan to a feel on the toy, step by step, beside it\n"
    "  --first-picture-time      print the seconds from start to the first picture of FILE\n"
    "  --help, --version\n";

struct Arguments {
  patina::LoadRequest request;
  std::optional<patina::UpAxis> up; // nullopt: the last choice.
  std::optional<std::filesystem::path> log;
  bool first_picture_time = false, demo = false;
  bool help = false, version = false;
};

Arguments parse(const std::vector<std::string>& words) {
  Arguments arguments;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    const auto value = [&]() -> const std::string& {
      if (i + 1 >= words.size()) throw patina::Error(word + " needs a value; see --help");
      return words[++i];
    };
    if (word == "--help" || word == "-h") {
      arguments.help = true;
    } else if (word == "--version") {
      arguments.version = true;
    } else if (word == "--unit") {
      arguments.request.options.unit = patina::parseMeshUnit(value());
      arguments.request.unit_chosen = true;
    } else if (word == "--up") {
      arguments.up = arguments.request.options.up = patina::parseUpAxis(value());
    } else if (word == "--iso") {
      const std::string& text = value();
      arguments.request.options.iso = patina::parseNumber(text);
      if (!arguments.request.options.iso)
        throw patina::Error("--iso '" + text + "' is not a number");
    } else if (word == "--log") {
      arguments.log = value();
    } else if (word == "--demo") {
      arguments.demo = true;
    } else if (word == "--first-picture-time") {
      arguments.first_picture_time = true;
    } else if (word.size() > 1 && word[0] == '-') {
      throw patina::Error("unknown option " + word + "; see --help");
    } else if (!arguments.request.path.empty()) {
      throw patina::Error("one file at a time: '" + word + "' is one too many");
    } else {
      arguments.request.path = word;
    }
  }
  return arguments;
}

// Avoids a warning of Qt on standard error, which scripts read, and a folder that others can
// change.
void giveRuntimeFolder() {
  const patina::RuntimeFolder folder = patina::runtimeFolder();
  if (!folder.problem.empty()) std::cerr << "patina-gui: " << folder.problem << '\n';
  if (folder.path.empty())
    unsetenv("XDG_RUNTIME_DIR");
  else
    setenv("XDG_RUNTIME_DIR", folder.path.c_str(), 1);
}

volatile std::sig_atomic_t interrupted = 0;

// Brings the log to disk and says what it lacks. Returns the exit code.
int finishLog(patina::FeelController& feel, const std::filesystem::path& path) {
  feel.collect();
  try {
    feel.log()->flush();
  } catch (const patina::Error& error) {
    std::cerr << "patina-gui: " << error.what() << '\n';
    return 2;
  }
  if (const std::size_t lost = feel.log()->lost(); lost > 0)
    std::cerr << "patina-gui: " << path.string() << ": " << lost
              << " samples were lost because the buffer was full\n";
  return 0;
}

// Reads field 22 of /proc/self/stat [clock ticks since boot]; the name may contain spaces.
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

// Opens the file and returns the seconds from the start of this process to the first presented
// frame with its mesh. Throws Error if there is none.
double firstPictureSeconds(patina::MainWindow& window, const patina::LoadRequest& request) {
  bool mesh_shown = false;
  double presented = 0;
  QString problem;
  QEventLoop loop;
  patina::DocumentController& documents = window.controllers().documents;
  QObject::connect(&documents, &patina::DocumentController::previewed, &loop,
                   [&] { mesh_shown = true; });
  QObject::connect(&documents, &patina::DocumentController::failed, &loop,
                   [&](const QString& message) {
                     problem = message;
                     loop.quit();
                   });
  QObject::connect(window.findChild<patina::SceneWidget*>(), &QOpenGLWidget::frameSwapped, &loop,
                   [&] {
                     if (!mesh_shown || presented != 0) return;
                     presented = now();
                     loop.quit();
                   });
  QTimer::singleShot(120000, &loop, &QEventLoop::quit);
  documents.open(request);
  if (presented == 0 && problem.isEmpty()) loop.exec();
  if (!problem.isEmpty()) throw patina::Error(problem.toStdString());
  if (presented == 0) throw patina::Error("no frame was presented within two minutes");
  documents.cancel();
  return presented - processStart();
}

int run(const Arguments& arguments, int argc, char** argv) {
  if (arguments.log) patina::requireWritable(*arguments.log);
  patina::requireDisplay();
  setenv("QT_QPA_PLATFORM", "xcb", 0);
  giveRuntimeFolder();
  QSurfaceFormat::setDefaultFormat(QVTKOpenGLNativeWidget::defaultFormat());
  QApplication application(argc, argv);
  QApplication::setApplicationName(QStringLiteral("patina"));
  QApplication::setOrganizationName(QStringLiteral("patina"));
  QApplication::setDesktopFileName(QStringLiteral("local.patina.Patina")); // See app/package.
  QApplication::setWindowIcon(QIcon(QStringLiteral(":/patina.png")));
  const patina::SystemTheme theme(application);
  patina::MainWindow window;
  patina::DocumentController& documents = window.controllers().documents;
  patina::FeelController& feel = window.controllers().feel;
  documents.setInteractive(!arguments.log && !arguments.first_picture_time);
  if (documents.isInteractive())
    window.restorePlace();
  else
    window.resize(1280, 800);
  window.show();
  if (arguments.first_picture_time) {
    std::cout << firstPictureSeconds(window, arguments.request) << '\n';
    return 0;
  }
  window.controllers().recovery.begin();
  patina::LoadRequest request = arguments.request;
  if (!arguments.up && documents.isInteractive()) request.options.up = patina::rememberedUp();
  // Scripts open the first preset instead of the welcome page.
  if (!request.path.empty() || !documents.isInteractive() || arguments.demo)
    documents.open(request);
  if (arguments.demo) {
    window.controllers().desks.choose(patina::Desk::texture);
    window.controllers().desks.open(patina::Panel::steps);
  }
  if (arguments.log) feel.startLog(*arguments.log);
  std::signal(SIGPIPE, SIG_IGN); // a log's reader may end first
  // These signals close the window, so that the log is still written.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    std::signal(signal, [](int) { interrupted = 1; });
  QTimer watch;
  QObject::connect(&watch, &QTimer::timeout, &window, [&] {
    if (interrupted == 0) return;
    if (documents.isInteractive()) {
      window.controllers().edits.thread().keepForRecovery();
      feel.keepForRecovery();
    }
    documents.setInteractive(false);
    window.close();
    // An open dialog would keep the program running.
    if (!window.isVisible()) QApplication::quit();
  });
  watch.start(100);
  int code = QApplication::exec();
  if (arguments.log) code = std::max(code, finishLog(feel, *arguments.log));
  if (!window.isReading()) return code;
  window.finishWithoutReaders();
  std::cout.flush();
  _exit(code); // the window's destructor would wait
}

} // namespace

int main(int argc, char** argv) {
  try {
    const Arguments arguments = parse({argv + 1, argv + argc});
    if (arguments.help) {
      std::cout << kHelp;
      return 0;
    }
    if (arguments.version) {
      std::cout << "patina " << patina::versionText() << '\n';
      return 0;
    }
    return run(arguments, argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "patina-gui: " << error.what() << '\n';
    return 2;
  }
}
