#include "acquisition/calibration/calibrate_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "acquisition/files/camera_file.h"
#include "acquisition/loaded/vision_library.h"
#include "acquisition/values/orientation.h"
#include "core/error.h"
#include "core/json.h"
#include "core/numbers.h"

namespace patina {
namespace {

constexpr double kWorstTip = 1e-3; // largest accepted standard deviation of the tip [m]
constexpr double kWorstRms = 1.5;  // largest accepted reprojection error [px]
constexpr std::size_t kMaxViews = BoardGuide::kMaxViews, kMaxLooks = 240;
constexpr double kLookStep = 0.1;  // time between searched frames if their number is unknown [s]
constexpr double kSameView = 0.01; // views closer than this are redundant [diagonals]
constexpr double kTimeWeight = 0.05;
constexpr double kBlurred = 2; // largest blur relative to sharp views

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
  GreyFrame size; // size only, without pixels
};

// Checks that all pictures have one size, either as shown or as stored.
struct Sizes {
  GreyFrame first; // size only, without pixels
  bool same = true, shown = true, stored = true;

  double diagonal() const { return std::hypot(first.width, first.height); }
  void add(const GreyFrame& size, const std::string& name) {
    if (first.width == 0) first = size;
    const auto isLike = [&](bool across) {
      return size.width == (across ? first.height : first.width) &&
             size.height == (across ? first.width : first.height);
    };
    same = same && size.orientation == first.orientation;
    shown = shown && isLike(false);
    stored = stored && isLike(isTransposed(size.orientation) != isTransposed(first.orientation));
    if (!shown && !stored) throw FileError(name, 0, "is of another size than the views before it");
  }
};

// Fits a camera to the views. Returns true if views of several orientations fit better as pictures
// of a camera that was held in several ways than as they are shown.
bool fitViews(const std::vector<SeenView>& views, const Sizes& sizes, CameraFit& best,
              const std::string& from) {
  best.rms = INFINITY;
  bool held = false;
  for (const bool as_held : {false, true}) {
    if (as_held ? !sizes.stored || sizes.same : !sizes.shown) continue;
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
  std::vector<double> blurs;
  for (const ViewChoice& view : views) blurs.push_back(view.blur);
  const auto tenth = blurs.begin() + static_cast<std::ptrdiff_t>((blurs.size() - 1) / 10);
  std::nth_element(blurs.begin(), tenth, blurs.end());
  const double max_blur = kBlurred * *tenth;
  const double lasts = std::max(1e-9, views.back().t - views.front().t);
  std::vector<double> far(views.size(), INFINITY), unlike = far; // distance to the chosen views
  std::size_t next = 0;
  for (std::size_t i = 1; i < views.size(); ++i)
    if (views[i].blur < views[next].blur) next = i;
  for (bool more = true; more && chosen.size() < most;) {
    chosen.push_back(next);
    const ViewChoice& last = views[next];
    more = false;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const double apart_now = distanceOf(views[i].outline, last.outline) / diagonal;
      unlike[i] = std::min(unlike[i], apart_now);
      far[i] = std::min(far[i], apart_now + kTimeWeight * std::abs(views[i].t - last.t) / lasts);
      if (views[i].blur > max_blur || unlike[i] <= kSameView) continue;
      if (!more || far[i] > far[next]) next = i;
      more = true;
    }
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

CalibratedCamera fitCameraToFrames(FrameSource& frames, const Board& board,
                                   const std::string& board_text, const std::string& from,
                                   Progress& progress, const BoardSeen& seen) {
  CalibratedCamera found;
  std::vector<SeenView> views, rejected; // the latter: live, blurred or like another
  std::vector<ViewChoice> choices;
  BoardGuide guide; // used for a live source
  Sizes sizes;
  TurnedFrames turns;
  std::string fault;
  std::size_t faults = 0;
  const bool pictures = frames.arePictures();
  const std::optional<std::size_t> count = frames.count();
  const std::size_t step = pictures || !count ? 1 : std::max<std::size_t>(1, *count / kMaxLooks);
  std::size_t with_board = 0;
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
    const GreyFrame size{image.width, image.height, {}, image.orientation};
    sizes.add(size, frame->name);
    turns.add(image, frame->name);
    const auto view = boardIn(image, board, !pictures, frame->name);
    const bool is_new = frames.isLive() && addPicture(guide, image, view, board);
    if (frames.isLive())
      progress.report(0.8 * static_cast<double>(guide.seenCells() + guide.seenTilts()) /
                          static_cast<double>(guide.seen.size() + guide.tilted.size()),
                      guide.advice + ", " + formatCount(guide.views.size()) + " views");
    else
      progress.report(count ? 0.8 * static_cast<double>(i) / static_cast<double>(*count) : 0,
                      "views");
    if (seen) seen({i, image, view, guide});
    if (!view) {
      if (found.first_rejected.empty()) found.first_rejected = frame->name;
      found.rejected.push_back(i);
      continue;
    }
    ++with_board;
    if (frames.isLive() && !is_new) {
      if (rejected.size() < kMaxViews) rejected.push_back({*view, size});
      continue;
    }
    views.push_back({*view, size});
    if (guide.complete) break;
    if (!pictures && !frames.isLive())
      choices.push_back({outlineOf(*view, board), blurOf(image, *view, board), frame->t});
  }
  found.notes = frames.notes();
  if (faults > 0)
    found.notes.push_back(formatCount(faults) + " of " + formatCount(found.frames) +
                          " frames cannot be read; the first: " + fault);
  if (frames.isLive() && !guide.complete)
    found.notes.push_back(from + ": ended with " + guide.summary() + "; next was: " + guide.advice);
  if (!choices.empty()) {
    std::vector<SeenView> chosen;
    for (const std::size_t i : chooseViews(choices, sizes.diagonal(), kMaxViews))
      chosen.push_back(std::move(views[i]));
    views = std::move(chosen);
  }
  found.views = views.size();
  found.unlike = with_board - views.size();
  const auto doubtful = [&] {
    return from + ": corners miss by " + formatNumber(std::round(10 * found.fit.rms) / 10) +
           " px, which is no calibration; is it " + board_text +
           " that the pictures show? Look at the number of its squares, their size and the "
           "markers', the family of markers, their layout (from 0 on by rows), and whether it is "
           "flat";
  };
  if (views.size() < 3) {
    // Corners of another board look blurred: a fit tells it from one that is held too still.
    views.insert(views.end(), rejected.begin(), rejected.end());
    if (views.size() >= 3) {
      fitViews(views, sizes, found.fit, from);
      if (found.fit.rms > kWorstRms) {
        found.doubt = doubtful();
        return found;
      }
    }
    throw FileError(from, 0,
                    "the board " + board_text + " is seen in " + formatCount(with_board) + " of " +
                        formatCount(found.frames) + " views" +
                        (found.unlike > 0
                             ? ", of which " + formatCount(found.views) + " are sharp and differ"
                             : "") +
                        "; three at least are needed");
  }
  progress.report(0.8, "camera");
  const bool held = fitViews(views, sizes, found.fit, from);
  if (const std::string line = turns.line(
          nullptr, held ? "the camera was turned between pictures; pixels are those of the first"
                        : "all are used as they are shown");
      !line.empty())
    found.notes.push_back(line);
  if (found.fit.rms > kWorstRms) found.doubt = doubtful();
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

PivotFit calibratePivot(const std::vector<CameraPose>& poses, const std::string& from) {
  const auto fit = fitPivot(poses);
  if (!fit)
    throw FileError(
        from, 0,
        "the poses do not determine the tip: take at least ten, tilted to all sides about a "
        "fixed point");
  const double deviation = std::sqrt(fit->covariance.diagonal().maxCoeff());
  if (deviation > kWorstTip)
    throw FileError(from, 0,
                    "the poses determine the tip only to " + formatLength(deviation) +
                        ": keep it fixed and tilt the probe about it to all sides");
  return *fit;
}

std::string withTip(const std::string& text, const std::string& name, const PivotFit& fit) {
  Json rig = parseJson(text, name);
  if (!rig.isObject()) throw FileError(name, 0, "is no object");
  const Vec3 deviation = fit.covariance.diagonal().cwiseSqrt();
  const auto array = [](const Vec3& v) { return Json(Json::Array{v.x(), v.y(), v.z()}); };
  rig.set("tip", array(fit.tip)).set("tip_deviation", array(deviation));
  return rig.dump() + "\n";
}

} // namespace patina
