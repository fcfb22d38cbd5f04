#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/serve/world.hpp"

namespace lineshaft {

/// What clients want of the machine, on its way to the one thread that may touch it: the one that
/// makes the box. That thread never waits for them: it takes what is there between two instants, or
/// finds the box in use and looks again after the next one.
class Mailbox {
  public:
    using Job = std::function<void()>;

    static constexpr std::size_t room = 256;  ///< jobs that wait, at most

    explicit Mailbox(World& world) : world_(world) {}

    /// Calls `job` in the machine's thread, and waits for its result; at once when that thread
    /// asks. Empty when the box is full or closed, or nobody has come for it within two seconds:
    /// then it is not called any more. What it throws is thrown here.
    template <class Call>
    auto ask(Call job) -> std::optional<decltype(job())>;

    /// In the machine's thread: whether jobs wait, and calls them.
    bool waits() const { return waits_; }
    void deliver();

    /// Likewise, for the last time.
    void close();

  private:
    bool put(Job job);

    World& world_;
    const std::thread::id owner_ = std::this_thread::get_id();
    std::mutex mutex_;
    std::vector<Job> jobs_, taken_;
    std::atomic<bool> waits_ = false;
    bool closed_ = false;
};

template <class Call>
auto Mailbox::ask(Call job) -> std::optional<decltype(job())> {
    if (std::this_thread::get_id() == owner_) return job();
    struct Asked {
        explicit Asked(Call c) : call(std::move(c)) {}

        Call call;
        std::mutex mutex;
        std::condition_variable changed;
        bool is_left = false, is_begun = false, is_done = false;
        std::optional<decltype(call())> result;
        std::exception_ptr thrown;
    };
    const auto asked = std::make_shared<Asked>(std::move(job));
    const auto call = [asked] {
        {
            const std::lock_guard lock(asked->mutex);
            if (asked->is_left) return;
            asked->is_begun = true;
        }
        try {
            asked->result = asked->call();
        } catch (...) {
            asked->thrown = std::current_exception();
        }
        const std::lock_guard lock(asked->mutex);
        asked->is_done = true;
        asked->changed.notify_one();
    };
    if (!put(call)) return {};
    constexpr std::int64_t patience = 2 * one_second,
                           end_of_time = std::numeric_limits<std::int64_t>::max() - 1;
    const auto is_done = [&] { return asked->is_done; };
    std::unique_lock lock(asked->mutex);
    if (!world_.wait(lock, asked->changed, world_.now() + patience, is_done) && !asked->is_begun)
        asked->is_left = true;
    else
        world_.wait(lock, asked->changed, end_of_time, is_done);
    if (asked->thrown) std::rethrow_exception(asked->thrown);
    return std::move(asked->result);
}

}  // namespace lineshaft
