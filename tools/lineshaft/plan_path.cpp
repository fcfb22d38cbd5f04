#include "tools/lineshaft/plan_path.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "blocks/group/axes_group.hpp"
#include "blocks/path/path_cubic.hpp"
#include "runtime/source/input_file.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/units.hpp"
#include "tools/lineshaft/plan_cells.hpp"

namespace lineshaft {

using namespace bulk;

namespace {

constexpr std::array<std::string_view, 11> columns = {
    "path",      "curve",     "position1", "position2", "position3", "position4",
    "position5", "position6", "border1",   "border2",   "border3"};
constexpr std::size_t path_column = 0, curve_column = 1, first_position = 2, first_border = 8;
constexpr double none = 1e300;

std::string_view text_of(PathFault fault) {
    switch (fault) {
        case PathFault::none:
            return "";
        case PathFault::not_finite:
            return "not_finite";
        case PathFault::no_length:
            return "no_length";
        case PathFault::no_arc:
            return "no_arc";
        case PathFault::limit_not_positive:
            return "limit_not_positive";
        case PathFault::not_joined:
            return "not_joined";
        case PathFault::full:
            return "full";
    }
    return "";
}

/// `V,A,J`; empty where it is not that.
std::optional<PathLimit> limit_of(std::string_view text) {
    std::array<double, 3> value{};
    std::optional rest = text;
    for (double& x : value) {
        const auto cell = next_cell(rest);
        if (!cell || !read_number(*cell, "", x).empty()) return {};
    }
    const PathLimit limit{value[0], value[1], value[2]};
    if (rest || !is_good(limit)) return {};
    return limit;
}

/// An empty cell is a line.
std::string read_curve(std::string_view cell, PathPointKind& kind) {
    const auto found = std::ranges::find(path_point_kind_names, cell);
    if (!cell.empty() && found == std::end(path_point_kind_names))
        return fmt::format("the curve '{}' is not line, arc, spline or cubic", cell);
    if (!cell.empty()) kind = static_cast<PathPointKind>(found - std::begin(path_point_kind_names));
    return {};
}

PathLimits limits_of(const std::vector<std::string>& texts) {
    PathLimits limits;
    limits.path = limit_of(texts.front()).value_or(PathLimit{});
    limits.axes.fill({none, none, none});
    for (std::size_t i = 0; i < limits.axes.size() && texts.size() > 1; ++i)
        limits.axes[i] = limit_of(texts[std::min(i + 1, texts.size() - 1)]).value_or(PathLimit{});
    return limits;
}

/// Where a path stands that leads nowhere.
PathMotion at_rest(const PathVector& position) {
    PathMotion made{};
    made.position = position;
    return made;
}

/// A finite number above 0, or not below it.
CLI::Validator number_above_zero(bool may_be_zero) {
    const auto refuse = [may_be_zero](const std::string& text) {
        double value = 0;
        const bool fits =
            read_number(text, "", value).empty() && (value > 0 || (may_be_zero && value == 0));
        return fits ? std::string()
                    : fmt::format("'{}' is not a number {}", text,
                                  may_be_zero ? "that is 0 or above" : "above 0");
    };
    return CLI::Validator(refuse, "");
}

}  // namespace

const std::string_view path_help =
    "\n\nposition1,position2[,...,position6][,curve][,border1..border3][,path], with --path: "
    "points\n"
    "of a path in the space of the axes, the first one its start. curve is line, arc (through the\n"
    "border), spline (of degree five) or cubic; rows of one number in the column path are one "
    "path.\n"
    "Numbers may have a unit, the same one in all rows of a column. A path with a line that "
    "cannot\n"
    "be read is not planned: bad_line; nor is one on which axes 4 to 6 move alone, if --limits "
    "has\n"
    "none of axes: no_limits_of_axes. The motion is that of MC_MovePath. A row each:\n"
    "  path,ok,error,points,pieces,length,duration\n"
    "or with --every one each so many seconds, and one at the instant at which the path ends:\n"
    "  path,time,distance,velocity,acceleration,jerk,position1..position6";

void add_path_options(CLI::App& sub, PathOptions& options, bool& is_path) {
    CLI::Option* path =
        sub.add_flag("--path", is_path, "Plan along paths through points; see below");
    CLI::Option* limits =
        sub.add_option(
               "--limits", options.limits,
               "Velocity, acceleration and jerk: the first time along the path, the second "
               "time those of axis 1, then of axis 2 and so on; the last one counts for all "
               "further axes")
            ->type_name("V,A,J")
            ->expected(1, static_cast<int>(most_path_axes) + 1)
            ->delimiter('\0')
            ->needs(path);
    path->needs(limits);
    sub.add_option("--deviation", options.deviation, "Round corners within so much of the curves")
        ->type_name("U")
        ->check(number_above_zero(true))
        ->needs(path);
    sub.add_option("--every", options.every, "A row each so many seconds along the path")
        ->type_name("S")
        ->check(number_above_zero(false))
        ->needs(path);
}

void take_limits(PathOptions& options, std::string& input) {
    std::vector<std::string>& limits = options.limits;
    if (limits.size() > 1 && input == "-" && !limit_of(limits.back()) &&
        std::filesystem::exists(limits.back())) {
        input = limits.back();
        limits.pop_back();
    }
    for (const std::string& text : limits)
        if (!limit_of(text))
            throw CLI::ValidationError(
                "--limits", fmt::format("'{}' is not V,A,J, three numbers above 0", text));
}

PathPlanner::PathPlanner(std::string file, const PathOptions& options)
    : lines_(std::move(file)),
      options_(options),
      limits_(limits_of(options.limits)),
      ring_(AxesGroup::look_ahead) {}

bool PathPlanner::line(std::string_view text, bool too_long, std::string& rows) {
    text = lines_.take(text);
    if (!too_long && trimmed(text, blanks).empty()) return true;
    if (!has_header_) {
        const std::string wrong = too_long ? "the line is too long" : read_header(text);
        if (!wrong.empty()) lines_.mistake(wrong);
        has_header_ = wrong.empty();
        if (has_header_)
            rows += options_.every > 0
                        ? "path,time,distance,velocity,acceleration,jerk,position1,position2,"
                          "position3,position4,position5,position6\n"
                        : "path,ok,error,points,pieces,length,duration\n";
        return has_header_;
    }
    PathTablePoint point;
    double name = name_.value_or(1);
    const std::string wrong = too_long
                                  ? fmt::format("the line has {} characters or more", longest_line)
                                  : read_point(text, point, name);
    if (!wrong.empty()) lines_.mistake(wrong);
    if (name_ && *name_ != name) end(rows);
    take(point, name, !wrong.empty(), rows);
    return true;
}

/// A path with a line that cannot be read would be another one without it.
void PathPlanner::take(const PathTablePoint& point, double name, bool is_bad, std::string& rows) {
    const bool begins = !name_;
    if (begins) begin(name, point.target());
    has_bad_line_ = has_bad_line_ || is_bad;
    if (!is_bad) ++points_;
    if (begins || has_bad_line_) return;
    waiting_.push_back(point);
    if (next_ + cubic_reach < waiting_.size()) lay(rows);
}

std::string PathPlanner::read_header(std::string_view text) {
    order_.clear();
    std::optional rest = text;
    while (const auto cell = next_cell(rest)) {
        const auto found = std::ranges::find(columns, *cell);
        if (found == columns.end())
            return fmt::format("the column '{}' is not known; the header names {}", *cell,
                               fmt::join(columns, ", "));
        const auto column = static_cast<std::size_t>(found - columns.begin());
        if (std::ranges::find(order_, column) != order_.end())
            return fmt::format("two columns are called '{}'", *cell);
        order_.push_back(column);
    }
    if (std::ranges::find(order_, first_position) == order_.end())
        return "there is no column 'position1'";
    return {};
}

/// A number with the unit that all numbers of its column have, or with none.
std::string PathPlanner::read_quantity(std::string_view cell, std::size_t column, double& value) {
    const bool is_word = !cell.empty() && std::isalpha(static_cast<unsigned char>(cell.back()));
    const std::size_t digit = cell.find_last_of("0123456789."),
                      end = cell.rfind(' ') != cell.npos ? cell.rfind(' ') : digit + 1;
    const bool has_unit = is_word && end != 0 && end < cell.size() &&
                          (cell[end] == ' ' || Unit::parse(std::string(cell.substr(end))));
    const std::string unit(has_unit ? trimmed(cell.substr(end), blanks) : "");
    units_.resize(columns.size());
    if (units_[column].value_or(unit) != unit)
        return fmt::format("'{}' in column {} has another unit than the rows above", cell,
                           columns[column]);
    units_[column] = unit;
    return read_number(has_unit ? trimmed(cell.substr(0, end), blanks) : cell, columns[column],
                       value);
}

/// Tells also of a line that is wrong which path it is of.
std::string PathPlanner::read_point(std::string_view text, PathTablePoint& point, double& path) {
    std::array<double, columns.size()> value{};
    value[path_column] = path;
    std::optional rest = text;
    std::size_t count = 0;
    std::string first_wrong;
    while (const auto cell = next_cell(rest)) {
        const std::size_t column = count < order_.size() ? order_[count] : columns.size();
        ++count;
        std::string wrong;
        if (column == curve_column)
            wrong = read_curve(*cell, point.kind);
        else if (column < first_border || (column < columns.size() && !cell->empty()))
            wrong = read_quantity(*cell, column, value[column]);
        if (first_wrong.empty()) first_wrong = wrong;
    }
    path = value[path_column];
    if (!first_wrong.empty()) return first_wrong;
    if (count != order_.size())
        return fmt::format("the line has {} cells instead of {}", count, order_.size());
    const double* const x = value.data() + first_position;
    std::copy(x, x + path_space, point.position.begin());
    std::copy(x + path_space, x + most_path_axes, point.rotary.begin());
    std::copy(x + most_path_axes, x + most_path_axes + path_space, point.border.begin());
    return {};
}

void PathPlanner::begin(double name, const PathVector& start) {
    name_ = name;
    from_ = start_ = start;
    has_bad_line_ = has_too_many_rows_ = lacks_limits_ = false;
    path_ = {};
    waiting_.clear();
    next_ = 0;
    fault_ = PathFault::none;
    points_ = samples_ = 0;
    duration_ = 0;
}

/// The next row that waits, as soon as there is room for it, as MC_MovePath does; those that count
/// for none behind it are forgotten.
void PathPlanner::lay(std::string& rows) {
    const std::size_t k = next_++;
    const bool is_spline = waiting_[k].kind >= PathPointKind::spline;
    const std::uint64_t needed = is_spline ? most_spline_parts : most_transition_parts;
    if (path_.count + needed + 1 > ring_.size()) run(rows, path_.count + needed + 1 - ring_.size());
    if (fault_ != PathFault::none || has_too_many_rows_ || interrupt_requested) return;
    PathRowCurves curves;
    std::size_t count = 0;
    const PathCurve* const before =
        path_.count > 0 ? &ring_[(path_.count - 1) % ring_.size()].curve : nullptr;
    fault_ = curves_of({waiting_, start_}, k, from_, before, curves, count);
    if (fault_ == PathFault::no_length) fault_ = PathFault::none, count = 0;
    for (std::size_t n = 0; n < count && fault_ == PathFault::none; ++n) append(curves[n]);
    from_ = waiting_[k].target();
    if (next_ < 4 * cubic_reach) return;
    const std::size_t forgotten = next_ - cubic_reach - 1;
    start_ = waiting_[forgotten - 1].target();
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(forgotten));
    next_ -= forgotten;
}

