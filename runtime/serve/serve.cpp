#include "runtime/serve/serve.hpp"

#include <filesystem>

#include <fmt/format.h>

#include "runtime/program/meaning.hpp"
#include "runtime/restart/retain.hpp"
#include "runtime/serve/modbus_session.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

constexpr const char* realtime_help =
    "run as root, or allow it: setcap cap_sys_nice,cap_ipc_lock+ep on the program, or rtprio and "
    "memlock in /etc/security/limits.conf";

void refuse_address(const Address& address, Diagnostics& refused) {
    if (address.port == 0) return;
    std::string cure;
    const std::string error = address.obstacle(cure);
    if (!error.empty()) refused.add(code::unusable_address, {}, error, cure);
}

/// What is written to the recording's file, if there is one.
void open_recording(std::optional<RecordingWriter>& recording, const Loaded& loaded,
                    const ServeOptions& options, const RunOptions& how, Diagnostics& refused) {
    if (options.record.empty()) return;
    Recorded machine{
        .program = std::filesystem::path(loaded.program.file->path).filename().string(),
        .meaning = meaning_of(loaded.program).in_force};
    if (how.restart == Restart::warm && !how.retain_path.empty())
        machine.retained = retained_line(how.retain_path);
    recording.emplace(World::system(), options.record, machine, how.restart == Restart::hot,
                      options.sync);
    if (!recording->error().empty())
        refused.add(code::recording_cannot_be_written, {}, recording->error(),
                    "name another file: --record FILE.yaml");
}

void open_audit(std::optional<Audit>& audit, const std::string& path, Diagnostics& refused) {
    if (path.empty()) return;
    audit.emplace(World::system(), path);
    if (!audit->error().empty())
        refused.add(code::recording_cannot_be_written, {}, audit->error(),
                    "name another file: --audit FILE");
}

/// A server's clients, and where they come in.
struct Door {
    Door(std::size_t most, Clients::Answer answer, const Address& address)
        : clients(World::system(), most, std::move(answer)),
          listener(clients, address.host, address.port) {}

    Clients clients;
    Listener listener;
};

void open_door(std::optional<Door>& door, std::size_t most, Clients::Answer answer,
               const Address& address, Diagnostics& refused) {
    if (address.port == 0) return;
    door.emplace(most, std::move(answer), address);
    if (!door->listener.error().empty())
        refused.add(code::unusable_address, {},
                    fmt::format("cannot listen at {}: {}", address.text(), door->listener.error()),
                    "allow this program more threads, files or memory, or name another port");
}

}  // namespace

ServeReport serve(Loaded& loaded, RunOptions how, const ServeOptions& options,
                  const std::function<void(const std::string&)>& ready) {
    loaded.linked.machine.duration = never - 1;
    loaded.linked.expectations.clear();
    ServeReport report;
    Diagnostics& refused = report.run.refused;
    refuse_address(options.http.address, refused);
    refuse_address(options.modbus, refused);
    std::optional<RecordingWriter> recording;
    std::optional<Audit> audit;
    if (refused.empty()) open_audit(audit, options.audit, refused);
    if (refused.empty()) open_recording(recording, loaded, options, how, refused);
    if (options.realtime > 0)
        if (const std::string error = Pacer::be_realtime(options.realtime); !error.empty())
            refused.add(code::no_realtime_priority, {}, error, realtime_help);
    if (!refused.empty()) return report;

    std::int64_t end = 0;
    World& world = World::system();
    Diagnostics closed;
    if (recording) how.observer = &*recording;
    how.drive = [&](Executive& executive, const std::function<std::string()>& checkpoint) {
        constexpr std::size_t most_modbus_clients = 16;
        Live live(loaded, executive, options.live, recording ? &*recording : nullptr, world);
        Desk desk(loaded);
        Api api(live, desk, loaded, checkpoint);
        Audit* const noted = audit ? &*audit : nullptr;
        HttpServer http(api, options.http, world, noted);
        if (options.http.address.port != 0 && !http.error().empty())
            closed.add(code::unusable_address, {},
                       "cannot serve HTTP without a part of lineshaft: " + http.error(),
                       "install lineshaft as a whole, or serve without a page: --http off");
        ModbusDesk modbus(live, desk, loaded.linked.modbus, options.http.guard.allow_write, noted);
        std::optional<Door> http_door, modbus_door;
        if (closed.empty())
            open_door(
                http_door, HttpServer::most_clients, [&](Client& client) { http.converse(client); },
                options.http.address, closed);
        open_door(
            modbus_door, most_modbus_clients,
            [&](Client& client) { converse(modbus, client, world); }, options.modbus, closed);
        if (closed.empty()) {
            ready(recording ? recording->path() : "");
            live.drive();
        }
        live.mailbox().close();
        http.end();
        report.pace = live.pace();
        end = live.time();
        return closed.empty();
    };
    report.run = run(loaded, how);
    if (!closed.empty()) report.run.refused = closed;
    if (recording) {
        recording->finish(end);
        report.recording_error = recording->error();
    }
    if (audit) report.audit_error = audit->error();
    return report;
}

}  // namespace lineshaft
