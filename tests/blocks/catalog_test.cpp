#include "blocks/catalog.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/axis/written_cam.hpp"
#include "runtime/model/random.hpp"
#include "runtime/source/units.hpp"
#include "tests/allocations.hpp"
#include "tests/blocks/scanning.hpp"
#include "tests/count_of.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// A block in memory of its own, as the linker makes it.
class Instance {
  public:
    explicit Instance(const BlockType& type) : type_(type), memory_(type.size) {
        type.construct(memory_.data());
    }

    void scan(std::int64_t index, std::int64_t later = 0) {
        const bool error = type_.scan_blocks(
            memory_.data(), 1,
            {.time = index * millisecond + later, .interval = millisecond, .index = index}, {});
        if (error != is_in_error()) FAIL("the scan says something else than the output");
    }
    void set(const Field& field, const Value& value) {
        store(field.type, memory_.data() + field.offset, value);
    }
    Value get(const Field& field) const { return load(field.type, memory_.data() + field.offset); }
    bool is_in_error() const {
        const Field* error = type_.find_readable("error");
        return error && std::get<bool>(get(*error));
    }
    void shift(std::int64_t by) {
        if (type_.shift) type_.shift(memory_.data(), by, type_.context);
    }
    bool same_bytes(const Instance& other) const {
        return std::memcmp(memory_.data(), other.memory_.data(), memory_.size()) == 0;
    }

  private:
    const BlockType& type_;
    std::vector<std::byte> memory_;
};

/// Leaves something else on the stack where a scan has its locals.
__attribute__((noinline)) void dirty_stack(unsigned char pattern) {
    volatile unsigned char garbage[8192];
    for (volatile unsigned char& byte : garbage) byte = pattern;
}

double any_real(Random& random) {
    constexpr double values[] = {0,   -0.0,     1,         -1,        0.001,  20,       -5,
                                 1e6, denormal, -denormal, largest,   -1e300, -largest, 1e-300,
                                 100, 5e4,      1e300,     6.2831853, 0.02,   3};
    return values[random.next() % std::size(values)];
}

/// Any finite value of the field's type.
Value any_value(const Field& field, Random& random) {
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    switch (field.type) {
        case Type::boolean:
            return random.next() % 2 == 0;
        case Type::enumeration:
            return static_cast<std::int64_t>(random.next() % field.names.size());
        case Type::integer: {
            const std::int64_t values[] = {0, 1, -1, 1000, most, -most - 1};
            return values[random.next() % std::size(values)];
        }
        default:
            return any_real(random);
    }
}

/// A value of a usual size; it may lie outside the limits.
Value usual_value(const Field& field, Random& random) {
    if (field.type != Type::real && field.type != Type::integer) return any_value(field, random);
    constexpr std::int64_t sizes[] = {1, 2, 3, 10, 100};
    const std::int64_t size = sizes[random.next() % std::size(sizes)];
    if (field.type == Type::integer) return size;
    return static_cast<double>(size);
}

void set_some(Instance& block, const BlockType& type, Random& random) {
    for (const Field& f : type.fields)
        if (f.direction == Direction::input && random.next() % 8 == 0)
            block.set(f, any_value(f, random));
}

/// Each field of the direction once in `times`, within the limits of what a program may set.
void set_usual(Instance& block, const BlockType& type, Direction direction, std::uint64_t times,
               Random& random) {
    for (const Field& f : type.fields) {
        if (f.direction != direction || random.next() % times != 0) continue;
        const Value value = usual_value(f, random);
        if (f.admits(value)) block.set(f, value);
    }
}

void set_parameters(Instance& block, const BlockType& type, Random& random) {
    set_usual(block, type, Direction::parameter, 2, random);
}

void check_finite_outputs(const Instance& block, const BlockType& type) {
    for (const Field& f : type.fields) {
        if (f.direction != Direction::output || f.type != Type::real) continue;
        INFO("output " << f.name);
        REQUIRE(std::isfinite(as_real(block.get(f))));
    }
}

constexpr std::int64_t scans_of_motion = 200;

bool differ(const Instance& a, const Instance& b, const BlockType& type) {
    return std::ranges::any_of(type.fields, [&](const Field& f) {
        return f.direction == Direction::output && f.type == Type::real && a.get(f) != b.get(f);
    });
}

bool can_move(const BlockType& type) {
    const auto has = [&](Direction direction) {
        return std::ranges::any_of(type.fields, [&](const Field& f) {
            return f.direction == direction && f.type == Type::real;
        });
    };
    return has(Direction::input) && has(Direction::output);
}

