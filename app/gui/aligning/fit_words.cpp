#include "app/gui/aligning/fit_words.h"

#include <algorithm>
#include <cmath>

#include <QObject>

#include "app/gui/scanning/scan_path.h"
#include "app/gui/widgets/words.h"

namespace patina {
namespace {

QString countWords(const Registration& found) {
  const auto count = std::count(found.counts.begin(), found.counts.end(), true);
  return QObject::tr("residual rms %1 of the %2 samples that count, %3 left out")
      .arg(inWords(found.rms))
      .arg(count)
      .arg(static_cast<std::ptrdiff_t>(found.counts.size()) - count);
}

} // namespace

QString doubtWords(const Registration& found) {
  if (!found.converged)
    return QObject::tr("No fit explains the path from here: ") + countWords(found);
  if (!isDoubtful(found)) return {};
  return QObject::tr("Not unique: ") + QString::fromStdString(inWords(*found.rivals));
}

QString fitWords(const Registration& found) {
  const QString doubt = doubtWords(found);
  if (!found.converged) return doubt;
  const auto deviation = [&](int from) {
    return std::sqrt(found.covariance.block<3, 3>(from, from).trace() / 3);
  };
  QString words = QObject::tr("Fitted: %1; uncertainty of the place (1σ) %2 and %3°")
                      .arg(countWords(found), inWords(deviation(3)))
                      .arg(deviation(0) * 180 / M_PI, 0, 'g', 2);
  if (!doubt.isEmpty()) words += QStringLiteral(". ") + doubt;
  for (const FreeMotion& motion : found.free)
    words += QStringLiteral("; ") + QString::fromStdString(inWords(motion));
  return words;
}

} // namespace patina
