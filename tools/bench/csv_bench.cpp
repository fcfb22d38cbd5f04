#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "runtime/trace/csv_writer.hpp"
#include "tools/bench/circle_trace.hpp"
#include "tools/bench/quickest.hpp"

using namespace lineshaft;

namespace {

/// Rows and what they are.
struct Table {
    TraceSetup setup;
    std::vector<std::uint64_t> words;
    std::size_t row_words() const { return 2 + setup.signals.size(); }
    std::size_t rows() const { return words.size() / row_words(); }
};

Table circle() {
    const RecordedCircle recorded;
    return {recorded.setup, recorded.words};
}

/// Reals of 16 and 17 digits, all different.
Table random_reals() {
    Table table;
    for (const char* name : {"a.a", "a.b", "a.c", "a.d", "a.e", "a.f", "a.g", "a.h"})
        table.setup.signals.push_back({.name = name, .type = Type::real, .unit = {}, .names = {}});
    std::mt19937_64 random(1);
    for (std::uint64_t row = 0; row < 10'000; ++row) {
        table.words.push_back(row * 1'000'000);
        table.words.push_back(row);
        for (int i = 0; i < 8; ++i) {
            const double value = std::ldexp(static_cast<double>(random()), -60);
            table.words.push_back(std::bit_cast<std::uint64_t>(value));
        }
    }
    return table;
}

std::string file() {
    return (std::filesystem::temp_directory_path() / "lineshaft_csv_bench.csv").string();
}

/// Before each writing: a file that is written over is flushed when it is closed, by ext4.
void remove_file() {
    for (const char* end : {"", ".part", "-metadata.json"}) std::filesystem::remove(file() + end);
}

void writer(benchmark::State& state, Table (*make)()) {
    const Table table = make();
    Quickest quickest;
    for (auto _ : state) {
        remove_file();
        quickest.time([&] {
            CsvWriter writer(file(), table.setup);
            writer.rows(table.words.data(), table.rows());
        });
    }
    quickest.count(state, table.words.size());
    remove_file();
}

/// As a run ends: the file is on the disk, whole, under its name.
void writer_to_disk(benchmark::State& state, Table (*make)()) {
    const Table table = make();
    Quickest quickest;
    for (auto _ : state) {
        remove_file();
        OutputSet files;
        quickest.time([&] {
            CsvWriter writer(file(), table.setup);
            writer.rows(table.words.data(), table.rows());
            writer.hand_over(files, csv_sidecar(writer.written(), {}, {}, {}));
            files.commit();
        });
        if (!files.error().empty()) state.SkipWithError(files.error().c_str());
    }
    quickest.count(state, table.words.size());
    remove_file();
}

char* append(char* end, const Table& table, std::size_t i) {
    const std::size_t column = i % table.row_words();
    const std::uint64_t word = table.words[i];
    char* const limit = end + 32;
    if (column == 0) return std::to_chars(end, limit, seconds(static_cast<std::int64_t>(word))).ptr;
    if (column == 1 || table.setup.signals[column - 2].type != Type::real)
        return std::to_chars(end, limit, word).ptr;
    return std::to_chars(end, limit, std::bit_cast<double>(word)).ptr;
}

/// The rows with std::to_chars, each cell anew: what a plain loop takes. Returns the end.
char* format_all(const Table& table, char* end) {
    for (std::size_t i = 0; i < table.words.size(); ++i) {
        end = append(end, table, i);
        *end++ = (i + 1) % table.row_words() == 0 ? '\n' : ',';
    }
    return end;
}

/// Likewise, but a cell that is as in the row before is copied from there, as the writer does.
char* format_changes(const Table& table, char* end) {
    std::vector<std::string_view> before(table.row_words());
    for (std::size_t i = 0; i < table.words.size(); ++i) {
        const std::size_t column = i % table.row_words();
        const bool is_same =
            i >= table.row_words() && table.words[i] == table.words[i - table.row_words()];
        char* const begin = end;
        end = is_same ? std::ranges::copy(before[column], end).out : append(end, table, i);
        before[column] = {begin, end};
        *end++ = column + 1 == table.row_words() ? '\n' : ',';
    }
    return end;
}

void bare(benchmark::State& state, Table (*make)(), char* (*format)(const Table&, char*),
          bool to_disk) {
    const Table table = make();
    std::vector<char> text(table.words.size() * 32);
    Quickest quickest;
    for (auto _ : state) {
        remove_file();
        quickest.time([&] {
            std::FILE* out = std::fopen(file().c_str(), "wb");
            const char* const end = format(table, text.data());
            std::fwrite(text.data(), 1, static_cast<std::size_t>(end - text.data()), out);
            std::fflush(out);
            if (to_disk) fsync(fileno(out));
            std::fclose(out);
        });
    }
    quickest.count(state, table.words.size());
    remove_file();
}

}  // namespace

BENCHMARK_CAPTURE(writer, circle, circle);
BENCHMARK_CAPTURE(bare, circle, circle, format_all, false);
BENCHMARK_CAPTURE(bare, circle_copying, circle, format_changes, false);
BENCHMARK_CAPTURE(writer_to_disk, circle, circle);
BENCHMARK_CAPTURE(bare, circle_copying_to_disk, circle, format_changes, true);
BENCHMARK_CAPTURE(writer, random, random_reals);
BENCHMARK_CAPTURE(bare, random, random_reals, format_all, false);
BENCHMARK_MAIN();
