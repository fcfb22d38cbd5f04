#include "tests/runtime/serve/simulated_world.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <system_error>

#include "runtime/model/device.hpp"

namespace lineshaft::test {

namespace {

constexpr std::int64_t microsecond = 1000, millisecond = 1'000'000;

}  // namespace

thread_local SimulatedWorld::Task* SimulatedWorld::mine_ = nullptr;

SimulatedWorld::SimulatedWorld(std::uint64_t seed, const Faults& faults)
    : seed_(seed), faults_(faults), random_(seed) {
    running_ = mine_ = &tasks_.emplace_back();
}

SimulatedWorld::~SimulatedWorld() {
    mine_ = nullptr;
}

std::int64_t SimulatedWorld::random(std::int64_t limit) {
    return static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(limit));
}

bool SimulatedWorld::happens(double part) {
    constexpr std::int64_t parts = 1'000'000;
    return static_cast<double>(random(parts)) < part * static_cast<double>(parts);
}

/// That may go on; time passes when nobody may.
SimulatedWorld::Task& SimulatedWorld::choose() {
    while (true) {
        std::vector<Task*> ready;
        std::int64_t next = never;
        for (Task& task : tasks_) {
            if (task.has_ended) continue;
            task.is_held = task.holds && task.holds();
            if (task.is_held || task.until <= now_) ready.push_back(&task);
            next = std::min(next, task.until);
        }
        if (!ready.empty()) return *ready[static_cast<std::size_t>(random(std::ssize(ready)))];
        if (next == never) {
            std::fprintf(stderr, "seed %llu: all wait for ever\n",
                         static_cast<unsigned long long>(seed_));
            std::abort();
        }
        now_ = next;
    }
}

void SimulatedWorld::hand_over(std::unique_lock<std::mutex>& lock) {
    running_ = &choose();
    if (running_ == mine_) return;
    running_->chosen.notify_one();
    mine_->chosen.wait(lock, [this] { return running_ == mine_; });
}

bool SimulatedWorld::block(std::int64_t until, const std::function<bool()>& holds) {
    std::unique_lock lock(mutex_);
    mine_->until = until;
    mine_->holds = holds;
    hand_over(lock);
    mine_->holds = nullptr;
    return mine_->is_held;
}

void SimulatedWorld::yield() {
    block(now_, {});
}

bool SimulatedWorld::wait(std::unique_lock<std::mutex>& lock, std::condition_variable&,
                          std::int64_t until, const std::function<bool()>& holds) {
    const bool is_of_client = mine_->number > 1;  // the first one writes the recording
    if (faults_.no_wait_for_disk && until == never && is_of_client) return false;
    lock.unlock();
    const bool held = block(until, holds);
    lock.lock();
    return held;
}

std::thread SimulatedWorld::start_task(std::function<void()> work, int number) {
    const std::lock_guard lock(mutex_);
    Task* const task = &tasks_.emplace_back();
    task->number = number;
    std::thread thread([this, task, work = std::move(work)] {
        mine_ = task;
        {
            std::unique_lock waiting(mutex_);
            task->chosen.wait(waiting, [&] { return running_ == task; });
        }
        work();
        const std::lock_guard ending(mutex_);
        task->has_ended = true;
        running_ = &choose();
        running_->chosen.notify_one();
    });
    by_thread_[thread.get_id()] = task;
    return thread;
}

std::thread SimulatedWorld::start(std::function<void()> work) {
    if (happens(faults_.no_thread))
        throw std::system_error(EAGAIN, std::generic_category(), "no thread");
    return start_task(std::move(work), ++started_);
}

std::thread SimulatedWorld::start_client(std::function<void()> work) {
    return start_task(std::move(work), 0);
}

void SimulatedWorld::join(std::thread& thread) {
    const Task* const task = by_thread_.at(thread.get_id());
    block(never, [task] { return task->has_ended; });
    thread.join();
}

/// A file on the simulated disk.
class SimulatedFile final : public GrowingFile {
  public:
    SimulatedFile(SimulatedWorld& world, std::string path)
        : world_(world), path_(std::move(path)) {}

    int lock() override { return 0; }
    std::int64_t size() override { return std::ssize(disk().text); }
    std::string read(std::int64_t from, std::size_t most) override {
        return disk().text.substr(static_cast<std::size_t>(from), most);
    }
    int append(std::string_view bytes, std::size_t& written) override {
        world_.sleep_until(world_.now() + world_.random(100 * microsecond));
        if (world_.happens(world_.faults().full_disk))
            world_.no_room_until_ = world_.now() + world_.random(300 * millisecond);
        const bool is_full = world_.now() < world_.no_room_until_;
        written =
            is_full ? static_cast<std::size_t>(world_.random(std::ssize(bytes))) : bytes.size();
        disk().text += bytes.substr(0, written);
        return is_full ? ENOSPC : 0;
    }
    int truncate(std::int64_t size) override {
        disk().text.resize(static_cast<std::size_t>(size));
        disk().flushed = std::min(disk().flushed, disk().text.size());
        return 0;
    }
    int flush() override {
        const std::size_t size = disk().text.size();
        world_.sleep_until(world_.now() + world_.random(5 * millisecond));
        if (world_.happens(world_.faults().failed_flush)) return EIO;
        disk().flushed = size;
        return 0;
    }

