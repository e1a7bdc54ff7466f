#include "acquisition/calibration/calibrate_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "acquisition/files/camera_file.h"
#include "acquisition/orientation.h"
#include "acquisition/vision_library.h"
#include "core/error.h"
#include "core/json.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr double kWorstTip = 1e-3; // standard deviation of what is no tip [m]
constexpr double kWorstRms = 1.5;  // of what is no calibration [px]
constexpr std::size_t kMostViews = 60, kMostLooks = 240;
constexpr double kLookStep = 0.1;  // between looks at frames whose number nobody knows [s]
constexpr double kSameView = 0.01; // views closer than this [diagonals] tell the same
constexpr double kNewView = 0.03;  // what a live source is waited for
constexpr double kTimeWeight = 0.05;
constexpr double kBlurred = 0.5; // of the sharpness of sharp views

double apart(const std::array<Vec2, 4>& a, const std::array<Vec2, 4>& b, double diagonal) {
  double squares = 0;
  for (std::size_t i = 0; i < 4; ++i) squares += (a[i] - b[i]).squaredNorm() / 4;
  return std::sqrt(squares) / diagonal;
}

std::optional<BoardView> boardIn(const GreyFrame& image, const Board& board, bool quick,
                                 const std::string& name) try {
  return findBoard(image, board, quick);
} catch (const FileError&) {
  throw;
} catch (const Error& error) {
  throw FileError(name, 0, error.what());
}

struct SeenView {
  BoardView view;
  GreyFrame size; // without pixels
};

// Pictures are of one size, either as they are shown or as they are stored.
struct Sizes {
  GreyFrame first; // without pixels
  bool alike = true, shown = true, stored = true;

  double diagonal() const { return std::hypot(first.width, first.height); }
  void add(const GreyFrame& size, const std::string& name) {
    if (first.width == 0) first = size;
    const auto isLike = [&](bool across) {
      return size.width == (across ? first.height : first.width) &&
             size.height == (across ? first.width : first.height);
    };
    alike = alike && size.orientation == first.orientation;
    shown = shown && isLike(false);
    stored = stored && isLike(isTransposed(size.orientation) != isTransposed(first.orientation));
    if (!shown && !stored) throw FileError(name, 0, "is of another size than the views before it");
  }
};

// True where views that are turned in several ways are those of a camera that was held in several
// ways, false where they fit better as they are shown.
bool fitViews(const std::vector<SeenView>& views, const Sizes& sizes, CameraFit& best,
              const std::string& from) {
  best.rms = INFINITY;
  bool held = false;
  for (const bool as_held : {false, true}) {
    if (as_held ? !sizes.stored || sizes.alike : !sizes.shown) continue;
    CameraFit fit;
    fit.camera.width = sizes.first.width;
    fit.camera.height = sizes.first.height;
    std::vector<BoardView> points;
    for (const SeenView& seen : views) {
      points.push_back(seen.view);
      if (as_held)
        for (Vec2& p : points.back().pixel) p = shownPixel(storedPixel(p, seen.size), sizes.first);
    }
    if (const std::string cause = visionLibrary().calibrate(points, fit); !cause.empty())
      throw FileError(from, 0, cause);
    if (!(fit.rms < best.rms)) continue;
    best = std::move(fit);
    held = as_held;
  }
  return held;
}

} // namespace

std::array<double, 9> parametersOf(const Camera& c) {
  const auto& d = c.distortion;
  return {c.fx, c.fy, c.cx, c.cy, d[0], d[1], d[2], d[3], d[4]};
}

