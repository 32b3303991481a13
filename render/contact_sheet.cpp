#include "render/contact_sheet.hpp"

#include <algorithm>
#include <cmath>

#include "render/colors.hpp"
#include "render/context/context.hpp"
#include "render/text.hpp"
#include "retarget/base/error.hpp"
#include "retarget/base/text.hpp"

namespace understudy::render {
namespace {

constexpr int kWidestCell = 600;  // pixels: a single moment does not become a poster
constexpr int kGap = 6, kMargin = 26, kGutter = 34, kTitle = 58, kHeader = 40, kBandGap = 26;  // pixels
const Vec3 kPaper(0.992f, 0.993f, 0.994f), kInk(0.13f, 0.15f, 0.18f), kFaintInk(0.46f, 0.49f, 0.53f);

struct ViewAngle {
  const char* name;
  float yaw;  // from the person's heading; to the person's right, so that motion goes left to right
};
constexpr ViewAngle kViews[] = {{"front", -0.58f}, {"side", -kPi / 2}};

/// One picture of a sheet before it is drawn.
struct Cell {
  Scene scene;
  Points outline;         ///< what must be seen
  bool left_out = false;  ///< paper in its place
};

/// Finite points of what is shown. With strays those far from all joints are left out: they must not make
/// everyone small.
Points outline(const Points& vertices, const std::optional<SkeletonView>& skeleton, bool strays) {
  constexpr float kReach = 0.35f;  // metres from a joint's box to fingertips, toes and hair
  Eigen::RowVector3f low = Eigen::RowVector3f::Constant(-1e6f), high = Eigen::RowVector3f::Constant(1e6f);
  const bool with_joints = skeleton && skeleton->joints.rows() > 0 && skeleton->joints.allFinite();
  if (with_joints && strays) {
    low = skeleton->joints.colwise().minCoeff().array() - kReach;
    high = skeleton->joints.colwise().maxCoeff().array() + kReach;
  }
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < vertices.rows(); ++i)
    if ((vertices.row(i).array() >= low.array()).all() && (vertices.row(i).array() <= high.array()).all())
      kept.push_back(i);
  const Eigen::Index joints = with_joints ? skeleton->joints.rows() : 0;
  Points points(static_cast<Eigen::Index>(kept.size()) + joints, 3);
  if (with_joints) points.bottomRows(joints) = skeleton->joints;
  for (size_t i = 0; i < kept.size(); ++i) points.row(i) = vertices.row(kept[i]);
  return points;
}

Cell make_cell(const Mesh& mesh, const std::optional<SkeletonView>& skeleton, const Vec3& color,
               bool strays) {
  constexpr float kGround = 2.2f;  // metres: about a person
  Cell cell;
  if (mesh.vertices.rows() > 0) add(cell.scene, mesh);
  for (auto& view : cell.scene.meshes) view.color = color;
  for (auto& view : cell.scene.clouds) view.color = color;
  if (skeleton) cell.scene.skeletons.push_back(*skeleton);
  cell.outline = outline(mesh.vertices, skeleton, strays);
  cell.scene.ground.radius = kGround;
  if (!strays && cell.outline.rows() > 0)
    cell.scene.ground.radius = (cell.outline.colwise().maxCoeff() - cell.outline.colwise().minCoeff()).norm();
  return cell;
}

/// A row of the sheet before it is known how many bands there are: one view of one subject, a cell a moment.
struct Row {
  std::string caption;
  float yaw;
  std::vector<Cell>* cells;
  float height = 0.05f;  ///< metres, of this subject's highest point above its floor
  PixelSize size{};      ///< of its cells
};

struct Layout {
  int width;  // of the sheet
  int columns, bands, band_height, header;
  float scale;  // of letters: 1 at the default width
};

/// Sets each row's height; returns half the width of the widest person, metres.
float measure(std::vector<Row>& rows) {
  float half_width = 0.02f;
  for (Row& row : rows)
    for (const Cell& cell : *row.cells) {
      if (cell.outline.rows() == 0) continue;
      Camera camera;
      camera.yaw = row.yaw;
      const Eigen::VectorXf x = cell.outline * axes(camera).col(0);
      half_width = std::max(half_width, (x.maxCoeff() - x.minCoeff()) / 2);
      row.height = std::max(row.height, cell.outline.col(1).maxCoeff() - cell.scene.ground.height);
    }
  return half_width;
}

/// Looks at the cell's person from the row's side, centred across and in depth, about half way up the
/// highest.
Camera camera_for(const Row& row, const Cell& cell) {
  Camera camera;
  camera.yaw = row.yaw;
  camera.pitch = 0;
  Vec3 center = Vec3::Zero();
  if (cell.outline.rows() > 0) {
    const Mat3 R = axes(camera);
    const Points seen = cell.outline * R;
    center = R * ((seen.colwise().minCoeff() + seen.colwise().maxCoeff()) / 2).transpose();
  }
  camera.target = Vec3(center.x(), cell.scene.ground.height + 0.48f * row.height, center.z());
  camera.pitch = 0.13f;
  // One horizontal lens for all rows: with one distance, one scale.
  camera.fov = 2 * std::atan(0.14f / row.size.aspect());
  return camera;
}

/// The distance from which every person of the sheet is wholly seen, so that all have one scale.
float common_distance(const std::vector<Row>& rows) {
  float distance = 0.1f;
  for (const Row& row : rows)
    for (const Cell& cell : *row.cells)
      distance = std::max(distance,
                          fitting_distance(camera_for(row, cell), cell.outline, row.size.aspect(), 0.035f));
  return distance;
}

Layout lay_out(const SheetOptions& options, size_t moments, std::vector<Row>& rows) {
  Layout layout{};
  layout.columns = std::max(1, std::min(options.columns, static_cast<int>(moments)));
  layout.bands = (static_cast<int>(moments) + layout.columns - 1) / layout.columns;
  const int beside = 2 * kMargin + kGutter + (layout.columns - 1) * kGap;
  const int width = std::min(kWidestCell, (options.width - beside) / layout.columns);
  layout.width = width < kWidestCell ? options.width : beside + layout.columns * width;
  US_CHECK(width >= 24, "a contact sheet of ", options.width, " pixels is too narrow for ", layout.columns,
           " columns");
  layout.scale = std::clamp(static_cast<float>(width) / 285.f, 0.75f, 1.2f);
  layout.header = static_cast<int>(kHeader * layout.scale);
  layout.band_height = layout.header;

  const float half_width = measure(rows);
  float highest = 0;
  for (const Row& row : rows) highest = std::max(highest, row.height);
  const float aspect = std::clamp(2 * half_width / highest, 0.55f, 1.25f);
  for (Row& row : rows) {
    row.size = {width,
                static_cast<int>(static_cast<float>(width) / aspect * std::max(0.4f, row.height / highest))};
    layout.band_height += row.size.height + kGap;
  }
  return layout;
}

Image turned_left(const Image& image) {
  Image turned(image.height, image.width);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) std::copy_n(image.at(x, y), 3, turned.at(y, image.width - 1 - x));
  return turned;
}

