#include "runtime/restart/retain.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/machine/kept_memory.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/input_file.hpp"
#include "runtime/source/json_text.hpp"
#include "runtime/source/text_hash.hpp"
#include "runtime/source/utf8.hpp"
#include "runtime/source/yaml.hpp"
#include "runtime/st/library/retained.hpp"
#include "runtime/st/types/elementary.hpp"
#include "runtime/trace/output_file.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<std::byte>;

constexpr YamlLimits retain_limits{.bytes = 256 << 20};
constexpr std::string_view help = "a cold restart (--restart cold) begins with the initial values";

constexpr std::int64_t retain_layout = 8;  // of the blocks
constexpr std::string_view check_begin = "\"check\": \"", no_check = "0000000000000000";

/// Where the digits of the file's own check stand; npos when there are none.
std::size_t check_place(std::string_view text) {
    const std::size_t at = text.find(check_begin);
    const bool has_room =
        at != std::string::npos && at + check_begin.size() + no_check.size() <= text.size();
    return has_room ? at + check_begin.size() : std::string::npos;
}

std::string check_of(std::string text, std::size_t place) {
    return text_hash(text.replace(place, no_check.size(), no_check));
}

bool is_intact(const std::string& text) {
    const std::size_t place = check_place(text);
    return place != std::string::npos &&
           text.substr(place, no_check.size()) == check_of(text, place);
}

/// Empty for no integer.
std::optional<Value> integer_of(const Json& json, Type type) {
    if (!json.is_number_integer()) return {};
    return whole_value(json.is_number_unsigned() ? Wide{json.get<std::uint64_t>()}
                                                 : Wide{json.get<std::int64_t>()},
                       type);
}

std::optional<Value> value_of(const Json& json, Type type) {
    if (type == Type::boolean && json.is_boolean()) return json.get<bool>();
    if (type == Type::real && json.is_number()) return json.get<double>();
    if (type == Type::boolean || type == Type::real) return {};
    return integer_of(json, type);
}

/// Among an enumeration's, and within the limits of the field.
bool is_admitted(const Value& value, const Signal& signal, const Machine& machine) {
    if (signal.type == Type::enumeration) return signal.names.takes(std::get<std::int64_t>(value));
    if (signal.port.instance < 0 || !is_integer(signal.type)) return true;
    const BlockPlace& block = machine.blocks[static_cast<std::size_t>(signal.port.instance)];
    return block.type->fields[static_cast<std::size_t>(signal.port.field)].admits(value);
}

