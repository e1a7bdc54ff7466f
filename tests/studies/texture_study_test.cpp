#include "app/studies/framework/studies.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/least_time.h"
#include "support/study_rows.h"

namespace patina {
namespace {

using test::knob;
using test::more;
using test::quickTables;
using test::word;

const WorkPrecisionRow& rowOfForm(const WorkPrecisionTable& table, const std::string& form,
                                  const std::string& column, double value) {
  for (const WorkPrecisionRow& row : table.rows)
    if (word(row, "form") == form && knob(row, column) == value) return row;
  throw std::invalid_argument("no row of " + form);
}

TEST(TextureStudy, EveryRowHasErrorAndTime) {
  ASSERT_EQ(quickTables<textureStudy>().size(), 6u);
  for (const WorkPrecisionTable& table : quickTables<textureStudy>())
    for (const WorkPrecisionRow& row : table.rows) {
      EXPECT_TRUE(row.error > 0 && row.error <= row.error_max) << table.title;
      EXPECT_GT(row.ns, 0) << table.title;
      for (const auto& [name, value] : row.more) EXPECT_TRUE(std::isfinite(value)) << name;
    }
}

// T-A18
TEST(TextureStudy, HarmonicsConvergeWithTheSmoothnessOfTheProfile) {
  const std::vector<WorkPrecisionTable>& tables = quickTables<textureStudy>();
  EXPECT_NEAR(*tables[0].order_fitted, -0.5, 0.05);
  EXPECT_NEAR(*tables[1].order_fitted, -2.5, 0.15);
  EXPECT_NEAR(*tables[2].order_fitted, -1.5, 0.4); // corners among waves
  for (std::size_t i = 0; i < 2; ++i)
    for (const WorkPrecisionRow& row : tables[i].rows)
      EXPECT_NEAR(more(row, "of closed form"), 1, 0.05) << tables[i].title;
}

TEST(TextureStudy, WideBlendDistortsMoreThanItCloses) {
  const std::vector<WorkPrecisionRow>& rows = quickTables<textureStudy>()[3].rows;
  for (std::size_t i = 2; i < rows.size(); ++i) EXPECT_GT(rows[i].error, rows[i - 1].error);
  for (const WorkPrecisionRow& row : rows)
    EXPECT_NEAR(more(row, "of the first 80 %"), more(rows[1], "of the first 80 %"), 0.01);
}

// T-A19d
TEST(TextureStudy, ExactPhaseIsAccurateAfterABillionPeriods) {
  const WorkPrecisionTable& table = quickTables<textureStudy>()[4];
  for (const double periods : {1., 1e6, 1e9}) {
    for (const char* form : {"direct", "table 1e-12"})
      EXPECT_LT(rowOfForm(table, form, "periods", periods).error_max, 1e-12) << periods;
  }
}

TEST(TextureStudy, GridHasTheRequestedPrecision) {
  const WorkPrecisionTable& table = quickTables<textureStudy>()[5];
  for (const double n : {16., 32., 64., 128.}) {
    for (const char* form : {"direct", "products, table 1e-12", "window 1e-12"})
      EXPECT_LT(rowOfForm(table, form, "N", n).error_max, 1e-12) << form << " " << n;
  }
}

// Ratios within one run; measured 0.014 and 0.009.
PATINA_TIMED_TEST(TextureStudy, TablesAreFarQuickerThanSums) {
  const WorkPrecisionTable &line = quickTables<textureStudy>()[4],
                           &plane = quickTables<textureStudy>()[5];
  const double direct = rowOfForm(line, "direct", "periods", 1).ns;
  EXPECT_LT(rowOfForm(line, "table 1e-12", "periods", 1).ns, 0.05 * direct);
  const double sum = rowOfForm(plane, "direct", "N", 128).ns;
  EXPECT_LT(rowOfForm(plane, "window 1e-12", "N", 128).ns, 0.04 * sum);
  // The window is as wide for many harmonics as for few.
  EXPECT_LT(rowOfForm(plane, "window 1e-12", "N", 128).ns,
            3 * rowOfForm(plane, "window 1e-12", "N", 16).ns);
}

} // namespace
} // namespace patina