/// Scanned `scans` times, with inputs that change now and then.
Instance scanned(const BlockType& type, std::uint64_t seed, std::int64_t scans) {
    Instance block(type);
    Random random(seed, type.name);
    set_parameters(block, type, random);
    set_usual(block, type, Direction::input, 4, random);
    for (std::int64_t i = 0; i < scans; ++i) {
        if (i % 50 == 25) set_usual(block, type, Direction::input, 4, random);
        block.scan(i);
    }
    return block;
}

/// Some of the type that run without an error after scans_of_motion scans, and whose outputs have
/// changed since the scan `since`.
std::vector<Instance> in_motion(const BlockType& type, std::int64_t since) {
    constexpr std::size_t enough = 5;
    std::vector<Instance> found;
    for (std::uint64_t seed = 1; seed <= 1000 && found.size() < enough; ++seed) {
        const Instance block = scanned(type, seed, scans_of_motion);
        if (!block.is_in_error() && differ(scanned(type, seed, since), block, type))
            found.push_back(block);
    }
    return found;
}

std::vector<Value> extremes(const Field& input) {
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    if (input.type == Type::integer) return {most, -most - 1, std::int64_t{-1}};
    if (input.type != Type::real) return {};
    return {not_a_number, infinite, -infinite, -0.0,  denormal,
            -denormal,    largest,  -largest,  1e300, -1e300};
}

/// Scans `block` with the extreme value for a while, then with the value of before for longer than
/// a set-point can be on its way to a drive.
void check_extreme(Instance block, std::int64_t scan, const BlockType& type, const Field& input,
                   const Value& extreme) {
    constexpr std::int64_t a_while = 10, longer = 70;
    INFO(type.name << "." << input.name << " = " << as_real(extreme) << " at scan " << scan);
    const Value good = block.get(input);
    block.set(input, extreme);
    for (const std::int64_t end = scan + a_while; scan < end; ++scan) {
        block.scan(scan);
        check_finite_outputs(block, type);
        if (!std::isfinite(as_real(extreme)) && type.find_readable("error"))
            REQUIRE(block.is_in_error());
        if (block.is_in_error()) REQUIRE(as_real(block.get(*type.find_readable("error_id"))) > 0);
    }
    block.set(input, good);
    for (const std::int64_t end = scan + longer; scan < end; ++scan) {
        block.scan(scan);
        check_finite_outputs(block, type);
    }
    CHECK_FALSE(block.is_in_error());
}

/// Outputs that are equal; 0 and -0 are, and so are what two errors hold.
bool agree(const Instance& a, const Instance& b, const BlockType& type) {
    return std::ranges::all_of(type.fields, [&](const Field& f) {
        return f.direction != Direction::output || a.get(f) == b.get(f);
    });
}

/// Two of a block, alike but for the sign of a zero in `inputs`.
void check_zeros(const Instance& block, std::int64_t scan, const BlockType& type,
                 std::span<const Field* const> inputs) {
    constexpr std::int64_t a_while = 100;
    Instance positive = block, negative = block;
    for (const Field* input : inputs) {
        positive.set(*input, 0.0);
        negative.set(*input, -0.0);
    }
    for (const std::int64_t end = scan + a_while; scan < end; ++scan) {
        INFO("scan " << scan);
        positive.scan(scan);
        negative.scan(scan);
        REQUIRE(agree(positive, negative, type));
    }
}

std::string replaced(std::string text, std::string_view parameter, std::string_view value) {
    const std::string place = fmt::format("{{{}}}", parameter);
    for (auto at = text.find(place); at != std::string::npos; at = text.find(place))
        text.replace(at, place.size(), value);
    return text;
}

/// The unit with every combination of the enumerations that it names.
std::vector<std::string> units(const BlockType& type, const Field& field) {
    std::vector<std::string> texts{std::string(field.unit)};
    for (const Field& p : type.fields) {
        const bool is_choice = p.direction == Direction::parameter && p.type == Type::enumeration;
        if (!is_choice && p.direction != Direction::in_out) continue;
        std::vector<std::string> next;
        for (const std::string& text : texts)
            for (const std::string_view value : p.names)
                next.push_back(replaced(text, p.name, value));
        texts = std::move(next);
    }
    return texts;
}

bool is_snake_case(std::string_view name) {
    return !name.empty() && name.front() >= 'a' && name.front() <= 'z' &&
           std::ranges::all_of(name, [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
           });
}

/// Those of PLCopen have its names: `MC_MoveAbsolute`, `ContinuousUpdate`.
bool is_of_plcopen(const BlockType& type) {
    return type.name.starts_with("MC_");
}

bool is_in_camel_case(std::string_view name) {
    return !name.empty() && name.front() >= 'A' && name.front() <= 'Z' &&
           std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) != 0; });
}

/// Its CamTableID is where it stands in memory.
bool says_its_place(const BlockType& type) {
    return type.name == WrittenCam::type;
}

