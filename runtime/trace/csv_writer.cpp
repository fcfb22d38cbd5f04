#include "runtime/trace/csv_writer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "runtime/csv/csv_cells.hpp"
#include "runtime/source/number_text.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t written_at_once = 65536;

char* append(char* end, Type type, std::uint64_t bits) {
    if (type == Type::real) return write_real(end, std::bit_cast<double>(bits));
    return type == Type::unsigned_integer ? write_unsigned(end, bits)
                                          : write_integer(end, static_cast<std::int64_t>(bits));
}

/// An enumeration's number as what it counts.
Type written_as(const Signal& signal) {
    const bool has_sign = signal.type != Type::enumeration || signal.names.has_sign();
    return has_sign ? signal.type : Type::unsigned_integer;
}

}  // namespace

CsvWriter::CsvWriter(std::string path, const TraceSetup& setup, const CsvStyle& style)
    : file_(std::make_unique<OutputFile>(path)),
      path_(std::move(path)),
      signals_(setup.signals),
      style_(style),
      separator_(style.excel_de ? ';' : ',') {
    std::string header = title_of(style_, "time", "s") + separator_ + "scan";
    for (const Signal& signal : signals_)
        header += separator_ + quoted(title_of(style_, signal.name, signal.unit), separator_);
    write(header + "\n");
    make_room();
}

CsvWriter::CsvWriter(std::string path, const TraceSetup& setup, const CsvStyle& style,
                     StateReader& begun)
    : file_(std::make_unique<OutputFile>(path, begun)),
      path_(std::move(path)),
      signals_(setup.signals),
      style_(style),
      separator_(style.excel_de ? ';' : ',') {
    begun.get(row_count_, 0, std::numeric_limits<std::int64_t>::max());
    begun.get(checksum_);
    make_room();
}

void CsvWriter::save(StateWriter& out) {
    file_->save(out);
    out.put(row_count_);
    out.put(checksum_);
}

void CsvWriter::make_room() {
    for (const Signal& signal : signals_) cells_.push_back({.type = written_as(signal)});
    longest_row_ = static_cast<std::ptrdiff_t>((2 + signals_.size()) * (longest_number + 1));
    text_.resize(static_cast<std::size_t>(longest_row_) + written_at_once);
}

void CsvWriter::rows(const std::uint64_t* words, std::size_t rows) {
    const char separator = separator_;
    char* end = text_.data();
    for (std::size_t row = 0; row < rows; ++row) {
        if (text_.data() + text_.size() - end < longest_row_) end = write_out(end);
        end = write_seconds(end, static_cast<std::int64_t>(*words++));
        *end++ = separator;
        end = write_integer(end, static_cast<std::int64_t>(*words++));
        for (Cell& cell : cells_) {
            *end++ = separator;
            end = append_cell(end, cell, *words++);
        }
        *end++ = '\n';
    }
    write_out(end);
    row_count_ += static_cast<std::int64_t>(rows);
}

void CsvWriter::write(std::string_view text) {
    checksum_.add(text);
    file_->write(text);
}

char* CsvWriter::write_out(char* end) {
    if (style_.excel_de) std::replace(text_.data(), end, '.', ',');
    write({text_.data(), static_cast<std::size_t>(end - text_.data())});
    for (Cell& cell : cells_) cell.text = nullptr;
    return text_.data();
}

char* CsvWriter::append_cell(char* end, Cell& cell, std::uint64_t bits) {
    if (cell.bits != bits || !cell.text) {
        char* const begin = end;
        end = append(end, cell.type, bits);
        cell = {.type = cell.type,
                .bits = bits,
                .text = begin,
                .length = static_cast<std::size_t>(end - begin)};
        return end;
    }
    std::array<char, longest_number> text;  // the two may overlap
    std::memcpy(text.data(), cell.text, text.size());
    std::memcpy(end, text.data(), text.size());
    return end + cell.length;
}

WrittenTable CsvWriter::written() const {
    return {.path = path_,
            .signals = signals_,
            .style = style_,
            .rows = row_count_,
            .crc32 = checksum_.text()};
}

void CsvWriter::hand_over(OutputSet& files, std::string sidecar) {
    files.add(std::move(file_), std::move(sidecar));
}

}  // namespace lineshaft
