#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/serve/http.hpp"
#include "runtime/serve/modbus_session.hpp"
#include "tests/count_of.hpp"
#include "tests/folder.hpp"
#include "tests/runtime/serve/simulated_world.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr std::int64_t millisecond = 1'000'000, patience = 8'000 * millisecond;
constexpr int writers = 4;

constexpr const char* program_text = R"(lineshaft: 1
tasks: {main: {every: 5 ms, priority: 1}, fast: {every: 2 ms, priority: 2}}
blocks:
  late: {type: ton, task: main, in: inputs.go, pt: 20 ms}
  counter: {type: ctu, task: fast, cu: late.q, pv: inputs.w0}
inputs: {go: false, w0: 0, w1: 0, w2: 0, w3: 0}
modbus:
  coils: {0: {signal: inputs.go, write: true}}
  holding_registers:
    0: {signal: inputs.w0, type: uint16, write: true}
    1: {signal: inputs.w1, type: uint16, write: true}
    2: {signal: inputs.w2, type: uint16, write: true}
    3: {signal: inputs.w3, type: uint16, write: true}
  input_registers: {0: counter.cv}
run: {for: 1 s}
)";

Loaded loaded(const std::string& recording) {
    Diagnostics out;
    const auto file = std::make_shared<SourceFile>(SourceFile{"program.yaml", program_text});
    LoadOptions options;
    options.recording = recording;
    Loaded loaded{.program = read_program(file, options, out), .linked = {}};
    loaded.linked = link(loaded.program, standard_blocks(), out);
    if (!out.empty()) throw std::runtime_error(out.render());
    return loaded;
}

/// What all signals are after each scan.
class Watcher final : public Observer {
  public:
    explicit Watcher(const Machine& machine) : machine_(machine) {}

    void scanned(int task, const Scan& scan) override {
        std::string row = fmt::format("{} {}", scan.time, task);
        for (const Signal& signal : machine_.signals) row += " " + signal.describe(signal.value());
        rows.push_back({scan.time, std::move(row)});
    }
    void settled(std::int64_t, std::int64_t) override {}

    struct Row {
        std::int64_t time;
        std::string text;
        bool operator==(const Row&) const = default;
    };
    std::vector<Row> rows;

  private:
    const Machine& machine_;
};

/// One run of a served machine and its clients, all by one seed.
class Simulation {
  public:
    Simulation(std::uint64_t seed, const Faults& faults) : world_(seed, faults) {}

    /// What does not hold; empty when all does.
    std::string run();

    int acknowledged = 0, answered = 0, refused = 0;

    /// What is left of it.
    std::string recording() const { return world_.left("recording.yaml"); }

  private:
    void serve();
    void play_modbus(int writer, SimulatedLine& line);
    void play_http(int writer, SimulatedLine& line);
    void check_recording();
    void check_replay();
    void note(int writer, int value);
    void complain(const std::string& what) {
        if (complaint_.empty()) complaint_ = what;
    }

    struct Write {
        int writer, value;
    };

    SimulatedWorld world_;
    std::atomic<bool> interrupt_ = false;
    std::string complaint_;
    std::vector<Write> kept_;  ///< that were acknowledged
    std::vector<Watcher::Row> rows_;
};

void Simulation::note(int writer, int value) {
    ++answered;
    if (world_.is_killed()) return;
    ++acknowledged;
    kept_.push_back({writer, value});
}

std::string frame_of(int transaction, std::initializer_list<int> data) {
    std::string frame;
    for (const int word : {transaction, 0, static_cast<int>(data.size()) + 1})
        frame += {static_cast<char>(word >> 8), static_cast<char>(word)};
    frame += '\1';
    for (const int byte : data) frame += static_cast<char>(byte);
    return frame;
}

