#include "runtime/study/result_file.hpp"

#include <filesystem>

#include <fmt/format.h>

#include "runtime/source/input_file.hpp"
#include "runtime/source/json_text.hpp"
#include "runtime/source/text_hash.hpp"
#include "runtime/study/study_reader.hpp"
#include "runtime/version.hpp"

namespace lineshaft {

namespace fs = std::filesystem;

namespace {

constexpr const char* sidecar = "-metadata.json";

}  // namespace

std::optional<ResultIdentity> read_identity(const std::string& path) {
    constexpr std::size_t longest = 16 << 20;  // bytes; a sidecar has some 60 a column
    int error = 0;
    const auto json = parse_json(read_bytes(path + sidecar, longest, error));
    if (error != 0 || !json.is_object() || !json.contains("lineshaft:study")) return {};
    ResultIdentity identity{.study = text_at(json, "lineshaft:study"),
                            .chunk = {},
                            .rows = integer_at(json, "lineshaft:rows", 0, most_runs).value_or(0),
                            .rows_hash = text_at(json, "lineshaft:rows_hash")};
    const auto chunk = json.find("lineshaft:chunk");
    if (chunk == json.end()) return identity;
    const auto of = integer_at(*chunk, "of", 1, most_runs);
    const auto index = of ? integer_at(*chunk, "index", 1, *of) : std::nullopt;
    identity.is_damaged = !index;
    if (index) identity.chunk = {*index, *of};
    return identity;
}

ResultReader::ResultReader(const std::string& path, const StudyCsv& csv)
    : file_(std::fopen(path.c_str(), "rb")), csv_(csv) {
    if (!line() || line_ + "\n" != csv_.header()) return;
    hash_ = text_hash(line_ + "\n");
    bytes_ = static_cast<std::int64_t>(line_.size()) + 1;
}

ResultReader::~ResultReader() {
    if (file_) std::fclose(file_);
}

bool ResultReader::line() {
    line_.clear();
    for (int c = file_ ? std::getc(file_) : EOF; c != EOF; c = std::getc(file_)) {
        if (c == '\n') return true;
        line_ += static_cast<char>(c);
    }
    return false;
}

std::optional<CaseResult> ResultReader::next() {
    if (bytes_ == 0 || !line()) return {};
    auto result = csv_.parse(line_);
    if (!result) return {};
    hash_ = text_hash(hash_ + line_ + "\n");
    bytes_ += static_cast<std::int64_t>(line_.size()) + 1;
    return result;
}

ResultFile::ResultFile(std::string path, const Study& study, const StudyCsv& csv,
                       std::optional<Chunk> chunk)
    : path_(std::move(path)), study_(study), csv_(csv), chunk_(chunk) {}

bool ResultFile::belongs(const ResultIdentity& identity) const {
    return identity.study == study_.identity && identity.chunk == chunk_ && !identity.is_damaged;
}

bool ResultFile::begin() {
    rows_ = 0;
    hash_ = text_hash(csv_.header());
    open(0);
    file_->write(csv_.header());
    file_->flush();
    error_ = file_->error();
    return error_.empty() && (!file_->is_regular() || write_sidecar(file_->part(), false));
}

void ResultFile::open(std::int64_t keep) {
    file_ = std::make_unique<OutputFile>(path_, keep);
}

bool ResultFile::resume(const std::function<void(const CaseResult&)>& take,
                        std::map<std::int64_t, CaseResult>& late) {
    const std::string part = path_ + ".part";
    if (!fs::exists(part)) return begin();
    const auto identity = read_identity(part);
    if (!identity || !belongs(*identity)) {
        error_ = fmt::format(
            "'{}' was left by another study, program or chunk: delete it, or leave --resume out",
            part);
        return false;
    }
    const std::int64_t first = chunk_.value_or(Chunk{}).range(study_.case_count()).first;
    ResultReader reader(part, csv_);
    if (reader.bytes() == 0) return begin();
    std::int64_t keep = reader.bytes();
    hash_ = reader.rows_hash();
    while (auto result = reader.next()) {
        const std::int64_t index = result->of->number - 1;
        if (index != first + rows_ || !late.empty()) {
            late.insert_or_assign(index, std::move(*result));
            continue;
        }
        take(*result);
        ++rows_;
        keep = reader.bytes();
        hash_ = reader.rows_hash();
    }
    open(keep);
    error_ = file_->error();
    return error_.empty();
}

bool ResultFile::take_whole(const std::function<void(const CaseResult&)>& take) const {
    const auto identity = read_identity(path_);
    const CaseRange range = chunk_.value_or(Chunk{}).range(study_.case_count());
    if (!identity || !belongs(*identity) || identity->rows != range.count()) return false;
    for (const bool second : {false, true}) {  // first whether it is whole
        ResultReader reader(path_, csv_);
        std::int64_t rows = 0;
        while (const auto result = reader.next()) {
            if (result->of->number - 1 != range.first + rows++) return false;
            if (second) take(*result);
        }
        if (rows != range.count() || reader.rows_hash() != identity->rows_hash) return false;
    }
    return true;
}

bool ResultFile::add(const CaseResult& result) {
    const std::string row = csv_.row(result);
    hash_ = text_hash(hash_ + row);
    ++rows_;
    file_->write(row);
    file_->flush();
    error_ = file_->error();
    return error_.empty();
}

void ResultFile::keep_late(const std::map<std::int64_t, CaseResult>& results) {
    for (const auto& [index, result] : results) file_->write(csv_.row(result));
    file_->flush();
}

bool ResultFile::commit() {
    if (!file_->is_regular()) return file_->commit();
    const std::string part = file_->part();
    if (!write_sidecar(path_, true)) return false;
    if (!file_->commit()) error_ = file_->error();
    std::error_code gone;
    if (error_.empty()) fs::remove(part + sidecar, gone);
    return error_.empty();
}

bool ResultFile::write_sidecar(const std::string& path, bool whole) {
    OutputFile file(path + sidecar);
    file.write(metadata(whole));
    if (!file.commit()) error_ = file.error();
    return error_.empty();
}

std::string ResultFile::metadata(bool whole) const {
    nlohmann::ordered_json json{{"@context", "http://www.w3.org/ns/csvw"},
                                {"url", fs::path(path_).filename().string()},
                                {"dc:title", study_.title},
                                {"lineshaft:version", version()},
                                {"lineshaft:study", study_.identity},
                                {"lineshaft:cases", study_.case_count()}};
    if (chunk_) json["lineshaft:chunk"] = {{"index", chunk_->index}, {"of", chunk_->of}};
    if (whole) json["lineshaft:rows"] = rows_;
    if (whole) json["lineshaft:rows_hash"] = hash_;
    json["tableSchema"] = {{"columns", csv_.schema()}};
    return json.dump(2) + "\n";
}

}  // namespace lineshaft