/// It does nothing by itself: tests/blocks/motion/ tests it with the others, and tests/st_tests a
/// cam that a program writes.
bool works_with_others(const BlockType& type) {
    return !type.handle.empty() || says_its_place(type) ||
           std::ranges::count(type.fields, Direction::in_out, &Field::direction) > 0;
}

}  // namespace

TEST_CASE("every block and field has its name and a doc string") {
    const Catalog catalog = standard_blocks();
    std::set<std::string_view> types;
    for (const BlockType& type : catalog.types()) {
        INFO("block " << type.name);
        CHECK((is_of_plcopen(type) || is_snake_case(type.name)));
        CHECK(types.insert(type.name).second);
        CHECK_FALSE(type.doc.empty());
        std::set<std::string_view> names{"type", "task"};  // keys of every block
        for (const Field& f : type.fields) {
            INFO("field " << f.name);
            CHECK((is_of_plcopen(type) ? is_in_camel_case(f.name) : is_snake_case(f.name)));
            CHECK_FALSE(f.doc.empty());
            CHECK(names.insert(f.name).second);
        }
    }
}

TEST_CASE("every field lies in its block and no two overlap") {
    const Catalog catalog = standard_blocks();
    for (const BlockType& type : catalog.types()) {
        std::vector<bool> used(type.size);
        for (const Field& f : type.fields) {
            INFO(type.name << "." << f.name);
            REQUIRE(f.offset + size_of(f.type) <= type.size);
            for (std::size_t i = f.offset; i < f.offset + size_of(f.type); ++i) {
                CHECK_FALSE(used[i]);
                used[i] = true;
            }
        }
    }
}

TEST_CASE("every default is a value that a program could set") {
    const Catalog catalog = standard_blocks();
    for (const BlockType& type : catalog.types()) {
        const Instance block(type);
        for (const Field& f : type.fields) {
            INFO(type.name << "." << f.name);
            if (f.direction != Direction::in_out)
                CHECK(f.names.empty() == (f.type != Type::enumeration));
            if (f.direction == Direction::output || f.direction == Direction::in_out) continue;
            CHECK(f.admits(block.get(f)));
            const double value = as_real(block.get(f));
            if (f.type != Type::enumeration) continue;
            CHECK(value >= 0);
            CHECK(value < static_cast<double>(f.names.size()));
        }
    }
}

TEST_CASE("every unit is known, whatever the parameters that it names") {
    const Catalog catalog = standard_blocks();
    for (const BlockType& type : catalog.types()) {
        for (const Field& f : type.fields) {
            for (const std::string& text : units(type, f)) {
                INFO(type.name << "." << f.name << ": unit '" << text << "'");
                CHECK(Unit::parse(text).has_value());
            }
            if (f.type == Type::boolean || f.type == Type::enumeration) CHECK(f.unit.empty());
        }
    }
}

TEST_CASE("errors are a boolean with the reason beside it") {
    const Catalog catalog = standard_blocks();
    for (const BlockType& type : catalog.types()) {
        INFO("block " << type.name);
        const Field* error = type.find_readable("error");
        const Field* id = type.find_readable(is_of_plcopen(type) ? "ErrorID" : "error_id");
        CHECK((error != nullptr) == (id != nullptr));
        if (!error || !id) continue;
        CHECK(error->direction == Direction::output);
        CHECK(error->type == Type::boolean);
        CHECK(id->type == Type::enumeration);
        CHECK(id->names.front() == "none");
    }
}

TEST_CASE("warnings are a device's count with the reason of the last beside it") {
    const Catalog catalog = standard_blocks();
    for (const BlockType& type : catalog.types()) {
        INFO("block " << type.name);
        const Field* count = type.find_readable("warnings");
        const Field* id = type.find_readable("warning_id");
        CHECK((count != nullptr) == (id != nullptr));
        if (!count || !id) continue;
        CHECK(type.is_device());
        CHECK(count->direction == Direction::output);
        CHECK(count->type == Type::integer);
        CHECK(id->type == Type::enumeration);
        CHECK(id->names.front() == "none");
    }
}

TEST_CASE("equal inputs give equal bytes, whatever was in memory before") {
    const Catalog catalog = standard_blocks();
    const auto last = static_cast<std::uint64_t>(count_of("LINESHAFT_SEEDS", 3));
    for (const BlockType& type : catalog.types()) {
        for (std::uint64_t seed = 1; seed <= last; ++seed) {
            INFO("block " << type.name << ", seed " << seed);
            Instance a(type), b(type);
            Random for_a(seed, type.name), for_b(seed, type.name);
            set_parameters(a, type, for_a);
            set_parameters(b, type, for_b);
            for (std::int64_t i = 0; i < 1000; ++i) {
                set_some(a, type, for_a);
                set_some(b, type, for_b);
                dirty_stack(0x00);
                a.scan(i);
                dirty_stack(0xff);
                b.scan(i);
            }
            CHECK(a.same_bytes(b));
        }
    }
}

