#include "runtime/trace/trace_files.hpp"

#include <filesystem>

#include <fmt/format.h>

namespace lineshaft {

TraceFiles::TraceFiles(const std::string& out, const TraceSetup& setup, std::string title,
                       std::string program_text, const CsvStyle& style)
    : setup_(setup),
      title_(std::move(title)),
      program_text_(std::move(program_text)),
      style_(style) {
    extension_ = std::filesystem::path(out).extension().string();
    stem_ = out.substr(0, out.size() - extension_.size());
    if (!setup.name.empty()) stem_ += "." + setup.name;
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
    const std::string wrong = csv_->finish(title_, program_text_, stopped_, expectations_);
    if (error_.empty()) error_ = wrong;
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
    error_ = csv_->error();
}

}  // namespace lineshaft
