#include "runtime/trace/csv_writer.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/version.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t longest_number = 32;

char* append_integer(char* end, std::int64_t value) {
    return std::to_chars(end, end + longest_number, value).ptr;
}

char* append_real(char* end, double value) {
    if (!std::isfinite(value)) return end;
    return std::to_chars(end, end + longest_number, value).ptr;
}

char* append(char* end, Type type, std::uint64_t bits) {
    if (type == Type::real) return append_real(end, std::bit_cast<double>(bits));
    return append_integer(end, static_cast<std::int64_t>(bits));
}

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

nlohmann::ordered_json csvw_column(const Signal& signal) {
    nlohmann::ordered_json column{{"titles", signal.name}, {"datatype", csvw_type(signal.type)}};
    if (signal.type == Type::boolean) column["datatype"] = {{"base", "boolean"}, {"format", "1|0"}};
    if (!signal.unit.empty()) column["unit"] = signal.unit;
    if (!signal.names.empty()) column["values"] = signal.names;
    return column;
}

}  // namespace

std::string text_hash(std::string_view text) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    return fmt::format("{:016x}", hash);
}

CsvWriter::CsvWriter(std::string path, const TraceSetup& setup)
    : file_(path), path_(std::move(path)), signals_(setup.signals) {
    std::string header = "time,scan";
    for (const Signal& signal : signals_) header += "," + signal.name;
    file_.write(header + "\n");
    row_.resize((2 + signals_.size()) * longest_number);
}

void CsvWriter::rows(const std::uint64_t* words, std::size_t rows) {
    for (std::size_t row = 0; row < rows; ++row) {
        char* end = append_real(row_.data(), seconds(static_cast<std::int64_t>(*words++)));
        *end++ = ',';
        end = append_integer(end, static_cast<std::int64_t>(*words++));
        for (const Signal& signal : signals_) {
            *end++ = ',';
            end = append(end, signal.type, *words++);
        }
        *end++ = '\n';
        file_.write({row_.data(), static_cast<std::size_t>(end - row_.data())});
    }
    row_count_ += static_cast<std::int64_t>(rows);
}

std::string CsvWriter::finish(const std::string& title, const std::string& program_text) {
    if (!file_.commit() || !file_.is_regular()) return file_.error();
    nlohmann::ordered_json columns = nlohmann::ordered_json::array();
    columns.push_back({{"titles", "time"}, {"datatype", "double"}, {"unit", "s"}});
    columns.push_back({{"titles", "scan"}, {"datatype", "integer"}});
    for (const Signal& signal : signals_) columns.push_back(csvw_column(signal));
    const nlohmann::ordered_json metadata{{"@context", "http://www.w3.org/ns/csvw"},
                                          {"url", std::filesystem::path(path_).filename().string()},
                                          {"dc:title", title},
                                          {"lineshaft:version", version()},
                                          {"lineshaft:program", text_hash(program_text)},
                                          {"lineshaft:rows", row_count_},
                                          {"tableSchema", {{"columns", columns}}}};
    OutputFile sidecar(path_ + "-metadata.json");
    sidecar.write(metadata.dump(2) + "\n");
    sidecar.commit();
    return sidecar.error();
}

}  // namespace lineshaft
