#include "runtime/csv/csv_metadata.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/source/yaml.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::json;

/// The text at `key`, empty when there is none.
std::string text_at(const Json& object, const char* key) {
    const auto it = object.find(key);
    return it != object.end() && it->is_string() ? it->get<std::string>() : std::string();
}

Type type_of(const Json& column) {
    const auto datatype = column.find("datatype");
    if (datatype == column.end()) return Type::real;
    const std::string name =
        datatype->is_object() ? text_at(*datatype, "base") : text_at(column, "datatype");
    if (name == "boolean") return Type::boolean;
    if (name != "integer") return Type::real;
    return column.contains("values") ? Type::enumeration : Type::integer;
}

CsvMetadata::Column column_of(const Json& column) {
    CsvMetadata::Column out{.title = text_at(column, "titles"),
                            .signal = text_at(column, "lineshaft:signal"),
                            .type = type_of(column),
                            .unit = text_at(column, "unit"),
                            .values = {}};
    if (out.signal.empty()) out.signal = out.title;
    const auto values = column.find("values");
    if (values == column.end() || !values->is_array()) return out;
    for (const Json& value : *values)
        out.values.push_back(value.is_string() ? value.get<std::string>() : std::string());
    return out;
}

}  // namespace

const CsvMetadata::Column* CsvMetadata::find(std::string_view wanted) const {
    const auto it = std::ranges::find(columns, wanted, &Column::title);
    return it == columns.end() ? nullptr : &*it;
}

std::string sidecar_path(const std::string& csv_path) {
    return csv_path + "-metadata.json";
}

std::optional<CsvMetadata> read_metadata(const std::string& csv_path, Diagnostics& out) {
    const std::string path = sidecar_path(csv_path);
    std::error_code unknown;  // then there is none
    if (!std::filesystem::is_regular_file(path, unknown)) return {};
    const auto file = read_source(path, out);
    if (!file) return {};
    const Json json = Json::parse(file->text, nullptr, false);
    const Json::json_pointer pointer("/tableSchema/columns");
    if (!json.is_object() || !json.contains(pointer) || !json[pointer].is_array()) {
        out.add("L0707", {file, 0, 0, 1}, "this is no CSVW description of a table",
                "remove it if the CSV is not a trace of lineshaft");
        return {};
    }
    CsvMetadata metadata{.title = text_at(json, "dc:title"),
                         .version = text_at(json, "lineshaft:version"),
                         .program = text_at(json, "lineshaft:program"),
                         .stopped = text_at(json, "lineshaft:stopped"),
                         .rows = {},
                         .crc32 = text_at(json, "lineshaft:crc32"),
                         .columns = {}};
    if (const auto rows = json.find("lineshaft:rows");
        rows != json.end() && rows->is_number_integer())
        metadata.rows = rows->get<std::int64_t>();
    for (const Json& column : json[pointer])
        if (column.is_object()) metadata.columns.push_back(column_of(column));
    return metadata;
}

}  // namespace lineshaft
