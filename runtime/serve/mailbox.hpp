#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace lineshaft {

/// What clients want of the machine, on its way to the one thread that may touch it: the one that
/// makes the box. That thread
/// never waits for them: it takes what is there between two instants, or finds the box in use and
/// looks again after the next one.
class Mailbox {
  public:
    using Job = std::function<void()>;

    static constexpr std::size_t room = 256;  ///< jobs that wait, at most

    /// Calls `job` in the machine's thread, and waits for its result; at once when that thread
    /// asks. Empty when the box is full or closed, or nobody has come for it within two seconds:
    /// then it is not called any more.
    template <class Call>
    auto ask(Call job) -> std::optional<decltype(job())>;

    /// In the machine's thread: whether jobs wait, and calls them.
    bool waits() const { return waits_; }
    void deliver();

    /// Likewise, for the last time.
    void close();

  private:
    bool put(Job job);

    const std::thread::id owner_ = std::this_thread::get_id();
    std::mutex mutex_;
    std::vector<Job> jobs_, taken_;
    std::atomic<bool> waits_ = false;
    bool closed_ = false;
};

template <class Call>
auto Mailbox::ask(Call job) -> std::optional<decltype(job())> {
    if (std::this_thread::get_id() == owner_) return job();
    using Result = decltype(job());
    struct Asked {
        explicit Asked(Call c) : call(std::move(c)) {}
        Call call;
        std::promise<Result> promise;
        std::atomic<bool> settled = false;
    };
    const auto asked = std::make_shared<Asked>(std::move(job));
    auto result = asked->promise.get_future();
    if (!put([asked] {
            if (!asked->settled.exchange(true)) asked->promise.set_value(asked->call());
        }))
        return {};
    constexpr auto patience = std::chrono::seconds(2);
    if (result.wait_for(patience) != std::future_status::ready && !asked->settled.exchange(true))
        return {};
    return result.get();
}

}  // namespace lineshaft
