#include <atomic>
#include <fstream>
#include <random>
#include <thread>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/serve/modbus_session.hpp"
#include "tests/source_folder.hpp"

using namespace lineshaft;

namespace {

std::string clause_program() {
    std::string inputs = "single: 1.5, fixed: 0, flag: false, last_bit: false, last_word: 0",
                coils = "65535: {signal: inputs.last_bit, write: true}", discrete,
                holding =
                    "65535: {signal: inputs.last_word, type: uint16, write: true}, "
                    "200: {signal: inputs.fixed, type: uint16}, "
                    "210: {signal: inputs.single, type: real32, write: true}, "
                    "220: {signal: inputs.flag, write: true}",
                input;
    for (int i = 0; i < 2000; ++i) {
        inputs += fmt::format(", bit{}: false", i);
        coils += fmt::format(", {0}: {{signal: inputs.bit{0}, write: true}}", i);
        discrete += fmt::format("{0}: inputs.bit{0}, ", i);
    }
    for (int i = 0; i < 131; ++i) {
        inputs += fmt::format(", word{}: 0", i);
        holding += fmt::format(", {0}: {{signal: inputs.word{0}, type: uint16, write: true}}", i);
        input += fmt::format("{0}: {{signal: inputs.word{0}, type: uint16}}, ", i);
    }
    return fmt::format(
        "lineshaft: 1\ntasks: {{main: {{every: 1 ms}}}}\n"
        "blocks: {{late: {{type: ton, task: main, in: inputs.flag, pt: 1 s}}}}\n"
        "inputs: {{{}}}\nmodbus:\n  coils: {{{}}}\n  discrete_inputs: {{{}65535: "
        "inputs.last_bit}}\n"
        "  holding_registers: {{{}}}\n  input_registers: {{{}65535: {{signal: inputs.last_word, "
        "type: uint16}}}}\nrun: {{for: 1 s}}\n",
        inputs, coils, discrete, holding, input);
}

constexpr const char* small_program = R"(lineshaft: 1
tasks: {main: {every: 1 ms}}
blocks: {late: {type: ton, task: main, in: inputs.flag, pt: 1 s}}
inputs: {flag: false, word: 0}
modbus: {holding_registers: {0: {signal: inputs.word, type: uint16, write: true}}}
run: {for: 1 s}
)";

/// A served machine that stands still, in the thread that makes it.
class Served {
  public:
    explicit Served(const std::string& program)
        : loaded_(load(program)),
          executive_(loaded_.linked.machine),
          live(loaded_, executive_, {.interrupt = &interrupt}, nullptr),
          desk_(loaded_),
          modbus(live, desk_, loaded_.linked.modbus, true) {
        executive_.begin();
        live.step(-1, 1);
    }

    std::atomic<bool> interrupt = false;

  private:
    static Loaded load(const std::string& program) {
        Diagnostics out;
        const auto file = std::make_shared<SourceFile>(SourceFile{"program.yaml", program});
        Loaded loaded{.program = read_program(file, {}, out), .linked = {}};
        loaded.linked = link(loaded.program, standard_blocks(), out);
        INFO(out.render());
        REQUIRE(out.empty());
        loaded.linked.machine.duration = never - 1;
        return loaded;
    }

    Loaded loaded_;
    Executive executive_;

  public:
    Live live;

  private:
    Desk desk_;

  public:
    ModbusDesk modbus;
};

/// `0a 0b*2` -> three bytes.
std::string bytes_of(const std::string& text) {
    std::string bytes;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        const std::size_t star = word.find('*');
        const int times = star == word.npos ? 1 : std::stoi(word.substr(star + 1));
        std::string part;
        for (std::size_t at = 0; at + 1 < std::min(star, word.size()); at += 2)
            part += static_cast<char>(std::stoi(word.substr(at, 2), nullptr, 16));
        for (int i = 0; i < times; ++i) bytes += part;
    }
    return bytes;
}

std::string framed(const std::string& data, int transaction = 0x1234) {
    const std::size_t length = data.size() + 1;
    return std::string{static_cast<char>(transaction >> 8), static_cast<char>(transaction), 0, 0,
                       static_cast<char>(length >> 8),      static_cast<char>(length),      1} +
           data;
}

std::string text_of(std::string_view bytes) {
    std::string text;
    for (const char byte : bytes) text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
    return text;
}

