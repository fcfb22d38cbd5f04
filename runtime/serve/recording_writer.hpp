#pragma once

#include <span>
#include <string>

#include "runtime/scan/executive.hpp"
#include "runtime/serve/world.hpp"

namespace lineshaft {

/// What comes from outside, checked: text as a program has it, and what it means.
struct Change {
    enum class Kind : std::uint8_t { set, force, lift_force };

    Kind kind = Kind::set;
    std::string name, text;     ///< of the signal; of the value
    Stimulus stimulus = {};     ///< of set
    Force force = {};           ///< of force
    std::byte* live = nullptr;  ///< of lift_force
};

/// An entry of a recording: changes of one kind that count from `time` [ns] on.
std::string recorded(std::int64_t time, std::span<const Change> changes);

/// How soon what is recorded is on the disk, and not only in the system's memory, which outlives
/// this program, but not a power failure.
struct RecordSync {
    static constexpr std::int64_t each = 0, none = never;

    std::int64_t within = each;  ///< each: before it is acknowledged; [ns] later; never
};

/// Which machine a recording is of, and how it began.
struct Recorded {
    std::string program, meaning;  ///< name of its file; Meaning::in_force
    std::string retained = {};     ///< retained_line(); empty: all began with its initial values
};

/// Writes a recording (see recording_form.hpp) as it comes: a thread of its own writes each entry,
/// so that the machine's thread waits for no disk, but for a checkpoint: it notes how much of the
/// recording there was. Who has asked for a change waits in keep(). When the disk is full, what
/// could not be written waits, is tried again, and is lost only if the machine ends before.
class RecordingWriter : public Observer {
  public:
    /// Replaces the file where it is a recording that has ended, or empty; where a machine was
    /// killed that recorded there, its recording stays, and this one is beside it, see path().
    /// `goes_on`: writes on where a checkpoint will say. Not where another one writes, nor over
    /// what is no recording: see error().
    RecordingWriter(World& world, std::string path, const Recorded& machine, bool goes_on,
                    RecordSync sync);
    ~RecordingWriter() override;
    RecordingWriter(const RecordingWriter&) = delete;
    RecordingWriter& operator=(const RecordingWriter&) = delete;

    /// The file that is written.
    const std::string& path() const { return path_; }

    /// Returns the mark of what has been appended so far.
    std::int64_t append(const std::string& line);

    /// Waits until all up to a mark is in the file, as the sync says. Empty, or why it is not.
    std::string keep(std::int64_t mark);

    /// The machine was served until `time` [ns]. Nothing may follow.
    void finish(std::int64_t time);

    /// Why there is no recording, or not all in it now; empty when all is well. Of any thread.
    std::string error() const;

    void scanned(int, const Scan&) override {}
    bool looks_at_scans() const override { return false; }
    void settled(std::int64_t, std::int64_t) override {}
    void save(StateWriter& out) const override;
    void restore(StateReader& in) override;

  private:
    void open(bool goes_on);
    bool take(const std::string& path, bool goes_on);
    void begin(const std::string& text);
    void work();

    World& world_;
    std::string path_;
    const RecordSync sync_;
    std::unique_ptr<GrowingFile> file_;
    mutable std::mutex mutex_;
    mutable std::condition_variable changed_;
    std::string error_, text_;
    std::int64_t appended_ = 0, kept_ = 0;  ///< bytes
    bool ended_ = false, is_broken_ = false;
    std::thread thread_;
};

}  // namespace lineshaft
