#include "runtime/serve/serve.hpp"

#include <filesystem>

#include "runtime/program/meaning.hpp"
#include "runtime/serve/modbus.hpp"

namespace lineshaft {

namespace {

constexpr const char* realtime_help =
    "run as root, or allow it: setcap cap_sys_nice,cap_ipc_lock+ep on the program, or rtprio and "
    "memlock in /etc/security/limits.conf";

void refuse_address(const Address& address, Diagnostics& refused) {
    if (address.port == 0) return;
    std::string cure;
    const std::string error = address.obstacle(cure);
    if (!error.empty()) refused.add("L0510", {}, error, cure);
}

/// What is written to the recording's file, if there is one.
void open_recording(std::optional<RecordingWriter>& recording, const Loaded& loaded,
                    const std::string& path, bool goes_on, Diagnostics& refused) {
    if (path.empty()) return;
    const std::string program =
        std::filesystem::path(loaded.program.file->path).filename().string();
    recording.emplace(path, program, meaning_of(loaded.program).in_force, goes_on);
    if (!recording->error().empty())
        refused.add("L0512", {}, recording->error(), "name another file: --record FILE.yaml");
}

}  // namespace

ServeReport serve(Loaded& loaded, RunOptions how, const ServeOptions& options,
                  const std::function<void()>& ready) {
    loaded.linked.machine.duration = never - 1;
    loaded.linked.expectations.clear();
    ServeReport report;
    Diagnostics& refused = report.run.refused;
    refuse_address(options.http.address, refused);
    refuse_address(options.modbus, refused);
    std::optional<RecordingWriter> recording;
    if (refused.empty())
        open_recording(recording, loaded, options.record, how.restart == Restart::hot, refused);
    if (options.realtime > 0)
        if (const std::string error = Pacer::be_realtime(options.realtime); !error.empty())
            refused.add("L0511", {}, error, realtime_help);
    if (!refused.empty()) return report;

    std::int64_t end = 0;
    if (recording) how.observer = &*recording;
    how.drive = [&](Executive& executive, const std::function<std::string()>& checkpoint) {
        Live live(loaded, executive, options.live, recording ? &*recording : nullptr);
        Desk desk(loaded);
        Api api(live, desk, loaded, checkpoint);
        ModbusDesk modbus_desk(live, desk, loaded.linked.modbus, options.http.allow_write);
        std::optional<HttpServer> http;
        std::optional<ModbusServer> modbus;
        if (options.http.address.port > 0) http.emplace(api, options.http);
        if (options.modbus.port > 0) modbus.emplace(modbus_desk, options.modbus);
        ready();
        live.drive();
        report.pace = live.pace();
        end = live.time();
    };
    report.run = run(loaded, how);
    if (recording) {
        recording->finish(end);
        report.recording_error = recording->error();
    }
    return report;
}

}  // namespace lineshaft
