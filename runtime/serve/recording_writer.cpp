#include "runtime/serve/recording_writer.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "runtime/source/units.hpp"
#include "runtime/source/yaml_text.hpp"

namespace lineshaft {

namespace {

/// Exact when it is read again: decimals of up to 15 digits are.
std::string time_text(std::int64_t time) {
    constexpr std::int64_t short_enough = 1'000'000'000'000'000;
    return time < short_enough ? format_time(time) : fmt::format("{} ns", time);
}

constexpr std::string_view first_key = "lineshaft_recording:", no_entry = "entries:\n",
                           the_end = "end: true}\n";

std::string head_of(const Recorded& machine) {
    std::string head = fmt::format("{} 1\nprogram: {}\nmeaning: '{}'\n", first_key,
                                   yaml_quoted(machine.program), machine.meaning);
    if (!machine.retained.empty())
        head += fmt::format("retained: {}\n", yaml_quoted(machine.retained));
    return head + std::string(no_entry);
}

std::string value_text(const Change& change) {
    const Type type = change.kind == Change::Kind::set ? change.stimulus.type : change.force.type;
    return type == Type::enumeration ? yaml_name(change.text) : change.text;
}

}  // namespace

std::string recorded(std::int64_t time, std::span<const Change> changes) {
    const bool lifts = changes.front().kind == Change::Kind::lift_force;
    const char* const key = lifts                                         ? "release"
                            : changes.front().kind == Change::Kind::force ? "force"
                                                                          : "set";
    std::string list;
    for (const Change& change : changes) {
        if (!list.empty()) list += ", ";
        list += yaml_name(change.name);
        if (!lifts) list += ": " + value_text(change);
    }
    return fmt::format("- {{at: {}, {}: {}}}\n", time_text(time), key,
                       lifts ? "[" + list + "]" : "{" + list + "}");
}

RecordingWriter::RecordingWriter(World& world, std::string path, const Recorded& machine,
                                 bool goes_on, RecordSync sync)
    : world_(world), path_(std::move(path)), sync_(sync) {
    open(goes_on);
    if (!error_.empty()) return;
    if (!goes_on) begin(head_of(machine));
    if (!error_.empty()) return;
    try {
        thread_ = world_.start([this] { work(); });
    } catch (const std::system_error& error) {
        error_ = fmt::format("cannot write '{}': {}", path_, error.code().message());
    }
}

RecordingWriter::~RecordingWriter() {
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) world_.join(thread_);
}

/// The first file that may be taken: the one that is named, or `name.2.yaml`, `name.3.yaml`...
void RecordingWriter::open(bool goes_on) {
    constexpr int most = 1000;
    const std::filesystem::path first = path_;
    for (int number = 2; !take(path_, goes_on) && error_.empty(); ++number) {
        if (number > most) {
            error_ = fmt::format(
                "'{}' and {} files beside it are recordings of machines that were "
                "killed",
                first.string(), most - 1);
            return;
        }
        path_ = (first.parent_path() /
                 fmt::format("{}.{}{}", first.stem().string(), number, first.extension().string()))
                    .string();
    }
}

/// False when there is a recording that has not ended, or an error.
bool RecordingWriter::take(const std::string& path, bool goes_on) {
    constexpr std::size_t most = 4096;
    int error = 0;
    file_ = world_.open(path, !goes_on, error);
    if (!file_) {
        error_ = cannot_write(path_, error);
        return false;
    }
    if (file_->lock() != 0) {
        error_ = fmt::format("another lineshaft writes '{}'", path);
        return false;
    }
    const std::int64_t size = file_->size();
    if (goes_on || size == 0) return true;
    if (!file_->read(0, most).starts_with(first_key)) {
        error_ = fmt::format("'{}' is something else than a recording, and stays", path);
        return false;
    }
    const std::string end = file_->read(std::max<std::int64_t>(size - std::int64_t{most}, 0), most);
    if (!end.ends_with(the_end) && !end.ends_with(no_entry)) return false;
    if (const int failed = file_->truncate(0); failed != 0) error_ = cannot_write(path_, failed);
    return error_.empty();
}

/// Before there is a thread.
void RecordingWriter::begin(const std::string& text) {
    std::size_t written = 0;
    const int error = file_->append(text, written);
    if (error != 0) error_ = cannot_write(path_, error);
    appended_ = kept_ = std::ssize(text);
}

std::string RecordingWriter::error() const {
    const std::lock_guard lock(mutex_);
    return error_;
}

std::int64_t RecordingWriter::append(const std::string& line) {
    std::int64_t mark = 0;
    {
        const std::lock_guard lock(mutex_);
        text_ += line;
        mark = appended_ += std::ssize(line);
    }
    changed_.notify_all();
    return mark;
}

std::string RecordingWriter::keep(std::int64_t mark) {
    std::unique_lock lock(mutex_);
    world_.wait(lock, changed_, never, [&] { return kept_ >= mark || !error_.empty(); });
    return kept_ >= mark ? "" : error_;
}

void RecordingWriter::finish(std::int64_t time) {
    append(fmt::format("- {{at: {}, {}", time_text(time), the_end));
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) world_.join(thread_);
}

void RecordingWriter::save(StateWriter& out) const {
    std::unique_lock lock(mutex_);
    world_.wait(lock, changed_, never, [this] { return kept_ == appended_ || !error_.empty(); });
    out.put(appended_);
}

void RecordingWriter::restore(StateReader& in) {
    const std::lock_guard lock(mutex_);
    in.get(appended_);
    kept_ = appended_;
    if (file_->size() < appended_)
        error_ = fmt::format("'{}' is not the recording of the checkpoint", path_);
    else if (const int error = file_->truncate(appended_); error != 0)
        error_ = cannot_write(path_, error);
    is_broken_ = !error_.empty();
}

/// What could not be written is tried again when something more comes, and now and then. After a
/// flush that failed nobody knows what is on the disk.
void RecordingWriter::work() {
    constexpr std::int64_t pause = 100'000'000;
    std::string text;
    std::int64_t due = never;
    std::unique_lock lock(mutex_);
    for (bool is_last = false; !is_last && !is_broken_;) {
        world_.wait(lock, changed_, text.empty() ? due : world_.now() + pause,
                    [this] { return ended_ || !text_.empty(); });
        is_last = ended_;
        text += text_;
        text_.clear();
        lock.unlock();
        std::size_t count = 0;
        int error = text.empty() ? 0 : file_->append(text, count);
        text.erase(0, count);
        if (count > 0) due = std::min(due, later(world_.now(), sync_.within));
        if (due < never && (is_last || due <= world_.now())) {
            due = never;
            if (const int failed = file_->flush(); failed != 0) {
                is_broken_ = true;
                error = failed;
            }
        }
        lock.lock();
        error_ = error != 0 ? cannot_write(path_, error) : "";
        if (!is_broken_) kept_ += static_cast<std::int64_t>(count);
        changed_.notify_all();
    }
}

}  // namespace lineshaft
