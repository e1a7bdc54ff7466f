// Larger inputs cost time and memory in proportion, within stated bounds.
// Times are processor times of the program, of which two processors, the reference, give two
// seconds in one. Sizes beyond an ordinary run are in the long form.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/file.h"
#include "geometry/io/mesh_io.h"
#include "geometry/mesh/shapes.h"
#include "integration/program.h"
#include "support/longer.h"

namespace patina::test {
namespace {

constexpr double kMb = 1e6;
constexpr double kProcessors = 2;
// Most that doubling may cost; caches take more than twice.
constexpr double kDoubling = 2.2;

struct Measured {
  Outcome outcome;
  double seconds = 0; // processor time of all threads
  double peak = 0;    // largest resident memory [bytes], at least that of this test at its start
};

class Growth : public ::testing::Test {
 protected:
  Measured measure(const std::vector<std::string>& words) const {
    std::vector<std::string> all = {programPath().string()};
    all.insert(all.end(), words.begin(), words.end());
    std::vector<char*> argv;
    for (std::string& word : all) argv.push_back(word.data());
    argv.push_back(nullptr);
    const std::string out = folder / "out", err = folder / "err";
    const pid_t pid = fork();
    if (pid == 0) {
      const bool redirected =
          std::freopen(out.c_str(), "w", stdout) && std::freopen(err.c_str(), "w", stderr);
      if (redirected) execv(argv[0], argv.data());
      _exit(127);
    }
    int status = 0;
    rusage usage{};
    while (wait4(pid, &status, 0, &usage) != pid && errno == EINTR) {
    }
    Measured result;
    result.outcome = {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
                      readFile(out), readFile(err)};
    for (const timeval& time : {usage.ru_utime, usage.ru_stime})
      result.seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    result.peak = 1024. * static_cast<double>(usage.ru_maxrss);
    return result;
  }

  Measured succeed(const std::vector<std::string>& words) const {
    Measured result = measure(words);
    EXPECT_EQ(result.outcome.exit, 0) << result.outcome.err;
    return result;
  }

  // Shortest processor time [s] of some runs, since other programs only add to it.
  double shortest(const std::function<std::vector<std::string>()>& words, int runs = 3) const {
    double seconds = succeed(words()).seconds;
    while (--runs > 0) seconds = std::min(seconds, succeed(words()).seconds);
    return seconds;
  }

  // Expects that twice the size takes `kDoubling` as long at most. Both times of a pair share what
  // other programs leave of the caches, so the least ratio of up to five pairs counts.
  static void expectProportion(const std::function<double()>& once,
                               const std::function<double()>& twice, const std::string& what = "") {
    double ratio = std::numeric_limits<double>::infinity();
    for (int pair = 0; pair < 5 && !(ratio <= kDoubling); ++pair)
      ratio = std::min(ratio, twice() / once());
    EXPECT_LE(ratio, kDoubling) << what;
  }

  std::string meshFile(const std::string& name, const TriangleMesh& mesh) const {
    writeMesh(folder / name, mesh);
    return folder / name;
  }
  std::string cube() const { return meshFile("cube.obj", box(Vec3(10, 10, 10))); }

  // A fresh name for each output, so that no run finds another's.
  std::string output(const std::string& ending = "") {
    return folder / ("out" + std::to_string(outputs_++) + ending);
  }

  ScratchFolder folder;

