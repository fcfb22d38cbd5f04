#include "runtime/run/origin.hpp"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "runtime/program/meaning.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

std::string file_name(const std::string& path) {
    return std::filesystem::path(path).filename().string();
}

std::string text_of(const ForcePlan& force) {
    std::string text = fmt::format("{} = {}", force.signal.text, force.value.text);
    if (force.from > 0) text += " from " + format_time(force.from);
    if (force.until < never) text += " until " + format_time(force.until);
    return text;
}

}  // namespace

TraceOrigin origin_of(const Loaded& loaded) {
    const auto& [program, linked] = loaded;
    const Meaning meaning = meaning_of(program);
    // [] and push_back() on nothing leave half an object where memory ends.
    Json run{{"program", file_name(program.file->path)}, {"form", meaning.form}};
    Json parameters = Json::object(), forces = Json::array(), replays = Json::array();
    for (const auto& [name, value] : program.parameters) parameters[name] = value;
    if (!parameters.empty()) run["parameters"] = std::move(parameters);
    run["seed"] = linked.machine.seed;
    if (program.controller_name)
        run["controller"] = {{"file", file_name(program.controller_name->text)},
                             {"hash", meaning.controller}};
    for (const ForcePlan& force : program.forces) forces.push_back(text_of(force));
    if (!forces.empty()) run["forces"] = std::move(forces);
    for (const ReplayedFile& file : linked.machine.replayed)
        replays.push_back({{"file", file_name(file.name)}, {"crc32", file.crc32}});
    if (!replays.empty()) run["replays"] = std::move(replays);
    return {.title = program.title,
            .program = meaning.in_force,
            .run = std::move(run),
            .notes = program.notes,
            .report = linked.report};
}

}  // namespace lineshaft