void PathPlanner::append(const PathCurve& curve) {
    PathJoint joint;
    joint.distance = PathJoint::any, joint.deviation = options_.deviation;
    PathLimits limits = limits_;
    if (!curve.is_in_space()) limits.path = no_path_limit;
    lacks_limits_ = !curve.is_in_space() && options_.limits.size() == 1;
    if (lacks_limits_) return void(fault_ = PathFault::limit_not_positive);
    fault_ = path_.append(ring_, curve, limits, joint);
}

/// To where a piece is entered, or to the end: from sample to sample.
void PathPlanner::run(std::string& rows, std::uint64_t piece) {
    const auto is_there = [&] { return path_.first >= piece || path_.finished(); };
    while (!is_there() && fault_ == PathFault::none && !interrupt_requested) {
        has_too_many_rows_ = takes_too_many_rows();
        if (has_too_many_rows_) return;
        const double sample = static_cast<double>(samples_) * options_.every;
        if (options_.every > 0 && !(duration_ < sample)) {
            path_.advance_to(ring_, 0, piece);
            write_sample(sample, path_.now(ring_), rows);
            ++samples_;
            continue;
        }
        const double most = options_.every > 0 ? sample - duration_ : Path::any_time;
        const double elapsed = path_.advance_to(ring_, most, piece);
        const bool is_sampled = options_.every > 0 && elapsed == most;
        duration_ = is_sampled ? sample : duration_ + elapsed;
        if (path_.lost || !std::isfinite(duration_)) fault_ = PathFault::not_finite;
    }
}

