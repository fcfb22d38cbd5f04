#include "runtime/run/side_by_side.hpp"

#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace lineshaft {

void side_by_side(std::int64_t jobs, const std::function<void()>& work,
                  const std::function<void()>& stop) {
    std::mutex mutex;
    std::exception_ptr thrown;
    const auto guarded = [&] {
        try {
            work();
        } catch (...) {
            const std::lock_guard lock(mutex);
            if (!thrown) thrown = std::current_exception();
            stop();
        }
    };
    std::vector<std::jthread> threads;
    try {
        for (std::int64_t i = 1; i < jobs; ++i) threads.emplace_back(guarded);
    } catch (const std::exception&) {  // no more threads or memory: those that run do the work
    }
    guarded();
    threads.clear();
    if (thrown) std::rethrow_exception(thrown);
}

}  // namespace lineshaft
