// A small study of stand-ins for networks, with all its files.
#pragma once

#include <map>
#include <string>

#include "app/stimuli/stimuli.hpp"
#include "tests/session/studio_fixture.hpp"

namespace understudy::app {

/// Two methods and a file on one target in two motions of a dance, 160 x 90, 13 frames a clip.
class SmallStudy : public StudioTest {
 protected:
  void SetUp() override;
  /// Into that folder of the test's own.
  StimuliReport make(const std::string& folder, bool separate = false);
  /// The bytes of every file in such a folder by its path in it, made.json apart.
  std::map<std::string, std::string> files_in(const std::string& folder) const;

  /// The dance as scans, with a point that far from the person in each.
  void write_dance(const std::string& file, const Vec3& stray) const;

  Study study_;
  std::function<void(const std::string& what, int64_t done, int64_t total)> progress_;
};

}  // namespace understudy::app
