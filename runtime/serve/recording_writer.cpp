#include "runtime/serve/recording_writer.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "runtime/source/units.hpp"

namespace lineshaft {

namespace {

/// Exact when it is read again: decimals of up to 15 digits are.
std::string time_text(std::int64_t time) {
    constexpr std::int64_t short_enough = 1'000'000'000'000'000;
    return time < short_enough ? format_time(time) : fmt::format("{} ns", time);
}

std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out.append(c == '\'' ? 2 : 1, c);
    return out + "'";
}

/// A name in braces or brackets, in quotes where it is not letters alone or a word of YAML's.
std::string name_text(const std::string& name) {
    constexpr std::string_view letters =
        "_.0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    const bool is_plain = name.find_first_not_of(letters) == std::string::npos &&
                          name.find_first_of(letters.substr(12)) != std::string::npos;
    static constexpr std::string_view words[] = {"null", "true", "false", "nan", "inf"};
    const bool is_word = std::ranges::any_of(
        words, [&](std::string_view word) { return same_letters(name, word); });
    return is_plain && !is_word ? name : quoted(name);
}

std::string value_text(const Change& change) {
    const Type type =
        change.kind == Change::Kind::set ? change.stimulus.type : change.force.type;
    return type == Type::enumeration ? name_text(change.text) : change.text;
}

}  // namespace

std::string recorded(std::int64_t time, std::span<const Change> changes) {
    const bool releases = changes.front().kind == Change::Kind::release;
    const char* const key = releases                                      ? "release"
                            : changes.front().kind == Change::Kind::force ? "force"
                                                                          : "set";
    std::string list;
    for (const Change& change : changes) {
        if (!list.empty()) list += ", ";
        list += name_text(change.name);
        if (!releases) list += ": " + value_text(change);
    }
    return fmt::format("- {{at: {}, {}: {}}}\n", time_text(time), key,
                       releases ? "[" + list + "]" : "{" + list + "}");
}

RecordingWriter::RecordingWriter(std::string path, const std::string& program,
                                 const std::string& meaning, bool goes_on)
    : path_(std::move(path)) {
    file_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC | (goes_on ? 0 : O_CREAT), 0666);
    if (file_ < 0) {
        error_ = fmt::format("cannot write '{}': {}", path_, std::strerror(errno));
        return;
    }
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0 || (!goes_on && ::ftruncate(file_, 0) != 0)) {
        error_ = fmt::format("another lineshaft writes '{}'", path_);
        return;
    }
    if (!goes_on)
        append(fmt::format("lineshaft_recording: 1\nprogram: {}\nmeaning: '{}'\nentries:\n",
                           quoted(program), meaning));
    thread_ = std::thread([this] { work(); });
}

RecordingWriter::~RecordingWriter() {
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
    }
    filled_.notify_one();
    if (thread_.joinable()) thread_.join();
    if (file_ >= 0) ::close(file_);
}

void RecordingWriter::append(std::string line) {
    {
        const std::lock_guard lock(mutex_);
        text_ += line;
        appended_ += std::ssize(line);
    }
    filled_.notify_one();
}

void RecordingWriter::finish(std::int64_t time) {
    append(fmt::format("- {{at: {}, end: true}}\n", time_text(time)));
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
    }
    filled_.notify_one();
    if (thread_.joinable()) thread_.join();
}

void RecordingWriter::save(StateWriter& out) const {
    std::unique_lock lock(mutex_);
    emptied_.wait(lock, [this] { return written_ == appended_; });
    out.put(appended_);
}

void RecordingWriter::restore(StateReader& in) {
    const std::lock_guard lock(mutex_);
    in.get(appended_);
    written_ = appended_;
    if (::lseek(file_, 0, SEEK_END) < appended_)
        error_ = fmt::format("'{}' is not the recording of the checkpoint", path_);
    else if (::ftruncate(file_, appended_) != 0 || ::lseek(file_, appended_, SEEK_SET) < 0)
        error_ = fmt::format("cannot write '{}': {}", path_, std::strerror(errno));
}

void RecordingWriter::work() {
    std::string text;
    std::unique_lock lock(mutex_);
    while (true) {
        filled_.wait(lock, [this] { return ended_ || !text_.empty(); });
        if (text_.empty()) return;
        text.swap(text_);
        lock.unlock();
        write(text);
        lock.lock();
        written_ += std::ssize(text);
        text.clear();
        emptied_.notify_all();
    }
}

void RecordingWriter::write(const std::string& text) {
    for (std::size_t done = 0; done < text.size() && error_.empty();) {
        const ssize_t written = ::write(file_, text.data() + done, text.size() - done);
        if (written >= 0)
            done += static_cast<std::size_t>(written);
        else if (errno != EINTR)
            error_ = fmt::format("cannot write '{}': {}", path_, std::strerror(errno));
    }
    ::fdatasync(file_);
}

}  // namespace lineshaft