/// Requests in bursts and pieces, without waiting for answers; each has its own.
void Simulation::play_modbus(int writer, SimulatedLine& line) {
    struct Sent {
        int transaction, value;  ///< value 0: nothing is written
    };
    std::deque<Sent> open;
    std::string got, waiting;
    int transaction = 0, value = 0;
    const auto take = [&](std::int64_t until) {
        const std::string bytes = line.receive(until);
        got += bytes;
        const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(got[at]); };
        while (got.size() >= 9 && got.size() >= 6u + byte(4) * 256u + byte(5)) {
            const int of = byte(0) * 256 + byte(1);
            if (open.empty() || open.front().transaction != of)
                return complain(fmt::format("an answer to {}, where {} has been asked", of,
                                            open.empty() ? -1 : open.front().transaction));
            const bool is_refused = (byte(7) & 0x80) != 0;
            refused += is_refused;
            if (open.front().value > 0 && !is_refused) note(writer, open.front().value);
            open.pop_front();
            got.erase(0, 6u + byte(4) * 256u + byte(5));
        }
    };
    const auto rounds = 5 + world_.random(20);
    for (std::int64_t i = 0; i < rounds && !line.is_shut(); ++i) {
        for (auto n = 1 + world_.random(4); n > 0; --n) {
            ++transaction;
            const auto kind = world_.random(8);
            open.push_back({transaction, kind < 4 ? ++value : 0});
            const int high = value >> 8, low = value & 0xFF;
            waiting += kind < 3    ? frame_of(transaction, {6, 0, writer, high, low})
                       : kind == 3 ? frame_of(transaction, {16, 0, writer, 0, 1, 2, high, low})
                       : kind == 4 ? frame_of(transaction, {3, 0, writer, 0, 1})
                       : kind == 5 ? frame_of(transaction, {8, 0, 0, 0, 0})
                       : kind == 6 ? frame_of(transaction, {3, 0, writer, 0, 1, 6, 0, 9, 9})
                                   : frame_of(transaction, {6, 0, 9, 0, 1});
        }
        while (!waiting.empty() && !line.is_shut()) {
            const auto part = static_cast<std::size_t>(1 + world_.random(std::ssize(waiting)));
            line.send(waiting.substr(0, part));
            waiting.erase(0, part);
            if (world_.happens(0.3))
                world_.sleep_until(world_.now() + world_.random(4 * millisecond));
        }
        take(world_.now() + world_.random(3 * millisecond));
    }
    for (const std::int64_t end = world_.now() + patience;
         !open.empty() && !line.is_shut() && world_.now() < end;)
        take(end);
    if (!open.empty() && !line.is_shut() && !interrupt_)
        complain(fmt::format("request {} of {} was never answered", open.front().transaction,
                             transaction));
    line.hang_up();
}

/// One request after the other, each in pieces.
void Simulation::play_http(int writer, SimulatedLine& line) {
    const auto rounds = 3 + world_.random(10);
    for (int value = 1; value <= rounds && !line.is_shut(); ++value) {
        const std::string body = fmt::format("{{\"inputs.w{}\": {}}}", writer, value);
        std::string request =
            fmt::format("POST /api/set HTTP/1.1\r\nHost: localhost\r\nContent-Length: {}\r\n\r\n{}",
                        body.size(), body);
        while (!request.empty() && !line.is_shut()) {
            const auto part = static_cast<std::size_t>(1 + world_.random(std::ssize(request)));
            line.send(request.substr(0, part));
            request.erase(0, part);
            if (world_.happens(0.2))
                world_.sleep_until(world_.now() + world_.random(9 * millisecond));
        }
        std::string got;
        const std::int64_t end = world_.now() + patience;
        while (!line.is_shut() && world_.now() < end) {
            got += line.receive(end);
            const std::size_t head = got.find("\r\n\r\n"), length = got.find("Content-Length: ");
            if (head != got.npos && length < head &&
                got.size() >= head + 4 + std::stoul(got.substr(length + 16)))
                break;
        }
        if (got.starts_with("HTTP/1.1 200"))
            note(writer, value);
        else if (got.starts_with("HTTP/1.1 "))
            ++refused;
        else if (!line.is_shut() && !interrupt_)
            complain("a request by HTTP was never answered");
    }
    line.hang_up();
}

void Simulation::serve() {
    Loaded program = loaded("");
    program.linked.machine.duration = never - 1;
    Executive executive(program.linked.machine);
    Watcher watcher(program.linked.machine);
    executive.add(watcher);
    const std::int64_t syncs[] = {RecordSync::each, 10 * millisecond, RecordSync::none};
    const auto sync = static_cast<std::size_t>(world_.random(std::ssize(syncs)));
    RecordingWriter recording(world_, "recording.yaml", {"program.yaml", "0123456789abcdef"}, false,
                              {syncs[sync]});
    if (!recording.error().empty()) return;  // refused: nobody could come
    const double speed = world_.happens(0.5) ? 1 : 10;
    Live live(program, executive, {.speed = speed, .interrupt = &interrupt_}, &recording, world_);
    Desk desk(program);
    Api api(live, desk, program, [] { return std::string(); });
    const HttpOptions options{.address = {}, .guard = {.allow_write = true}};
    HttpServer http(api, options, world_);
    ModbusDesk modbus(live, desk, program.linked.modbus, true);
    executive.begin();
    {
        const std::size_t most = world_.happens(0.2) ? 2 : 8;
        Clients clients(world_, most, [&](Client& client) { converse(modbus, client, world_); });
        Clients visitors(world_, most, [&](Client& client) { http.converse(client); });
        std::deque<SimulatedLine> lines;
        std::vector<std::thread> threads;
        int playing = writers;
        for (int writer = 0; writer < writers; ++writer) {
            SimulatedLine& line = lines.emplace_back(world_);
            const bool by_http = writer % 2 == 1;
            (by_http ? visitors : clients).admit(line.socket());
            threads.push_back(world_.start_client([&, writer, by_http] {
                world_.sleep_until(world_.now() + world_.random(5 * millisecond));
                by_http ? play_http(writer, line) : play_modbus(writer, line);
                if (--playing == 0) interrupt_ = true;
            }));
        }
        if (world_.happens(0.5))
            threads.push_back(world_.start_client([&, sync] {
                world_.sleep_until(world_.now() + world_.random(100 * millisecond));
                const bool of_power = syncs[sync] == RecordSync::each && world_.happens(0.5);
                world_.kill(of_power);
                interrupt_ = true;
            }));
        live.drive();
        http.end();
        interrupt_ = true;
        for (std::thread& thread : threads) world_.join(thread);
    }
    recording.finish(live.time());
    rows_ = std::move(watcher.rows);
}

