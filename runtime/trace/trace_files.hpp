#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/trace/background_sink.hpp"
#include "runtime/trace/csv_writer.hpp"

namespace lineshaft {

/// The files of a trace's measurements: the trace `name` of `out.csv` goes to `out.name.csv`, one
/// that may repeat to `out.name.1.csv`, `out.name.2.csv`, ... `out` is what the user named, the
/// file of the trace without a name.
std::vector<std::string> trace_paths(const std::string& out, const TraceSetup& setup);

/// Writes each measurement of a trace to a CSV file of its own, see CsvWriter and trace_paths().
class TraceFiles : public TraceSink {
  public:
    /// `setup`, `origin` and `files`, which takes them, must outlive this.
    TraceFiles(std::string out, const TraceSetup& setup, const TraceOrigin& origin,
               const CsvStyle& style, OutputSet& files);

    /// For the files that end after the run: why it stopped, empty if it completed, and what came
    /// of the program's expectations.
    void set_outcome(std::string stopped, nlohmann::ordered_json verdicts) {
        stopped_ = std::move(stopped);
        expectations_ = std::move(verdicts);
    }

    void begin() override;
    void rows(const std::uint64_t* words, std::size_t rows) override;
    void end() override;

    /// What has been handed over goes to the disk; restore() goes on there, in an object that has
    /// not begun. An error if the files are not those that were saved.
    void save(StateWriter& out);
    void restore(StateReader& in);

    /// What has been written.
    const std::vector<std::string>& paths() const { return paths_; }
    bool is_open() const { return csv_.has_value(); }
    /// What is wrong with the open file; empty when all is well.
    std::string error() const { return csv_ ? csv_->error() : ""; }
    /// Whether writing goes wrong: the rest of the run would not be recorded.
    bool failed() const { return csv_ && csv_->failed(); }

  private:
    std::string next_path() const;
    void open(auto&... state);

    std::string out_;
    const TraceSetup& setup_;
    const TraceOrigin& origin_;
    CsvStyle style_;
    OutputSet& files_;
    std::string stopped_;
    nlohmann::ordered_json expectations_;
    std::optional<CsvWriter> csv_;
    std::optional<BackgroundSink> background_;
    std::vector<std::string> paths_;
};

}  // namespace lineshaft
