// patina-gui: the window.
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <sys/stat.h>
#include <unistd.h>

#include <QApplication>
#include <QIcon>
#include <QSurfaceFormat>
#include <QTimer>

#include "app/gui/loading/first_picture.h"
#include "app/gui/loading/up_choice.h"
#include "app/gui/window/main_window.h"
#include "app/gui/window/system_theme.h"
#include "app/gui/window/tour.h"
#include "core/error.h"
#include "core/numbers.h"
#include "core/version.h"
#include "visualization/view/display.h"

namespace {

constexpr const char* kHelp =
    "Usage: patina-gui [FILE] [options]\n\n"
    "Opens a mesh (.obj .ply .stl), a volume (.vti), a workspace folder or a scan folder in a\n"
    "window; surfaces are felt with the mouse. Without FILE: a page to begin\n"
    "from; with --tour, --log or --first-picture-time the toy dinosaur.\n\n"
    "  --unit UNIT               of a mesh: mm (default), cm, m, in, or fit (longest side 100 mm)\n"
    "  --up AXIS                 of a mesh file: z (default), or y, which is turned to z\n"
    "  --iso VALUE               of a volume from elsewhere: where its surface is\n"
    "  --log FILE.csv            record every tick, written when the window closes\n"
    "  --tour FOLDER             a scripted session: pictures and feel.csv into FOLDER, then quit\n"
    "  --demo                    from a scan to a feel on the toy, step by step, beside it\n"
    "  --first-picture-time      print the seconds from start to the first picture of FILE\n"
    "  --help, --version\n";

struct Arguments {
  patina::LoadRequest request;
  std::optional<patina::UpAxis> up; // absent: as it was chosen last
  std::optional<std::filesystem::path> log, tour;
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
    } else if (word == "--tour") {
      arguments.tour = value();
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

// Qt prints a warning where no session has set this, and a script reads our standard error.
void giveRuntimeFolder() {
  if (std::getenv("XDG_RUNTIME_DIR") != nullptr) return;
  const auto folder =
      std::filesystem::temp_directory_path() / ("patina-runtime-" + std::to_string(getuid()));
  if (mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST)
    setenv("XDG_RUNTIME_DIR", folder.c_str(), 0);
}

volatile std::sig_atomic_t interrupted = 0;

int run(const Arguments& arguments, int argc, char** argv) {
  if (arguments.log) patina::requireWritable(*arguments.log);
  if (arguments.demo && !patina::isBuilt(patina::Desk::texture))
    throw patina::Error("--demo: this program was built without scans (PATINA_ACQUISITION)");
  patina::requireDisplay();
  setenv("QT_QPA_PLATFORM", "xcb", 0);
  giveRuntimeFolder();
  QSurfaceFormat::setDefaultFormat(QVTKOpenGLNativeWidget::defaultFormat());
  QApplication application(argc, argv);
  QApplication::setApplicationName(QStringLiteral("patina"));
  QApplication::setOrganizationName(QStringLiteral("patina"));
  QApplication::setDesktopFileName(QStringLiteral("local.patina.Patina")); // app/package has it
  QApplication::setWindowIcon(QIcon(QStringLiteral(":/patina.png")));
  const patina::SystemTheme theme(application);
  patina::MainWindow window;
  patina::DocumentController& documents = window.controllers().documents;
  patina::FeelController& feel = window.controllers().feel;
  documents.setAsks(!arguments.tour && !arguments.log && !arguments.first_picture_time);
  if (documents.asks())
    window.restorePlace();
  else
    window.resize(1280, 800);
  window.show();
  if (arguments.tour) {
    patina::runTour(window, arguments.request, *arguments.tour);
    return 0;
  }
  if (arguments.first_picture_time) {
    std::cout << patina::firstPictureSeconds(window, arguments.request) << '\n';
    return 0;
  }
  window.controllers().recovery.begin();
  patina::LoadRequest request = arguments.request;
  if (!arguments.up && documents.asks()) request.options.up = patina::rememberedUp();
  // Where nobody sees the page, or nobody asks for it, the first preset is open.
  if (!request.path.empty() || !documents.asks() || arguments.demo) documents.open(request);
  if (arguments.demo) {
    window.controllers().desks.choose(patina::Desk::texture);
    window.controllers().desks.open(patina::Panel::steps);
  }
  if (arguments.log) feel.startLog();
  // Ctrl-C, kill and a lost terminal are ways to close the window: the log is still written.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    std::signal(signal, [](int) { interrupted = 1; });
  QTimer watch;
  QObject::connect(&watch, &QTimer::timeout, &window, [&] {
    if (interrupted == 0) return;
    if (documents.asks()) window.controllers().edits.thread().leaveBehind();
    documents.setAsks(false);
    window.close();
    // A question that is still open would keep the program alive.
    if (!window.isVisible()) QApplication::quit();
  });
  watch.start(100);
  const int code = QApplication::exec();
  if (arguments.log) {
    const std::size_t lost = feel.log().lost();
    feel.log().save(*arguments.log);
    if (lost > 0)
      std::cerr << "patina-gui: " << arguments.log->string() << ": " << lost
                << " ticks came too fast to be kept\n";
  }
  return code;
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