/// Everything that was acknowledged stands in what is left, in a line that is whole.
void Simulation::check_recording() {
    const std::string text = world_.left("recording.yaml");
    const std::string_view whole(text.data(), text.rfind('\n') + 1);
    for (const auto& [writer, value] : kept_)
        if (whole.find(fmt::format("inputs.w{}: {}}}", writer, value)) == whole.npos)
            return complain(
                fmt::format("w{} = {} was acknowledged and is not recorded", writer, value));
}

/// What is left of the recording, played back, gives the same scans up to its last entry.
void Simulation::check_replay() {
    const Folder folder;
    const std::string path = folder / "recording.yaml";
    std::ofstream(path, std::ios::binary) << world_.left("recording.yaml");
    Loaded again = loaded(path);
    Executive executive(again.linked.machine);
    Watcher watcher(again.linked.machine);
    executive.add(watcher);
    executive.begin();
    executive.run_until(again.linked.machine.end);
    const std::int64_t end = again.linked.machine.end;
    const auto until_end = [&](std::vector<Watcher::Row>& rows) {
        std::erase_if(rows, [&](const auto& row) { return row.time >= end; });
    };
    until_end(rows_);
    until_end(watcher.rows);
    if (watcher.rows.size() != rows_.size())
        return complain(fmt::format("{} scans were {} when they were played back", rows_.size(),
                                    watcher.rows.size()));
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (rows_[i] != watcher.rows[i])
            return complain(fmt::format("'{}' was '{}' when it was played back", rows_[i].text,
                                        watcher.rows[i].text));
}

std::string Simulation::run() {
    serve();
    check_recording();
    const std::string left = world_.left("recording.yaml");
    if (left.find("entries:\n") != left.npos) check_replay();
    return complaint_;
}

/// Faults of which the seed has some or none.
Faults faults_of(std::uint64_t seed) {
    std::mt19937_64 random(seed ^ 0x5EED);
    const auto part = [&](double most) { return random() % 2 == 0 ? 0 : most; };
    return {.no_thread = part(0.2), .full_disk = part(0.1), .failed_flush = part(0.01)};
}

}  // namespace

TEST_CASE(
    "a served machine in a simulated world keeps what it acknowledges, answers all, replays") {
    const auto first = static_cast<std::uint64_t>(count_of("LINESHAFT_SEED", 1)),
               count = static_cast<std::uint64_t>(count_of("LINESHAFT_WORLDS", 300));
    int acknowledged = 0, answered = 0, refused = 0;
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        Simulation simulation(seed, faults_of(seed));
        INFO("LINESHAFT_SEED=" << seed << " LINESHAFT_WORLDS=1");
        REQUIRE(simulation.run() == "");
        acknowledged += simulation.acknowledged;
        answered += simulation.answered;
        refused += simulation.refused;
    }
    if (count >= 300) CHECK((acknowledged > 1000 && answered > acknowledged && refused > 100));
    if (std::getenv("LINESHAFT_FIGURES"))
        WARN(count << " worlds: " << answered << " writes answered, " << acknowledged
                   << " of them before a kill, " << refused << " requests refused");
}

TEST_CASE("a simulated world of one seed is the same one each time") {
    const auto told = [](std::uint64_t seed) {
        Simulation simulation(seed, faults_of(seed));
        return fmt::format("'{}' {} {} {}\n{}", simulation.run(), simulation.acknowledged,
                           simulation.answered, simulation.refused, simulation.recording());
    };
    for (std::uint64_t seed = 1; seed <= 5; ++seed) CHECK(told(seed) == told(seed));
}

TEST_CASE("planted faults are found in a simulated world, and each time by the same seed") {
    const auto found_by = [](const Faults& faults, const std::string& words) {
        for (std::uint64_t seed = 1; seed <= 100; ++seed) {
            const std::string complaint = Simulation(seed, faults).run();
            if (complaint.empty()) continue;
            INFO(complaint);
            CHECK(complaint.find(words) != complaint.npos);
            CHECK(Simulation(seed, faults).run() == complaint);
            return true;
        }
        return false;
    };
    CHECK(found_by({.no_wait_for_disk = true}, "is not recorded"));
    CHECK(found_by({.lost_request = true}, "answer"));
}
