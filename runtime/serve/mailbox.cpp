#include "runtime/serve/mailbox.hpp"

namespace lineshaft {

bool Mailbox::put(Job job) {
    const std::lock_guard lock(mutex_);
    if (closed_ || jobs_.size() >= room) return false;
    jobs_.push_back(std::move(job));
    waits_ = true;
    return true;
}

void Mailbox::deliver() {
    {
        const std::unique_lock lock(mutex_, std::try_to_lock);
        if (!lock) return;
        taken_.swap(jobs_);
        waits_ = false;
    }
    for (const Job& job : taken_) job();
    taken_.clear();
}

void Mailbox::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        taken_.swap(jobs_);
    }
    for (const Job& job : taken_) job();
    taken_.clear();
}

}  // namespace lineshaft
