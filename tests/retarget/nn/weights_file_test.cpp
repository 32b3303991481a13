#include "retarget/nn/weights_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "retarget/base/error.hpp"

namespace understudy::nn {
namespace {

namespace fs = std::filesystem;

std::string path_for(const std::string& name) {
  return (fs::temp_directory_path() / ("understudy_" + name + std::to_string(getpid()))).string();
}

std::string whole(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

TEST(WeightsFile, ComesBackAsItWasWritten) {
  torch::nn::Linear written(5, 3), read(5, 3);
  const std::string path = path_for("weights");
  save_weights(path, {"test", 2, {{"samples", 7}}}, *written, /*half=*/false);
  EXPECT_EQ(load_weights(path, "test", 2, *read).numbers.at("samples"), 7);
  EXPECT_TRUE(torch::equal(written->weight, read->weight));
  fs::remove(path);
}

TEST(WeightsFile, RefusesAnotherKindVersionOrShape) {
  torch::nn::Linear small(5, 3), large(6, 3);
  const std::string path = path_for("refused");
  save_weights(path, {"test", 2, {}}, *small);
  EXPECT_THROW(load_weights(path, "other", 2, *small), Error);
  EXPECT_THROW(load_weights(path, "test", 3, *small), Error);
  EXPECT_THROW(load_weights(path, "test", 2, *large), Error);
  fs::remove(path);
}

TEST(WeightsFile, LaterPartsMayBeMissingAndStayAsTheyAre) {
  using torch::nn::Linear, torch::nn::Sequential;
  Sequential before(Linear(3, 3)), after(Linear(3, 3), Linear(3, 1));
  const std::string path = path_for("later");
  const auto begins_with = [](char part) {
    return [part](const std::string& name) { return name[0] == part; };
  };
  save_weights(path, {"test", 2, {}}, *before, /*half=*/false);
  EXPECT_THROW(load_weights(path, "test", 2, *after), Error);
  EXPECT_THROW(load_weights(path, "test", 2, *after, begins_with('2')), Error);
  const auto own = after->parameters()[2].clone();
  const WeightsHeader header = load_weights(path, "test", 2, *after, begins_with('1'));
  EXPECT_EQ(header.lacking, (std::vector<std::string>{"1.weight", "1.bias"}));
  EXPECT_TRUE(torch::equal(after->parameters()[0], before->parameters()[0]));
  EXPECT_TRUE(torch::equal(after->parameters()[2], own));
  save_weights(path, {"test", 2, {}}, *after, /*half=*/false);
  EXPECT_TRUE(load_weights(path, "test", 2, *after, begins_with('1')).lacking.empty());
  fs::remove(path);
}

TEST(WeightsFile, CutAnywhereIsAnErrorThatNamesTheFile) {
  torch::nn::Linear net(5, 3);
  const std::string path = path_for("cut");
  save_weights(path, {"test", 2, {}}, *net);
  const std::string bytes = whole(path);
  for (size_t length = 0; length < bytes.size(); length += 5) {
    std::ofstream(path, std::ios::binary) << bytes.substr(0, length);
    try {
      load_weights(path, "test", 2, *net);
      ADD_FAILURE() << "loaded " << length << " of " << bytes.size() << " bytes";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    }
  }
  fs::remove(path);
}

TEST(WeightsFile, DescriptionsOfAnotherFormAreErrorsThatNameTheFile) {
  torch::nn::Linear net(2, 2);
  const std::string path = path_for("form");
  for (
      const std::string text :
      {R"({"kind":3,"tensors":{}})", R"({"kind":"test","version":2,"tensors":[1]})",
       R"({"kind":"test","version":2,"tensors":{"weight":{"shape":[2,2],"half":"no","offset":0}}})",
       R"({"kind":"test","version":2,"tensors":{"weight":{"shape":[2147483647,2147483647,8],"half":true,"offset":0}}})",
       R"({"kind":"test","version":2,"tensors":{"weight":{"shape":[2,2],"half":true,"offset":-8}}})"}) {
    const auto length = static_cast<uint32_t>(text.size());
    std::string bytes = "USWEIGHT" + std::string(reinterpret_cast<const char*>(&length), 4);
    std::ofstream(path, std::ios::binary) << bytes + text + std::string(64, '\0');
    try {
      load_weights(path, "test", 2, *net);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    }
  }
  fs::remove(path);
}

}  // namespace
}  // namespace understudy::nn