TEST_CASE("no block allocates in its scan") {
    const Catalog catalog = standard_blocks();
    for (const BlockType& type : catalog.types()) {
        INFO("block " << type.name);
        Instance block(type);
        Random random(1, type.name);
        const std::int64_t before = allocations();
        for (std::int64_t i = 0; i < 1000; ++i) {
            set_some(block, type, random);
            block.scan(i);
        }
        CHECK(allocations() == before);
    }
}

TEST_CASE("finite inputs give finite outputs, however extreme") {
    const Catalog catalog = standard_blocks();
    for (const BlockType& type : catalog.types()) {
        for (std::uint64_t seed = 1; seed <= 200; ++seed) {
            INFO("block " << type.name << ", seed " << seed);
            Instance block(type);
            Random random(seed, type.name);
            set_parameters(block, type, random);
            for (std::int64_t i = 0; i < 500; ++i) {
                set_some(block, type, random);
                block.scan(i);
                check_finite_outputs(block, type);
            }
        }
    }
}

TEST_CASE("an extreme input is reported or held off the outputs, and over when it is over") {
    const Catalog catalog = standard_blocks();
    for (const BlockType& type : catalog.types()) {
        if (works_with_others(type)) continue;
        const Instance at_rest(type);
        std::vector<Instance> moving = in_motion(type, scans_of_motion - 1);
        if (moving.empty()) moving = in_motion(type, 0);  // outputs follow the inputs at once
        INFO("block " << type.name);
        REQUIRE((!moving.empty() || !can_move(type)));
        for (const Field& input : type.fields) {
            if (input.direction != Direction::input) continue;
            for (const Value& extreme : extremes(input)) {
                check_extreme(at_rest, 0, type, input, extreme);
                for (const Instance& block : moving)
                    check_extreme(block, scans_of_motion, type, input, extreme);
            }
        }
    }
}

TEST_CASE("the sign of a zero changes no output") {
    const Catalog catalog = standard_blocks();
    for (const BlockType& type : catalog.types()) {
        const Instance at_rest(type);
        const std::vector<Instance> moving = in_motion(type, 0);
        std::vector<const Field*> inputs;
        for (const Field& f : type.fields)
            if (f.direction == Direction::input && f.type == Type::real) inputs.push_back(&f);
        for (std::size_t i = 0; i <= inputs.size(); ++i) {
            const auto some =
                i < inputs.size() ? std::span(inputs).subspan(i, 1) : std::span(inputs);
            INFO(type.name << "." << (some.size() == 1 ? some[0]->name : "all its inputs"));
            check_zeros(at_rest, 0, type, some);
            for (const Instance& block : moving) check_zeros(block, scans_of_motion, type, some);
        }
    }
}

TEST_CASE("a block whose moments are shifted goes on in shifted time as before") {
    const Catalog catalog = standard_blocks();
    for (const BlockType& type : catalog.types()) {
        if (type.is_device() || says_its_place(type)) continue;
        for (std::uint64_t seed = 1; seed <= 30; ++seed) {
            const auto begun = static_cast<std::int64_t>(seed) * 17;
            Instance block = scanned(type, seed, begun), shifted = block;
            const std::int64_t by = seed % 2 == 0 ? -begun * millisecond : 12345;
            shifted.shift(by);
            Random random(seed, "inputs");
            for (std::int64_t i = begun; i < begun + 300; ++i) {
                INFO(type.name << ", seed " << seed << ", scan " << i);
                if (i % 50 == 25) {
                    Random same = random;
                    set_usual(block, type, Direction::input, 4, random);
                    set_usual(shifted, type, Direction::input, 4, same);
                }
                block.scan(i);
                shifted.scan(i, by);
                REQUIRE(agree(block, shifted, type));
            }
        }
    }
}

TEST_CASE("a kind that the catalogue lacks on purpose is known with what to do instead") {
    const Catalog& blocks = standard_blocks();
    for (const char* name : {"MC_TorqueControl", "mc_readactualtorque"}) {
        CHECK(blocks.find(name) == nullptr);
        CHECK(blocks.instead_of(name).find("servo_drive") != std::string_view::npos);
    }
    CHECK(blocks.instead_of("MC_MEASURINGINPUT").find("MC_TouchProbe") != std::string_view::npos);
    CHECK(blocks.instead_of("MC_CommandTable").find("BufferMode") != std::string_view::npos);
    CHECK(blocks.instead_of("MC_MoveVelocity").empty());
}
