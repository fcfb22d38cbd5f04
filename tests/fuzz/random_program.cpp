#include "tests/fuzz/random_program.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "runtime/source/units.hpp"

namespace lineshaft::test {

namespace {

constexpr std::size_t most_tasks = 3, most_blocks = 16, most_stimuli = 12;
constexpr int scans = 200;

constexpr double magnitudes[] = {1,   0,   -1,    0.5,    10,  -10,  100, 1000, 1e-3,
                                 1e6, -20, 6.283, 1e-300, 1e9, -1e9, 3,   -0.25};

/// What a wire can begin at, and what can be set from outside.
struct Source {
    std::string name;
    Type type;
    std::string unit;
    const Field* field = nullptr;  ///< of an enumeration: only the same names fit
};

Value default_of(const BlockType& type, const Field& field) {
    std::vector<std::byte> memory(type.size);
    type.construct(memory.data());
    return load(field.type, memory.data() + field.offset);
}

std::string_view default_name(const BlockType& type, const Field& field) {
    return field.names[static_cast<std::size_t>(std::get<std::int64_t>(default_of(type, field)))];
}

class Generator {
  public:
    Generator(Choices& choices, const Catalog& catalog) : choices_(choices), catalog_(catalog) {}

    RandomProgram make();

  private:
    void add_task(std::size_t index);
    void add_block(std::size_t index);
    const BlockType& choose_type();
    void refer(const Field& field);
    std::string setting(const Field& field, const std::string& unit);
    std::string value(const Field& field, const std::string& unit);
    std::string literal(const Field& field, const std::string& unit);
    double number(const Field& field);
    std::string wire(const Field& field, const std::string& unit);
    std::string new_input(const Field& field, const std::string& unit);
    std::string unit_of(const Field& field) const;
    void add_stimuli();
    void add_bounds(const BlockType& type, const std::string& name);
    bool is_limit(const Field& field) const;
    bool may_misfit(const Field& field) const;
    bool is_switch(const Field& field) const;

    struct Input {
        std::string name;
        Field field;
        std::string unit;
    };

    /// What a reference can name.
    struct Made {
        std::string name, unit;
    };

