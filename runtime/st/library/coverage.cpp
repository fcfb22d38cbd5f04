#include "runtime/st/library/coverage.hpp"

#include <algorithm>
#include <map>
#include <mutex>

#include <fmt/format.h>

namespace lineshaft::st {

namespace {

struct Counted {
    std::string name;
    int line = 0;
    std::uint64_t hits = 0;
};

/// By where it begins in the file; of a branch also by its number.
using Points = std::map<std::pair<std::uint32_t, std::uint32_t>, Counted>;

struct Collected {
    std::mutex mutex;
    std::atomic<bool> is_on = false;
    std::map<std::string, std::map<CoverPoint::Kind, Points>> files;
};

Collected& collected() {
    static Collected all;
    return all;
}

std::uint64_t hit(const auto& points) {
    return static_cast<std::uint64_t>(
        std::ranges::count_if(points, [](const auto& p) { return p.second.hits > 0; }));
}

std::string functions_text(const Points& points) {
    std::string text;
    for (const auto& [key, point] : points)
        text += fmt::format("FN:{},{}\n", point.line, point.name);
    for (const auto& [key, point] : points)
        text += fmt::format("FNDA:{},{}\n", point.hits, point.name);
    return text + fmt::format("FNF:{}\nFNH:{}\n", points.size(), hit(points));
}

/// A branch of what was never reached has '-'.
std::string branches_text(const Points& points) {
    std::string text;
    for (const auto& [key, point] : points) {
        const bool reached = std::ranges::any_of(points, [&, begin = key.first](const auto& other) {
            return other.first.first == begin && other.second.hits > 0;
        });
        text += fmt::format("BRDA:{},{},{},{}\n", point.line, key.first, key.second,
                            reached ? std::to_string(point.hits) : "-");
    }
    return text + fmt::format("BRF:{}\nBRH:{}\n", points.size(), hit(points));
}

/// A line was executed as often as that one of its statements that was executed most.
std::string lines_text(const Points& points) {
    std::map<int, Counted> lines;
    for (const auto& [key, point] : points) {
        Counted& line = lines[point.line];
        line.hits = std::max(line.hits, point.hits);
    }
    std::string text;
    for (const auto& [line, counted] : lines) text += fmt::format("DA:{},{}\n", line, counted.hits);
    return text + fmt::format("LF:{}\nLH:{}\n", lines.size(), hit(lines));
}

}  // namespace

void start_coverage() {
    collected().is_on = true;
}

bool is_covered() {
    return collected().is_on;
}

void record(const Code& code) {
    const std::lock_guard lock(collected().mutex);
    for (std::size_t i = 0; i < code.points.size(); ++i) {
        const CoverPoint& point = code.points[i];
        Counted& counted = collected().files[point.place.source->file->path][point.kind]
                                            [{point.place.begin, point.branch}];
        counted.name = point.name;
        counted.line = static_cast<int>(point.place.mark().line);
        counted.hits += code.hits[i].load();
    }
}

std::string lcov_text() {
    const std::lock_guard lock(collected().mutex);
    std::string text;
    for (auto& [path, kinds] : collected().files)
        text += fmt::format("TN:\nSF:{}\n{}{}{}end_of_record\n", path,
                            functions_text(kinds[CoverPoint::Kind::function]),
                            branches_text(kinds[CoverPoint::Kind::branch]),
                            lines_text(kinds[CoverPoint::Kind::statement]));
    return text;
}

}  // namespace lineshaft::st
