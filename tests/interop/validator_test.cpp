// Khronos' glTF-Validator finds nothing to say against what we export.
#include <gtest/gtest.h>

#include "tests/interop/exported.hpp"

namespace understudy::tests {
namespace {

std::string first_messages(const nlohmann::json& report) {
  std::string out;
  for (const auto& message : report["messages"])
    if ((message["severity"] == "error" || message["severity"] == "warning") && out.size() < 1000)
      out += message.dump() + "\n";
  return out;
}

TEST(Validator, FindsNoErrorAndNoWarningInAnyExport) {
  std::vector<std::string> paths;
  for (const Exported& exported : all_exported()) paths.push_back(exported.path);
  for (const auto& report : validated(paths)) {
    ASSERT_FALSE(report.contains("failed")) << report.dump();
    EXPECT_EQ(report["errors"], 0) << report["file"] << "\n" << first_messages(report);
    EXPECT_EQ(report["warnings"], 0) << report["file"] << "\n" << first_messages(report);
  }
}

}  // namespace
}  // namespace understudy::tests
