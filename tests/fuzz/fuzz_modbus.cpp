/// The first byte tells what is allowed; the others come by Modbus/TCP. Each answer is a whole
/// frame, time stands still, and what may not be written is as it was.

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "runtime/serve/modbus_request.hpp"
#include "tests/fuzz/served_machine.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

void hold(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "%s\n", what);
    std::abort();
}

constexpr std::size_t most_pdu_bytes = 253;

/// Whether a frame without its header is one: function code and what follows it.
bool is_answer(std::string_view frame) {
    const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(frame[at]); };
    if (frame.empty() || frame.size() > most_pdu_bytes) return false;
    if (byte(0) & 0x80)
        return frame.size() == 2 && ((byte(1) >= 1 && byte(1) <= 3) || byte(1) == 6);
    switch (byte(0)) {
        case write_single_coil:
        case write_single_register:
        case write_multiple_coils:
        case write_multiple_registers:
            return frame.size() == 5;
        case mask_write_register:
            return frame.size() == 7;
        default:
            return frame.size() > 2 && frame.size() == 2u + byte(1);
    }
}

void check_frames(std::string_view answered) {
    constexpr std::size_t header = 7;
    while (!answered.empty()) {
        hold(answered.size() > header, "an answer is cut off");
        const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(answered[at]); };
        const std::size_t size = 256u * byte(4) + byte(5);
        hold(byte(2) == 0 && byte(3) == 0 && size > 1 && answered.size() >= 6 + size,
             "an answer has a wrong header");
        hold(is_answer(answered.substr(header, size - 1)), "an answer is none of its function");
        answered.remove_prefix(6 + size);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    ServedMachine& machine = ServedMachine::get();
    const bool allow_write = data[0] & 1, may_write = data[0] & 2;
    ModbusDesk desk(machine.live, machine.desk, machine.map, allow_write);
    const std::string before = machine.state(), inputs = machine.inputs();
    ModbusSession session(desk, {"127.0.0.1", may_write});
    std::string_view rest(reinterpret_cast<const char*>(data) + 1, size - 1);
    std::string answers;
    for (std::size_t part = 1; !rest.empty(); part = part * 7 % 31) {
        answers += session.take(rest.substr(0, part));
        rest.remove_prefix(std::min(part, rest.size()));
    }
    check_frames(answers);
    hold(machine.state() == before, "a client of Modbus did not leave the machine standing");
    machine.go_on();
    hold(machine.is_fixed(), "a client of Modbus wrote what is only read");
    hold((allow_write && may_write) || machine.inputs() == inputs,
         "a client of Modbus wrote what it may not");
    return 0;
}
