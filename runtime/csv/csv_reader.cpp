#include "runtime/csv/csv_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "runtime/csv/csv_cells.hpp"
#include "runtime/csv/csv_lines.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/utf8.hpp"
#include "runtime/source/yaml.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t most_mistakes = 20;
constexpr double exact_up_to = 9007199254740992.0;  // 2^53
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

std::string help_with(const CsvColumn& column) {
    if (column.type != Type::real) return fmt::format("the column is {}", name_of(column.type));
    if (column.names.empty()) return "leave the cell empty where there is no value";
    return fmt::format("write {}", fmt::join(column.names, ", "));
}

/// Grows by half, so that the old values and the new ones together take at most 20 bytes each.
void append(std::vector<double>& values, double value) {
    if (values.size() == values.capacity()) values.reserve(values.size() + values.size() / 2 + 1);
    values.push_back(value);
}

/// Whether a column of whole numbers may hold the value.
bool fits(const CsvColumn& column, Wide value) {
    return column.type != Type::boolean || value == 0 || value == 1;
}

class CsvReader {
  public:
    CsvReader(const std::string& path, Diagnostics& out, const CsvOptions& options)
        : path_(path), out_(out), options_(options), lines_(path) {}

    std::optional<CsvTable> read();

  private:
    bool is_yaml();
    bool header();
    void add_columns(const std::vector<std::string_view>& cells);
    bool is_title(std::string_view cell);
    CsvColumn column_of(std::string_view cell) const;
    void check_names(const std::vector<std::string_view>& cells);
    void select();
    void rows();
    void blank_rows(std::size_t next);
    void row();
    const char* cell(CsvColumn& column, const char* at, const char* end);
    void take(CsvColumn& column, Wide value, double rounded);
    void take(CsvColumn& column, double value);
    void odd_cell(CsvColumn& column, std::string_view cell);
    void end_of_rows();
    void drop_last_row();
    void check_file();

    /// A mistake in a part of the line under way.
    void fail(const char* code, std::string_view part, std::string message, std::string help = {});
    bool is_enough() const { return mistakes_ >= most_mistakes; }

    const std::string& path_;
    Diagnostics& out_;
    const CsvOptions& options_;
    CsvLines lines_;
    std::string_view line_;
    std::size_t number_ = 0;  ///< of the line
    std::size_t blank_ = 0;   ///< lines up to it that may be the last
    std::size_t mistakes_ = 0;
    char separator_ = ',';
    std::vector<CsvColumn*> order_;  ///< of the file's columns; null: not wanted
    std::unordered_map<std::string_view, const CsvMetadata::Column*> described_;  ///< by title
    std::shared_ptr<const SourceFile> shown_;  ///< the last line with a mistake, alone
    CsvTable table_;
};

std::optional<CsvTable> CsvReader::read() {
    const std::size_t before = out_.count();
    if (is_yaml()) return {};
    table_.metadata = read_metadata(path_, out_);
    if (lines_.next(line_) && header()) rows();
    check_file();
    table_.crc32 = lines_.checksum();
    if (out_.count() != before) return {};
    return std::move(table_);
}

/// Whether it is a program, say, for which its trace is often taken; that is told.
bool CsvReader::is_yaml() {
    struct Kind {
        std::string_view key, name, command;
    };
    static constexpr Kind kinds[] = {
        {"lineshaft:", "a program", "lineshaft run {} --trace out.csv"},
        {"lineshaft_study:", "a study", "lineshaft study {} --traces DIR"},
        {"lineshaft_fit:", "a fit", ""},
        {"lineshaft_controller:", "a controller", ""},
        {"lineshaft_recording:", "a recording", ""}};
    if (!path_.ends_with(".yaml") && !path_.ends_with(".yml")) return false;
    Diagnostics unread;
    const auto file = read_source(path_, unread);
    if (!file) return false;
    const auto kind =
        std::ranges::find_if(kinds, [&](const Kind& k) { return file->has_key(k.key); });
    if (kind == std::end(kinds)) return false;
    std::string command(kind->command);
    if (!command.empty()) command.replace(command.find("{}"), 2, path_);
    out_.add(code::no_columns, {file, 0, 0, 1}, fmt::format("this is {}, not a trace", kind->name),
             command.empty() ? "" : "a trace is written by: " + command);
    return true;
}

