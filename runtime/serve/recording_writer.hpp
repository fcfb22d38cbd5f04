#pragma once

#include <condition_variable>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "runtime/scan/executive.hpp"

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
/// for no disk, but for a checkpoint: it notes how much of the recording there was.
class RecordingWriter : public Observer {
  public:
    /// Unless another one writes the file. Replaces it, or `goes_on` where a checkpoint will say.
    /// `meaning`: Meaning::in_force.
    RecordingWriter(std::string path, const std::string& program, const std::string& meaning,
                    bool goes_on);
    ~RecordingWriter() override;
    RecordingWriter(const RecordingWriter&) = delete;
    RecordingWriter& operator=(const RecordingWriter&) = delete;

    void append(std::string line);

    /// The machine was served until `time` [ns]. Nothing may follow.
    void finish(std::int64_t time);

    /// Empty when all is well. After the constructor, and after finish().
    const std::string& error() const { return error_; }

    void scanned(int, const Scan&) override {}
    void settled(std::int64_t, std::int64_t) override {}
    void save(StateWriter& out) const override;
    void restore(StateReader& in) override;

  private:
    void work();
    void write(const std::string& text);

    std::string path_, error_;
    int file_ = -1;
    mutable std::mutex mutex_;
    mutable std::condition_variable filled_, emptied_;
    std::string text_;
    std::int64_t appended_ = 0, written_ = 0;  ///< bytes
    bool ended_ = false;
    std::thread thread_;
};

}  // namespace lineshaft
