#include "retarget/character/vertex_colors.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "retarget/base/error.hpp"
#include "retarget/base/index.hpp"
#include "retarget/base/log.hpp"
#include "retarget/character/picture.hpp"

namespace understudy {
namespace {

using nlohmann::json;

int pixel(float t, int count, bool repeat) {
  if (!std::isfinite(t)) return 0;
  t = repeat ? t - std::floor(t) : std::clamp(t, 0.0f, 1.0f);
  return std::clamp(static_cast<int>(t * static_cast<float>(count)), 0, count - 1);
}

/// Linear light at texture coordinates, repeated beyond 0..1 or not.
Vec3 light_at(const Pixels& pixels, float u, float v, bool repeat_u, bool repeat_v) {
  const int x = pixel(u, pixels.width, repeat_u), y = pixel(v, pixels.height, repeat_v);
  const uint8_t* const p = pixels.rgb.get() + 3 * (static_cast<int64_t>(y) * pixels.width + x);
  return (Vec3(p[0], p[1], p[2]) / 255).unaryExpr(&to_linear);
}

/// What is seen of a material.
struct Look {
  Vec3 factor = Vec3::Ones();  // linear
  std::shared_ptr<const Pixels> picture;
  size_t uv = 0;
  bool repeat_u = true, repeat_v = true;
};

json member(const json& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  return object.is_object() && found != object.end() ? *found : json();
}

std::optional<size_t> index_in(const json& object, const char* name, size_t count) {
  const json value = member(object, name);
  if (!value.is_number_unsigned() || value.get<uint64_t>() >= count) return {};
  return value.get<size_t>();
}

json object_of(const std::string& text) {
  return json::parse(text, nullptr, /*allow_exceptions=*/false);
}

/// Looks of materials; each picture is decoded once.
class Looks {
 public:
  explicit Looks(const Character& character) : character_(character) {}

  const Look& of(int material) {
    const auto known = looks_.find(material);
    return known != looks_.end() ? known->second : looks_[material] = made(material);
  }

 private:
  Look made(int material) {
    Look look;
    if (material < 0) return look;
    const json pbr = member(object_of(character_.materials[material]), "pbrMetallicRoughness");
    const json factor = member(pbr, "baseColorFactor");
    for (size_t i = 0; factor.is_array() && i < std::min<size_t>(3, factor.size()); ++i)
      if (factor[i].is_number()) look.factor[i] = std::clamp(factor[i].get<float>(), 0.0f, 1.0f);
    add_texture(member(pbr, "baseColorTexture"), look);
    return look;
  }

  void add_texture(const json& info, Look& look) {
    const auto texture = index_in(info, "index", character_.textures.size());
    if (!texture) return;
    look.uv = index_in(info, "texCoord", 8).value_or(0);
    const json object = object_of(character_.textures[*texture]);
    look.picture = picture_of(object);
    const auto sampler = index_in(object, "sampler", character_.samplers.size());
    if (!sampler) return;
    const json how = object_of(character_.samplers[*sampler]);
    constexpr int kClampToEdge = 33071;
    look.repeat_u = member(how, "wrapS") != kClampToEdge;
    look.repeat_v = member(how, "wrapT") != kClampToEdge;
  }

  /// Of the texture's own picture or, where that is none or not decoded here, of the extensions'.
  std::shared_ptr<const Pixels> picture_of(const json& texture) {
    std::vector<size_t> sources;
    const json extensions = member(texture, "extensions");
    for (const json& from :
         {texture, member(extensions, "EXT_texture_webp"), member(extensions, "KHR_texture_basisu")})
      if (const auto source = index_in(from, "source", character_.images.size())) sources.push_back(*source);
    const auto decoded = [&](size_t i) { return is_decoded(character_.images[i].bytes); };
    const auto first = std::find_if(sources.begin(), sources.end(), decoded);
    if (first != sources.end()) return picture(*first);
    return sources.empty() ? nullptr : picture(sources.front());
  }

  std::shared_ptr<const Pixels> picture(size_t index) {
    const auto known = pictures_.find(index);
    if (known != pictures_.end()) return known->second;
    auto& made = pictures_[index];
    const CharacterImage& image = character_.images[index];
    try {
      made = std::make_shared<const Pixels>(decode_picture(image.bytes));
    } catch (const Error& error) {
      log::warn(character_.called() + ": the picture '" + image.name + "' is not shown: " + error.what());
    }
    return made;
  }

  const Character& character_;
  std::map<int, Look> looks_;
  std::map<size_t, std::shared_ptr<const Pixels>> pictures_;
};

Vec3 linear_color(const CharacterPart& part, const Look& look, Eigen::Index v) {
  Vec3 color = look.factor;
  if (look.picture && look.uv < part.uvs.size())
    color = color.cwiseProduct(light_at(*look.picture, part.uvs[look.uv](v, 0), part.uvs[look.uv](v, 1),
                                        look.repeat_u, look.repeat_v));
  if (part.colors.rows() > 0) color = color.cwiseProduct(Vec3(part.colors.row(v).head<3>().transpose()));
  return color.cwiseMax(0.0f).cwiseMin(1.0f);
}

}  // namespace

float to_linear(float shown) {
  return shown <= 0.04045f ? shown / 12.92f : std::pow((shown + 0.055f) / 1.055f, 2.4f);
}

float to_shown(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

Points vertex_colors(const Character& character) {
  Looks looks(character);
  Points out(character.vertex_count(), 3);
  Eigen::Index at = 0;
  for (const auto& part : character.parts) {
    const Look& look = looks.of(part.material);
    for (Eigen::Index v = 0; v < part.vertices.rows(); ++v, ++at)
      out.row(at) = linear_color(part, look, v).unaryExpr(&to_shown).transpose();
  }
  if (out.rows() == 0 || (out.rowwise() - Eigen::RowVector3f(out.row(0))).cwiseAbs().maxCoeff() < 0.004f)
    return Points(0, 3);
  return out;
}

void paint(MergedSurface& surface, const Character& character) {
  surface.mesh.colors.resize(0, 3);
  const Points colors = vertex_colors(character);
  if (colors.rows() == 0) return;
  US_CHECK(colors.rows() == ssize(surface.map), character.called(), ": has ", colors.rows(),
           " vertices, its surface ", surface.map.size());
  surface.mesh.colors = Points::Zero(surface.mesh.vertices.rows(), 3);
  Eigen::VectorXf corners = Eigen::VectorXf::Zero(surface.mesh.vertices.rows());
  for (size_t i = 0; i < surface.map.size(); ++i) {
    surface.mesh.colors.row(surface.map[i]) += colors.row(i);
    ++corners[surface.map[i]];
  }
  surface.mesh.colors.array().colwise() /= corners.array();
}

}  // namespace understudy