    Choices& choices_;
    const Catalog& catalog_;
    RandomProgram program_;
    int shortest_interval_ms_ = std::numeric_limits<int>::max();
    std::vector<std::string> tasks_;
    std::vector<Source> sources_;
    std::vector<Input> inputs_;
    std::string inputs_text_;
    std::string task_;                            ///< of the block being made
    std::multimap<std::string_view, Made> made_;  ///< blocks so far by type
    const BlockType* type_ = nullptr;
    std::map<std::string, std::string> names_;  ///< of its enumeration parameters
    std::map<std::string, double> numbers_;     ///< that its settings were given
};

RandomProgram Generator::make() {
    program_.text = "lineshaft: 1\ntitle: Random\ntasks:\n";
    const std::size_t tasks = 1 + choices_.below(most_tasks);
    for (std::size_t i = 0; i < tasks; ++i) add_task(i);
    program_.text += "blocks:\n";
    const std::size_t blocks = 1 + choices_.below(most_blocks);
    for (std::size_t i = 0; i < blocks; ++i) add_block(i);
    if (!inputs_.empty()) program_.text += "inputs:\n" + inputs_text_;
    add_stimuli();
    program_.text +=
        fmt::format("run: {{for: {} ms, on_error: continue}}\n", scans * shortest_interval_ms_);
    return std::move(program_);
}

void Generator::add_task(std::size_t index) {
    constexpr int intervals[] = {1, 2, 4, 5, 10};
    constexpr std::string_view jitters[] = {"0 ms", "100 us", "10 %"};
    constexpr std::string_view costs[] = {"0 us", "50 us", "100 us"};
    const int interval = choices_.one_of(intervals);
    shortest_interval_ms_ = std::min(shortest_interval_ms_, interval);
    tasks_.push_back(fmt::format("t{}", index));
    program_.text += fmt::format("  {}: {{every: {} ms, priority: {}, jitter: {}, cost: {}}}\n",
                                 tasks_.back(), interval, 1 + choices_.below(20),
                                 choices_.one_of(jitters), choices_.one_of(costs));
}

/// What it refers to comes first.
const BlockType& Generator::choose_type() {
    const BlockType* type = &choices_.one_of(catalog_.types());
    for (const Field& field : type->fields)
        if (field.direction == Direction::in_out && !made_.contains(field.refers))
            return *catalog_.find(field.refers);
    return *type;
}

void Generator::refer(const Field& field) {
    const auto [first, last] = made_.equal_range(field.refers);
    const auto count = static_cast<std::size_t>(std::distance(first, last));
    const Made& made = std::next(first, static_cast<std::ptrdiff_t>(choices_.below(count)))->second;
    names_[std::string(field.name)] = made.unit;
    program_.text += fmt::format("    {}: {}\n", field.name, made.name);
}

void Generator::add_block(std::size_t index) {
    type_ = &choose_type();
    task_ = choices_.one_of(tasks_);
    names_.clear();
    numbers_.clear();
    const std::string name = fmt::format("b{}", index);
    program_.text += fmt::format("  {}:\n    type: {}\n    task: {}\n", name, type_->name, task_);
    for (const Field& field : type_->fields)
        if (field.direction == Direction::parameter && field.type == Type::enumeration) {
            std::string_view chosen = default_name(*type_, field);
            if (choices_.once_in(4)) chosen = choices_.one_of(field.names);
            names_[std::string(field.name)] = chosen;
            if (!chosen.empty()) program_.text += fmt::format("    {}: {}\n", field.name, chosen);
        }
    for (const Field& field : type_->fields)
        if (field.direction == Direction::in_out) refer(field);
    made_.emplace(type_->name, Made{name, names_.contains("unit") ? names_["unit"] : ""});
    for (const Field& field : type_->fields)
        if (field.direction < Direction::output && field.type != Type::enumeration)
            numbers_[std::string(field.name)] = as_real(default_of(*type_, field));
    for (const Field& field : type_->fields) {
        const bool is_set =
            field.direction < Direction::output && !names_.contains(std::string(field.name)) &&
            (field.required || choices_.once_in(2)) && !is_switch(field) &&
            !(may_misfit(field) && !field.unit.empty() && field.type == Type::integer);
        if (is_set) program_.text += setting(field, unit_of(field));
    }
    for (const Field& field : type_->fields)
        if (field.direction == Direction::output)
            sources_.push_back(
                {fmt::format("{}.{}", name, field.name), field.type, unit_of(field), &field});
    add_bounds(*type_, name);
}

/// A limit of the motion stays as it is, so that the outputs can be held against it.
bool Generator::is_limit(const Field& field) const {
    return type_->name == "path_move" && field.name.ends_with("_limit");
}

/// It would ask for other parameters.
bool Generator::is_switch(const Field& field) const {
    return type_->misfit && field.type == Type::boolean && field.direction == Direction::parameter;
}

/// A constant that may come to nothing beside others; a value from outside is taken as it comes.
bool Generator::may_misfit(const Field& field) const {
    return type_->misfit && (field.type == Type::integer || field.type == Type::real);
}

std::string Generator::setting(const Field& field, const std::string& unit) {
    return fmt::format("    {}: {}\n", field.name,
                       field.direction == Direction::parameter || is_limit(field)
                           ? literal(field, unit)
                           : value(field, unit));
}

std::string Generator::value(const Field& field, const std::string& unit) {
    if (choices_.once_in(2))
        if (std::string from = wire(field, unit); !from.empty()) return from;
    if (may_misfit(field) || (choices_.once_in(3) && inputs_.size() < most_stimuli))
        return new_input(field, unit);
    return literal(field, unit);
}

std::string Generator::wire(const Field& field, const std::string& unit) {
    std::vector<const Source*> fitting;
    for (const Source& source : sources_)
        if (source.type == field.type && source.unit == unit &&
            (field.type != Type::enumeration || source.field->names.fits(field.names)))
            fitting.push_back(&source);
    return fitting.empty() ? "" : choices_.one_of(fitting)->name;
}

std::string Generator::new_input(const Field& field, const std::string& unit) {
    const bool would_be_real = field.type == Type::integer && !unit.empty();
    if (field.type == Type::enumeration || would_be_real) return literal(field, unit);
    inputs_.push_back({fmt::format("i{}", inputs_.size()), field, unit});
    inputs_text_ += fmt::format("  {}: {}\n", inputs_.back().name, literal(field, unit));
    return "inputs." + inputs_.back().name;
}

double Generator::number(const Field& field) {
    const double wanted = choices_.one_of(magnitudes);
    for (const double sign : {1.0, -1.0})
        if (field.admits(wanted * sign)) return wanted * sign;
    for (const double other : magnitudes)
        if (field.admits(other)) return other;
    return std::isfinite(field.minimum) ? field.minimum : field.maximum;
}

std::string Generator::literal(const Field& field, const std::string& unit) {
    switch (field.type) {
        case Type::boolean: {
            const bool chosen = choices_.once_in(2);
            numbers_[std::string(field.name)] = chosen;
            return chosen ? "true" : "false";
        }
        case Type::enumeration:
            return std::string(choices_.one_of(field.names));
        case Type::integer: {
            const double whole = std::trunc(number(field));
            double admitted = field.admits(whole) ? whole : field.minimum;
            if (unit == "ns") admitted = std::abs(admitted);  // a time is not negative
            return fmt::format("{} {}",
                               static_cast<std::int64_t>(std::clamp(admitted, -1e18, 1e18)), unit);
        }
        default: {
            const double chosen = number(field);
            numbers_[std::string(field.name)] = chosen;
            std::string text = format_number(chosen);
            if (text.find_first_of(".e") == text.npos) text += ".0";  // a real, not an integer
            return fmt::format("{} {}", text, unit);
        }
    }
}

std::string Generator::unit_of(const Field& field) const {
    std::string text(field.unit);
    for (const auto& [parameter, chosen] : names_) {
        const std::string place = fmt::format("{{{}}}", parameter);
        for (auto at = text.find(place); at != std::string::npos; at = text.find(place))
            text.replace(at, place.size(), chosen);
    }
    return text;
}

void Generator::add_stimuli() {
    if (inputs_.empty()) return;
    program_.text += "stimulus:\n";
    const std::size_t count = 1 + choices_.below(most_stimuli);
    for (std::size_t i = 0; i < count; ++i) {
        const Input& input = choices_.one_of(inputs_);
        program_.text += fmt::format("  - {{at: {} us, set: {{inputs.{}: {}}}}}\n",
                                     i * 1000 + choices_.below(200) * 5, input.name,
                                     literal(input.field, input.unit));
    }
}

void Generator::add_bounds(const BlockType& type, const std::string& name) {
    if (type.name != "path_move") return;
    for (const char* quantity : {"velocity", "acceleration", "jerk"})
        program_.bounds.push_back(
            {fmt::format("{}.{}", name, quantity), numbers_[fmt::format("{}_limit", quantity)]});
}

}  // namespace

RandomProgram random_program(Choices& choices, const Catalog& catalog) {
    return Generator(choices, catalog).make();
}

}  // namespace lineshaft::test
