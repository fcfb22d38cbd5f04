#pragma once

#include <array>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "runtime/trace/recorder.hpp"

namespace lineshaft {

/// Hands rows to another sink in a thread of its own, in order, so that the machine runs on while
/// they are formatted and written. At most eight blocks wait; then rows() waits too, until half of
/// them are taken: waking a thread costs as much as some tens of rows.
class BackgroundSink : public TraceSink {
  public:
    /// `to`, which takes rows of `row_words` words, must outlive this and is left alone by others
    /// until finish().
    BackgroundSink(TraceSink& to, std::size_t row_words);
    ~BackgroundSink() override;

    void rows(const std::uint64_t* words, std::size_t rows) override;

    /// Returns when all rows have been taken; until the next ones the other sink is at rest. Throws
    /// what the other sink has thrown; it gets no rows after that.
    void drain();

    /// Likewise, and none may follow.
    void finish();

    static constexpr std::size_t waiting_blocks = 8;

  private:
    struct Block {
        std::vector<std::uint64_t> words;
        std::size_t rows = 0;
    };

    void join();
    void rethrow();
    void work();
    void take(const Block& block);

    TraceSink& to_;
    std::size_t row_words_;
    std::array<Block, waiting_blocks> blocks_;
    std::size_t given_ = 0;  ///< blocks so far; the next is blocks_[given_ % size]
    std::size_t taken_ = 0;
    bool finished_ = false;
    std::exception_ptr thrown_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::thread thread_;
};

}  // namespace lineshaft
