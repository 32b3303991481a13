#include "app/study/analysis_page.hpp"

#include <gtest/gtest.h>

#include <map>

namespace understudy::app {
namespace {

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(BoxPlot, HasABoxForEachLevel) {
  EffectReport effect;
  effect.name = "method";
  effect.summaries = {{"<ours>", 5, 4, 6, 5, 1, 7, 2, 7, 20}, {"TST", 3, 3, 4, 3.2, 2, 5, 2, 5, 20}};
  const std::string svg = box_plot("motion & shape", effect);
  EXPECT_EQ(count(svg, "<rect"), 2);
  EXPECT_EQ(count(svg, "<circle"), 1);  // 1 lies below the whisker of the first
  EXPECT_EQ(count(svg, "&lt;ours&gt;"), 1);
  EXPECT_EQ(count(svg, "motion &amp; shape"), 1);
  // The scale from 1 to 7 is 240 pixels high from 40: the first box goes from 6 to 4, its median is 5.
  EXPECT_EQ(count(svg, "y=\"80.0\" width=\"44.0\" height=\"80.0\""), 1) << svg;
  EXPECT_EQ(count(svg, "y1=\"120.0\" x2=\"126.0\" y2=\"120.0\" stroke=\"#112\""), 1) << svg;
}

TEST(StudyPage, ShowsQuestionsTestsAndWhoIsExcluded) {
  AnalysisOptions options;
  options.study = "a & b";
  options.factors = {"method", "motion"};
  options.attention = {AttentionCheck{"action", "", "motion"}};
  const std::string folder = US_SOURCE_DIR "/tests/data/study/exclusions";
  std::map<std::string, std::string> files;
  for (auto& [name, text] : page_files(analyse(read_answers(folder), options))) files[name] = text;
  const std::string& page = files["index.html"];
  EXPECT_EQ(count(page, "<svg"), 2);
  EXPECT_EQ(count(page, "Results: a &amp; b"), 2);  // title and heading
  EXPECT_EQ(count(page, "<td>E07 (excluded)</td><td>18</td>"), 1) << page;
  EXPECT_EQ(count(page, "href=\"medians.csv\""), 1);
  EXPECT_EQ(count(page, "11 of 14 participants are analysed"), 1);
  EXPECT_EQ(count(page, "E07 is excluded: has 8 of 9 answers to &quot;shape&quot;"), 1);
  EXPECT_EQ(count(page, "<td>method</td><td>F(2, 20)</td><td>14.29</td><td>0.0001</td>"), 1) << page;
  EXPECT_EQ(count(page, "<td>method</td><td>H4D</td><td>ours</td><td>-5.23</td><td>0.0001</td>"), 1) << page;
  for (const char* name : {"boxes_1_1.svg", "boxes_1_2.svg", "anova.csv", "participants.csv"})
    EXPECT_FALSE(files[name].empty()) << name;
}

}  // namespace
}  // namespace understudy::app
