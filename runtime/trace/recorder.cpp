#include "runtime/trace/recorder.hpp"

#include <algorithm>
#include <cstring>

#include "runtime/trace/background_sink.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t rows_per_block = 256;
constexpr std::uint64_t blocks = 1 + BackgroundSink::waiting_blocks;  // one under way

}  // namespace

std::uint64_t TraceSetup::memory() const {
    constexpr auto most = std::uint64_t{1} << 63;
    const std::uint64_t row = sizeof(std::uint64_t) * row_words();
    const std::uint64_t rows = static_cast<std::uint64_t>(pre_trigger) + blocks * rows_per_block;
    return rows > most / row ? most : rows * row;
}

Recorder::Recorder(TraceSetup setup, TraceSink& sink)
    : setup_(std::move(setup)),
      sink_(sink),
      watch_(setup_.trigger),
      row_words_(setup_.row_words()),
      words_(row_words_ * rows_per_block),
      ring_(row_words_ * static_cast<std::size_t>(setup_.pre_trigger)) {
    for (const Signal& signal : setup_.signals)
        sources_.push_back({signal.slot, size_of(signal.type) == sizeof(std::uint64_t)});
}

void Recorder::save(StateWriter& out) const {
    watch_.save(out);
    out.put(ring_);
    out.put(ring_next_);
    for (const std::int64_t n : {ring_rows_, origin_, rows_, recorded_, measurements_}) out.put(n);
    out.put(recording_);
}

void Recorder::restore(StateReader& in) {
    watch_.restore(in);
    in.get(ring_);
    in.get(ring_next_, 0, ring_.empty() ? 0 : ring_.size() - row_words_);
    in.require(ring_next_ % row_words_ == 0, "a trace");
    in.get(ring_rows_, 0, setup_.pre_trigger);
    in.get(origin_, 0, never - 1);
    in.get(rows_, 0, never - 1);
    in.get(recorded_, 0, never - 1);
    in.get(measurements_, 0, setup_.repeat);
    in.get(recording_);
    const bool is_full = setup_.samples > 0 && rows_ >= setup_.samples;
    in.require(!recording_ || (measurements_ > 0 && !is_full), "a trace");
    const auto next = static_cast<std::int64_t>(ring_next_ / row_words_);
    in.require(ring_rows_ == setup_.pre_trigger || ring_rows_ == next, "a trace");
}

void Recorder::begin(std::int64_t time) {
    recording_ = true;
    origin_ = time;
    rows_ = 0;
    ++measurements_;
    sink_.begin();
    give_ring();
}

void Recorder::end() {
    flush();
    recording_ = false;
    sink_.end();
}

void Recorder::finish() {
    if (recording_) end();
}

void Recorder::scanned(int task, const Scan& scan) {
    if (task != setup_.task) return;
    if (setup_.trigger.kind != TriggerKind::immediate)
        look(scan);
    else if (measurements_ == 0)
        begin(0);
    if (recording_ && is_over(scan.time)) end();
    if (setup_.every != 1 && scan.index % setup_.every != 0) return;
    if (recording_)
        record(scan);
    else if (setup_.pre_trigger > 0)
        keep(scan);
}

void Recorder::look(const Scan& scan) {
    if (!watch_.fires() || measurements_ == setup_.repeat) return;
    if (recording_ && !is_over(scan.time)) return;
    if (recording_) end();
    if (on_trigger) on_trigger(scan);
    begin(scan.time);
}

bool Recorder::is_over(std::int64_t time) const {
    return setup_.duration > 0 && time - origin_ > setup_.duration;
}

void Recorder::record(const Scan& scan) {
    copy_row(scan, origin_, words_.data() + used_);
    used_ += row_words_;
    ++rows_;
    if (used_ == words_.size()) flush();
    if (rows_ == setup_.samples) end();
}

void Recorder::copy_row(const Scan& scan, std::int64_t origin, std::uint64_t* word) const {
    *word++ = static_cast<std::uint64_t>(scan.time - origin);
    *word++ = static_cast<std::uint64_t>(scan.index);
    for (const Source& source : sources_) {
        std::uint64_t bits = 0;
        if (source.is_word)
            std::memcpy(&bits, source.slot, sizeof bits);
        else
            std::memcpy(&bits, source.slot, 1);
        *word++ = bits;
    }
}

void Recorder::keep(const Scan& scan) {
    copy_row(scan, 0, ring_.data() + ring_next_);
    ring_next_ += row_words_;
    if (ring_next_ == ring_.size()) ring_next_ = 0;
    if (ring_rows_ < setup_.pre_trigger) ++ring_rows_;
}

/// The oldest rows first.
void Recorder::give_ring() {
    const auto rows = static_cast<std::size_t>(ring_rows_);
    for (std::size_t row = 0; row < rows; ++row)
        ring_[row * row_words_] -= static_cast<std::uint64_t>(origin_);
    const std::size_t oldest = ring_rows_ == setup_.pre_trigger ? ring_next_ / row_words_ : 0;
    give_ring(oldest, rows);
    give_ring(0, oldest);
    recorded_ += ring_rows_;
    ring_rows_ = 0;
    ring_next_ = 0;
}

void Recorder::give_ring(std::size_t row, std::size_t end) {
    for (; row < end; row += rows_per_block)
        sink_.rows(ring_.data() + row * row_words_, std::min(rows_per_block, end - row));
}

void Recorder::flush() {
    const std::size_t rows = used_ / row_words_;
    if (rows > 0) sink_.rows(words_.data(), rows);
    recorded_ += static_cast<std::int64_t>(rows);
    used_ = 0;
}

}  // namespace lineshaft
