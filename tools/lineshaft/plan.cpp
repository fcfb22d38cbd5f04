#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "blocks/profile/seven_segment.hpp"
#include "runtime/csv/number_text.hpp"
#include "runtime/trace/output_file.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

constexpr const char* plan_help =
    "One row of output for each line of input, blank lines aside:\n"
    "  ok            1: planned; 0: cannot be planned, or a bad line: all other cells are empty\n"
    "  case          which ramps there are, and which of them hold the acceleration limit\n"
    "  equation      1 to 11, that gave the times\n"
    "  T1..T7        durations of the segments, jerk +J 0 -J 0 -J 0 +J\n"
    "  end_velocity  Ve, or what is reached at L if L is too short for Ve\n"
    "Cannot be planned: Vm, A or J not above 0, Vs or Ve outside of 0..Vm, L below 0, NaN or\n"
    "infinite numbers. A bad line (cells missing, no number) is reported on stderr as\n"
    "FILE:LINE: error: ...; the others are planned, and the exit code is 2. Columns may stand in\n"
    "any order. Units are the caller's: u, u/s, u/s^2, u/s^3.";

constexpr std::string_view output_header = "ok,case,equation,T1,T2,T3,T4,T5,T6,T7,end_velocity\n";
constexpr std::string_view not_planned = "0,,,,,,,,,,\n";

constexpr std::size_t longest_line = 65536;

struct Column {
    std::string_view name;
    double SevenSegment::*member;
};

constexpr std::array columns{Column{"Vs", &SevenSegment::Vs}, Column{"Ve", &SevenSegment::Ve},
                             Column{"Vm", &SevenSegment::Vm}, Column{"A", &SevenSegment::A},
                             Column{"J", &SevenSegment::J},   Column{"L", &SevenSegment::L}};

struct PlanCommand {
    std::string input = "-";
    std::string output;
};

std::string column_names() {
    std::string text;
    for (const Column& c : columns) text += (text.empty() ? "" : ", ") + std::string(c.name);
    return text;
}

