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

PulseWriter::PulseWriter(std::string path, Machine& machine) : file_(path), path_(std::move(path)) {
    file_.write("channel,time_ns,direction\n");
    listen_to(machine);
}

PulseWriter::PulseWriter(std::string path, Machine& machine, StateReader& begun)
    : file_(path, begun), path_(std::move(path)) {
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
    writer.file_.write({text.data(), static_cast<std::size_t>(end - text.data())});
}

std::string PulseWriter::finish(const std::string& stopped) {
    std::error_code none;  // then a later step tells what is wrong
    if (file_.is_regular() && !file_.failed()) std::filesystem::remove(sidecar_path(path_), none);
    if (!file_.commit() || stopped.empty() || !file_.is_regular()) return file_.error();
    const nlohmann::ordered_json note{{"@context", "http://www.w3.org/ns/csvw"},
                                      {"url", std::filesystem::path(path_).filename().string()},
                                      {"lineshaft:stopped", stopped}};
    OutputFile sidecar(sidecar_path(path_));
    sidecar.write(note.dump(2) + "\n");
    sidecar.commit();
    return sidecar.error();
}

}  // namespace lineshaft
