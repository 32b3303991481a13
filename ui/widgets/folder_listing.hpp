// Lists a folder in a thread of its own, so that the interface never waits for a disk.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace understudy::ui {

struct FolderEntry {
  std::string name;
  bool is_folder = false;
  uint64_t bytes = 0;     ///< of a file
  int64_t changed_s = 0;  ///< seconds since 1970; 0: not known
  int frames = 0;  ///< a folder: how many scan frames of one format lie in it (counting stops at 10,000)
  int poses = 0;   ///< a folder of 2D poses: how many JSON files lie in it; counted where there are no scans
  bool is_case = false;  ///< a folder with a case.json
};

/// One look at a folder: folders first, then files, each in natural order, without hidden ones.
struct FolderContents {
  std::vector<FolderEntry> entries;
  bool finished = false;
  int frames = 0, poses = 0;  ///< as in FolderEntry, of the folder itself; known when all entries are
  bool is_case = false;       ///< it has a case.json
  std::string problem;        ///< why it cannot be listed, one sentence; empty when it can
};

/// Lists one folder in the background. Made and asked from one thread; never blocks it. What was found stays
/// sorted and grows until finished; the frames of folders are counted last.
class FolderListing {
 public:
  explicit FolderListing(const std::string& folder);
  ~FolderListing();  ///< detaches the thread, which then stops by itself
  FolderListing(const FolderListing&) = delete;
  FolderListing& operator=(const FolderListing&) = delete;

  /// The newest; never null, another pointer after each change.
  std::shared_ptr<const FolderContents> contents() const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

/// "512 B", "3.4 MB".
std::string file_size(uint64_t bytes);

}  // namespace understudy::ui