/// By what is planned: nobody has room for so many.
bool PathPlanner::takes_too_many_rows() const {
    constexpr double most_rows = 1e12;
    return options_.every > 0 &&
           duration_ + (path_.leg.duration() - path_.time) > most_rows * options_.every;
}

void PathPlanner::write_sample(double time, const PathMotion& m, std::string& rows) const {
    rows += fmt::format("{}", name_.value_or(1));
    append_number(rows, time);
    for (const double x : {m.way.position, m.way.velocity, m.way.acceleration, m.way.jerk})
        append_number(rows, x);
    for (const double x : m.position) append_number(rows, x);
    rows += '\n';
}

void PathPlanner::end(std::string& rows) {
    if (!name_) return;
    while (next_ < waiting_.size() && !has_bad_line_) lay(rows);
    if (!has_bad_line_) run(rows, Path::to_end);
    const bool ok = fault_ == PathFault::none && !has_bad_line_ && !has_too_many_rows_;
    const std::string_view why = has_bad_line_        ? "bad_line"
                                 : lacks_limits_      ? "no_limits_of_axes"
                                 : has_too_many_rows_ ? "it takes more than 1e12 rows"
                                                      : text_of(fault_);
    if (options_.every > 0 && ok && path_.finished())
        write_sample(duration_, path_.count > 0 ? path_.now(ring_) : at_rest(from_), rows);
    if (options_.every == 0) {
        rows += fmt::format("{},{},{},{},{}", *name_, ok ? 1 : 0, why, points_, path_.count);
        if (ok) {
            append_number(rows, path_.now(ring_).way.position);
            append_number(rows, duration_);
        } else {
            rows += ",,";
        }
        rows += '\n';
    } else if (!ok) {
        lines_.mistake(fmt::format("the path {} cannot be planned: {}", *name_, why));
    }
    name_.reset();
}

void PathPlanner::finish(std::string& rows) {
    if (has_header_) return end(rows);
    if (lines_.any_mistake()) return;
    lines_.mistake_of_header(
        "the header is missing; the first line names position1, position2, ...");
}

}  // namespace lineshaft
