#include "app/gui/aligning/fit_words.h"

#include <algorithm>
#include <cmath>

#include <QObject>

#include "app/gui/scanning/scan_path.h"
#include "app/gui/toolkit/words.h"

namespace patina {
namespace {

QString countWords(const Registration& found) {
  const auto count = std::count(found.inliers.begin(), found.inliers.end(), true);
  return QObject::tr("residual rms %1 of %2 inliers, %3 samples rejected")
      .arg(inWords(found.rms))
      .arg(count)
      .arg(static_cast<std::ptrdiff_t>(found.inliers.size()) - count);
}

} // namespace

QString warningText(const Registration& found) {
  if (!found.converged)
    return QObject::tr("No fit from here matches the path: ") + countWords(found);
  if (!isUnreliable(found)) return {};
  return QObject::tr("Not unique: ") + shownText(inWords(*found.alternatives));
}

QString fitWords(const Registration& found) {
  const QString doubt = warningText(found);
  if (!found.converged) return doubt;
  const auto deviation = [&](int from) {
    return std::sqrt(found.covariance.block<3, 3>(from, from).trace() / 3);
  };
  QString words =
      QObject::tr("Fitted: %1; uncertainty (1σ) of the path's points %2, of the pose %3 and %4°")
          .arg(countWords(found), inWords(pathDeviation(found)), inWords(deviation(3)))
          .arg(deviation(0) * 180 / M_PI, 0, 'g', 2);
  if (!doubt.isEmpty()) words += QStringLiteral(". ") + doubt;
  for (const UnobservableMotion& motion : found.free)
    words += QStringLiteral("; ") + shownText(inWords(motion));
  return words;
}

} // namespace patina
