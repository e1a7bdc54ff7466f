#include "app/gui/aligning/fit_words.h"

#include <algorithm>
#include <cmath>

#include <QObject>

#include "app/gui/scanning/scan_path.h"
#include "app/gui/widgets/words.h"

namespace patina {

QString fitWords(const Registration& found) {
  if (!found.converged) return QObject::tr("No fit explains the path from here");
  const auto count = std::count(found.counts.begin(), found.counts.end(), true);
  const auto left_out = static_cast<std::ptrdiff_t>(found.counts.size()) - count;
  const auto deviation = [&](int from) {
    return std::sqrt(found.covariance.block<3, 3>(from, from).trace() / 3);
  };
  QString words = QObject::tr("Fitted: rms %1 of the %2 samples that count, %3 left out; place "
                              "known to %4 and %5°")
                      .arg(inWords(found.rms))
                      .arg(count)
                      .arg(left_out)
                      .arg(inWords(deviation(3)))
                      .arg(deviation(0) * 180 / M_PI, 0, 'g', 2);
  if (isDoubtful(found))
    words += QObject::tr("; not unique: ") + QString::fromStdString(inWords(*found.rivals));
  for (const FreeMotion& motion : found.free)
    words += QStringLiteral("; ") + QString::fromStdString(inWords(motion));
  return words;
}

} // namespace patina
