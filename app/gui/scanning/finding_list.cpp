#include "app/gui/scanning/finding_list.h"

#include <QSignalBlocker>

#include "app/gui/window/theme.h"

namespace patina {

FindingList::FindingList(OpenScan& scan, QWidget* parent) : QListWidget(parent), scan_(scan) {
  setObjectName(QStringLiteral("findings"));
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setTextElideMode(Qt::ElideRight);
  setUniformItemSizes(true);
  dress(*this, QStringLiteral("QListWidget { border: none; background: @card; }"
                              "QListWidget::item { padding: 2px 6px; }"
                              "QListWidget::item:selected { background: @chosen; color: @text; }"));
  setToolTip(tr("What is missing or was left out, and why; a click goes there"));
  connect(this, &QListWidget::currentRowChanged, this, [this](int row) {
    if (row < 0 || scan_.path() == nullptr) return;
    const auto& findings = scan_.path()->findings;
    if (row >= static_cast<int>(findings.size())) return; // that nothing is missing
    const Finding& finding = findings[static_cast<std::size_t>(row)];
    // Gaps begin and end at poses that are there: what is missing is between them.
    const bool lasts = finding.kind == Finding::Kind::gap || finding.kind == Finding::Kind::dropout;
    scan_.cursor().set(lasts ? (finding.from + finding.to) / 2 : finding.from);
  });
  connect(&scan_, &OpenScan::opened, this, &FindingList::fill);
  connect(&scan_, &OpenScan::pathMade, this, &FindingList::fill);
  connect(&scan_.cursor(), &ScanCursor::moved, this, &FindingList::follow);
}

void FindingList::fill() {
  const QSignalBlocker quiet(this);
  clear();
  if (scan_.path() == nullptr) return;
  for (const Finding& finding : scan_.path()->findings) {
    auto* item = new QListWidgetItem(QStringLiteral("%1 s   %2   %3")
                                         .arg(finding.from, 7, 'f', 3)
                                         .arg(wordOf(finding.kind), finding.words),
                                     this);
    item->setToolTip(finding.words);
  }
  if (count() == 0)
    addItem(scan_.path()->poses.empty() ? tr("There are no poses yet.")
                                        : tr("Every frame has a pose, and the path has no gap."));
  follow();
}

void FindingList::follow() {
  const QSignalBlocker quiet(this);
  const Finding* finding = scan_.cursor().finding();
  setCurrentRow(finding == nullptr ? -1
                                   : static_cast<int>(finding - scan_.path()->findings.data()));
}

} // namespace patina
