// The window for choosing files and folders.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ui/gui/ui.hpp"
#include "ui/widgets/folder_listing.hpp"
#include "ui/widgets/icons.hpp"

namespace understudy::ui {

/// Which files are shown, and whether a folder itself may be the answer.
struct FileFilter {
  std::string label;
  std::vector<std::string> suffixes;  ///< lower case, with the dot; none: every file
  bool folders = false;               ///< one of scan frames or of 2D poses, or a case, may be chosen
  bool any_folder = false;            ///< the folder that is shown may be chosen, whatever is in it
  bool passes(const std::string& name) const;
};
/// Source: all that moves. BodyMotion: what an SMPL-format body performs. Times: when scans were taken, or
/// markers. Known: all that opens.
enum class FileKind {
  Source,
  Target,
  BodyMotion,
  Times,
  Document,
  Study,
  Answers,
  Known,
  Any,
  Folder,
  Poses
};
FileFilter filter_of(FileKind kind);

struct Place {
  std::string label, path;
  Icon icon = Icon::Folder;
};

/// What the pane on the right shows about the selected file.
struct FilePreview {
  ImTextureID texture = nullptr;
  float width = 0, height = 0;  ///< of the texture
  std::string text;
};

struct BrowseRequest {
  std::string title = "Open";
  std::string accept = "Open";      ///< on the button
  bool save = false;                ///< asks for a name, and before it replaces a file
  std::vector<FileFilter> filters;  ///< the first is chosen; none: every file
  std::string folder;               ///< where to start; empty: where it was last, or the home folder
  std::string name;                 ///< when saving: the name suggested
};

/// One at a time. Keys: arrows, PageUp and PageDown, Home and End; Enter opens; Backspace goes up; Right
/// looks into a folder that Enter would choose; letters find; / and ~ begin a path, Ctrl+L edits the one
/// shown; Escape closes. Marks: browser.path, .up, .crumb.N, .place.LABEL, .entry.NAME, .look.NAME, .name,
/// .filter, .new_folder, .folder_name, .create, .accept, .cancel, .overwrite.yes.
class FileBrowser {
 public:
  std::vector<Place> places;  ///< below home, documents and root: samples, recent folders
  std::function<FilePreview(const std::string& path)> preview;  ///< asked every frame; must not wait

  void open(BrowseRequest request);
  bool is_open() const { return open_; }
  const std::string& folder() const { return folder_; }
  /// Call once a frame, outside any window. The path chosen, in the frame in which it is.
  std::optional<std::string> draw(Ui& ui);

 private:
  void go_to(const std::string& folder, const std::string& selected = "");
  void go_up();
  void refresh();
  const FileFilter& filter() const;
  bool can_choose(const FolderEntry& entry) const;
  bool can_choose_folder() const;
  std::string path_of(const FolderEntry& entry) const;
  int selected_row() const;
  const FolderEntry* selected() const;
  void select(int row);

  void draw_header(Ui& ui);
  void draw_path(Ui& ui);
  void draw_crumbs(Ui& ui);
  void draw_places(Ui& ui);
  void draw_new_folder(Ui& ui);
  void draw_list(Ui& ui);
  void draw_entry(Ui& ui, int row);
  void draw_preview(Ui& ui);
  void draw_footer(Ui& ui);
  void draw_overwrite(Ui& ui);
  void take_keys(Focus& focus);
  void begin_typed_path(Focus& focus);
  std::string typed_path() const;
  void find_typed();
  void activate(const FolderEntry& entry);
  void accept();
  void finish(const std::string& path);

  BrowseRequest request_;
  bool open_ = false, editing_path_ = false, naming_folder_ = false, scroll_to_selected_ = false;
  bool path_begun_ = false;  ///< by a key: what is typed goes behind it
  ImGuiID path_id_ = 0;
  int filter_ = 0;
  std::string folder_, typed_path_, name_, new_folder_, problem_, overwrite_, wanted_, left_;
  std::unique_ptr<FolderListing> listing_;
  std::shared_ptr<const FolderContents> contents_;
  std::vector<int> rows_;  ///< entries that the filter lets through
  int rows_of_filter_ = -1;
  std::string selected_name_, found_;
  double found_at_ = 0;
  std::optional<std::string> chosen_;
};

}  // namespace understudy::ui
