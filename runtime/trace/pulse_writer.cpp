#include "runtime/trace/pulse_writer.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "runtime/csv/csv_metadata.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t longest_time = 20;

}  // namespace

PulseWriter::PulseWriter(std::string path, Machine& machine)
    : file_(std::make_unique<OutputFile>(std::move(path))) {
    file_->write("channel,time_ns,direction\n");
    listen_to(machine);
}

PulseWriter::PulseWriter(std::string path, Machine& machine, StateReader& begun)
    : file_(std::make_unique<OutputFile>(std::move(path), begun)) {
    listen_to(machine);
}

void PulseWriter::listen_to(Machine& machine) {
    for (DeviceCall& device : machine.devices) {
        channels_.push_back(std::make_unique<Channel>(*this, device.name));
        device.sink = channels_.back().get();
    }
}

void PulseWriter::Channel::edges(std::span<const std::int64_t> times, bool reverse) {
    const std::string_view direction = reverse ? ",-1\n" : ",1\n";
    std::string& text = writer.text_;
    text.resize(times.size() * (name.size() + 1 + longest_time + direction.size()));
    char* end = text.data();
    for (const std::int64_t time : times) {
        end = std::ranges::copy(name, end).out;
        *end++ = ',';
        end = std::to_chars(end, end + longest_time, time).ptr;
        end = std::ranges::copy(direction, end).out;
    }
    writer.file_->write({text.data(), static_cast<std::size_t>(end - text.data())});
}

void PulseWriter::finish(OutputSet& files, const std::string& stopped) {
    const std::string name = std::filesystem::path(file_->path()).filename().string();
    const nlohmann::ordered_json note{
        {"@context", "http://www.w3.org/ns/csvw"}, {"url", name}, {"lineshaft:stopped", stopped}};
    files.add(std::move(file_), stopped.empty() ? "" : sidecar_text(note));
}

}  // namespace lineshaft
