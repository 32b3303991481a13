// JSON reports: of one retargeted sequence, and of an evaluation.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "app/run/evaluator.hpp"
#include "app/run/latency.hpp"
#include "retarget/skeleton/made_frames.hpp"

namespace understudy::app {

using Json = nlohmann::ordered_json;

/// What made the figures: {"program", "weights"}; weights are the files in the folder with their CRC-32.
Json report_header(const std::string& weights_folder);
/// CRC-32 of a file as eight digits. Throws Error when it cannot be read.
std::string checksum(const std::filesystem::path& path);
Json to_json(const Metrics& metrics);
/// Milliseconds a stage at this quantile.
Json to_json(const Latency& latency, double quantile);
/// [{"first", "last", "doubt_m"}], both inside.
Json to_json(const std::vector<MadeFrames>& made);
/// Writes beside the path, then renames. Throws Error naming the path.
void write_json(const std::string& path, const Json& json);

}  // namespace understudy::app
