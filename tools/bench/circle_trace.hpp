#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "blocks/catalog.hpp"
#include "runtime/run/single_run.hpp"
#include "tests/source_folder.hpp"

namespace lineshaft {

/// programs/paper/wei2025_circle.yaml with its defaults.
inline Loaded load_circle() {
    Diagnostics problems;
    auto loaded = load_program(test::in_source("programs/paper/wei2025_circle.yaml"), {},
                               standard_blocks(), problems);
    if (!loaded) throw std::runtime_error(problems.render());
    return std::move(*loaded);
}

/// A trace kept in memory.
struct MemoryTrace : TraceSink {
    explicit MemoryTrace(const TraceSetup& setup) : row_words(2 + setup.signals.size()) {}

    void rows(const std::uint64_t* first, std::size_t count) override {
        words.insert(words.end(), first, first + count * row_words);
    }
    std::size_t rows() const { return words.size() / row_words; }

    std::size_t row_words;
    std::vector<std::uint64_t> words;
};

struct EventList : EventSink {
    void happened(const RunEvent& event) override { list.push_back(event); }
    std::vector<RunEvent> list;
};

/// The circle's trace, position of shaft, x and y first, and its events.
struct RecordedCircle {
    RecordedCircle() {
        Recorder recorder(setup, trace);
        Executive executive(loaded.linked.machine);
        executive.report_to(events);
        executive.run({&recorder});
        recorder.finish();
    }
    std::size_t rows() const { return trace.rows(); }

    Loaded loaded = load_circle();
    TraceSetup setup = loaded.linked.traces.front();
    MemoryTrace trace{setup};
    EventList events;
    std::size_t row_words = trace.row_words;
    const std::vector<std::uint64_t>& words = trace.words;
};

}  // namespace lineshaft
