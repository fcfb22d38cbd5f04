#include "runtime/trace/background_sink.hpp"

#include <utility>

namespace lineshaft {

BackgroundSink::BackgroundSink(TraceSink& to, std::size_t row_words)
    : to_(to), row_words_(row_words), thread_([this] { work(); }) {}

BackgroundSink::~BackgroundSink() {
    join();
}

void BackgroundSink::rows(const std::uint64_t* words, std::size_t rows) {
    std::unique_lock lock(mutex_);
    if (given_ - taken_ == blocks_.size())
        changed_.wait(lock, [this] { return given_ - taken_ <= blocks_.size() / 2; });
    Block& block = blocks_[given_ % blocks_.size()];
    lock.unlock();
    block.words.assign(words, words + rows * row_words_);
    block.rows = rows;
    lock.lock();
    ++given_;
    changed_.notify_all();
}

void BackgroundSink::drain() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return given_ == taken_; });
    rethrow();
}

void BackgroundSink::finish() {
    join();
    rethrow();
}

void BackgroundSink::rethrow() {
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

void BackgroundSink::join() {
    {
        const std::lock_guard lock(mutex_);
        finished_ = true;
        changed_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
}

void BackgroundSink::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return given_ > taken_ || finished_; });
        if (given_ == taken_) return;
        const Block& block = blocks_[taken_ % blocks_.size()];
        lock.unlock();
        take(block);
        lock.lock();
        ++taken_;
        if (given_ - taken_ <= blocks_.size() / 2) changed_.notify_all();
    }
}

void BackgroundSink::take(const Block& block) {
    if (thrown_) return;
    try {
        to_.rows(block.words.data(), block.rows);
    } catch (...) {
        thrown_ = std::current_exception();
    }
}

}  // namespace lineshaft
