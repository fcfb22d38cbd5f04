#include "runtime/csv/csv_metadata.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/csv/checksum.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/json_text.hpp"
#include "runtime/source/yaml.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

Type type_of(const Json& column) {
    const auto datatype = column.find("datatype");
    if (datatype == column.end()) return Type::real;
    const std::string name =
        datatype->is_object() ? text_at(*datatype, "base") : text_at(column, "datatype");
    if (name == "boolean") return Type::boolean;
    if (name != "integer") return Type::real;
    return column.contains("values") ? Type::enumeration : Type::integer;
}

/// One for each name; none where these have 0, 1, 2, ...
std::vector<Wide> numbers_of(const Json& column, std::size_t names) {
    const auto list = column.find("lineshaft:numbers");
    if (list == column.end() || !list->is_array() || list->size() != names) return {};
    std::vector<Wide> numbers;
    for (const Json& number : *list) {
        if (number.is_number_unsigned())
            numbers.push_back(number.get<std::uint64_t>());
        else
            numbers.push_back(number.is_number_integer() ? number.get<std::int64_t>() : 0);
    }
    return numbers;
}

CsvMetadata::Column column_of(const Json& column) {
    CsvMetadata::Column out{.title = text_at(column, "titles"),
                            .signal = text_at(column, "lineshaft:signal"),
                            .type = type_of(column),
                            .unit = text_at(column, "unit"),
                            .values = {},
                            .numbers = {}};
    if (out.signal.empty()) out.signal = out.title;
    const auto values = column.find("values");
    if (values == column.end() || !values->is_array()) return out;
    for (const Json& value : *values)
        out.values.push_back(value.is_string() ? value.get<std::string>() : std::string());
    out.numbers = numbers_of(column, out.values.size());
    return out;
}

constexpr const char* check_key = "lineshaft:check";
constexpr std::size_t check_digits = 8;

/// Where the digits of a sidecar's own check stand; npos when there are none.
std::size_t check_place(const std::string& text) {
    const std::string begin = fmt::format("\"{}\": \"", check_key);
    const std::size_t at = text.find(begin);
    if (at == std::string::npos || at + begin.size() + check_digits > text.size())
        return std::string::npos;
    return at + begin.size();
}

std::string check_of(std::string text, std::size_t place) {
    Checksum checksum;
    checksum.add(text.replace(place, check_digits, check_digits, '0'));
    return checksum.text();
}

std::optional<bool> is_intact(const std::string& text) {
    const std::size_t place = check_place(text);
    if (place == std::string::npos) return {};
    return text.substr(place, check_digits) == check_of(text, place);
}

/// `m.csv, crc32 1a2b3c4d` of an object, a text as it is, `a; b` of a list.
std::string text_of(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    std::string text;
    if (value.is_array())
        for (const Json& item : value) text += (text.empty() ? "" : "; ") + text_of(item);
    if (value.is_array()) return text;
    if (!value.is_object()) return value.dump();
    for (const auto& [key, part] : value.items())
        text += (text.empty() ? "" : ", ") + (key == "file" ? "" : key + " ") + text_of(part);
    return text;
}

std::vector<std::pair<std::string, std::string>> made_by(const Json& run) {
    std::vector<std::pair<std::string, std::string>> list;
    if (!run.is_object()) return list;
    for (const auto& [key, value] : run.items()) {
        if (key == "form") continue;
        if (key == "parameters" && value.is_object())
            for (const auto& [name, text] : value.items())
                list.emplace_back("parameter " + name, text_of(text));
        else
            list.emplace_back(key, text_of(value));
    }
    return list;
}

}  // namespace

const CsvMetadata::Column* CsvMetadata::find(std::string_view wanted) const {
    const auto it = std::ranges::find(columns, wanted, &Column::title);
    return it == columns.end() ? nullptr : &*it;
}

std::string sidecar_path(const std::string& csv_path) {
    return csv_path + "-metadata.json";
}

std::string sidecar_text(nlohmann::ordered_json metadata) {
    metadata[check_key] = std::string(check_digits, '0');
    std::string text = metadata.dump(2) + "\n";
    const std::size_t place = check_place(text);
    return text.replace(place, check_digits, check_of(text, place));
}

std::optional<CsvMetadata> read_metadata(const std::string& csv_path, Diagnostics& out) {
    const std::string path = sidecar_path(csv_path);
    std::error_code unknown;  // then there is none
    if (!std::filesystem::is_regular_file(path, unknown)) return {};
    const auto file = read_source(path, out);
    if (!file) return {};
    const Json json = parse_json(file->text);
    const Json::json_pointer pointer("/tableSchema/columns");
    if (!json.is_object() || !json.contains(pointer) || !json[pointer].is_array()) {
        out.add(code::sidecar_not_understood, {file, 0, 0, 1},
                "this is not a CSVW description of a table",
                "remove it if the CSV is not a trace of lineshaft");
        return {};
    }
    CsvMetadata metadata{.title = text_at(json, "dc:title"),
                         .version = text_at(json, "lineshaft:version"),
                         .program = text_at(json, "lineshaft:program"),
                         .form = {},
                         .made_by = {},
                         .stopped = text_at(json, "lineshaft:stopped"),
                         .rows = {},
                         .crc32 = text_at(json, "lineshaft:crc32"),
                         .intact = is_intact(file->text),
                         .columns = {}};
    if (const auto run = json.find("lineshaft:run"); run != json.end()) {
        metadata.form = text_at(*run, "form");
        metadata.made_by = made_by(*run);
    }
    metadata.rows = integer_at(json, "lineshaft:rows", 0, std::numeric_limits<std::int64_t>::max());
    for (const Json& column : json[pointer])
        if (column.is_object()) metadata.columns.push_back(column_of(column));
    return metadata;
}

}  // namespace lineshaft