 private:
  int outputs_ = 0;
};

std::string nested(std::size_t levels) {
  std::string text = "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\">"
                     "<ImageData WholeExtent=\"0 1 0 1 0 1\"><Piece Extent=\"0 1 0 1 0 1\">";
  for (std::size_t i = 0; i < levels; ++i) text += "<a>";
  return text;
}

TEST_F(Growth, NestedVolumeEndsInOneLine) {
  for (const std::size_t levels : {std::size_t{333333}, std::size_t{3000000}}) {
    const Measured found = measure({"info", folder.write("nested.vti", nested(levels))});
    expectOneLineError(found.outcome, {"nested.vti", "32 levels"});
    EXPECT_LE(found.peak, 100 * kMb) << levels;
  }
}

// One triangle many times, and a fan of slivers at a vertex, flat or as a cone.
TriangleMesh repeatedTriangle(int count) {
  TriangleMesh mesh{{Vec3(0, 0, 0), Vec3(50, 0, 0), Vec3(0, 50, 0)}, {}, {}};
  mesh.triangles.assign(static_cast<std::size_t>(count), {0, 1, 2});
  return mesh;
}
TriangleMesh fan(int count, double height) {
  TriangleMesh mesh;
  mesh.positions.emplace_back(0, 0, height);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    mesh.positions.emplace_back(50 * std::cos(angle), 50 * std::sin(angle), 0);
    mesh.triangles.push_back({0, i + 1, (i + 1) % count + 1});
  }
  return mesh;
}

TEST_F(Growth, RepeatedTriangleTakesASecond) {
  const auto seconds = [&](int count) {
    const std::string mesh =
        meshFile("t" + std::to_string(count) + ".stl", repeatedTriangle(count));
    return shortest([&] { return std::vector<std::string>{"field", mesh, "-o", output(".vti")}; });
  };
  EXPECT_LE(seconds(30000), 1 * kProcessors);
  expectProportion([&] { return seconds(30000); }, [&] { return seconds(60000); });
}

TEST_F(Growth, FanOfSliversTakesTwoSecondsAndAConeThree) {
  for (const double height : {0., 20.}) {
    const double limit = height > 0 ? 3 : 2;
    const auto seconds = [&](int count) {
      const std::string mesh = meshFile("f" + std::to_string(count) + ".stl", fan(count, height));
      return shortest(
          [&] {
            return std::vector<std::string>{"field", mesh, "-o", output(".vti")};
          },
          1);
    };
    EXPECT_LE(std::min(seconds(30000), seconds(30000)), limit * kProcessors) << height;
    for (const int count : {15000, 30000})
      if (count == 15000 || isLong())
        expectProportion([&] { return seconds(count); }, [&] { return seconds(2 * count); },
                         std::to_string(height));
  }
}

TEST_F(Growth, FileAddedFourThousandTimesTakesASecond) {
  const std::string mesh = cube();
  const auto seconds = [&](int count) {
    return shortest([&] {
      std::vector<std::string> words{"scene", "-o", output()};
      for (int i = 0; i < count; ++i) words.insert(words.end(), {"--add", mesh});
      return words;
    });
  };
  EXPECT_LE(seconds(4000), 1 * kProcessors);
  expectProportion([&] { return seconds(4000); }, [&] { return seconds(8000); });
}

TEST_F(Growth, ObjectsOfOneFileShareItsMesh) {
  const std::string mesh = meshFile("ball.ply", icosphere(10, 32)); // 20,480 triangles
  const auto peaks = [&](int count) {
    const std::string workspace = output();
    std::vector<std::string> words{"scene", "-o", workspace};
    for (int i = 0; i < count; ++i) words.insert(words.end(), {"--add", mesh});
    const Measured made = succeed(words), listed = succeed({"scene", "-o", workspace});
    return std::pair(made.peak, listed.peak);
  };
  const auto few = peaks(100), many = peaks(1000);
  EXPECT_LE(many.first, 1.5 * few.first);
  EXPECT_LE(many.second, 1.5 * few.second);
}

TEST_F(Growth, SimulatedScanTakesTimeInProportionToItsLength) {
  const std::string mesh = cube();
  const auto seconds = [&](long length, int runs) {
    return shortest(
        [&] {
          return std::vector<std::string>{"simulate-scan", mesh,        "-o",
                                          output(),        "--seconds", std::to_string(length)};
        },
        runs);
  };
  const long length = longer(120);
  expectProportion([&] { return seconds(length, 1); }, [&] { return seconds(2 * length, 1); });
  if (isLong()) {
    EXPECT_LE(seconds(3600, 1), 3.3 * seconds(1200, 1));
  }
}

// A ball of some million triangles as a binary STL, written in parts.
std::string manyTriangles(const ScratchFolder& folder, int rings) {
  const std::string name = folder / ("m" + std::to_string(rings) + ".stl");
  std::ofstream file(name, std::ios::binary);
  const std::string head(80, ' ');
  const auto count = static_cast<std::uint32_t>(4 * rings * (rings - 1));
  file.write(head.data(), 80).write(reinterpret_cast<const char*>(&count), 4);
  const auto point = [&](int ring, int step) {
    const double polar = std::numbers::pi * ring / rings;
    const double around = std::numbers::pi * (step % (2 * rings)) / rings;
    const double sine = ring == rings ? 0 : std::sin(polar);
    return std::array<float, 3>{static_cast<float>(50 * sine * std::cos(around)),
                                static_cast<float>(50 * sine * std::sin(around)),
                                static_cast<float>(50 * std::cos(polar))};
  };
  const auto write = [&](const std::array<float, 3>& a, const std::array<float, 3>& b,
                         const std::array<float, 3>& c) {
    std::array<char, 50> facet{};
    std::size_t at = 12;
    for (const auto* corner : {&a, &b, &c}) {
      std::memcpy(facet.data() + at, corner->data(), 12);
      at += 12;
    }
    file.write(facet.data(), facet.size());
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int step = 0; step < 2 * rings; ++step) {
      const auto a = point(ring, step), b = point(ring + 1, step), c = point(ring + 1, step + 1),
                 d = point(ring, step + 1);
      if (ring + 1 < rings) write(a, b, c);
      if (ring > 0) write(a, c, d);
    }
  return name;
}

TEST_F(Growth, TriangleTakesAQuarterOfAKilobyte) {
  const int rings = isLong() ? 2237 : 500; // 20 million triangles, or one million
  const double count = 4. * rings * (rings - 1);
  const std::string mesh = manyTriangles(folder, rings), workspace = output();
  for (const auto& words : {std::vector<std::string>{"info", mesh, "--no-field"},
                            {"scene", "-o", workspace, "--add", mesh},
                            {"info", workspace, "--no-field"}})
    EXPECT_LE(succeed(words).peak, 250 * count + 30 * kMb) << words[0];
}

TEST_F(Growth, CommentsTakeNoMemory) {
  const long size = isLong() ? 1000000000 : 150000000; // bytes
  const std::string mesh = cube(), part(1000000, 'x');
  const auto told = [](const Measured& measured) { // without the line of the file's name
    return measured.outcome.out.substr(measured.outcome.out.find('\n'));
  };
  const std::string plain = told(succeed({"info", mesh, "--no-field"}));
  for (const char* between : {"", "\n#"}) {
    const std::string commented = folder / "commented.obj";
    std::ofstream file(commented, std::ios::binary);
    file << '#';
    for (long i = 0; i < size; i += 1000000) file << part << between;
    file << '\n' << std::ifstream(mesh).rdbuf();
    file.close();
    const Measured found = succeed({"info", commented, "--no-field"});
    EXPECT_LE(found.peak, 100 * kMb);
    EXPECT_EQ(told(found), plain);
  }
}

} // namespace
} // namespace patina::test
