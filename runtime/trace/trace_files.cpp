#include "runtime/trace/trace_files.hpp"

#include <filesystem>

#include <fmt/format.h>

namespace lineshaft {

TraceFiles::TraceFiles(const std::string& out, const TraceSetup& setup, const TraceOrigin& origin,
                       const CsvStyle& style, OutputSet& files)
    : setup_(setup), origin_(origin), style_(style), files_(files) {
    extension_ = std::filesystem::path(out).extension().string();
    stem_ = out.substr(0, out.size() - extension_.size());
    if (!setup.name.empty() && out != "-") stem_ += "." + setup.name;
}

std::string TraceFiles::next_path() const {
    if (setup_.repeat == 1) return stem_ + extension_;
    return fmt::format("{}.{}{}", stem_, paths_.size() + 1, extension_);
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
    csv_->finish(files_, origin_, stopped_, expectations_);
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
    in.get(files);
    in.get(is_open);
    while (in.ok() && paths_.size() < files) paths_.push_back(next_path());
    if (!in.ok() || !is_open) return;
    open(in);
}

}  // namespace lineshaft
