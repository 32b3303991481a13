// What answers depend on, part by part.
#include "app/study/study.hpp"
#include "retarget/base/checksum.hpp"
#include "retarget/base/text.hpp"

namespace understudy::app {
namespace {

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string checksum_of(const Json& json) {
  return checksum_text(fnv1a(text_of(json)));
}

/// The parts of the design by their names, in the order of the study.
Json parts_of(const Study& study, const std::string& folder) {
  const Json json = to_json(study, folder);
  Json parts = Json::object();
  const auto add_all = [&](const char* list, const std::string& what) {
    for (const Json& one : json.at(list))
      parts[what + " '" + one.at("name").get<std::string>() + "'"] = checksum_of(one);
  };
  add_all("conditions", "condition");
  add_all("motions", "motion");
  add_all("targets", "target");
  add_all("questions", "question");
  for (const char* whole : {"layout", "clip", "picture"}) parts[whole] = checksum_of(json.at(whole));
  Json plan = json.at("plan");
  for (const char* free : {"break_every", "participants", "least_right", "must_exceed"}) plan.erase(free);
  parts["plan"] = checksum_of(plan);
  return parts;
}

}  // namespace

std::string digest_of(const Study& study, const std::string& folder) {
  return text_of(parts_of(study, folder));
}

std::string changes_since(const std::string& digest, const Study& study, const std::string& folder) {
  const Json before = Json::parse(digest, nullptr, /*allow_exceptions=*/false);
  US_CHECK(before.is_object(), "'", excerpt(digest), "' is no digest of a study");
  const Json now = parts_of(study, folder);
  std::string changes;
  for (const auto& [name, checksum] : now.items())
    if (!before.contains(name))
      append_item(changes, name + " is new");
    else if (before[name] != checksum)
      append_item(changes, name);
  for (const auto& item : before.items())
    if (!now.contains(item.key())) append_item(changes, item.key() + " is gone");
  // An ordered object is equal to another only where the order is, too.
  if (changes.empty() && before != now) changes = "the order of conditions, motions, targets or questions";
  return changes;
}

}  // namespace understudy::app
