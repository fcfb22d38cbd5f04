#include "runtime/debug/data_breakpoints.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

namespace lineshaft::debug {

namespace {

/// Whether variables at `at` begin anew with each call of what runs there.
bool is_of_call(const Frame& frame, const std::byte* at) {
    const st::Routine& routine = *frame.routine;
    const bool is_body = !routine.owner && !routine.is_function();
    const std::byte* const begin =
        frame.base + 8 * std::size_t{is_body ? routine.temps_begin : routine.first};
    return at >= begin && at < frame.base + 8 * std::size_t{routine.variables_end};
}

bool is_aside(const Frame& frame, const std::byte* at) {
    return frame.aside && at >= frame.aside && at < frame.aside + 8 * std::size_t{frame.of->kept()};
}

std::optional<std::pair<std::size_t, std::size_t>> read_id(std::string_view id) {
    std::size_t first = 0, bytes = 0;
    const char* const end = id.data() + id.size();
    const auto colon = std::from_chars(id.data(), end, first);
    if (colon.ec != std::errc() || colon.ptr == end || *colon.ptr != ':') return {};
    const auto last = std::from_chars(colon.ptr + 1, end, bytes);
    if (last.ec != std::errc() || last.ptr != end) return {};
    return std::pair(first, bytes);
}

}  // namespace

std::string DataBreakpoints::id_of(const Shown& shown, const std::vector<Frame>& frames) const {
    const auto is_in_call = [&](const Frame& frame) {
        return is_of_call(frame, shown.at) || is_aside(frame, shown.at);
    };
    const std::byte* const memory = machine_.memory.data();
    const bool is_inside = shown.at && shown.bytes > 0 && shown.at >= memory &&
                           shown.at < memory + machine_.memory.size();
    if (!is_inside || std::ranges::any_of(frames, is_in_call)) return {};
    return fmt::format("{}:{}", shown.at - memory, shown.bytes);
}

std::vector<DataBreakpoints::Placed> DataBreakpoints::set(const std::vector<std::string>& ids) {
    watched_.clear();
    std::vector<Placed> placed;
    for (const std::string& id : ids) {
        const auto place = read_id(id);
        const std::size_t size = machine_.memory.size();
        if (!place || place->first >= size || place->second > size - place->first) {
            placed.push_back({.error = fmt::format("'{}' names no variable of this program", id)});
            continue;
        }
        placed.push_back({++last_number_});
        watched_.push_back({last_number_, place->first, place->second});
    }
    begin();
    return placed;
}

void DataBreakpoints::begin() {
    for (Watched& watched : watched_) look(watched);
}

std::vector<int> DataBreakpoints::changed() {
    std::vector<int> numbers;
    for (Watched& watched : watched_)
        if (look(watched)) numbers.push_back(watched.number);
    return numbers;
}

/// Whether it is another value than when it was looked at last.
bool DataBreakpoints::look(Watched& watched) const {
    const auto begin = machine_.memory.begin() + static_cast<std::ptrdiff_t>(watched.first);
    const auto end = begin + static_cast<std::ptrdiff_t>(watched.bytes);
    if (std::equal(begin, end, watched.seen.begin(), watched.seen.end())) return false;
    watched.seen.assign(begin, end);
    return true;
}

}  // namespace lineshaft::debug