/// Empty for what is not that many bytes.
Bytes bytes_of(const Json& block, const char* key, std::size_t size) {
    if (!block.contains(key) || !block[key].is_string()) return {};
    const std::string text = block[key];
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

bool is_text(std::string_view text) {
    while (!text.empty()) {
        const Utf8Character first = first_character(text);
        if (!first.valid) return false;
        text.remove_prefix(first.bytes);
    }
    return true;
}

/// As it is written in the language, or as its bytes where JSON has nothing like it: of a number
/// that is none, of a text that is no UTF-8, of a union, of a long list.
Json json_of(const RetainedVariable& kept) {
    const auto number = read<std::int64_t>(kept.live);
    switch (kept.type->kind) {
        case st::Type::Kind::boolean:
            return number != 0;
        case st::Type::Kind::real:
            if (const auto value = read<double>(kept.live); std::isfinite(value)) return value;
            break;
        case st::Type::Kind::text: {
            const std::string_view text(reinterpret_cast<const char*>(kept.live) + 8,
                                        static_cast<std::size_t>(number));
            if (is_text(text)) return text;
            break;
        }
        case st::Type::Kind::array:
        case st::Type::Kind::union_:
            break;
        default:
            if (kept.type->is_unsigned_64()) return static_cast<std::uint64_t>(number);
            return number;
    }
    return {{"bytes", hexadecimal({kept.live, kept.size})}};
}

/// Empty for what cannot be one.
Bytes bytes_of(const Json& json, const RetainedVariable& kept) {
    if (json.is_object()) return bytes_of(json, "bytes", kept.size);
    Bytes bytes(kept.size);
    const auto put = [&](auto value) { std::memcpy(bytes.data(), &value, sizeof value); };
    switch (kept.type->kind) {
        case st::Type::Kind::boolean:
            if (!json.is_boolean()) return {};
            put(std::int64_t{json.get<bool>()});
            break;
        case st::Type::Kind::real:
            if (!json.is_number()) return {};
            put(json.get<double>());
            break;
        case st::Type::Kind::text: {
            if (!json.is_string()) return {};
            const auto text = json.get<std::string>();
            if (text.size() > kept.size - 8) return {};
            put(std::int64_t(text.size()));
            std::memcpy(bytes.data() + 8, text.data(), text.size());
            break;
        }
        default: {
            const Type type = kept.type->is_unsigned_64() ? Type::unsigned_integer : Type::integer;
            const auto value = integer_of(json, type);
            if (!value) return {};
            store(type, bytes.data(), *value);
        }
    }
    return st::is_value(*kept.type, bytes.data()) ? bytes : Bytes();
}

Json json_of(const RetainedBlock& kept, std::int64_t now) {
    const BlockPlace& block = kept.place;
    Bytes bytes(block.live, block.live + block.type->size);
    if (block.type->shift) block.type->shift(bytes.data(), -now, block.type->context);
    return {{"settings", kept.settings}, {"state", hexadecimal(bytes)}};
}

/// All but what the program says itself.
void restore(const RetainedBlock& kept, const Bytes& state, KeptMemory& memory) {
    const BlockPlace& block = kept.place;
    Bytes bytes = state;
    const auto is_kept = [&](Direction direction) {
        return direction == Direction::output || direction == Direction::local ||
               (direction == Direction::input && kept.is_part);
    };
    for (const Field& field : block.type->fields)
        if (!is_kept(field.direction))
            std::memcpy(&bytes[field.offset], block.live + field.offset, size_of(field.type));
    memory.take(block, block.live, bytes.data());
    std::copy_n(block.live, block.type->size, block.published);
}

/// A file of retained values while it is read.
struct Reading {
    const Json& root;
    Machine& machine;
    KeptMemory& memory;
    std::shared_ptr<const SourceFile> file;
    Diagnostics& out;

    void fail(const std::string& message) const {
        out.add(code::retain_file_does_not_fit, {file, 0, 0, 1}, message, std::string(help));
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
    if (!value || !is_admitted(*value, kept.signal, reading.machine)) {
        reading.fail(fmt::format("'{}' is {}, the file has {}", kept.signal.name,
                                 name_of(kept.signal.type), json->dump()));
        return false;
    }
    store(kept.signal.type, kept.live, *value);
    store(kept.signal.type, kept.published, *value);
    return true;
}

bool set_variable(const Reading& reading, const RetainedVariable& kept) {
    const Json* json = reading.find("values", kept.name);
    if (!json) return false;
    const Bytes bytes = bytes_of(*json, kept);
    if (bytes.empty()) {
        reading.fail(fmt::format("'{}' is {}, the file has {}", kept.name, st::describe(*kept.type),
                                 json->dump()));
        return false;
    }
    std::ranges::copy(bytes, kept.live);
    std::ranges::copy(bytes, kept.published);
    return true;
}

bool set_block(const Reading& reading, const RetainedBlock& kept) {
    const BlockPlace& block = kept.place;
    const Json* json = reading.find("blocks", block.name);
    if (!json) return false;
    const Bytes bytes = bytes_of(*json, "state", block.type->size);
    if (bytes.empty() || !json->contains("settings") || (*json)["settings"] != kept.settings) {
        reading.fail(
            fmt::format("'{}' ({}) was retained with other parameters, as another kind of "
                        "block, or by another version of lineshaft",
                        block.name, block.type->name));
        return false;
    }
    restore(kept, bytes, reading.memory);
    return true;
}

bool is_object(const Json& root, const char* key) {
    return root.contains(key) && root[key].is_object();
}

bool is_retain_file(const Json& root) {
    return root.is_object() && integer_at(root, "lineshaft_retain", 1, retain_layout) &&
           is_object(root, "values") && (!root.contains("blocks") || is_object(root, "blocks"));
}

std::string copy_before(const std::string& path) {
    return path + ".bak";
}

/// Whether there is a file with a check that fits.
bool is_good(const std::string& path) {
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(path, unknown)) return false;
    int error = 0;
    const std::string text = read_bytes(path, retain_limits.bytes, error);
    return error == 0 && is_intact(text);
}

/// Under another name too, so that there is a whole file at each moment. Where that cannot be there
/// is no copy.
void keep_copy(const std::string& path) {
    std::error_code unknown;
    std::filesystem::remove(copy_before(path), unknown);
    std::filesystem::create_hard_link(path, copy_before(path), unknown);
    if (unknown) std::filesystem::copy_file(path, copy_before(path), unknown);
}

/// What is read: the file, or, with a warning, the copy before it. Empty when there is none.
std::string readable(const std::string& path, Diagnostics& out) {
    std::error_code unknown;
    const bool exists = std::filesystem::exists(path, unknown);
    if (exists && !std::filesystem::is_regular_file(path, unknown)) return path;
    if (is_good(path) || !is_good(copy_before(path))) return exists ? path : "";
    out.warn(code::retain_file_does_not_fit, {},
             fmt::format("'{}' is {}: the copy before it, '{}', is taken", path,
                         exists ? "damaged" : "not there", copy_before(path)));
    return copy_before(path);
}

/// Empty when nothing is.
std::string what_is_wrong(const Json& root, const std::string& text) {
    if (!is_retain_file(root)) {
        return text.find("lineshaft_retain") == std::string::npos
                   ? "this is not a file of retained values"
                   : "the file of retained values is damaged";
    }
    if (integer_at(root, "lineshaft_retain", retain_layout, retain_layout) && !is_intact(text))
        return "the file of retained values is damaged: its check does not fit";
    if (!integer_at(root, "lineshaft_retain", retain_layout, retain_layout))
        return "the file is of an earlier lineshaft, whose blocks were laid out otherwise";
    return {};
}

/// Blocks that were linked with others go on without those that were not retained.
void mend_links(const Machine& machine, KeptMemory& memory) {
    for (int round = 0; round < 2; ++round)  // an axis before its commands
        for (const RetainedBlock& kept : machine.retained_blocks) memory.mend(kept.instance);
}

}  // namespace

