#include "runtime/trace/csv_sidecar.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "runtime/csv/csv_metadata.hpp"
#include "runtime/version.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

std::string csvw_type(Type type) {
    switch (type) {
        case Type::boolean:
            return "boolean";
        case Type::real:
            return "double";
        default:
            return "integer";
    }
}

Json csvw_column(const Signal& signal, const std::string& title) {
    Json column{{"titles", title}, {"datatype", csvw_type(signal.type)}};
    if (title != signal.name) column["lineshaft:signal"] = signal.name;
    if (signal.type == Type::boolean) column["datatype"] = {{"base", "boolean"}, {"format", "1|0"}};
    if (!signal.unit.empty()) column["unit"] = signal.unit;
    if (!signal.names.empty()) column["values"] = signal.names.list();
    if (Json numbers = numbers_json(signal.names); !numbers.empty())
        column["lineshaft:numbers"] = std::move(numbers);
    return column;
}

Json csvw_columns(const WrittenTable& table) {
    Json columns = Json::array();
    const auto add = [&](const Signal& s) {
        columns.push_back(csvw_column(s, title_of(table.style, s.name, s.unit)));
    };
    add({.name = "time", .type = Type::real, .unit = "s", .names = {}});
    add({.name = "scan", .type = Type::integer, .unit = {}, .names = {}});
    for (const Signal& signal : table.signals) add(signal);
    return columns;
}

}  // namespace

Json numbers_json(const ValueNames& names) {
    Json list = Json::array();
    for (const Wide number : names.odd_numbers()) {
        if (number < 0)
            list.push_back(static_cast<std::int64_t>(number));
        else
            list.push_back(static_cast<std::uint64_t>(number));
    }
    return list;
}

std::string title_of(const CsvStyle& style, std::string_view name, std::string_view unit) {
    std::string text(name);
    const char dot = style.names == CsvStyle::Names::slash ? '/' : '_';
    if (style.names != CsvStyle::Names::dot) std::ranges::replace(text, '.', dot);
    return style.units && !unit.empty() ? fmt::format("{} [{}]", text, unit) : text;
}

std::string csv_sidecar(const WrittenTable& table, const TraceOrigin& origin,
                        const std::string& stopped, const Json& expectations) {
    Json metadata{{"@context", "http://www.w3.org/ns/csvw"},
                  {"url", std::filesystem::path(table.path).filename().string()},
                  {"dc:title", origin.title},
                  {"lineshaft:version", version()},
                  {"lineshaft:program", origin.program}};
    if (!origin.run.is_null()) metadata["lineshaft:run"] = origin.run;
    if (!origin.notes.empty()) metadata["lineshaft:notes"] = origin.notes;
    if (!origin.report.is_null()) metadata["lineshaft:report"] = origin.report;
    metadata["lineshaft:rows"] = table.rows;
    metadata["lineshaft:crc32"] = table.crc32;
    if (!stopped.empty()) metadata["lineshaft:stopped"] = stopped;
    if (table.style.excel_de) metadata["dialect"] = {{"delimiter", ";"}};
    if (!expectations.empty()) metadata["lineshaft:expectations"] = expectations;
    metadata["tableSchema"] = {{"columns", csvw_columns(table)}};
    return sidecar_text(std::move(metadata));
}

}  // namespace lineshaft
