// A program that edits and saves a workspace, for tests that let its disk fail or kill it.
//   workspace_child edit FOLDER           a stroke, a scene, a save, an undo: a line after each
//   workspace_child insist FOLDER         ten strokes, an undo in place of one that fails
//   workspace_child picture FILE          reads it
//   workspace_child replace FOLDER        the folder becomes a workspace of its own
//   workspace_child strokes FOLDER SEED   strokes and saves without end: "N" after each record
#include <cstdio>
#include <random>
#include <string>

#include "core/error.h"
#include "pictures/picture_file.h"
#include "support/painted_scene.h"
#include "workspace/workspace.h"

namespace patina {
namespace {

void report(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

// Returns the scene after so many events: its values and its paint distinguish it.
Scene sceneAfter(Scene scene, std::uint64_t events) {
  scene.haptics.stiffness = 100 + static_cast<double>(events);
  scene.objects[0].paint =
      somePaint(*scene.objects[0].mesh, static_cast<unsigned>(events), With::material);
  return scene;
}

void edit(const std::filesystem::path& folder) {
  OpenedWorkspace opened = openWorkspace(folder);
  JournalWriter journal(opened.journal_file, opened.journal.size());
  journal.append(someStroke(20, 800));
  report("stroke");
  const Scene scene = sceneAfter(opened.scene, journal.events() + 1);
  const std::string state = storeState(scene, journal.events() + 1, folder);
  journal.append(StoredSceneEdit{"change", state});
  report("scene");
  saveWorkspace(scene, journal.events(), opened.states, folder);
  report("saved");
  journal.append(UndoEvent{});
  report("undo");
}

void insist(const std::filesystem::path& folder) {
  const OpenedWorkspace opened = openWorkspace(folder);
  JournalWriter journal(opened.journal_file, opened.journal.size());
  for (int i = 0; i < 10; ++i) {
    try {
      journal.append(someStroke(20 - i, 100 + i));
    } catch (const FileError&) {
      journal.append(UndoEvent{}); // shorter: it does not cover the remains of the first
    }
  }
}

void picture(const std::filesystem::path& path) {
  const Picture read = readPicture(path);
  report(std::to_string(read.width));
}

void strokes(const std::filesystem::path& folder, unsigned seed) {
  std::mt19937 random(seed);
  OpenedWorkspace opened = openWorkspace(folder);
  JournalWriter journal(opened.journal_file, opened.journal.size());
  report(std::to_string(journal.events()));
  for (;;) {
    const std::uint64_t number = journal.events() + 1;
    const Scene scene = sceneAfter(opened.scene, number);
    if (random() % 4 == 0)
      journal.append(StoredSceneEdit{"change", storeState(scene, number, folder)});
    else
      journal.append(someStroke(static_cast<int>(random() % 400), 800));
    report(std::to_string(journal.events()));
    if (random() % 3 == 0) saveWorkspace(scene, number, opened.states, folder);
  }
}

int run(int count, char** words) {
  const std::string command = count > 2 ? words[1] : "";
  try {
    if (command == "edit")
      edit(words[2]);
    else if (command == "insist")
      insist(words[2]);
    else if (command == "picture")
      picture(words[2]);
    else if (command == "replace")
      saveWorkspace(paintedScene(0.08, 2, With::material), words[2]);
    else if (command == "strokes" && count > 3)
      strokes(words[2], static_cast<unsigned>(std::stoul(words[3])));
    else
      return 64;
  } catch (const Error& error) {
    std::fprintf(stderr, "workspace_child: %s\n", error.what());
    return 2;
  }
  return 0;
}

} // namespace
} // namespace patina

int main(int count, char** words) {
  return patina::run(count, words);
}