std::string write_retained(const std::string& path, const Machine& machine, std::int64_t now) {
    Json root{{"lineshaft_retain", retain_layout}, {"check", no_check}, {"values", Json::object()}};
    for (const Retained& kept : machine.retained)
        std::visit([&](auto v) { root["values"][kept.signal.name] = v; }, kept.signal.value());
    for (const RetainedVariable& kept : machine.retained_variables)
        root["values"][kept.name] = json_of(kept);
    for (const RetainedBlock& kept : machine.retained_blocks)
        root["blocks"][kept.place.name] = json_of(kept, now);
    std::string text = root.dump(2) + "\n";
    const std::size_t place = check_place(text);
    text.replace(place, no_check.size(), check_of(text, place));
    OutputFile file(path);
    file.write(text);
    if (!file.complete()) return file.error();
    if (file.is_regular() && is_good(path)) keep_copy(path);
    file.commit();
    return file.error();
}

int read_retained(const std::string& path, Machine& machine, Diagnostics& out) {
    const std::string name = readable(path, out);
    if (name.empty()) return 0;
    const auto file = read_source(name, out, {}, retain_limits);
    return file ? take_retained(file->text, file, machine, out) : 0;
}

int take_retained(const std::string& text, const std::shared_ptr<const SourceFile>& file,
                  Machine& machine, Diagnostics& out) {
    const Json root = parse_json(text);
    KeptMemory memory(machine, 0);
    const Reading reading{root, machine, memory, file, out};
    if (const std::string wrong = what_is_wrong(root, text); !wrong.empty()) {
        reading.fail(wrong);
        return 0;
    }
    int set = 0;
    for (const Retained& kept : machine.retained) set += set_value(reading, kept);
    for (const RetainedVariable& kept : machine.retained_variables)
        set += set_variable(reading, kept);
    for (const RetainedBlock& kept : machine.retained_blocks) set += set_block(reading, kept);
    mend_links(machine, memory);
    if (const std::string damaged = memory.damaged(); out.empty() && !damaged.empty())
        reading.fail(fmt::format("the state of {} cannot be as the file has it", damaged));
    return set;
}

std::string retained_line(const std::string& path) {
    Diagnostics told;  // by the run that takes them
    const std::string name = readable(path, told);
    int error = 0;
    const std::string text = name.empty() ? "" : read_bytes(name, retain_limits.bytes, error);
    if (error != 0 || !is_intact(text)) return {};
    std::string line;
    bool is_indent = false;
    for (const char c : text) {
        is_indent = c == '\n' || (is_indent && c == ' ');
        if (!is_indent) line += c;
    }
    const std::size_t place = check_place(line);
    return line.replace(place, no_check.size(), check_of(line, place));
}

}  // namespace lineshaft
