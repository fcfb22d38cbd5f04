#pragma once

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "runtime/model/state.hpp"

namespace lineshaft {

/// A file that appears under its name only when it is whole: written as `NAME.part`, then flushed
/// to the disk and renamed. While another process writes that part it is `NAME.part2`, and so on:
/// a part is locked (flock) while it is written, and taken over when its writer has gone. What has
/// been written when something goes wrong stays in the part. What exists and is no regular file (a
/// device, a pipe) is written to as it is, and `-` is the standard output.
class OutputFile {
  public:
    /// Goes on after the first `keep` bytes of what stays in `NAME.part`; an error if another
    /// process writes it.
    explicit OutputFile(std::string path, std::int64_t keep = 0);
    /// Goes on where the file ended at save(); what an earlier run wrote behind it goes. An error
    /// if neither its part nor NAME is that file.
    OutputFile(std::string path, StateReader& begun);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::string_view text);
    /// Hands what was written to the operating system, so that it stays if this program is killed.
    void flush();
    /// complete() and publish(): an OutputSet of one. False when any step failed: see error().
    bool commit();

    /// Nothing is to stay: the part goes.
    void discard();

    /// All is on the disk, in the part. False when any step failed.
    bool complete();
    /// Gives the complete part its name. False when that failed.
    bool publish();

    /// Flushes to the disk, and notes where the file ends and with what.
    void save(StateWriter& out);

    const std::string& path() const { return path_; }
    /// Where it is being written.
    std::string part() const { return path_ + suffix_; }

    /// False for a device or a pipe.
    bool is_regular() const { return regular_; }

    /// `cannot write 'x.csv': No space left on device`; empty while all is well.
    const std::string& error() const { return error_; }

    /// Whether there is an error. May be asked while another thread writes.
    bool failed() const { return failed_; }

  private:
    enum class Taken { yes, busy, failed };

    bool look();
    void open(std::int64_t keep);
    bool take_up(std::int64_t size, const std::string& tail);
    Taken take_part();
    void take_free_part();
    void open_stream(int descriptor, std::int64_t keep);
    void fail(const char* what);
    void set_error(std::string text);

    std::string path_;
    std::string suffix_ = ".part";
    bool regular_ = true;
    int descriptor_ = -1;  ///< of the part, until the stream has it
    std::FILE* file_ = nullptr;
    std::string error_;
    std::atomic<bool> failed_ = false;
};

}  // namespace lineshaft
