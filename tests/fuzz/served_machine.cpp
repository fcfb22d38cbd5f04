#include "tests/fuzz/served_machine.hpp"

#include <cstdio>
#include <cstdlib>

#include <sys/socket.h>
#include <unistd.h>

#include "blocks/catalog.hpp"

namespace lineshaft::test {

namespace {

constexpr std::int64_t end = 10'000'000'000;

constexpr const char* program = R"(lineshaft: 1
tasks: {main: {every: 10 ms, priority: 1}, fast: {every: 5 ms, priority: 2}}
blocks:
  x: {type: axis, task: fast}
  power: {type: MC_Power, task: main, Axis: x, Enable: inputs.go}
  late: {type: ton, task: main, in: inputs.go, pt: 20 ms}
  counter: {type: ctu, task: main, cu: inputs.count, pv: 5}
inputs: {go: false, count: false, ratio: 1.5, fixed: 1.5}
modbus:
  coils: {5: {signal: inputs.go, write: true}, 6: {signal: inputs.count, write: true}, 7: late.q}
  discrete_inputs: {0: late.q}
  holding_registers:
    10: {signal: inputs.ratio, type: real32, write: true}
    12: {signal: inputs.fixed, type: real64, words: low_first}
    20: {signal: inputs.ratio, type: int16, scale: 0.01, write: true, order: little}
    21: {signal: x.state, type: uint16}
    30: {signal: inputs.ratio, type: int64, write: true}
  input_registers: {0: counter.cv}
run: {for: 1 s}
trace: {task: main, signals: [late.q, x.position]}
)";

Loaded load() {
    Diagnostics out;
    const auto file = std::make_shared<SourceFile>(SourceFile{"program.yaml", program});
    Loaded loaded{.program = read_program(file, {}, out), .linked = {}};
    loaded.linked = link(loaded.program, standard_blocks(), out);
    if (!out.empty()) {
        std::fputs(out.render().c_str(), stderr);
        std::abort();
    }
    loaded.linked.machine.duration = never - 1;
    return loaded;
}

}  // namespace

ServedMachine::ServedMachine()
    : loaded_(load()),
      executive_(loaded_.linked.machine),
      live(loaded_, executive_, {.end = end, .interrupt = &interrupt_}, nullptr),
      desk(loaded_),
      api(live, desk, loaded_, [] { return std::string("checkpoint"); }),
      map(loaded_.linked.modbus) {
    executive_.begin();
    live.step(-1, 1);
}

std::string ServedMachine::state() const {
    const Machine& machine = loaded_.linked.machine;
    const LiveState now = live.state();
    std::string text(reinterpret_cast<const char*>(machine.memory.data()), machine.memory.size());
    text += std::to_string(now.time) + ' ' + std::to_string(now.speed) + ' ' +
            std::to_string(now.paused) + ' ' + std::to_string(machine.forces.size());
    return text;
}

void ServedMachine::go_on() {
    Machine& machine = loaded_.linked.machine;
    while (!machine.forces.empty()) {
        executive_.lift_force(machine.forces.front().live);
        live.step(-1, 1);
    }
    live.set_speed(1);
    live.step(-1, 1);
}

std::string ServedMachine::inputs() const {
    std::string text;
    for (const Signal& signal : loaded_.linked.machine.signals)
        if (signal.name.starts_with("inputs.")) text += signal.describe(signal.value()) + ' ';
    return text;
}

bool ServedMachine::is_fixed() const {
    return std::get<double>(loaded_.linked.machine.find("inputs.fixed")->value()) == 1.5;
}

std::string ServedMachine::answer(std::string_view bytes,
                                  const std::function<void(Client&)>& converse) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) std::abort();
    const int room = 8 << 20;  // for all answers, which are read when all are there
    ::setsockopt(ends[1], SOL_SOCKET, SO_SNDBUFFORCE, &room, sizeof room);
    const auto written = ::send(ends[0], bytes.data(), bytes.size(), 0);
    if (written != static_cast<ssize_t>(bytes.size())) std::abort();
    ::shutdown(ends[0], SHUT_WR);
    {
        Client client(system_socket(ends[1]), 0);
        converse(client);
    }
    std::string answered;
    char part[4096];
    for (ssize_t got = 0; (got = ::recv(ends[0], part, sizeof part, 0)) > 0;)
        answered.append(part, static_cast<std::size_t>(got));
    ::close(ends[0]);
    return answered;
}

ServedMachine& ServedMachine::get() {
    static std::unique_ptr<ServedMachine> machine;
    if (!machine || machine->live.time() > end / 2) machine = std::make_unique<ServedMachine>();
    return *machine;
}

}  // namespace lineshaft::test
