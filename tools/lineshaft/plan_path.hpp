#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "blocks/group/path_table.hpp"
#include "blocks/path/path.hpp"
#include "tools/lineshaft/plan_cells.hpp"

namespace lineshaft {

extern const std::string_view path_help;

struct PathOptions {
    std::vector<std::string> limits;  ///< `V,A,J` of the path, then of the axes
    double deviation = 0;             ///< of rounded corners [u]
    double every = 0;                 ///< between samples [s]; 0: a row a path
};

/// `--path`, `--limits`, `--deviation`, `--every`.
void add_path_options(CLI::App& sub, PathOptions& options, bool& is_path);

/// The last word behind `--limits` is the input where it is a file; other words than limits are
/// refused by a CLI::ValidationError.
void take_limits(PathOptions& options, std::string& input);

/// Turns the lines of a file of points into rows: one a path, or one a sample.
class PathPlanner {
  public:
    PathPlanner(std::string file, const PathOptions& options);

    bool line(std::string_view text, bool too_long, std::string& rows);
    void finish(std::string& rows);
    bool has_header() const { return has_header_; }
    bool any_mistake() const { return lines_.any_mistake(); }

  private:
    std::string read_header(std::string_view text);
    std::string read_point(std::string_view text, PathTablePoint& point, double& path);
    std::string read_quantity(std::string_view cell, std::size_t column, double& value);
    void take(const PathTablePoint& point, double name, bool is_bad, std::string& rows);
    void begin(double name, const PathVector& start);
    void lay(std::string& rows);
    void append(const PathCurve& curve);
    void run(std::string& rows, std::uint64_t piece);
    bool takes_too_many_rows() const;
    void write_sample(double time, const PathMotion& motion, std::string& rows) const;
    void end(std::string& rows);

    bulk::CountedLines lines_;
    PathOptions options_;
    PathLimits limits_;
    std::vector<std::size_t> order_;                 ///< of the header's columns
    std::vector<std::optional<std::string>> units_;  ///< of the columns that have been read
    bool has_header_ = false;

    std::vector<PathPiece> ring_;
    Path path_;
    std::optional<double> name_;           ///< of the path under way
    std::vector<PathTablePoint> waiting_;  ///< those to come, and those that count for them
    std::size_t next_ = 0;                 ///< the first of those to come
    PathVector start_{}, from_{};
    PathFault fault_ = PathFault::none;
    bool has_bad_line_ = false, has_too_many_rows_ = false,
         lacks_limits_ = false;  ///< of the path under way
    std::size_t points_ = 0, samples_ = 0;
    double duration_ = 0;  ///< so far [s]
};

}  // namespace lineshaft