void CsvReader::check_file() {
    if (lines_.error() == EFBIG)
        return out_.add(
            code::row_of_another_length, {table_.header, 0, 0, 1},
            fmt::format("line {} has more than {} bytes", number_ + 1, CsvLines::longest));
    if (lines_.error() != 0)
        return out_.add(code::file_cannot_be_read, {},
                        fmt::format("cannot read '{}': {}", path_, std::strerror(lines_.error())));
    if (number_ == 0)
        out_.add(code::no_columns,
                 {std::make_shared<const SourceFile>(SourceFile{path_, ""}), 0, 0, 1},
                 "the file is empty", "the first line names the columns");
}

bool CsvReader::header() {
    ++number_;
    if (line_.starts_with(utf8_byte_order_mark)) line_.remove_prefix(utf8_byte_order_mark.size());
    table_.header = std::make_shared<const SourceFile>(SourceFile{path_, std::string(line_)});
    line_ = table_.header->text;
    if (table_.metadata)
        for (const CsvMetadata::Column& column : table_.metadata->columns)
            described_.emplace(column.title, &column);
    separator_ = separator_of(line_);
    const char* const end = line_.data() + line_.size();
    std::vector<std::string_view> cells;
    for (const char* at = line_.data(); !is_enough(); ++at) {
        const char* const stop = cell_end(at, end, separator_);
        if (is_title({at, stop})) cells.emplace_back(at, stop);
        at = stop;
        if (at == end) break;
    }
    if (!is_enough()) add_columns(cells);
    if (mistakes_ == 0) select();
    return mistakes_ == 0;
}

bool CsvReader::is_title(std::string_view cell) {
    const std::string title = unquoted(cell);
    double number = 0;
    if (!title.empty() && read_cell(title, number)) return true;
    fail(code::no_columns, cell,
         title.empty() ? "a column has no name"
                       : fmt::format("'{}' is not a name of a column", title),
         "the first line names the columns");
    return false;
}

void CsvReader::add_columns(const std::vector<std::string_view>& cells) {
    table_.columns.reserve(cells.size());
    for (const std::string_view cell : cells) table_.columns.push_back(column_of(cell));
    check_names(cells);
}

CsvColumn CsvReader::column_of(std::string_view cell) const {
    CsvColumn column;
    column.title = column.name = unquoted(cell);
    const std::size_t bracket = column.title.find(" [");
    if (bracket != std::string::npos && column.title.ends_with(']')) {
        column.unit = column.title.substr(bracket + 2, column.title.size() - bracket - 3);
        column.name = column.title.substr(0, bracket);
    }
    if (const auto it = described_.find(column.title); it != described_.end()) {
        const CsvMetadata::Column* known = it->second;
        column.name = known->signal;
        column.unit = known->unit;
        column.type = known->type;
        column.names = known->values;
        column.numbers = known->numbers;
    }
    for (const auto& [name, values] : options_.names)
        if (name == column.name) column.names = values;
    return column;
}

/// A column's name and its title are names of no other column. A set of them would take more
/// memory than the columns.
void CsvReader::check_names(const std::vector<std::string_view>& cells) {
    std::vector<std::pair<std::string_view, std::size_t>> names;
    names.reserve(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const CsvColumn& column = table_.columns[i];
        names.emplace_back(column.name, i);
        if (column.title != column.name) names.emplace_back(column.title, i);
    }
    std::ranges::sort(names);
    std::vector<std::size_t> again;
    for (std::size_t i = 1; i < names.size(); ++i)
        if (names[i].first == names[i - 1].first) again.push_back(names[i].second);
    std::ranges::sort(again);
    again.erase(std::unique(again.begin(), again.end()), again.end());
    for (std::size_t i = 0; i < again.size() && !is_enough(); ++i)
        fail(code::column_twice, cells[again[i]],
             fmt::format("two columns are called '{}'", table_.columns[again[i]].title));
}

