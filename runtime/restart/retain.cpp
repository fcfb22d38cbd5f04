#include "runtime/restart/retain.hpp"

#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/source/yaml.hpp"
#include "runtime/trace/output_file.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

std::optional<Value> value_of(const Json& json, Type type) {
    if (type == Type::boolean && json.is_boolean()) return json.get<bool>();
    if (type == Type::real && json.is_number()) return json.get<double>();
    if (type != Type::boolean && type != Type::real && json.is_number_integer())
        return json.get<std::int64_t>();
    return {};
}

}  // namespace

std::string write_retained(const std::string& path, const Machine& machine) {
    Json values = Json::object();
    for (const Retained& kept : machine.retained)
        std::visit([&](auto v) { values[kept.signal.name] = v; }, kept.signal.value());
    OutputFile file(path);
    file.write(Json{{"lineshaft_retain", 1}, {"values", values}}.dump(2) + "\n");
    file.commit();
    return file.error();
}

int read_retained(const std::string& path, Machine& machine, Diagnostics& out) {
    std::error_code unknown;
    if (!std::filesystem::exists(path, unknown)) return 0;
    const auto file = read_source(path, out);
    if (!file) return 0;
    const auto fail = [&](const std::string& message) {
        out.add("L0507", {file, 0, 0, 1}, message,
                "a cold restart (--restart cold) begins with the initial values");
    };
    const Json root = Json::parse(file->text, nullptr, false);
    if (!root.is_object() || !root.contains("lineshaft_retain") || root["lineshaft_retain"] != 1 ||
        !root.contains("values") || !root["values"].is_object()) {
        fail("this is not a file of retained values");
        return 0;
    }
    int set = 0;
    for (const Retained& kept : machine.retained) {
        const auto it = root["values"].find(kept.signal.name);
        if (it == root["values"].end() || it->is_null()) continue;
        const auto value = value_of(*it, kept.signal.type);
        if (!value) {
            fail(fmt::format("'{}' is {}, the file has {}", kept.signal.name,
                             name_of(kept.signal.type), it->dump()));
            continue;
        }
        store(kept.signal.type, kept.live, *value);
        store(kept.signal.type, kept.published, *value);
        ++set;
    }
    return set;
}

}  // namespace lineshaft
