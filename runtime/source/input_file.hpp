#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>

namespace lineshaft {

/// Set by SIGINT and SIGTERM: whoever runs or waits for input ends.
extern std::atomic<bool> interrupt_requested;

/// The bytes of a file, or of a pipe that is waited for until `interrupt_requested`.
class InputFile {
  public:
    /// Does not wait for the other end of a pipe.
    explicit InputFile(const std::string& path);
    /// Reads a descriptor that stays open, such as the standard input.
    explicit InputFile(int descriptor);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    /// As many bytes as there are now, at most `size`; 0 at the end, and after an error.
    std::size_t read(char* to, std::size_t size);

    bool is_ended() const { return ended_; }
    /// An errno, 0 while all is well; EINTR: interrupted.
    int error() const { return error_; }

  private:
    bool wait();

    int descriptor_;
    bool owned_ = false;
    bool waits_ = false;  ///< a regular file has its bytes
    bool ended_ = false;
    int error_ = 0;
};

/// Whether a regular file, by whatever name, is one that an InputFile of this process was opened
/// for.
bool was_read(const std::string& path);

/// From now on read_bytes() gives these for a file, whatever its name, be it there or not: the text
/// that an editor has open. Empty: those of the disk again. Not while another thread reads.
void lay_over(const std::string& path, std::optional<std::string> bytes);

/// All bytes of a file, at most `most`; `error` is an errno, or 0.
std::string read_bytes(const std::string& path, std::size_t most, int& error);

}  // namespace lineshaft
