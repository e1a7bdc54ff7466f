// Tables from spreadsheets and other programs.
#include "core/csv.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"

namespace patina {
namespace {

const CsvColumns kTipColumns{{"t [s]", "x [m]", "y [m]", "z [m]"}};
using TableRows = std::vector<std::vector<double>>;

struct ReadTable {
  TableRows rows;
  std::string left_out, not_finite;
};

ReadTable readTable(const std::string& text, const CsvColumns& columns = kTipColumns) {
  CsvReader reader(sourceOfText(text), "a.csv", columns);
  ReadTable out;
  for (std::vector<double> row; reader.next(row);) out.rows.push_back(row);
  out.left_out = reader.leftOut();
  out.not_finite = reader.firstNotFinite();
  return out;
}

std::string tableRefusal(const std::string& text, const CsvColumns& columns = kTipColumns) {
  try {
    readTable(text, columns);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

const TableRows kTableRows = {{0, 1.5, -2.25, 3}, {0.25, 4, 5.125, -6e-3}};

std::string asUtf16(const std::string& text, bool big) {
  std::string bytes = big ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) big ? bytes += {'\0', c} : bytes += {c, '\0'};
  return bytes;
}

TEST(CsvDialects, SameTableIsReadInTheDialectOfEachProgram) {
  const std::string plain = "t [s],x [m],y [m],z [m]\n0,1.5,-2.25,3\n0.25,4,5.125,-6e-3\n";
  const std::string semicolons = "t [s];x [m];y [m];z [m]\n0;1,5;-2,25;3\n0,25;4;5,125;-6e-3\n";
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
    return text;
  };
  const std::string texts[] = {
      plain,
      semicolons,
      replaced(plain, ",", ";"),
      replaced(plain, ",", "\t"),
      replaced(semicolons, ";", "\t"),
      replaced(plain, ",", " , "),
      replaced(plain, "\n", "\r\n"),
      replaced(plain, "\n", "\r"),
      replaced(semicolons, "\n", "\r"),
      plain.substr(0, plain.size() - 1),
      "\xEF\xBB\xBF" + semicolons,
      asUtf16(replaced(semicolons, ";", "\t"), false),
      asUtf16(plain, true),
      "sep=;\r\n" + replaced(semicolons, "\n", "\r\n"),
      "sep=\t\n" + replaced(plain, ",", "\t"),
      "\n\n" + plain + "\n\n",
      "# made by a logger\n#\n" + plain,
      "# " + plain,
      "% made by MATLAB\n%\n" + plain,
      replaced(plain, "\n", "\n% said \"so, twice\n  # and, again\n"),
      replaced(plain, "\n", ",\n"),
      replaced(semicolons, "\n", ";\n") + ";;;;\n",
      "\"t [s]\",\"x [m]\",\"y [m]\",\"z "
      "[m]\"\n0,1.5,-2.25,3\n\"0.25\",\"4\",\"5.125\",\"-6e-3\"\n",
      "\"t [s]\",\"x [m]\",\"y [m]\",\"z "
      "[m]\"\n\"0\",\"1,5\",\"-2,25\",\"3\"\n\"0,25\",4,\"5,125\","
      "-6e-3\n",
      "z [m],t [s],y [m],x [m]\n3,0,-2.25,1.5\n-6e-3,0.25,5.125,4\n",
      "t [ms],x [mm],y [cm],z [um]\n0,1500,-225,3000000\n250,4000,512.5,-6000\n",
      "T (ms);X(mm);Y [ mm ];z  [m]\n0;1500;-2250;3\n250;4000;5125;-0,006\n",
      "t [s],x [\xC2\xB5m],y [\xCE\xBCm],z [\xB5m]\n0,1500000,-2250000,3000000\n"
      "0.25,4000000,5125000,-6000\n",
      "t [us],x [m],y [m],z [m]\n0,+1.5,-2.25,3\n250000,4,5.125,-6E-03\n",
      "t [s],x [m],y [m],z [m],note\n0,1.5,-2.25,3,\"first, of "
      "two\"\n0.25,4,5.125,-6e-3,12.05.2024\n",
      "note,t [s],x [m],y [m],z [m]\n%7,0,1.5,-2.25,3\n% of 4, or more\n#8,0.25,4,5.125,-6e-3\n",
      "note,t [s],x [m],y [m],z [m]\n#7,0,1.5,-2.25,3,\n# of 4\n#8,0.25,4,5.125,-6e-3,\n",
      "t [s],x [m],y [m],z [m],tip\n0,1.5,-2.25,3,5\" ball\n0.25,4,5.125,-6e-3,3\"\n",
      "date;t [s];x [m];y [m];z [m]\n12.05.2024;0;1,5;-2,25;3\n12.05.2024;0,25;4;5,125;-6e-3\n",
  };
  for (const std::string& text : texts) EXPECT_EQ(tableRefusal(text), "") << text;
  for (const std::string& text : texts) EXPECT_EQ(readTable(text).rows, kTableRows) << text;
}

TEST(CsvDialects, MillimetresConvertExactlyLikeTheDecimalNumber) {
  const auto rows = readTable("x [mm]\n52\n0.1\n", {{"x [m]"}}).rows;
  EXPECT_EQ(rows, (TableRows{{0.052}, {0.1 / 1000}}));
}

TEST(CsvDialects, UnitsOfForcesAccelerationsAndAnglesAreConverted) {
  const auto rows =
      readTable(
          "f [mN];a (g);b [mm/s\xC2\xB2];w [deg];c [cm/s^2];v [mm/s];d [mm s^-2]\n"
          "1500;2;9810;180;100;250;1000\n",
          {{"f [N]", "a [m/s^2]", "b [m/s^2]", "w [rad]", "c [m/s^2]", "v [m/s]", "d [m/s^2]"}})
          .rows;
  EXPECT_EQ(rows, (TableRows{{1.5, 2 * 9.80665, 9.81, M_PI, 1, 0.25, 1}}));
}

TEST(CsvDialects, UnreadColumnsAreNamed) {
  EXPECT_EQ(readTable("t [s],x [m],y [m],z [m]\n").left_out, "");
  EXPECT_EQ(readTable("t [s],x [m],u,y [m],z [m]\n").left_out, "a.csv: column left out: u");
  EXPECT_EQ(readTable("t [s],x [mm],x [m],y [m],z [m],b\n").left_out,
            "a.csv: columns left out: x [mm], b");
  EXPECT_EQ(readTable("t [s],x [m],u\n", {{"t [s]"}, {"x [m]"}, {"u"}}).left_out, "");
  EXPECT_EQ(readTable("a,b,c,d,e,f,g,h,i,j,t [s]\n", {{"t [s]"}}).left_out,
            "a.csv: columns left out: a, b, c, d, e, f, g, h and 2 more");
}

TEST(CsvDialects, MissingOptionalColumnIsNaN) {
  const CsvColumns columns{{"x [m]"}, {"sigma [m]", "u"}};
  CsvReader reader(sourceOfText("u,x [m]\n7,1\n"), "a.csv", columns);
  std::vector<double> row;
  ASSERT_TRUE(reader.next(row));
  EXPECT_EQ(row[0], 1);
  EXPECT_TRUE(std::isnan(row[1]));
  EXPECT_EQ(row[2], 7);
  EXPECT_FALSE(reader.has("sigma [m]"));
  EXPECT_TRUE(reader.has("u"));
  EXPECT_EQ(reader.firstNotFinite(), "");
}

TEST(CsvDialects, FirstNonFiniteValueIsNamedWithItsPosition) {
  for (const char* text : {"nan", "NaN", "-nan", "inf", "-Inf", "1.#IND", "-1.#IND", "1.#INF",
                           "1.#QNAN0", "-nan(ind)", "infinity"}) {
    const ReadTable found =
        readTable("t [s],x [m],y [m],z [m]\n0,0,0,0\n1,2,3," + std::string(text) + "\n2,nan,0,0\n");
    EXPECT_EQ(found.rows.size(), 3u);
    EXPECT_FALSE(std::isfinite(found.rows[1][3])) << text;
    EXPECT_EQ(found.not_finite, "line 3: z [m] is '" + std::string(text) + "'");
  }
  const ReadTable german = readTable("x [mm];y [m]\n1,#IND;0\n", {{"x [m]", "y [m]"}});
  EXPECT_EQ(german.not_finite, "line 2: x [mm] is '1,#IND'");
}

TEST(CsvDialects, MissingValuesAreNaN) {
  for (const std::string text : {"NA", "na", "N/A", "null", "NULL", "#N/A", "#DIV/0!", "#NUM!"})
    for (const std::string& cell : {text, " " + text + " ", "\"" + text + "\""}) {
      const ReadTable found =
          readTable("t [s],x [m],y [m],z [m]\n0,1,2,3\n1,2," + cell + ",4\n" + text + ",2,3,4\n");
      ASSERT_EQ(found.rows.size(), 3u) << text;
      EXPECT_TRUE(std::isnan(found.rows[1][2]) && std::isnan(found.rows[2][0])) << text;
      EXPECT_EQ(found.rows[1][3], 4);
      EXPECT_EQ(found.not_finite, "line 3: y [m] is '" + text + "'");
    }
  for (const std::string row : {"0,,2,3", "0, ,2,3", "0,\"\",2,3", "0,,2,3,"}) {
    const ReadTable found = readTable("t [s],x [m],y [m],z [m]\n" + row + "\n");
    ASSERT_EQ(found.rows.size(), 1u) << row;
    EXPECT_TRUE(std::isnan(found.rows[0][1])) << row;
    EXPECT_EQ(found.not_finite, "line 2: x [m] is empty") << row;
  }
  EXPECT_EQ(readTable("t [s];x [m];y [m];z [m]\n0;1,5;2;\n").not_finite, "line 2: z [m] is empty");
}

TEST(CsvDialects, FaultsAreNamed) {
  const auto says = [](const std::string& text, const std::string& cause,
                       const CsvColumns& columns = kTipColumns) {
    const std::string found = tableRefusal(text, columns);
    EXPECT_NE(found.find(cause), std::string::npos) << text << "\n" << found << "\n" << cause;
  };
  says("t [s],x [m],z [m]\n",
       "a.csv:1: header is 't [s],x [m],z [m]', separated by commas: it lacks "
       "'y [m]' of 't [s],x [m],y [m],z [m]'");
  says("t [s] x [m] y [m] z [m]\n", "or a comma, semicolon or tab between columns");
  says("t [s]|x [m]|y [m]|z [m]\n", "or a comma, semicolon or tab between columns");
  says("t [s];x [furlong];y [m];z [m]\n",
       "separated by semicolons: column 'x [furlong]' is not in a known unit: write 'x [m]' or one "
       "of m, km, dm, cm, mm, um, nm, in, ft");
  says("t [mm],x [m],y [m],z [m]\n", "column 't [mm]' is not in a known unit: write 't [s]' or one "
                                     "of s, ms, us, ns, min, h");
  says("t\tx\ty\tz\n", "separated by tabs: column 't' has no unit: write 't [s]' or another unit");
  says("t [s],x [mm],x [cm],y [m],z [m]\n", "'x [mm]' and 'x [cm]' are the same column");
  says("sep=|\nt [s]|x [m]\n", "a.csv:1: 'sep=|' is no known separator");
  const std::string head = "t [s];x [m];y [m];z [m]\n";
  says(head + "0;1.234,5;2;3\n",
       "a.csv:2: x [m]: '1.234,5' is not a number: write one decimal sign");
  says(head + "0;1,234,567;2;3\n", "a.csv:2: x [m]: '1,234,567' is not a number");
  says(head + "0;1.5;2;3\n1;1,234;2;3\n",
       "a.csv:3: x [m]: '1,234' has a decimal comma, numbers before it decimal points");
  says(head + "0;1,234;2;3\n1;1.5;2;3\n",
       "a.csv:3: x [m]: '1.5' has a decimal point, numbers before it decimal commas");
  says(head + "0;1,5;abc;3\n", "a.csv:2: y [m]: 'abc' is not a number");
  says(head + "0;1,5;3\n", "a.csv:2: 3 values where the header names 4, separated by semicolons");
  says(head + "0;1,5;3;4;5\n", "a.csv:2: 5 values where the header names 4");
  says("t [s],x [m],y [m],z [m]\n0,\"1,5\",2,x\n", "a.csv:2: z [m]: 'x' is not a number");
  says("note,t [s],x [m],y [m],z [m]\n#8,0.25,4\n", "a.csv:2: 3 values where the header names 5");
  const std::string open_quote = ": a quoted cell does not end in this line: remove the line break";
  says("\"t\n[s]\",x [m],y [m],z [m]\n0,1,2,3\n", "a.csv:1" + open_quote);
  says(head + "0;1;2;3\n0;1;2;\"3\n\"\n", "a.csv:3" + open_quote);
  says("t [s],x [m],y [m],z [m],note\n0,1,2,3,\"first,\nsecond\"\n", "a.csv:2" + open_quote);
  says(head + "0;NAN0;2;3\n", "a.csv:2: x [m]: 'NAN0' is not a number");
  says("", "a.csv: is empty: its first line must be 't [s],x [m],y [m],z [m]'");
  says("# nothing\n\n", "a.csv: is empty");
  says("0,1,2,3\n1,2,3,4\n", "a.csv:1: header is '0,1,2,3'");
}

} // namespace
} // namespace patina