/// A row's caption, reading upwards along its left side.
void draw_caption(Image& sheet, const Font& font, const std::string& caption, const Eigen::Vector2i& at,
                  int height) {
  const float room = 0.97f * static_cast<float>(height), full = font.width(caption, 17);
  const float size = full > room ? 17 * room / full : 17;
  const float width = font.width(caption, size);
  Image strip(height, kGutter, kPaper);
  font.draw(strip, caption, {std::max(0.f, (static_cast<float>(height) - width) / 2), 20}, size, kFaintInk);
  paste(sheet, turned_left(strip), at.x(), at.y());
}

/// What stands over a column; either may be empty.
struct Header {
  std::string name, time;
};

/// Smaller where it would be wider than its column.
void draw_header(Image& sheet, const Font& font, const Header& header, const Eigen::Vector2f& at,
                 const Layout& layout, int column_width) {
  float size = 18 * layout.scale, gap = header.name.empty() ? 0 : 10 * layout.scale;
  const float wide = font.width(header.name, size) + gap + font.width(header.time, size);
  const float room = static_cast<float>(column_width) - 4;
  if (wide > room) size *= room / wide, gap *= room / wide;
  font.draw(sheet, header.name, at, size, kInk);
  font.draw(sheet, header.time, {at.x() + font.width(header.name, size) + gap, at.y()}, size, kFaintInk);
}

void draw_disc(Image& image, const Eigen::Vector2f& center, float radius, const Vec3& color) {
  for (int y = static_cast<int>(center.y() - radius) - 1; y <= static_cast<int>(center.y() + radius) + 1; ++y)
    for (int x = static_cast<int>(center.x() - radius) - 1; x <= static_cast<int>(center.x() + radius) + 1;
         ++x) {
      if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
      const float distance = (Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) - center).norm();
      const float cover = std::clamp(radius - distance + 0.5f, 0.f, 1.f);
      uint8_t* pixel = image.at(x, y);
      for (int c = 0; c < 3; ++c)
        pixel[c] =
            static_cast<uint8_t>((1 - cover) * static_cast<float>(pixel[c]) + cover * 255 * color[c] + 0.5f);
    }
}

