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

#include "blocks/profile/any_state.hpp"
#include "blocks/profile/seven_segment.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/number_text.hpp"
#include "runtime/trace/output_file.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/plan_cells.hpp"
#include "tools/lineshaft/plan_path.hpp"

namespace lineshaft {

using namespace bulk;

namespace {

constexpr const char* plan_help =
    "The header says what is planned. Columns may stand in any order, units are the caller's: u,\n"
    "u/s, u/s^2, u/s^3. Blank lines aside, each line gives one row:\n\n"
    "Vs,Ve,Vm,A,J,L: seven-segment moves along a path\n"
    "  ok            1: planned; 0: cannot be planned, or a bad line: all other cells are empty\n"
    "  case          which ramps there are, and which of them hold the acceleration limit\n"
    "  equation      1 to 11, that gave the times\n"
    "  T1..T7        durations of the segments, jerk +J 0 -J 0 -J 0 +J\n"
    "  end_velocity  Ve, or what is reached at L if L is too short for Ve\n"
    "Cannot be planned: Vm, A or J not above 0, Vs or Ve outside of 0..Vm, L below 0, NaN or\n"
    "infinite numbers.\n\n"
    "p0,v0,a0,pf,vf,V,A,D,J[,Vmin][,T]: from any state to the position pf with velocity vf and\n"
    "acceleration 0, velocity in Vmin..V (without a cell -V..V), acceleration in -D..A, in the "
    "least\n"
    "time, or in the least feasible duration that is no less than T\n"
    "  row           number of the row, from 1\n"
    "  ok            1: planned; 0: not\n"
    "  error         why not: not_finite, limit_not_positive (V, A, D, J above 0, Vmin below),\n"
    "                velocity_above_limit (vf outside of Vmin..V), bad_line\n"
    "  T             duration of the motion\n"
    "  j1,t1,...     jerk and duration of each phase; cells after the last one are empty\n\n"
    "A bad line (cells missing, not a number) is reported on stderr as FILE:LINE: error: ...; the "
    "others\n"
    "are planned, and the exit code is 2.";

constexpr std::size_t most_columns = 11;

/// The cells of a line in the order of the form's columns.
struct Cells {
    std::array<double, most_columns> value{};
    std::array<bool, most_columns> given{};
};

/// One of the problems: the columns of its header, of which the last ones may be left out, and the
/// rows that it answers with.
struct RowForm {
    std::vector<std::string_view> columns;
    std::size_t needed;
    std::string output_header;
    void (*append)(std::string& rows, std::size_t row, const Cells* cells,
                   const PlanOptions& options);
};

struct PlanCommand {
    std::string input = "-";
    std::string output;
    PlanOptions options;
    PathOptions path;
    bool is_path = false;
};

void append_move(std::string& text, std::size_t, const Cells* cells, const PlanOptions&) {
    SevenSegmentPlan made;
    if (cells != nullptr) {
        const auto& [Vs, Ve, Vm, A, J, L, none1, none2, none3, none4, none5] = cells->value;
        if (plan(SevenSegment{Vs, Ve, Vm, A, J, L}, made) != PlanResult::ok) cells = nullptr;
    }
    if (cells == nullptr) {
        text += "0,,,,,,,,,,\n";
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

PlanResult plan_motion(const Cells& cells, const PlanOptions& options, MotionPlan& out) {
    const auto& [p0, v0, a0, pf, vf, V, A, D, J, Vmin, T] = cells.value;
    MotionLimits limits;
    const PlanResult result = limits.set(V, cells.given[9] ? Vmin : -V, A, D, J);
    if (result != PlanResult::ok) return result;
    const MotionState from{p0, v0, a0, 0};
    return cells.given[10] ? plan(limits, from, {pf, vf}, T, out, options)
                           : plan(limits, from, {pf, vf}, out, options);
}

void append_motion(std::string& text, std::size_t row, const Cells* cells,
                   const PlanOptions& options) {
    MotionPlan out;
    std::string_view error = "bad_line";
    if (cells != nullptr) {
        const PlanResult result = plan_motion(*cells, options, out);
        error = result == PlanResult::ok ? "" : name(result);
    }
    text += std::to_string(row);
    text += error.empty() ? ",1," : ",0,";
    text += error;
    if (error.empty())
        append_number(text, out.duration);
    else
        text += ',';
    for (std::size_t i = 0; i < out.count; ++i) {
        append_number(text, out.phases[i].start.jerk);
        append_number(text, out.phases[i].duration);
    }
    text.append(2 * (MotionPlan::most_phases - out.count), ',');
    text += '\n';
}

std::string motion_header() {
    std::string text = "row,ok,error,T";
    for (std::size_t i = 1; i <= MotionPlan::most_phases; ++i) text += fmt::format(",j{0},t{0}", i);
    return text + '\n';
}

const RowForm& move_form() {
    static const RowForm form{{"Vs", "Ve", "Vm", "A", "J", "L"},
                              6,
                              "ok,case,equation,T1,T2,T3,T4,T5,T6,T7,end_velocity\n",
                              append_move};
    return form;
}

const RowForm& motion_form() {
    static const RowForm form{{"p0", "v0", "a0", "pf", "vf", "V", "A", "D", "J", "Vmin", "T"},
                              9,
                              motion_header(),
                              append_motion};
    return form;
}

std::string column_names(const RowForm& form) {
    std::string text;
    for (std::size_t i = 0; i < form.columns.size(); ++i) {
        const bool left_out = i >= form.needed;
        text += (left_out ? "[, " : text.empty() ? "" : ", ") + std::string(form.columns[i]);
        if (left_out) text += ']';
    }
    return text;
}

std::string all_names() {
    return column_names(move_form()) + " or " + column_names(motion_form());
}

/// The form that a file's header names, and the order of its columns there.
struct Header {
    const RowForm* form = nullptr;
    std::vector<std::size_t> order;

    /// What is wrong with the line; empty when nothing is.
    std::string read(std::string_view line);
};

std::string Header::read(std::string_view line) {
    std::vector<std::string_view> cells;
    std::optional rest = line;
    while (const auto cell = next_cell(rest)) cells.push_back(*cell);
    const auto begins = motion_form().columns.begin();
    const bool motion = std::ranges::any_of(cells, [&](std::string_view cell) {
        return std::find(begins, begins + 5, cell) != begins + 5;
    });
    form = motion ? &motion_form() : &move_form();
    for (const std::string_view cell : cells) {
        const auto found = std::ranges::find(form->columns, cell);
        if (found == form->columns.end())
            return fmt::format("the column '{}' is not known; the header names {}", cell,
                               motion ? column_names(*form) : all_names());
        const auto column = static_cast<std::size_t>(found - form->columns.begin());
        if (std::ranges::find(order, column) != order.end())
            return fmt::format("two columns are called '{}'", cell);
        order.push_back(column);
    }
    for (std::size_t i = 0; i < form->needed; ++i)
        if (std::ranges::find(order, i) == order.end())
            return fmt::format("there is no column '{}'; the header names {}", form->columns[i],
                               column_names(*form));
    return {};
}

/// What is wrong with the line; empty when nothing is.
std::string read_cells(std::string_view line, const Header& header, Cells& cells) {
    std::optional rest = line;
    std::size_t count = 0;
    std::string mistake;
    while (const auto cell = next_cell(rest)) {
        if (count < header.order.size() && mistake.empty()) {
            const std::size_t column = header.order[count];
            cells.given[column] = !cell->empty() || column < header.form->needed;
            if (cells.given[column])
                mistake = read_number(*cell, header.form->columns[column], cells.value[column]);
        }
        ++count;
    }
    if (count != header.order.size())
        return fmt::format("the line has {} cells instead of {}", count, header.order.size());
    return mistake;
}

/// Turns the lines of one file into rows.
class Planner {
  public:
    Planner(std::string file, const PlanOptions& options)
        : lines_(std::move(file)), options_(options) {}

    /// One line, without its newline. False when no further line can be understood.
    bool line(std::string_view text, bool too_long, std::string& rows);
    /// Without a header there is nothing to plan.
    void finish(std::string& rows);
    bool has_header() const { return header_.form != nullptr; }
    bool any_mistake() const { return lines_.any_mistake(); }

  private:
    bool header(std::string_view text, std::string& rows);

    CountedLines lines_;
    PlanOptions options_;
    Header header_;
    std::size_t row_ = 0;
};

bool Planner::line(std::string_view text, bool too_long, std::string& rows) {
    text = lines_.take(text);
    if (!too_long && trimmed(text, blanks).empty()) return true;
    if (!has_header()) return header(text, rows);
    Cells cells;
    const std::string wrong = too_long
                                  ? fmt::format("the line has {} characters or more", longest_line)
                                  : read_cells(text, header_, cells);
    if (!wrong.empty()) lines_.mistake(wrong);
    header_.form->append(rows, ++row_, wrong.empty() ? &cells : nullptr, options_);
    return true;
}

bool Planner::header(std::string_view text, std::string& rows) {
    Header read;
    if (const std::string wrong = read.read(text); !wrong.empty()) {
        lines_.mistake(wrong);
        return false;
    }
    header_ = std::move(read);
    rows += header_.form->output_header;
    return true;
}

void Planner::finish(std::string&) {
    if (has_header() || lines_.any_mistake()) return;
    lines_.mistake_of_header("the header is missing; the first line names " + all_names());
}

template <class Planner>
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
        while (lines.next(line, too_long, got == Lines::Read::end)) {
            if (!planner.line(line, too_long, rows)) return Exit::wrong;
            if (interrupt_requested) return Exit::interrupted;
        }
        sink.write(rows);
        sink.flush();
        if (!sink.error().empty()) break;
    }
    rows.clear();
    planner.finish(rows);
    if (interrupt_requested) return Exit::interrupted;
    sink.write(rows);
    return planner.any_mistake() ? Exit::wrong : Exit::fine;
}

template <class Planner>
Exit plan_file(InputFile& file, Planner& planner, const PlanCommand& command) {
    Lines lines(file);
    OutputFile sink(command.output.empty() ? "-" : command.output);
    const Exit result = plan_lines(lines, planner, sink);
    if (!planner.has_header()) sink.discard();
    if (!planner.has_header() || (result != Exit::fine && result != Exit::wrong)) return result;
    sink.commit();
    if (sink.error().empty()) return result;
    spdlog::error("{}", sink.error());
    return Exit::fault;
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
    const std::string name = standard_input ? "stdin" : command.input;
    if (command.is_path) {
        PathPlanner planner(name, command.path);
        return plan_file(file, planner, command);
    }
    Planner planner(name, command.options);
    return plan_file(file, planner, command);
}

}  // namespace

void add_plan(CLI::App& app, Exit& result) {
    auto command = std::make_shared<PlanCommand>();
    CLI::App* sub = app.add_subcommand(
        "plan",
        "Plan motions in bulk, CSV -> CSV: seven-segment moves, or from any state to a goal");
    sub->add_option("input", command->input, "The CSV file; - is the standard input")
        ->capture_default_str();
    sub->add_option("-o,--output", command->output, "Write here instead of to the standard output")
        ->type_name("FILE");
    PlanOptions& options = command->options;
    sub->add_flag_callback(
        "--soonest", [&options] { options.entry = Entry::soonest; },
        "Bring a state outside its limits back as soon as possible, not tangentially; it may "
        "arrive later");
    sub->add_option("--tolerance", options.tolerance,
                    "How near the end of the direct ramp counts as the goal")
        ->type_name("ULP")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    add_path_options(*sub, command->path, command->is_path);
    sub->footer(std::string(plan_help) + std::string(path_help));
    sub->callback([command, &result] {
        take_limits(command->path, command->input);
        result = execute(*command);
    });
}

}  // namespace lineshaft
