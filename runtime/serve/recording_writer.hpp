#pragma once

#include <condition_variable>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "runtime/net/machine.hpp"

namespace lineshaft {

/// What comes from outside, checked: text as a program has it, and what it means.
struct Change {
    enum class Kind : std::uint8_t { set, force, release };

    Kind kind = Kind::set;
    std::string name, text;     ///< of the signal; of the value
    Stimulus stimulus = {};     ///< of set
    Force force = {};           ///< of force
    std::byte* live = nullptr;  ///< of release
};

/// An entry of a recording: changes of one kind that count from `time` [ns] on.
std::string recorded(std::int64_t time, std::span<const Change> changes);

/// Writes a recording (see recording_form.hpp) as it comes: a thread of its own hands each entry
/// to the disk, so that a machine that is killed leaves what it had and the machine's thread waits
/// for no disk.
class RecordingWriter {
  public:
    /// Replaces the file, unless another one writes it. `meaning`: Meaning::in_force.
    RecordingWriter(std::string path, const std::string& program, const std::string& meaning);
    ~RecordingWriter();
    RecordingWriter(const RecordingWriter&) = delete;
    RecordingWriter& operator=(const RecordingWriter&) = delete;

    void append(std::string line);

    /// The machine was served until `time` [ns]. Nothing may follow.
    void finish(std::int64_t time);

    /// Empty when all is well. After the constructor, and after finish().
    const std::string& error() const { return error_; }

  private:
    void work();
    void write(const std::string& text);

    std::string path_, error_;
    int file_ = -1;
    std::mutex mutex_;
    std::condition_variable filled_;
    std::string text_;
    bool ended_ = false;
    std::thread thread_;
};

}  // namespace lineshaft