/// Title on the left; on the right which colour is which side, unless bones have none.
void draw_title(Image& sheet, const Font& font, const std::string& title, bool sides) {
  const float base = kMargin + 20;
  font.draw(sheet, title, {static_cast<float>(kMargin + kGutter), base}, 25, kInk);
  if (!font.found() || !sides) return;
  float x = static_cast<float>(sheet.width - kMargin);
  for (const auto& [word, color] : {std::pair{"right", kRightColor}, std::pair{"left", kLeftColor}}) {
    x -= font.width(word, 17);
    font.draw(sheet, word, {x, base}, 17, kFaintInk);
    draw_disc(sheet, {x - 13, base - 6}, 6, color);
    x -= 42;
  }
}

bool have_sides(const std::vector<SheetMoment>& moments) {
  const auto sided = [](const SheetMoment& m) { return !m.skeleton || !m.skeleton->sides.empty(); };
  return std::all_of(moments.begin(), moments.end(), sided);
}

std::vector<Cell> source_cells(const std::vector<SheetMoment>& moments, const SheetOptions& options) {
  std::vector<Cell> cells;
  const auto shown = [](const SheetMoment& m) { return m.source.vertices.rows() > 0 || m.skeleton; };
  if (std::none_of(moments.begin(), moments.end(), shown)) return cells;
  for (const SheetMoment& m : moments)
    cells.push_back(make_cell(m.source, m.skeleton, options.source_color, options.strays));
  return cells;
}

std::vector<Cell> target_cells(const std::vector<SheetMoment>& moments, const SheetOptions& options) {
  std::vector<Cell> cells;
  if (std::none_of(moments.begin(), moments.end(), [](const SheetMoment& m) { return m.target.has_value(); }))
    return cells;
  for (const SheetMoment& m : moments)
    cells.push_back(make_cell(m.target.value_or(Mesh{}), std::nullopt, options.target_color, options.strays));
  return cells;
}

std::vector<Row> rows_of(std::vector<Cell>& sources, std::vector<Cell>& targets,
                         const SheetOptions& options) {
  std::vector<Row> rows;
  for (const ViewAngle& view : kViews) {
    const float yaw = options.heading + view.yaw;
    if (!sources.empty()) rows.push_back({options.source_caption + " \xC2\xB7 " + view.name, yaw, &sources});
    if (!targets.empty()) rows.push_back({options.target_caption + " \xC2\xB7 " + view.name, yaw, &targets});
  }
  return rows;
}

std::string time_text(double seconds) {
  return printed("%.2f s", seconds);
}

/// Rows and columns, wherever they came from. sides: the title tells left from right.
Image draw(Renderer& renderer, std::vector<Row> rows, const std::vector<Header>& headers,
           const SheetOptions& options, bool sides) {
  const Layout layout = lay_out(options, headers.size(), rows);
  const float distance = common_distance(rows);
  const Font font = Font::system();
  const int band = layout.band_height + kBandGap;
  const int top = options.title.empty() && !sides ? kMargin - layout.header / 2 : kTitle;
  Image sheet(layout.width, top + layout.bands * band - kBandGap + kMargin - kGap, kPaper);
  draw_title(sheet, font, options.title, sides);
  for (size_t i = 0; i < headers.size(); ++i) {
    const int column = static_cast<int>(i) % layout.columns;
    const int x = kMargin + kGutter + column * (rows[0].size.width + kGap);
    int y = top + static_cast<int>(i) / layout.columns * band + layout.header;
    draw_header(sheet, font, headers[i], {x + 2, y - layout.header * 0.32f}, layout, rows[0].size.width);
    for (const Row& row : rows) {
      const Cell& cell = (*row.cells)[i];
      Camera camera = camera_for(row, cell);
      camera.distance = distance;
      if (!cell.left_out) paste(sheet, renderer.render_image(cell.scene, camera, row.size), x, y);
      if (column == 0) draw_caption(sheet, font, row.caption, {kMargin - 4, y}, row.size.height);
      y += row.size.height + kGap;
    }
  }
  return sheet;
}

}  // namespace

