#include "tests/blocks/motion/sequences.hpp"

#include <sstream>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "runtime/model/random.hpp"
#include "tests/blocks/scanning.hpp"

namespace lineshaft::test {

namespace {

/// What a pin may be; `Wanted` is the Velocity of MC_MoveVelocity.
std::vector<double> values_of(std::string_view pin) {
    if (pin == "Position") return {0, 1, 5, 20, 40, -30, 350};
    if (pin == "Distance") return {0, 0.001, 3, 10, -10, 40, -60};
    if (pin == "Velocity" || pin == "VelocityDiff") return {-1, 100, 50, 20, 5};
    if (pin == "Wanted") return {100, -100, 20, -40, 0};
    if (pin == "EndVelocity") return {0, 10, 50, -20};
    if (pin == "Acceleration" || pin == "Deceleration") return {-1, 1000, 300, 100};
    if (pin == "Jerk") return {-1, 50000, 5000};
    if (pin == "Direction") return {0, 1, 2, 3};
    if (pin == "BufferMode") return {0, 0, 0, 1, 2, 3, 4, 5};
    if (pin == "HomingMode") return {0, 1, 2};
    if (pin == "VelFactor") return {1, 0.5, 0};
    if (pin == "AccFactor" || pin == "JerkFactor") return {1, 0.5};
    if (pin == "ExecutionMode") return {0, 0, 1};
    return {0, 1};
}

Type type_of(std::string_view pin) {
    if (pin == "Direction" || pin == "BufferMode" || pin == "HomingMode" || pin == "ExecutionMode")
        return Type::enumeration;
    return values_of(pin).size() == 2 && values_of(pin)[1] == 1 && !pin.ends_with("Factor")
               ? Type::boolean
               : Type::real;
}

}  // namespace

Sequences::Sequences(const Setup& setup) : setup_(setup), bench_(program()) {
    for (const Pin& pin : pins_) places_.push_back(bench_.live(pin.name));
    for (NamedCommand& command : commands_)
        command.block = &bench_.block<CommandBlock>(command.name);
    for (int i = 0; i < setup.axes; ++i) axis_.push_back(&bench_.axis(fmt::format("x{}", i)));
}

PinChanges Sequences::draw(std::uint64_t seed) const {
    Random random(seed, "commands");
    const auto any = [&](std::size_t n) { return random.next() % n; };
    PinChanges events;
    for (std::int64_t at = 0; at < setup_.length;
         at += setup_.pause + static_cast<std::int64_t>(any(12)))
        for (std::size_t n = 1 + any(setup_.at_once); n > 0; --n) {
            const std::size_t pin = any(pins_.size());
            const auto& values = pins_[pin].values;
            const bool is_power = pins_[pin].name.starts_with("MC_Power");
            const bool holds = pins_[pin].name.starts_with("MC_Stop") && any(3) != 0;
            if ((is_power && any(20) != 0) || holds) continue;
            events.push_back({at, pin, values[any(values.size())]});
        }
    return events;
}

std::string Sequences::run(const PinChanges& events) {
    bench_.restart();
    for (const NamedCommand& command : commands_) command.block->pins.rules = setup_.rules;
    for (const std::size_t pin : powers_) set(pin, 1);
    begin();
    auto next = events.begin();
    for (std::int64_t at = 0; at < setup_.length + setup_.patience; ++at) {
        if (at == setup_.length) {
            set_all(".Execute", "", 0);
            for (const char* level : {".Enable", ".EnablePositive", ".EnableNegative"})
                set_all(level, "", 1);
            set_all("Factor", "", 1);
        }
        for (; next != events.end() && next->at <= at; ++next) set(next->pin, next->value);
        bench_.step();
        const std::string wrong = check();
        if (!wrong.empty()) return fmt::format("at {} ms: {}", at, wrong);
        if (at > setup_.length && ends(at - setup_.length)) return {};
    }
    return "it does not end";
}

PinChanges shrunk(PinChanges events, const std::function<bool(const PinChanges&)>& goes_wrong) {
    for (std::size_t size = events.size() / 2; size > 0; size /= 2)
        for (std::size_t i = 0; i + size <= events.size();) {
            PinChanges less = events;
            const auto first = less.begin() + static_cast<std::ptrdiff_t>(i);
            less.erase(first, first + static_cast<std::ptrdiff_t>(size));
            if (goes_wrong(less))
                events = std::move(less);
            else
                i += size;
        }
    return events;
}

std::string Sequences::text(const PinChanges& events) const {
    std::string text;
    for (const PinChange& e : events)
        text += fmt::format("  {:4} ms  {} = {}\n", e.at, pins_[e.pin].name, e.value);
    return text;
}

std::string Sequences::program() {
    std::string text =
        "tasks:\n"
        "  servo: {every: 1 ms, priority: 20, cost: 0.3 ms}\n"
        "  interrupt: {every: 2 ms, priority: 10}\n"
        "  main: {every: 5 ms, priority: 1, cost: 2 ms}\n"
        "blocks:\n";
    std::size_t number = 0;
    for (int i = 0; i < setup_.axes; ++i) {
        const bool modulo = setup_.modulo && i % 2 == 1;
        text += fmt::format(
            "  x{}: {{type: axis, task: servo, unit: {}, default_jerk: 2e4 {}/s^3}}\n", i,
            modulo ? "deg, modulo: true, period: 360 deg" : "mm", modulo ? "deg" : "mm");
        for (const CommandDraw& command : setup_.commands) {
            const std::string name = fmt::format("{}_{}", command.type, number++);
            text += fmt::format("  {}: {{type: {}, task: {}, Axis: x{}}}\n", name, command.type,
                                setup_.tasks[number % setup_.tasks.size()], i);
            add_pins(name, command);
        }
    }
    return text;
}

void Sequences::add_pins(const std::string& name, const CommandDraw& command) {
    const std::string_view type = command.type;
    commands_.push_back({name, type, nullptr});
    std::istringstream pins(command.pins);
    for (std::string pin; pins >> pin;) {
        if (type == "MC_Power") powers_.push_back(pins_.size());
        pins_.push_back(
            {name + "." + (pin == "Wanted" ? "Velocity" : pin), type_of(pin), values_of(pin)});
    }
}

void Sequences::set(std::size_t pin, double value) {
    const Type type = pins_[pin].type;
    store(type, places_[pin],
          type == Type::boolean ? Value(value != 0)
          : type == Type::real  ? Value(value)
                                : Value(static_cast<std::int64_t>(value)));
}

void Sequences::set_all(std::string_view ending, std::string_view beginning, double value) {
    for (std::size_t i = 0; i < pins_.size(); ++i)
        if (pins_[i].name.ends_with(ending) && pins_[i].name.starts_with(beginning)) set(i, value);
}

void check_sequences(Sequences& sequences, std::int64_t count, std::string_view what) {
    for (std::int64_t seed = 1; seed <= count; ++seed) {
        const PinChanges events = sequences.draw(static_cast<std::uint64_t>(seed));
        if (sequences.run(events).empty()) continue;
        const PinChanges less =
            shrunk(events, [&](const PinChanges& some) { return !sequences.run(some).empty(); });
        FAIL(fmt::format("{}, seed {}: {}\n{}", what, seed, sequences.run(less),
                         sequences.text(less)));
    }
}

}  // namespace lineshaft::test