void CsvReader::select() {
    order_.reserve(table_.columns.size());
    if (options_.columns.empty()) {
        for (CsvColumn& column : table_.columns) order_.push_back(&column);
        return;
    }
    std::vector<bool> wanted(table_.columns.size());
    for (const std::string& name : options_.columns)
        if (const CsvColumn* column = table_.require(name, out_))
            wanted[static_cast<std::size_t>(column - table_.columns.data())] = true;
        else
            ++mistakes_;
    std::vector<CsvColumn> kept;
    kept.reserve(static_cast<std::size_t>(std::ranges::count(wanted, true)));
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (wanted[i]) kept.push_back(std::move(table_.columns[i]));
        order_.push_back(wanted[i] ? &kept.back() : nullptr);
    }
    table_.columns = std::move(kept);
}

void CsvReader::rows() {
    while (lines_.next(line_)) {
        ++number_;
        if (trimmed(line_).empty()) {
            ++blank_;
            continue;
        }
        if (table_.rows + blank_ >= options_.most_rows)
            return out_.add(code::too_many_rows, {table_.header, 0, 0, 1},
                            fmt::format("more than {} rows do not fit into the memory that is "
                                        "allowed for them",
                                        options_.most_rows));
        blank_rows(number_);
        row();
        if (!is_enough()) continue;
        return out_.add(
            code::cell_is_no_number, {table_.header, 0, 0, 1},
            fmt::format("there are {} mistakes; the rest of the file is not read", mistakes_));
    }
    if (lines_.error() == 0 && mistakes_ == 0) end_of_rows();
}

/// Blank lines are rows where the line `next` is one, or where the sidecar counts them.
void CsvReader::blank_rows(std::size_t next) {
    const std::string_view line = std::exchange(line_, "");
    for (number_ = next - blank_; number_ < next && !is_enough(); ++number_) row();
    number_ = next;
    blank_ = 0;
    line_ = line;
}

void CsvReader::row() {
    const std::size_t before = mistakes_;
    const char* at = line_.data();
    const char* const end = at + line_.size();
    std::size_t count = 0;
    for (;; ++at) {
        CsvColumn* const column = count < order_.size() ? order_[count] : nullptr;
        at = column ? cell(*column, at, end) : cell_end(at, end, separator_);
        ++count;
        if (at == end || is_enough()) break;
    }
    ++table_.rows;
    const bool cut = !lines_.is_ended() && options_.last_row_may_be_cut;
    if (cut || mistakes_ != before || count == order_.size()) return;
    fail(lines_.is_ended() ? code::row_of_another_length : code::csv_is_not_whole, line_,
         fmt::format("the row has {} {} instead of {}{}", count, count == 1 ? "cell" : "cells",
                     order_.size(), lines_.is_ended() ? "" : ": the file is cut"),
         separator_ == ',' && count > order_.size()
             ? "with decimal commas, semicolons stand between the cells"
             : "");
}

/// Reads a cell into its column; where it ends.
const char* CsvReader::cell(CsvColumn& column, const char* at, const char* end) {
    if (column.type == Type::real) {
        double value = 0;
        const auto [stop, error] = std::from_chars(at, end, value);
        if (error == std::errc{} && (stop == end || *stop == separator_) && std::isfinite(value)) {
            append(column.values, value);
            return stop;
        }
    } else {
        std::int64_t value = 0;
        const auto [stop, error] = std::from_chars(at, end, value);
        if (error == std::errc{} && (stop == end || *stop == separator_) && fits(column, value)) {
            take(column, value, static_cast<double>(value));
            return stop;
        }
    }
    const char* const stop = cell_end(at, end, separator_);
    odd_cell(column, {at, stop});
    return stop;
}

void CsvReader::take(CsvColumn& column, Wide value, double rounded) {
    if (std::abs(rounded) >= exact_up_to) column.large.push_back({column.values.size(), value});
    append(column.values, rounded);
}

void CsvReader::take(CsvColumn& column, double value) {
    if (std::isnan(value)) column.not_numbers.push_back(column.values.size());
    append(column.values, value);
}

