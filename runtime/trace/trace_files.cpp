#include "runtime/trace/trace_files.hpp"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

namespace lineshaft {

namespace {

std::string path_of(const std::string& out, const TraceSetup& setup, std::size_t number) {
    const std::string extension = std::filesystem::path(out).extension().string();
    std::string path = out.substr(0, out.size() - extension.size());
    if (!setup.name.empty() && out != "-") path += "." + setup.name;
    if (setup.repeat > 1) path += fmt::format(".{}", number);
    return path + extension;
}

}  // namespace

std::vector<std::string> trace_paths(const std::string& out, const TraceSetup& setup) {
    std::vector<std::string> paths;
    for (std::int64_t i = 1; i <= setup.repeat; ++i)
        paths.push_back(path_of(out, setup, static_cast<std::size_t>(i)));
    return paths;
}

TraceFiles::TraceFiles(std::string out, const TraceSetup& setup, const TraceOrigin& origin,
                       const CsvStyle& style, OutputSet& files)
    : out_(std::move(out)), setup_(setup), origin_(origin), style_(style), files_(files) {}

std::string TraceFiles::next_path() const {
    return path_of(out_, setup_, paths_.size() + 1);
}

void TraceFiles::open(auto&... state) {
    csv_.emplace(paths_.back(), setup_, style_, state...);
    background_.emplace(*csv_, setup_.row_words());
}

void TraceFiles::begin() {
    paths_.push_back(next_path());
    open();
}

void TraceFiles::rows(const std::uint64_t* words, std::size_t rows) {
    background_->rows(words, rows);
}

void TraceFiles::end() {
    background_->finish();
    csv_->hand_over(files_, csv_sidecar(csv_->written(), origin_, stopped_, expectations_));
    background_.reset();
    csv_.reset();
}

void TraceFiles::save(StateWriter& out) {
    out.put(std::uint64_t{paths_.size()});
    out.put(csv_.has_value());
    if (!csv_) return;
    background_->drain();
    csv_->save(out);
}

void TraceFiles::restore(StateReader& in) {
    std::uint64_t files = 0;
    bool is_open = false;
    in.get(files, 0, static_cast<std::uint64_t>(setup_.repeat));
    in.get(is_open);
    in.require(!is_open || files > 0, "a trace");
    while (in.ok() && paths_.size() < files) paths_.push_back(next_path());
    if (!in.ok() || !is_open) return;
    open(in);
}

}  // namespace lineshaft
