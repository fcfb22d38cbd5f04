#pragma once

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace lineshaft {

/// A file that appears under its name only when it is whole: written as `NAME.part`, then flushed
/// to the disk and renamed. What has been written when something goes wrong stays in `NAME.part`.
/// What exists and is no regular file (a device, a pipe) is written to as it is.
class OutputFile {
  public:
    /// Goes on after the first `keep` bytes of what stays in `NAME.part`.
    explicit OutputFile(std::string path, std::int64_t keep = 0);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::string_view text);
    /// Hands what was written to the operating system, so that it stays if this program is killed.
    void flush();
    /// False when any step failed: see error().
    bool commit();

    /// False for a device or a pipe.
    bool is_regular() const { return regular_; }

    /// `cannot write 'x.csv': No space left on device`; empty while all is well.
    const std::string& error() const { return error_; }

    /// Whether there is an error. May be asked while another thread writes.
    bool failed() const { return failed_; }

  private:
    void fail(const char* what);

    std::string path_;
    std::string part_;
    bool regular_ = true;
    std::FILE* file_ = nullptr;
    std::string error_;
    std::atomic<bool> failed_ = false;
};

}  // namespace lineshaft