Image contact_sheet(Renderer& renderer, const std::vector<SheetMoment>& moments,
                    const SheetOptions& options) {
  US_CHECK(!moments.empty(), "a contact sheet needs at least one moment");
  std::vector<Cell> sources = source_cells(moments, options), targets = target_cells(moments, options);
  std::vector<Row> rows = rows_of(sources, targets, options);
  US_CHECK(!rows.empty(), "a contact sheet needs a scan, joints or a target to show");
  std::vector<Header> headers;
  headers.reserve(moments.size());
  for (const SheetMoment& moment : moments)
    headers.push_back({"Frame " + std::to_string(moment.frame), time_text(moment.seconds)});
  return draw(renderer, std::move(rows), headers, options, have_sides(moments));
}

Image contact_sheet(const std::vector<SheetMoment>& moments, const SheetOptions& options) {
  const auto context = make_offscreen_context();
  Renderer renderer;
  return contact_sheet(renderer, moments, options);
}

Image strip(Renderer& renderer, const std::vector<StripRow>& performers, const std::vector<double>& seconds,
            const StripOptions& options) {
  const bool side_by_side = seconds.size() == 1;
  std::vector<std::vector<Cell>> cells(side_by_side ? 1 : performers.size());
  std::vector<Header> headers;
  bool anybody = false, sides = false;
  for (size_t p = 0; p < performers.size(); ++p) {
    US_CHECK(performers[p].moments.size() == seconds.size(), performers[p].caption, ": has ",
             performers[p].moments.size(), " moments, the strip ", seconds.size());
    for (const StripMoment& m : performers[p].moments) {
      Cell cell = make_cell(m.mesh, m.skeleton, performers[p].color, /*strays=*/true);
      cell.left_out = m.mesh.vertices.rows() == 0 && !m.skeleton;
      anybody = anybody || !cell.left_out;
      sides = sides || (m.skeleton && !m.skeleton->sides.empty());
      cells[side_by_side ? 0 : p].push_back(std::move(cell));
    }
    if (side_by_side) headers.push_back({performers[p].caption, ""});
  }
  US_CHECK(anybody, "nobody is to be seen in the strip");
  std::vector<Row> rows;
  rows.reserve(cells.size());
  for (size_t r = 0; r < cells.size(); ++r)
    rows.push_back({side_by_side ? time_text(seconds[0]) : performers[r].caption, options.yaw, &cells[r]});
  if (!side_by_side)
    for (const double time : seconds) headers.push_back({"", time_text(time)});
  SheetOptions sheet;
  sheet.title = options.title, sheet.width = options.width, sheet.columns = options.columns;
  return draw(renderer, std::move(rows), headers, sheet, sides);
}

Image strip(const std::vector<StripRow>& performers, const std::vector<double>& seconds,
            const StripOptions& options) {
  const auto context = make_offscreen_context();
  Renderer renderer;
  return strip(renderer, performers, seconds, options);
}

int picture_width(const StripOptions& options, int columns) {
  const int across = std::max(1, std::min(columns, options.columns));
  return (options.width - 2 * kMargin - kGutter - (across - 1) * kGap) / across;
}

Image picture_sheet(const std::vector<PictureRow>& rows, const std::vector<std::string>& headers,
                    const StripOptions& options) {
  US_CHECK(!rows.empty() && !headers.empty(), "a sheet of pictures needs one");
  const int count = static_cast<int>(headers.size()), columns = std::min(options.columns, count);
  const int width = picture_width(options, count);
  Layout layout{options.width, columns, (count + columns - 1) / columns, kHeader, kHeader, 1};
  for (const PictureRow& row : rows) {
    US_CHECK(row.pictures.size() == headers.size(), row.caption, ": has ", row.pictures.size(),
             " pictures, the sheet ", headers.size());
    layout.band_height += row.pictures[0].height + kGap;
  }
  const Font font = Font::system();
  const int band = layout.band_height + kBandGap, top = options.title.empty() ? kMargin / 2 : kTitle;
  Image sheet(layout.width, top + layout.bands * band - kBandGap + kMargin - kGap, kPaper);
  draw_title(sheet, font, options.title, /*sides=*/false);
  for (int i = 0; i < count; ++i) {
    const int x = kMargin + kGutter + i % columns * (width + kGap);
    int y = top + i / columns * band + kHeader;
    const size_t at = static_cast<size_t>(i);
    draw_header(sheet, font, {headers[at], ""}, {x + 2, y - kHeader * 0.32f}, layout, width);
    for (const PictureRow& row : rows) {
      paste(sheet, row.pictures[at], x, y);
      if (i % columns == 0) draw_caption(sheet, font, row.caption, {kMargin - 4, y}, row.pictures[at].height);
      y += row.pictures[at].height + kGap;
    }
  }
  return sheet;
}

}  // namespace understudy::render
