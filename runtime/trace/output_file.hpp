#pragma once

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "runtime/model/state.hpp"

namespace lineshaft {

/// A file that appears under its name only when it is whole: written as `NAME.part`, then flushed
/// to the disk and renamed. What has been written when something goes wrong stays in `NAME.part`.
/// What exists and is no regular file (a device, a pipe) is written to as it is.
class OutputFile {
  public:
    /// Goes on after the first `keep` bytes of what stays in `NAME.part`.
    explicit OutputFile(std::string path, std::int64_t keep = 0);
    /// Goes on where the file ended at save(); what an earlier run wrote behind it goes. An error
    /// if neither `NAME.part` nor NAME is that file.
    OutputFile(std::string path, StateReader& begun);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::string_view text);
    /// Hands what was written to the operating system, so that it stays if this program is killed.
    void flush();
    /// False when any step failed: see error().
    bool commit();

    /// Flushes to the disk, and notes where the file ends and with what.
    void save(StateWriter& out);

    /// False for a device or a pipe.
    bool is_regular() const { return regular_; }

    /// `cannot write 'x.csv': No space left on device`; empty while all is well.
    const std::string& error() const { return error_; }

    /// Whether there is an error. May be asked while another thread writes.
    bool failed() const { return failed_; }

  private:
    bool look();
    bool take_up(std::int64_t size, const std::string& tail);
    void open(std::int64_t keep);
    void fail(const char* what);
    void set_error(std::string text);

    std::string path_;
    std::string part_;
    bool regular_ = true;
    std::FILE* file_ = nullptr;
    std::string error_;
    std::atomic<bool> failed_ = false;
};

}  // namespace lineshaft