std::vector<std::size_t> chooseViews(const std::vector<ViewChoice>& views, double diagonal,
                                     std::size_t most) {
  std::vector<std::size_t> chosen;
  if (views.empty()) return chosen;
  std::vector<double> sharp;
  for (const ViewChoice& view : views) sharp.push_back(view.sharpness);
  const auto ninth = sharp.begin() + static_cast<std::ptrdiff_t>(9 * (sharp.size() - 1) / 10);
  std::nth_element(sharp.begin(), ninth, sharp.end());
  const double least = kBlurred * *ninth;
  const double lasts = std::max(1e-9, views.back().t - views.front().t);
  std::vector<double> far(views.size(), INFINITY), unlike = far; // from what was chosen
  std::size_t next = 0;
  for (std::size_t i = 1; i < views.size(); ++i)
    if (views[i].sharpness > views[next].sharpness) next = i;
  for (bool more = true; more && chosen.size() < most;) {
    chosen.push_back(next);
    const ViewChoice& last = views[next];
    more = false;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const double apart_now = apart(views[i].outline, last.outline, diagonal);
      unlike[i] = std::min(unlike[i], apart_now);
      far[i] = std::min(far[i], apart_now + kTimeWeight * std::abs(views[i].t - last.t) / lasts);
      if (views[i].sharpness < least || unlike[i] <= kSameView) continue;
      if (!more || far[i] > far[next]) next = i;
      more = true;
    }
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

CalibratedCamera calibrateCamera(FrameSource& frames, const Board& board,
                                 const std::string& board_text, const std::string& from,
                                 Progress& progress, const BoardSeen& seen) {
  CalibratedCamera found;
  std::vector<SeenView> views;
  std::vector<ViewChoice> choices, kept; // kept: that a live source was waited for
  Sizes sizes;
  TurnedFrames turns;
  std::string fault;
  std::size_t faults = 0;
  const bool pictures = frames.arePictures();
  const std::optional<std::size_t> count = frames.count();
  const std::size_t step = pictures || !count ? 1 : std::max<std::size_t>(1, *count / kMostLooks);
  double last = -INFINITY;
  while (std::optional<SourceFrame> frame = frames.next()) {
    if (progress.cancelled() && frames.isLive()) break;
    progress.throwIfCancelled();
    const std::size_t i = found.frames++;
    if (!frame->fault.empty()) {
      if (faults++ == 0) fault = frame->fault;
      found.rejected.push_back(i);
      continue;
    }
    if (!pictures && (count ? i % step != 0 : frame->t < last + kLookStep)) continue;
    last = frame->t;
    const GreyFrame& image = frame->image;
    const double share = count             ? static_cast<double>(i) / static_cast<double>(*count)
                         : frames.isLive() ? static_cast<double>(kept.size()) / kMostViews
                                           : 0;
    progress.report(0.8 * std::min(1., share), frames.isLive() ? formatCount(kept.size()) + " of " +
                                                                     formatCount(kMostViews) +
                                                                     " views that differ"
                                                               : "views");
    const GreyFrame size{image.width, image.height, {}, image.orientation};
    sizes.add(size, frame->name);
    turns.add(image, frame->name);
    const auto view = boardIn(image, board, !pictures, frame->name);
    if (seen) seen(i, view);
    if (!view) {
      if (found.first_rejected.empty()) found.first_rejected = frame->name;
      found.rejected.push_back(i);
      continue;
    }
    views.push_back({*view, size});
    if (pictures) continue;
    choices.push_back({outlineOf(*view, board), sharpnessOf(image, *view), frame->t});
    if (!frames.isLive()) continue;
    const bool is_new = std::all_of(kept.begin(), kept.end(), [&](const ViewChoice& before) {
      return apart(before.outline, choices.back().outline, sizes.diagonal()) > kNewView;
    });
    if (is_new) kept.push_back(choices.back());
    if (kept.size() == kMostViews) break;
  }
  found.notes = frames.notes();
  if (faults > 0)
    found.notes.push_back(formatCount(faults) + " of " + formatCount(found.frames) +
                          " frames cannot be read; the first: " + fault);
  const std::size_t with_board = views.size();
  if (!pictures) {
    std::vector<SeenView> chosen;
    for (const std::size_t i : chooseViews(choices, sizes.diagonal(), kMostViews))
      chosen.push_back(std::move(views[i]));
    views = std::move(chosen);
  }
  found.views = views.size();
  found.unlike = with_board - views.size();
  if (views.size() < 3)
    throw FileError(from, 0,
                    "the board " + board_text + " is seen in " + formatCount(with_board) + " of " +
                        formatCount(found.frames) + " views" +
                        (found.unlike > 0
                             ? ", of which " + formatCount(views.size()) + " are sharp and differ"
                             : "") +
                        "; three at least are needed");
  progress.report(0.8, "camera");
  const bool held = fitViews(views, sizes, found.fit, from);
  if (const std::string line = turns.line(
          nullptr, held
                       ? "the camera was held in several ways, and its pixels count as in the first"
                       : "all count as they are shown");
      !line.empty())
    found.notes.push_back(line);
  if (found.fit.rms > kWorstRms)
    found.doubt = from + ": corners miss by " + formatNumber(std::round(10 * found.fit.rms) / 10) +
                  " px, which is no calibration; is it " + board_text +
                  " that the pictures show? Look at the number of its squares, their size and the "
                  "markers', the family of markers, their layout (from 0 on by rows), and whether "
                  "it is flat";
  return found;
}

std::string calibratedText(const CameraFit& fit, const std::string& board_text) {
  std::string lines = "avg_reprojection_error: " + formatNumber(fit.rms) + "\nboard: \"" +
                      board_text + "\"\ndeviations: !!opencv-matrix\n   rows: 1\n" +
                      "   cols: 9\n   dt: d\n   data: [ ";
  for (std::size_t i = 0; i < fit.deviation.size(); ++i)
    lines += (i ? ", " : "") + formatNumber(fit.deviation[i]);
  return cameraText(fit.camera, lines + " ]\n");
}

PivotFit tipOf(const std::vector<CameraPose>& poses, const std::string& from) {
  const auto fit = fitPivot(poses);
  if (!fit)
    throw FileError(from, 0,
                    "the poses do not tell the tip: ten at least, turned to all sides about a "
                    "point that stands still");
  const double deviation = std::sqrt(fit->covariance.diagonal().maxCoeff());
  if (deviation > kWorstTip)
    throw FileError(from, 0,
                    "the poses tell the tip to " + formatLength(deviation) +
                        " only: it must stand still while the probe turns about it to all sides");
  return *fit;
}

std::string rigWithTip(const std::string& text, const std::string& name, const PivotFit& fit) {
  Json rig = parseJson(text, name);
  if (!rig.isObject()) throw FileError(name, 0, "is no object");
  rig.set("tip", Json(Json::Array{fit.tip.x(), fit.tip.y(), fit.tip.z()}));
  return rig.dump() + "\n";
}

} // namespace patina
