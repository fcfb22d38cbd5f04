#include "runtime/trace/recorder.hpp"

#include <cstring>

namespace lineshaft {

namespace {

constexpr std::size_t rows_per_block = 1024;

}  // namespace

Recorder::Recorder(TraceSetup setup, TraceSink& sink)
    : setup_(std::move(setup)), sink_(sink), words_((2 + setup_.signals.size()) * rows_per_block) {}

void Recorder::scanned(int task, const Scan& scan) {
    if (task != setup_.task || scan.index % setup_.every != 0) return;
    std::uint64_t* word = words_.data() + used_;
    *word++ = static_cast<std::uint64_t>(scan.time);
    *word++ = static_cast<std::uint64_t>(scan.index);
    for (const Signal& signal : setup_.signals) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, signal.slot, size_of(signal.type));
        *word++ = bits;
    }
    used_ += 2 + setup_.signals.size();
    ++recorded_;
    if (used_ == words_.size()) flush();
}

void Recorder::flush() {
    if (used_ > 0) sink_.rows(words_.data(), used_ / (2 + setup_.signals.size()));
    used_ = 0;
}

}  // namespace lineshaft