/// A name, empty, quoted, between blanks, with a decimal comma or a plus, not finite; or wrong.
void CsvReader::odd_cell(CsvColumn& column, std::string_view cell) {
    std::string text = unquoted(cell);
    if (separator_ == ';' && column.type == Type::real) std::ranges::replace(text, ',', '.');
    if (text.empty()) return append(column.values, missing);
    if (const auto named = std::ranges::find(column.names, text); named != column.names.end()) {
        const Wide number = column.number(static_cast<std::size_t>(named - column.names.begin()));
        return take(column, number, static_cast<double>(number));
    }
    const char* wrong = nullptr;
    if (column.type == Type::real) {
        double real = missing;
        wrong = read_cell(text, real);
        if (!wrong && (std::isfinite(real) || column.name != "time")) return take(column, real);
        if (!wrong) wrong = "is not a time";
    } else {
        std::int64_t with_sign = 0;
        std::uint64_t without = 0;
        wrong = read_cell(text, with_sign);
        if (wrong && !read_cell(text, without)) wrong = nullptr;
        const Wide whole = without > 0 ? Wide{without} : Wide{with_sign};
        if (!wrong && fits(column, whole)) return take(column, whole, static_cast<double>(whole));
        if (!wrong) wrong = "is not one of its values";
    }
    fail(code::cell_is_no_number, cell,
         fmt::format("'{}' in column '{}' {}", text, column.title, wrong), help_with(column));
    append(column.values, missing);
}

void CsvReader::end_of_rows() {
    const bool is_cut = !lines_.is_ended() && blank_ == 0 && number_ > 1;
    if (is_cut && options_.last_row_may_be_cut) drop_last_row();
    if (table_.metadata && table_.metadata->rows &&
        static_cast<std::size_t>(*table_.metadata->rows) == table_.rows + blank_)
        blank_rows(number_ + 1);
    if (options_.last_row_may_be_cut || !table_.metadata || !table_.metadata->rows) return;
    const auto due = static_cast<std::size_t>(*table_.metadata->rows);
    if (due == table_.rows && lines_.is_ended()) return;
    out_.add(code::csv_is_not_whole, {table_.header, 0, 0, 1},
             due == table_.rows ? "the file is cut: its last row has no end"
                                : fmt::format("the file has {} rows, where its sidecar tells of {}",
                                              table_.rows, due),
             "it is not the file that was recorded; remove the sidecar to read it all the same");
}

void CsvReader::drop_last_row() {
    --table_.rows;
    for (CsvColumn& column : table_.columns) {
        column.values.resize(table_.rows);
        if (!column.large.empty() && column.large.back().row == table_.rows)
            column.large.pop_back();
        if (!column.not_numbers.empty() && column.not_numbers.back() == table_.rows)
            column.not_numbers.pop_back();
    }
}

void CsvReader::fail(const char* code, std::string_view part, std::string message,
                     std::string help) {
    ++mistakes_;
    const std::string_view before =
        line_.substr(0, static_cast<std::size_t>(part.data() - line_.data()));
    if (!shown_ || shown_->first_line != static_cast<int>(number_))
        shown_ = std::make_shared<const SourceFile>(
            SourceFile{path_, std::string(line_), static_cast<int>(number_)});
    out_.add(code,
             {shown_, static_cast<int>(number_), static_cast<int>(count_characters(before)) + 1,
              std::max(1, static_cast<int>(count_characters(part)))},
             std::move(message), std::move(help));
}

}  // namespace

Wide CsvColumn::integer(std::size_t row) const {
    const auto it = std::ranges::lower_bound(large, row, {}, &Large::row);
    if (it != large.end() && it->row == row) return it->value;
    return is_missing(row) ? 0 : static_cast<std::int64_t>(values[row]);
}

const CsvColumn* CsvTable::find(std::string_view name) const {
    const auto it = std::ranges::find_if(
        columns, [&](const CsvColumn& c) { return c.name == name || c.title == name; });
    return it == columns.end() ? nullptr : &*it;
}

const CsvColumn* CsvTable::require(std::string_view name, Diagnostics& out, Mark where) const {
    if (const CsvColumn* column = find(name)) return column;
    std::vector<std::string> names;
    for (const CsvColumn& column : columns) names.push_back(column.name);
    if (!where.file) where = {header, 1, 1, static_cast<int>(count_characters(header->text))};
    out.add(code::unknown_column, std::move(where),
            fmt::format("'{}' has no column '{}'", header->path, name), suggest(name, names));
    return nullptr;
}

std::optional<CsvTable> read_csv(const std::string& path, Diagnostics& out,
                                 const CsvOptions& options) {
    return CsvReader(path, out, options).read();
}

}  // namespace lineshaft
