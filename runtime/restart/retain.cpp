#include "runtime/restart/retain.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "runtime/source/yaml.hpp"
#include "runtime/trace/output_file.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<std::byte>;

constexpr std::string_view help = "a cold restart (--restart cold) begins with the initial values";

std::optional<Value> value_of(const Json& json, Type type) {
    if (type == Type::boolean && json.is_boolean()) return json.get<bool>();
    if (type == Type::real && json.is_number()) return json.get<double>();
    if (type != Type::boolean && type != Type::real && json.is_number_integer())
        return json.get<std::int64_t>();
    return {};
}

std::string hexadecimal(const Bytes& bytes) {
    std::string text;
    for (const std::byte byte : bytes) text += fmt::format("{:02x}", static_cast<unsigned>(byte));
    return text;
}

/// Empty for what is not that many bytes.
Bytes bytes_of(const Json& block, std::size_t size) {
    if (!block.contains("state") || !block["state"].is_string()) return {};
    const std::string text = block["state"];
    if (text.size() != 2 * size) return {};
    Bytes bytes(size);
    for (std::size_t i = 0; i < size; ++i) {
        const char* digits = text.data() + 2 * i;
        unsigned value = 0;
        if (std::from_chars(digits, digits + 2, value, 16).ptr != digits + 2) return {};
        bytes[i] = static_cast<std::byte>(value);
    }
    return bytes;
}

Json json_of(const RetainedBlock& kept, const BlockPlace& block, std::int64_t now) {
    Bytes bytes(block.live, block.live + block.type->size);
    if (block.type->shift) block.type->shift(bytes.data(), -now, block.type->context);
    return {{"settings", kept.settings}, {"state", hexadecimal(bytes)}};
}

/// All but what the program says itself.
void restore(const BlockPlace& block, const Bytes& state) {
    Bytes bytes = state;
    for (const Field& field : block.type->fields)
        if (field.direction != Direction::output && field.direction != Direction::local)
            std::memcpy(&bytes[field.offset], block.live + field.offset, size_of(field.type));
    std::ranges::copy(bytes, block.live);
    std::ranges::copy(bytes, block.published);
}

/// A file of retained values while it is read.
struct Reading {
    const Json& root;
    Machine& machine;
    std::shared_ptr<const SourceFile> file;
    Diagnostics& out;

    void fail(const std::string& message) const {
        out.add("L0507", {file, 0, 0, 1}, message, std::string(help));
    }
    /// Null where the file does not have it.
    const Json* find(const char* list, const std::string& name) const {
        if (!root.contains(list)) return nullptr;
        const auto it = root[list].find(name);
        return it == root[list].end() || it->is_null() ? nullptr : &*it;
    }
};

bool set_value(const Reading& reading, const Retained& kept) {
    const Json* json = reading.find("values", kept.signal.name);
    if (!json) return false;
    const auto value = value_of(*json, kept.signal.type);
    if (!value) {
        reading.fail(fmt::format("'{}' is {}, the file has {}", kept.signal.name,
                                 name_of(kept.signal.type), json->dump()));
        return false;
    }
    store(kept.signal.type, kept.live, *value);
    store(kept.signal.type, kept.published, *value);
    return true;
}

bool set_block(const Reading& reading, const RetainedBlock& kept) {
    const BlockPlace& block = reading.machine.blocks[kept.instance];
    const Json* json = reading.find("blocks", block.name);
    if (!json) return false;
    const Bytes bytes = bytes_of(*json, block.type->size);
    if (bytes.empty() || !json->contains("settings") || (*json)["settings"] != kept.settings) {
        reading.fail(
            fmt::format("'{}' ({}) was retained with other parameters, as another kind of "
                        "block, or by another version of lineshaft",
                        block.name, block.type->name));
        return false;
    }
    restore(block, bytes);
    return true;
}

bool is_retain_file(const Json& root) {
    const auto is_object = [&](const char* key) {
        return root.contains(key) && root[key].is_object();
    };
    return root.is_object() && root.contains("lineshaft_retain") && root["lineshaft_retain"] == 1 &&
           is_object("values") && (!root.contains("blocks") || is_object("blocks"));
}

}  // namespace

std::string write_retained(const std::string& path, const Machine& machine, std::int64_t now) {
    Json root{{"lineshaft_retain", 1}, {"values", Json::object()}};
    for (const Retained& kept : machine.retained)
        std::visit([&](auto v) { root["values"][kept.signal.name] = v; }, kept.signal.value());
    for (const RetainedBlock& kept : machine.retained_blocks) {
        const BlockPlace& block = machine.blocks[kept.instance];
        root["blocks"][block.name] = json_of(kept, block, now);
    }
    OutputFile file(path);
    file.write(root.dump(2) + "\n");
    file.commit();
    return file.error();
}

int read_retained(const std::string& path, Machine& machine, Diagnostics& out) {
    std::error_code unknown;
    if (!std::filesystem::exists(path, unknown)) return 0;
    const auto file = read_source(path, out);
    if (!file) return 0;
    const Json root = Json::parse(file->text, nullptr, false);
    const Reading reading{root, machine, file, out};
    if (!is_retain_file(root)) {
        reading.fail("this is not a file of retained values");
        return 0;
    }
    int set = 0;
    for (const Retained& kept : machine.retained) set += set_value(reading, kept);
    for (const RetainedBlock& kept : machine.retained_blocks) set += set_block(reading, kept);
    return set;
}

}  // namespace lineshaft