std::string_view without_blanks(std::string_view text) {
    constexpr const char* blanks = " \t\r";
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// A cell without blanks and quotes around it.
std::string_view bare(std::string_view cell) {
    cell = without_blanks(cell);
    if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return cell;
    return without_blanks(cell.substr(1, cell.size() - 2));
}

/// Takes the first cell off `rest`; nothing when there is none.
std::optional<std::string_view> next_cell(std::optional<std::string_view>& rest) {
    if (!rest) return {};
    const std::size_t comma = rest->find(',');
    const std::string_view cell = rest->substr(0, comma);
    if (comma == std::string_view::npos)
        rest.reset();
    else
        rest->remove_prefix(comma + 1);
    return bare(cell);
}

/// What is wrong with `cell` as a number; empty when nothing is.
std::string read_number(std::string_view cell, const Column& column, double& value) {
    if (cell.empty()) return fmt::format("column {} is empty", column.name);
    const bool plus = cell.size() > 1 && cell[0] == '+' && cell[1] != '-';
    const char* const end = cell.data() + cell.size();
    const auto [stop, error] = std::from_chars(cell.data() + (plus ? 1 : 0), end, value);
    if (error == std::errc::result_out_of_range && stop == end)
        return fmt::format("'{}' in column {} is beyond the range of numbers", cell, column.name);
    if (error != std::errc{} || stop != end)
        return fmt::format("'{}' in column {} is not a number", cell, column.name);
    return {};
}

/// The order of a file's columns.
struct Header {
    std::vector<const Column*> order;

    /// What is wrong with the line; empty when nothing is.
    std::string read(std::string_view line);
};

std::string Header::read(std::string_view line) {
    std::optional rest = line;
    while (const auto cell = next_cell(rest)) {
        const auto found = std::ranges::find(columns, *cell, &Column::name);
        if (found == columns.end())
            return fmt::format("unknown column '{}'; the header names {}", *cell, column_names());
        if (std::ranges::find(order, &*found) != order.end())
            return fmt::format("a second column '{}'", *cell);
        order.push_back(&*found);
    }
    for (const Column& c : columns)
        if (std::ranges::find(order, &c) == order.end())
            return fmt::format("no column '{}'; the header names {}", c.name, column_names());
    return {};
}

/// What is wrong with the line; empty when nothing is.
std::string read_problem(std::string_view line, const Header& header, SevenSegment& problem) {
    std::optional rest = line;
    std::size_t count = 0;
    std::string mistake;
    while (const auto cell = next_cell(rest)) {
        if (count < header.order.size() && mistake.empty()) {
            const Column& column = *header.order[count];
            mistake = read_number(*cell, column, problem.*column.member);
        }
        ++count;
    }
    if (count != columns.size())
        return fmt::format("{} cells instead of {}", count, columns.size());
    return mistake;
}

void append_number(std::string& text, double value) {
    std::array<char, longest_number> digits;
    text += ',';
    text.append(digits.data(), write_real(digits.data(), value));
}

void append_row(std::string& text, const SevenSegment& problem) {
    SevenSegmentPlan made;
    if (plan(problem, made) != PlanResult::ok) {
        text += not_planned;
        return;
    }
    text += "1,";
    text += name(made.kind);
    text += ',';
    text += std::to_string(equation(made.kind));
    for (const double T : made.T) append_number(text, T);
    append_number(text, made.end.velocity);
    text += '\n';
}

/// Turns the lines of one file into rows.
class Planner {
  public:
    explicit Planner(std::string file) : file_(std::move(file)) {}

    /// One line, without its newline. False when no further line can be understood.
    bool line(std::string_view text, bool too_long, std::string& rows);
    /// Without a header there is nothing to plan.
    void finish();
    bool has_header() const { return !header_.order.empty(); }
    bool any_mistake() const { return mistakes_; }

  private:
    bool header(std::string_view text, std::string& rows);
    void mistake(const std::string& what);

    std::string file_;
    Header header_;
    std::size_t number_ = 0;
    bool mistakes_ = false;
};

bool Planner::line(std::string_view text, bool too_long, std::string& rows) {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (++number_ == 1 && text.starts_with(byte_order_mark))
        text.remove_prefix(byte_order_mark.size());
    if (!too_long && without_blanks(text).empty()) return true;
    if (!has_header()) return header(text, rows);
    SevenSegment problem;
    const std::string wrong = too_long
                                  ? fmt::format("a line of {} characters or more", longest_line)
                                  : read_problem(text, header_, problem);
    if (wrong.empty()) {
        append_row(rows, problem);
    } else {
        mistake(wrong);
        rows += not_planned;
    }
    return true;
}

bool Planner::header(std::string_view text, std::string& rows) {
    Header read;
    if (const std::string wrong = read.read(text); !wrong.empty()) {
        mistake(wrong);
        return false;
    }
    header_ = std::move(read);
    rows += output_header;
    return true;
}

void Planner::finish() {
    if (has_header() || mistakes_) return;
    number_ = 1;
    mistake("no header; the first line names " + column_names());
}

void Planner::mistake(const std::string& what) {
    fmt::print(stderr, "{}:{}: error: {}\n", file_, number_, what);
    mistakes_ = true;
}

/// Reads what is there of a file or a pipe, and cuts it into lines, in constant memory. A line that
/// is too long is cut at its beginning.
class Lines {
  public:
    explicit Lines(InputFile& file) : file_(file), buffer_(longest_line, '\0') {}

    enum class Read { some, end, failed, interrupted };

    Read read();
    int error() const { return file_.error(); }  ///< an errno
    /// The next whole line of what has been read; at the end the last one, whatever ends it.
    bool next(std::string_view& line, bool& too_long, bool at_end);

  private:
    InputFile& file_;
    std::string buffer_;
    std::size_t begin_ = 0, end_ = 0;
    bool too_long_ = false;  ///< the line under way has lost its beginning
};

Lines::Read Lines::read() {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    if (end_ == buffer_.size()) {
        too_long_ = true;
        end_ = 1;  // at the end of the file there is still a line
    }
    const std::size_t count = file_.read(buffer_.data() + end_, buffer_.size() - end_);
    end_ += count;
    if (interrupt_requested) return Read::interrupted;
    if (file_.error() != 0) return Read::failed;
    return count == 0 ? Read::end : Read::some;
}

bool Lines::next(std::string_view& line, bool& too_long, bool at_end) {
    const std::string_view rest(buffer_.data() + begin_, end_ - begin_);
    const std::size_t newline = rest.find('\n');
    if (newline == std::string_view::npos && (!at_end || rest.empty())) return false;
    line = rest.substr(0, newline);
    begin_ = newline == std::string_view::npos ? end_ : begin_ + newline + 1;
    too_long = too_long_;
    too_long_ = false;
    return true;
}

Exit plan_lines(Lines& lines, Planner& planner, OutputFile& sink) {
    std::string rows;
    for (auto got = Lines::Read::some; got == Lines::Read::some;) {
        got = lines.read();
        if (got == Lines::Read::interrupted) return Exit::interrupted;
        if (got == Lines::Read::failed) {
            spdlog::error("cannot read: {}", std::strerror(lines.error()));
            return Exit::fault;
        }
        rows.clear();
        std::string_view line;
        bool too_long = false;
        while (lines.next(line, too_long, got == Lines::Read::end))
            if (!planner.line(line, too_long, rows)) return Exit::wrong;
        sink.write(rows);
        sink.flush();
        if (!sink.error().empty()) break;
    }
    planner.finish();
    return planner.any_mistake() ? Exit::wrong : Exit::fine;
}

Exit execute(const PlanCommand& command) {
    const bool standard_input = command.input == "-";
    if (std::filesystem::is_directory(command.input)) {
        spdlog::error("cannot read '{}': it is a directory", command.input);
        return Exit::wrong;
    }
    Diagnostics out;
    check_outputs({command.output}, {command.input}, out);
    if (!out.empty()) return report(out, false);
    InputFile file = standard_input ? InputFile(STDIN_FILENO) : InputFile(command.input);
    if (file.error() != 0) {
        spdlog::error("cannot open '{}': {}", command.input, std::strerror(file.error()));
        return Exit::wrong;
    }
    Lines lines(file);
    Planner planner(standard_input ? "stdin" : command.input);
    OutputFile sink(command.output.empty() ? "-" : command.output);
    const Exit result = plan_lines(lines, planner, sink);
    if (!planner.has_header() || (result != Exit::fine && result != Exit::wrong)) return result;
    sink.commit();
    if (sink.error().empty()) return result;
    spdlog::error("{}", sink.error());
    return Exit::fault;
}

}  // namespace

void add_plan(CLI::App& app, Exit& result) {
    auto command = std::make_shared<PlanCommand>();
    CLI::App* sub = app.add_subcommand(
        "plan", "Plan seven-segment moves in bulk: CSV with the columns Vs,Ve,Vm,A,J,L -> CSV");
    sub->add_option("input", command->input, "The CSV file; - is the standard input")
        ->capture_default_str();
    sub->add_option("-o,--output", command->output, "Write here instead of to the standard output")
        ->type_name("FILE");
    sub->footer(plan_help);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
