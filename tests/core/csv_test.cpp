#include "core/csv.h"

#include "core/error.h"
#include "core/file.h"

namespace patina {
namespace {

const std::vector<std::string> kTip{"t [s]", "x [m]", "y [m]", "z [m]"};

std::string csvError(const std::string& text) {
  try {
    parseCsv(text, "tip.csv", kTip);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(Csv, ReadsHeaderAndRows) {
  const CsvTable table =
      parseCsv("t [s],x [m],y [m],z [m],force [N]\r\n0,1,2,3,4\r\n\r\n1e-3, -1,.5,0,nan\r\n",
               "tip.csv", kTip);
  EXPECT_EQ(table.columns.size(), 5u);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[1][2], 0.5);
}

TEST(Csv, AcceptsAByteOrderMarkAndNoLastNewline) {
  EXPECT_EQ(parseCsv("\xEF\xBB\xBFt [s],x [m],y [m],z [m]\n1,2,3,4", "a", kTip).rows.size(), 1u);
}

TEST(Csv, NamesTheLineOfAFault) {
  const std::string header = "t [s],x [m],y [m],z [m]\n0,0,0,0\n";
  EXPECT_EQ(csvError(header + "1,2,3\n"),
            "tip.csv:3: 3 values where the header names 4, separated by commas");
  EXPECT_EQ(csvError(header + "1,2,x,4\n"), "tip.csv:3: y [m]: 'x' is not a number");
  EXPECT_TRUE(csvError("time,x,y,z\n1,2,3,4\n").starts_with("tip.csv:1: header is 'time,x,y,z'"));
  EXPECT_TRUE(csvError("").starts_with("tip.csv: is empty"));
}

TEST(Csv, NamesAColumnThatStandsTwice) {
  try {
    parseCsv("x,x,y\n1,2,3\n", "table.csv", {"x", "y"});
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("the column 'x' stands twice"), std::string::npos)
        << error.what();
  }
  EXPECT_EQ(parseCsv("x,z,z\n1,2,3\n", "table.csv", {"x"}).rows.size(), 1U); // not needed
}

TEST(Csv, NamesADecimalCommaAsSuch) {
  const std::string header = "t [s],x [m],y [m],z [m]\n";
  EXPECT_NE(csvError(header + "0,1,1,5,2,5,3,5\n").find("decimal comma"), std::string::npos);
  EXPECT_NE(csvError(header + "0,1;1,5;2,5;3,5\n").find("decimal comma"), std::string::npos);
  EXPECT_EQ(csvError(header + "0,1,1,2,5,3,5\n"),
            "tip.csv:2: 7 values where the header names 4, separated by commas; none has a point: "
            "are there decimal commas?");
  EXPECT_EQ(csvError(header + "0.1,1,1,2,5\n"),
            "tip.csv:2: 5 values where the header names 4, separated by commas");
}

TEST(Csv, KeepsTheMessageOnOneLineForAnyContent) {
  std::string hostile = "\x01\x02\r\x03";
  hostile.append(5000, 'z');
  const std::string error = csvError(hostile);
  EXPECT_LT(error.size(), 200u);
  for (const char c : error) EXPECT_GE(static_cast<unsigned char>(c), 0x20);
}

TEST(Csv, WrittenNumbersReadBackBitForBit) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  CsvTable table{kTip, {}};
  for (int i = 0; i < 200; ++i)
    table.rows.push_back({normal(random), normal(random) * 1e-200, normal(random) * 1e200, -0.0});
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "patina_csv_test.csv";
  writeCsv(path, table);
  const CsvTable back = readCsv(path, kTip);
  std::filesystem::remove(path);
  EXPECT_EQ(back.rows, table.rows);
  EXPECT_EQ(back.columns, table.columns);
}

// Rows and their numbers must not depend on where the chunks of the file end.
TEST(Csv, ReadsInPiecesOfAnySizeTheSameRowsAndLines) {
  const std::string dos = "\xEF\xBB\xBFt [s],x [m],y [m],z [m]\r\n0,1,2,3\r\n\n4,5,6,7\n8,9,1,2";
  const std::string mac = "t [s],x [m],y [m],z [m]\r0,1,2,3\r\r4,5,6,7\r8,9,1,2\r";
  for (const std::string& text : {dos, mac})
    for (std::size_t piece = 1; piece < text.size() + 2; ++piece) {
      std::string_view rest = text;
      CsvReader reader(
          [&](char* buffer, std::size_t capacity) {
            const std::size_t count = rest.copy(buffer, std::min(piece, capacity));
            rest.remove_prefix(count);
            return count;
          },
          "tip.csv", {kTip});
      std::vector<double> row;
      const std::pair<std::vector<double>, std::size_t> expected[] = {
          {{0, 1, 2, 3}, 2}, {{4, 5, 6, 7}, 4}, {{8, 9, 1, 2}, 5}};
      for (const auto& [values, line] : expected) {
        ASSERT_TRUE(reader.next(row));
        EXPECT_EQ(row, values);
        EXPECT_EQ(reader.line(), line);
      }
      EXPECT_FALSE(reader.next(row));
    }
}

TEST(Csv, EndlessLineIsRejectedBeforeItFillsTheMemory) {
  std::size_t given = 0;
  const auto endless = [&](char* buffer, std::size_t capacity) {
    std::fill_n(buffer, capacity, '1');
    given += capacity;
    return capacity;
  };
  EXPECT_THROW(CsvReader(endless, "tip.csv", {kTip}), FileError);
  EXPECT_LT(given, std::size_t{1} << 22);
}

TEST(Csv, UncommittedFileLeavesNothing) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("patina_csv_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  writeFileAtomically(folder / "t.csv", "before");
  {
    CsvWriter writer(folder / "t.csv", kTip);
    for (int i = 0; i < 100000; ++i) writer.add({1, 2, 3, 4});
    EXPECT_EQ(readFile(folder / "t.csv"), "before");
  }
  EXPECT_EQ(readFile(folder / "t.csv"), "before");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  std::filesystem::remove_all(folder);
}

} // namespace
} // namespace patina
