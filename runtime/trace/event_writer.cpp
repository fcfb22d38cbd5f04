#include "runtime/trace/event_writer.hpp"

#include <array>

#include <fmt/format.h>

#include "runtime/csv/csv_cells.hpp"
#include "runtime/source/number_text.hpp"

namespace lineshaft {

namespace {

std::string seconds_text(std::int64_t time) {
    std::array<char, longest_number> text;
    return {text.data(), write_seconds(text.data(), time)};
}

}  // namespace

std::string events_path(const std::string& trace_path) {
    const bool csv = trace_path.ends_with(".csv");
    return trace_path.substr(0, trace_path.size() - (csv ? 4 : 0)) + ".events.csv";
}

EventWriter::EventWriter(std::string path, const Machine& machine)
    : file_(std::make_unique<OutputFile>(std::move(path))), machine_(machine) {
    file_->write("time,scan,task,kind,text\n");
}

EventWriter::EventWriter(std::string path, const Machine& machine, StateReader& begun)
    : file_(std::make_unique<OutputFile>(std::move(path), begun)), machine_(machine) {}

void EventWriter::happened(const RunEvent& event) {
    const std::string scan = event.scan < 0 ? "" : std::to_string(event.scan);
    const std::string task =
        event.task < 0 ? "" : machine_.tasks[static_cast<std::size_t>(event.task)].name;
    file_->write(fmt::format("{},{},{},{},{}\n", seconds_text(event.time), scan, task,
                             name_of(event.kind), quoted(event.text)));
}

}  // namespace lineshaft
