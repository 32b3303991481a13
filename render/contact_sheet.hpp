// A contact sheet: moments of a motion side by side, the scan with its extracted skeleton, and the target;
// and a strip: several performers of it, a row each.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/renderer.hpp"

namespace understudy::render {

/// One column of a sheet. Metres, y up; source and target may stand in different places.
struct SheetMoment {
  int frame = 0;
  double seconds = 0;
  Mesh source;                           ///< the scan, a mesh or a cloud; empty: not shown
  std::optional<SkeletonView> skeleton;  ///< extracted from it
  std::optional<Mesh> target;  ///< the target performing it, a mesh or a cloud; in none: no target rows
};

struct SheetOptions {
  std::string title;
  int width = 1800;   ///< pixels, at most; the height follows from the people shown
  int columns = 6;    ///< moments in a row; more continue below
  float heading = 0;  ///< radians about +y that the person faces, 0 is +z; the sheet looks from there
  bool strays =
      true;  ///< what is far from all joints, a stray or a piece of floor, may lie outside the picture
  std::string source_caption = "Scan, extracted skeleton", target_caption = "Target";
  Vec3 source_color = Vec3(0.66f, 0.71f, 0.76f), target_color = Vec3(0.80f, 0.75f, 0.69f);
};

/// Rows: three-quarter front and side view, each of the source and, where any moment has one, the target. One
/// scale for the whole sheet; each person is centred, the floor is where it is. Throws Error without moments.
Image contact_sheet(Renderer& renderer, const std::vector<SheetMoment>& moments,
                    const SheetOptions& options = {});
/// The same with an offscreen context of its own; no context is current on this thread afterwards.
Image contact_sheet(const std::vector<SheetMoment>& moments, const SheetOptions& options = {});

/// Who is seen at a moment of a strip; neither mesh nor skeleton: nobody, their motion has ended.
struct StripMoment {
  Mesh mesh;  ///< or a cloud
  std::optional<SkeletonView> skeleton;
};

struct StripRow {
  std::string caption;
  std::vector<StripMoment> moments;
  Vec3 color = SheetOptions().target_color;
};

struct StripOptions {
  std::string title;
  int width = 1800, columns = 12;  ///< as of a sheet
  float yaw = 0;                   ///< radians, where it looks from: Camera's
};

/// A row for each performer, a column for each time; at one time alone a column for each performer. Scale and
/// places as in a sheet. Throws Error where a row has not a moment for each time, and where nobody is seen.
Image strip(Renderer& renderer, const std::vector<StripRow>& rows, const std::vector<double>& seconds,
            const StripOptions& options = {});
/// The same with an offscreen context of its own.
Image strip(const std::vector<StripRow>& rows, const std::vector<double>& seconds,
            const StripOptions& options = {});

/// Pictures that are there already, all of one width and in a row of one height.
struct PictureRow {
  std::string caption;
  std::vector<Image> pictures;
};

/// A row each below `headers`, one a column; no more columns than options.columns, more go on below.
/// Throws Error where a row has not a picture for each header, and without a row.
Image picture_sheet(const std::vector<PictureRow>& rows, const std::vector<std::string>& headers,
                    const StripOptions& options = {});
/// How wide they are in a sheet of so many columns, pixels.
int picture_width(const StripOptions& options, int columns);

}  // namespace understudy::render
