#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "runtime/study/study_csv.hpp"
#include "runtime/trace/output_file.hpp"

namespace lineshaft {

/// Slice `index` of `of` of a study's cases, counted from 1.
struct Chunk {
    std::int64_t index = 1, of = 1;

    /// Slices differ by at most one case.
    CaseRange range(std::int64_t cases) const {
        return {cases * (index - 1) / of, cases * index / of};
    }
    bool operator==(const Chunk&) const = default;
};

/// What a sidecar says of a result file.
struct ResultIdentity {
    std::string study;           ///< Study::identity
    std::optional<Chunk> chunk;  ///< none: all cases
    std::int64_t rows = 0;
    std::string rows_hash;    ///< of header and rows
    bool is_damaged = false;  ///< it names a chunk that there cannot be
};

/// `PATH-metadata.json`; empty when there is none, or it is not of a study.
std::optional<ResultIdentity> read_identity(const std::string& path);

/// Reads a result file row by row, from the case after the header. Stops where a row is torn or not
/// of this study.
class ResultReader {
  public:
    ResultReader(const std::string& path, const StudyCsv& csv);
    ~ResultReader();
    ResultReader(const ResultReader&) = delete;
    ResultReader& operator=(const ResultReader&) = delete;

    /// The next row; empty at the end.
    std::optional<CaseResult> next();
    /// The hash of what was read as text.
    const std::string& rows_hash() const { return hash_; }
    std::int64_t bytes() const { return bytes_; }

  private:
    bool line();

    std::FILE* file_ = nullptr;
    const StudyCsv& csv_;
    std::string line_, hash_;
    std::int64_t bytes_ = 0;
};

/// A study's results while they grow: `PATH.part` holds the rows so far, `PATH.part-metadata.json`
/// whose they are. When all are there the file appears under its name, its sidecar before it.
class ResultFile {
  public:
    ResultFile(std::string path, const Study& study, const StudyCsv& csv,
               std::optional<Chunk> chunk);

    /// Begins anew.
    bool begin();

    /// Takes up what an interrupted run left: rows in order go to `take`, those that finished
    /// before an earlier one to `late`. True and nothing taken when there is nothing; false and
    /// error() when it is another study's.
    bool resume(const std::function<void(const CaseResult&)>& take,
                std::map<std::int64_t, CaseResult>& late);

    /// All rows of a file that is there already, whole and of this study and chunk, go to `take`.
    bool take_whole(const std::function<void(const CaseResult&)>& take) const;

    /// The next row; on the disk when this returns. False: see error().
    bool add(const CaseResult& result);
    /// Rows that finished before an earlier one, kept for resume().
    void keep_late(const std::map<std::int64_t, CaseResult>& results);
    bool commit();

    std::int64_t rows() const { return rows_; }
    const std::string& error() const { return error_; }

  private:
    void open(std::int64_t keep);
    bool belongs(const ResultIdentity& identity) const;
    std::string metadata(bool whole) const;
    bool write_sidecar(const std::string& path, bool whole);

    std::string path_;
    const Study& study_;
    const StudyCsv& csv_;
    std::optional<Chunk> chunk_;
    std::unique_ptr<OutputFile> file_;
    std::string hash_, error_;
    std::int64_t rows_ = 0;
};

}  // namespace lineshaft