constexpr ModbusPeer near_peer{"127.0.0.1", true};

}  // namespace

TEST_CASE("Modbus: each clause of the specification is answered as it says") {
    Served machine(clause_program());
    std::ifstream file(test::in_source("tests/runtime/serve/modbus_clauses.txt"));
    int clauses = 0;
    for (std::string line; std::getline(file, line);) {
        const std::size_t arrow = line.find('>'), bar = line.find('|');
        if (line.starts_with('#') || arrow == line.npos) continue;
        INFO(line);
        ++clauses;
        const bool is_frame = line.starts_with("frame ");
        const std::string request =
            bytes_of(line.substr(is_frame ? 6 : 0, arrow - (is_frame ? 6 : 0)));
        const std::string answer = line.substr(arrow + 2, bar - arrow - 3);
        ModbusSession session(machine.modbus, near_peer);
        std::string got;
        for (const char byte : is_frame ? request : framed(request))
            got += session.take({&byte, 1});
        CHECK(session.is_lost() == (answer == "end"));
        if (answer == "end" || answer == "nothing")
            CHECK(got.empty());
        else
            CHECK(text_of(got) == text_of(is_frame ? bytes_of(answer) : framed(bytes_of(answer))));
    }
    CHECK(clauses >= 120);
}

TEST_CASE("Modbus: of requests that do not wait for answers none is lost, however they are cut") {
    Served machine(small_program);
    std::mt19937_64 random(3);
    const std::string kinds[] = {bytes_of("03 0000 0001"),       bytes_of("06 0000 0007"),
                                 bytes_of("03 0005 0001"),       bytes_of("08 0000 0000"),
                                 bytes_of("03 0000 0001 00"),    bytes_of("2b 0e 01 00"),
                                 bytes_of("10 0000 0001 01 00"), bytes_of("85")};
    ModbusSession session(machine.modbus, near_peer);
    int sent = 0, answered = 0;
    std::string answers;
    while (sent < 10'000) {
        std::string bytes;
        for (std::uint64_t n = random() % 20; n > 0; --n)
            bytes += framed(kinds[random() % std::size(kinds)], sent++ % 65536);
        for (std::string_view rest = bytes; !rest.empty();) {
            const std::size_t part = 1 + random() % rest.size();
            answers += session.take(rest.substr(0, part));
            rest.remove_prefix(part);
        }
        for (; answers.size() >= 6; ++answered) {
            const auto word = [&](std::size_t at) {
                return static_cast<unsigned char>(answers[at]) << 8 |
                       static_cast<unsigned char>(answers[at + 1]);
            };
            REQUIRE(word(0) == answered % 65536);
            answers.erase(0, 6 + static_cast<std::size_t>(word(4)));
        }
    }
    CHECK(answered == sent);
}

TEST_CASE("Modbus: who may not write reads, and writes nothing") {
    Served machine(small_program);
    ModbusSession session(machine.modbus, {"192.0.2.1", false});
    CHECK(text_of(session.take(framed(bytes_of("06 0000 0007")))) ==
          text_of(framed(bytes_of("86 01"))));
    CHECK(text_of(session.take(framed(bytes_of("03 0000 0001")))) ==
          text_of(framed(bytes_of("03 02 0000"))));
}

TEST_CASE(
    "Modbus: bits that clients set at once in one register are all set, also while it stands") {
    constexpr int clients = 8, rounds = 2;
    for (const bool stands : {false, true}) {
        Served machine(small_program);
        std::atomic<int> done = 0, left = clients;
        std::vector<std::thread> threads;
        if (stands) machine.live.pause();
        for (int client = 0; client < clients; ++client)
            threads.emplace_back([&, client] {
                ModbusSession session(machine.modbus, near_peer);
                for (int round = 0; round < rounds; ++round) {
                    const int bit = 1 << (rounds * client + round);
                    const std::string request =
                        framed(bytes_of(fmt::format("16 0000 {:04x} {:04x}", 0xFFFF & ~bit, bit)));
                    done += session.take(request) == request;
                }
                if (--left == 0) machine.interrupt = true;
            });
        machine.live.drive();
        for (auto& thread : threads) thread.join();
        ModbusSession session(machine.modbus, near_peer);
        CHECK(done == clients * rounds);
        CHECK(text_of(session.take(framed(bytes_of("03 0000 0001")))) ==
              text_of(framed(bytes_of("03 02 ffff"))));
    }
}
