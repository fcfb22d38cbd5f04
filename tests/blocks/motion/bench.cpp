#include "tests/blocks/motion/bench.hpp"

#include <cmath>
#include <sstream>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/machine/kept_memory.hpp"
#include "runtime/program/program.hpp"
#include "tests/blocks/scanning.hpp"

namespace lineshaft::test {

namespace {

using Row = std::vector<std::string>;

Row split(const std::string& line) {
    std::istringstream in(line);
    Row cells;
    for (std::string cell; in >> cell;) cells.push_back(cell);
    return cells;
}

Value value_of(Type type, std::span<const std::string_view> names, const std::string& cell) {
    if (type == Type::boolean) return cell == "1";
    if (type == Type::integer) return std::int64_t{std::stoll(cell)};
    if (type == Type::real) return std::stod(cell);
    const auto name = std::ranges::find(names, cell);
    REQUIRE(name != names.end());
    return name - names.begin();
}

}  // namespace

MotionBench::MotionBench(std::string program) {
    Diagnostics out;
    const auto file = std::make_shared<const SourceFile>(
        SourceFile{"bench.yaml", "lineshaft: 1\n" + program + "\nrun: {for: 1000 h}\n"});
    const Program read = read_program(file, {}, out);
    REQUIRE(out.render() == "");
    linked_ = link(read, standard_blocks(), out);
    INFO(out.render());
    REQUIRE(out.empty());  // commands that nothing in the program begins are begun by the test
    linked_.machine.continue_on_error = true;
    StateWriter state;
    Executive(linked_.machine).save(state);
    beginning_ = state.bytes();
    restart();
}

Port MotionBench::port(std::string_view signal) const {
    const auto dot = signal.find('.');
    const int number = linked_.net.instance_numbers.at(std::string(signal.substr(0, dot)));
    const BlockType& type = *linked_.net.instance(number).type;
    const Field* field = type.find_settable(signal.substr(dot + 1));
    if (!field) field = type.find_readable(signal.substr(dot + 1));
    INFO(signal);
    REQUIRE(field);
    return linked_.net.port(number, *field);
}

void MotionBench::set(std::string_view signal, const Value& value) {
    const Port to = port(signal);
    store(linked_.net.field(to).type, linked_.machine.live(to), value);
}

Value MotionBench::get(std::string_view signal) const {
    const Port from = port(signal);
    return load(linked_.net.field(from).type,
                const_cast<Machine&>(linked_.machine).published(from));
}

std::byte* MotionBench::live(std::string_view signal) {
    return linked_.machine.live(port(signal));
}

void MotionBench::restart() {
    resume(beginning_, 0);
}

std::string MotionBench::checkpoint() const {
    StateWriter state;
    executive_->save(state);
    return state.bytes();
}

void MotionBench::resume(const std::string& state, std::int64_t next) {
    executive_ = std::make_unique<Executive>(linked_.machine);
    StateReader in(state);
    executive_->restore(in);
    REQUIRE(in.at_end());
    executive_->begin();
    next_ = next;
}

void MotionBench::step(std::int64_t milliseconds) {
    next_ += milliseconds;
    executive_->run_until((next_ - 1) * millisecond);
    constexpr std::int64_t seldom = 16;
    if (next_ % seldom == 0)
        REQUIRE(KeptMemory(linked_.machine, now() * millisecond).damaged() == "");
}

std::string MotionBench::text(std::string_view signal) const {
    const Field& field = linked_.net.field(port(signal));
    const Value value = get(signal);
    if (field.type == Type::boolean) return std::get<bool>(value) ? "1" : "0";
    if (field.type == Type::real)
        return fmt::format("{:.7g}", std::round(as_real(value) * 1e5) / 1e5 + 0.0);
    return describe(value, field.type, field.names, "");
}

void MotionBench::check(std::string_view table) {
    std::istringstream lines{std::string(table)};
    Row head;
    for (std::string line; std::getline(lines, line);) {
        const Row row = split(line);
        if (row.empty()) continue;
        if (head.empty()) {
            head = row;
            continue;
        }
        INFO(line);
        REQUIRE(row.size() == head.size());
        step(std::stoll(row[0]) - next_);
        bool is_output = false;
        std::string found = row[0];
        for (std::size_t i = 1; i < row.size(); ++i) {
            if (row[i] == "|") {
                step();
                is_output = true;
                found += " |";
                continue;
            }
            if (!is_output && row[i] != ".") {
                const Field& field = linked_.net.field(port(head[i]));
                set(head[i], value_of(field.type, field.names, row[i]));
            }
            found += " " + (is_output && row[i] != "." ? text(head[i]) : row[i]);
        }
        std::string wanted;
        for (const std::string& cell : row) wanted += (wanted.empty() ? "" : " ") + cell;
        CHECK(found == wanted);
    }
}

}  // namespace lineshaft::test
