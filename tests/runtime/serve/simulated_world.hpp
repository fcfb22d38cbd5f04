#pragma once

#include <deque>
#include <list>
#include <map>
#include <random>
#include <vector>

#include "runtime/serve/clients.hpp"

namespace lineshaft::test {

/// What goes wrong in a simulated world, and how often: parts of a whole.
struct Faults {
    double no_thread = 0;           ///< of threads that are started
    double full_disk = 0;           ///< of what is appended: there is no room for some time
    double failed_flush = 0;        ///< of flushes
    bool no_wait_for_disk = false;  ///< planted: who waits for the recording does not
    bool lost_request = false;  ///< planted: what waits is thrown away with an exception's answer
};

/// A world in virtual time: threads of which one runs at a time, chosen by the seed whenever one
/// of them waits for something; so a seed's run is always the same one. The thread that makes it is
/// the first of them, and has one world at a time.
class SimulatedWorld final : public World {
  public:
    SimulatedWorld(std::uint64_t seed, const Faults& faults);
    ~SimulatedWorld() override;
    SimulatedWorld(const SimulatedWorld&) = delete;
    SimulatedWorld& operator=(const SimulatedWorld&) = delete;

    std::int64_t now() override { return now_; }
    void sleep_until(std::int64_t time) override { block(time, {}); }
    bool wait(std::unique_lock<std::mutex>& lock, std::condition_variable& changed,
              std::int64_t until, const std::function<bool()>& holds) override;
    std::thread start(std::function<void()> work) override;
    void join(std::thread& thread) override;
    std::unique_ptr<GrowingFile> open(const std::string& path, bool may_make, int& error) override;

    /// A thread that is always there: a client, not the server's.
    std::thread start_client(std::function<void()> work);

    /// Waits until something holds, which is asked again whenever a thread waits. False when it is
    /// `until` [ns]. When all threads wait without an end, that is told, and the process aborted.
    bool block(std::int64_t until, const std::function<bool()>& holds);
    /// Others may go on first.
    void yield();

    /// At least 0, below `limit`.
    std::int64_t random(std::int64_t limit);
    bool happens(double part);

    /// What the files hold now is what is left of them: all that was written, or after a power
    /// failure what has been flushed, and some of what has not.
    void kill(bool of_power);
    bool is_killed() const { return is_killed_; }
    /// What is left of a file.
    std::string left(const std::string& path) const;

    const Faults& faults() const { return faults_; }

  private:
    friend class SimulatedFile;

    struct Task {
        std::condition_variable chosen;
        std::function<bool()> holds = {};
        std::int64_t until = 0;
        bool has_ended = false, is_held = false;
        int number = 0;  ///< of those that the server has started; 0: another
    };
    struct Disk {
        std::string text;
        std::size_t flushed = 0;
    };

    std::thread start_task(std::function<void()> work, int number);
    void hand_over(std::unique_lock<std::mutex>& lock);
    Task& choose();

    static thread_local Task* mine_;

    const std::uint64_t seed_;
    const Faults faults_;
    std::mt19937_64 random_;
    std::mutex mutex_;
    std::list<Task> tasks_;
    std::map<std::thread::id, Task*> by_thread_;
    Task* running_ = nullptr;
    int started_ = 0;
    std::int64_t now_ = 1'000'000'000, no_room_until_ = 0;
    std::map<std::string, Disk> disk_, left_;
    bool is_killed_ = false;
};

/// Bytes on their way between a client and its server, late, in pieces.
class SimulatedLine {
  public:
    explicit SimulatedLine(SimulatedWorld& world) : world_(world) {}

    /// The server's end.
    std::unique_ptr<Socket> socket();

    /// The client's: what comes until `until` [ns]; empty when nothing does, or the line is shut.
    std::string receive(std::int64_t until);
    void send(std::string_view bytes);
    void hang_up() { is_hung_up_ = true; }
    bool is_shut() const { return is_shut_; }

  private:
    friend class SimulatedSocket;

    struct Piece {
        std::int64_t at;
        std::string bytes;
    };
    bool has_come(const std::deque<Piece>& way) const {
        return !way.empty() && way.front().at <= world_.now();
    }
    void put(std::deque<Piece>& way, std::string_view bytes);

    SimulatedWorld& world_;
    std::deque<Piece> to_server_, to_client_;
    bool is_hung_up_ = false, is_shut_ = false, is_shut_in_ = false;
};

}  // namespace lineshaft::test