  private:
    SimulatedWorld::Disk& disk() { return world_.disk_[path_]; }

    SimulatedWorld& world_;
    const std::string path_;
};

std::unique_ptr<GrowingFile> SimulatedWorld::open(const std::string& path, bool may_make,
                                                  int& error) {
    error = may_make || disk_.contains(path) ? 0 : ENOENT;
    return error == 0 ? std::make_unique<SimulatedFile>(*this, path) : nullptr;
}

void SimulatedWorld::kill(bool of_power) {
    left_ = disk_;
    is_killed_ = true;
    if (!of_power) return;
    for (auto& [path, disk] : left_) {
        const auto unsafe = static_cast<std::int64_t>(disk.text.size() - disk.flushed);
        disk.text.resize(disk.flushed + static_cast<std::size_t>(random(unsafe + 1)));
    }
}

std::string SimulatedWorld::left(const std::string& path) const {
    const auto& files = is_killed_ ? left_ : disk_;
    const auto it = files.find(path);
    return it == files.end() ? "" : it->second.text;
}

void SimulatedLine::put(std::deque<Piece>& way, std::string_view bytes) {
    const std::int64_t at = world_.now() + world_.random(2 * millisecond);
    way.push_back({std::max(at, way.empty() ? 0 : way.back().at), std::string(bytes)});
}

void SimulatedLine::send(std::string_view bytes) {
    put(to_server_, bytes);
}

std::string SimulatedLine::receive(std::int64_t until) {
    world_.block(until, [this] { return has_come(to_client_) || is_shut_; });
    std::int64_t next = until;
    while (!has_come(to_client_) && !to_client_.empty() && world_.now() < until) {
        next = std::min(until, to_client_.front().at);
        world_.sleep_until(next);
    }
    if (!has_come(to_client_)) return {};
    std::string bytes = std::move(to_client_.front().bytes);
    to_client_.pop_front();
    return bytes;
}

/// The server's end of a line.
class SimulatedSocket final : public Socket {
  public:
    explicit SimulatedSocket(SimulatedLine& line) : line_(line), world_(line.world_) {}
    ~SimulatedSocket() override { line_.is_shut_ = true; }
    SimulatedSocket(const SimulatedSocket&) = delete;
    SimulatedSocket& operator=(const SimulatedSocket&) = delete;

    bool is_readable(std::int64_t until) override {
        const auto holds = [this] { return line_.has_come(line_.to_server_) || is_over(); };
        while (!holds() && world_.now() < until) {
            const std::int64_t next =
                line_.to_server_.empty() ? until : std::min(until, line_.to_server_.front().at);
            const std::size_t count = line_.to_server_.size();
            world_.block(next, [&] { return holds() || line_.to_server_.size() != count; });
        }
        return holds();
    }
    std::size_t receive(char* to, std::size_t size, std::int64_t until) override {
        if (!is_readable(until) || !line_.has_come(line_.to_server_) || line_.is_shut_in_) return 0;
        std::string& bytes = line_.to_server_.front().bytes;
        const std::size_t count = std::min(size, bytes.size());
        bytes.copy(to, count);
        bytes.erase(0, count);
        if (bytes.empty()) line_.to_server_.pop_front();
        world_.yield();
        return count;
    }
    std::size_t send(std::string_view bytes, std::int64_t) override {
        world_.yield();
        if (line_.is_shut_ || line_.is_hung_up_) return 0;
        const auto count = static_cast<std::size_t>(1 + world_.random(std::ssize(bytes)));
        line_.put(line_.to_client_, bytes.substr(0, count));
        const bool is_exception = bytes.size() > 7 && (bytes[7] & 0x80) != 0;
        if (world_.faults().lost_request && is_exception) line_.to_server_.clear();
        return count;
    }
    bool has_ended() override { return line_.is_hung_up_ || line_.is_shut_; }
    void shut_in() override { line_.is_shut_in_ = true; }
    void shut() override { line_.is_shut_ = line_.is_shut_in_ = true; }
    std::string peer() const override { return "127.0.0.1"; }

  private:
    bool is_over() const { return line_.is_hung_up_ || line_.is_shut_ || line_.is_shut_in_; }

    SimulatedLine& line_;
    SimulatedWorld& world_;
};

std::unique_ptr<Socket> SimulatedLine::socket() {
    return std::make_unique<SimulatedSocket>(*this);
}

}  // namespace lineshaft::test
