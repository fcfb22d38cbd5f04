#include "runtime/model/catalog.hpp"

#include <cstring>

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

/// Its output bears its input's name, as an axis' velocity does.
struct Doubler {
    double wanted = 3;
    double value = 0;
    std::int64_t offset = 0;

    static constexpr std::string_view type = "doubler";
    static constexpr std::string_view doc = "doubles its input";
    static std::span<const Field> fields() {
        static const Field table[] = {
            parameter("offset", &Doubler::offset, "", "added"),
            input("value", &Doubler::wanted, "", "to be doubled"),
            output("value", &Doubler::value, "", "doubled"),
        };
        return table;
    }
    void scan(const Scan& now) { value = 2 * wanted + static_cast<double>(offset + now.index); }
};

struct Nothing {
    static constexpr std::string_view type = "nothing";
    static constexpr std::string_view doc = "does nothing";
    static std::span<const Field> fields() { return {}; }
    void scan(const Scan&) {}
};

Catalog two() {
    Catalog catalog;
    catalog.add<Doubler>().add<Nothing>();
    return catalog;
}

}  // namespace

TEST_CASE("a block type is found by its name") {
    const Catalog catalog = two();
    REQUIRE(catalog.find("doubler"));
    CHECK(catalog.find("doubler")->doc == "doubles its input");
    CHECK(catalog.find("doubler")->size == sizeof(Doubler));
    CHECK(catalog.find("double") == nullptr);
    CHECK(catalog.find("") == nullptr);
    CHECK(catalog.names() == std::vector<std::string>{"doubler", "nothing"});
}

TEST_CASE("what is set is the input, what is read the output of one name") {
    const BlockType type = *two().find("doubler");
    REQUIRE(type.find_settable("value"));
    CHECK(type.find_settable("value")->direction == Direction::input);
    REQUIRE(type.find_readable("value"));
    CHECK(type.find_readable("value")->direction == Direction::output);
    CHECK(type.find_readable("offset")->direction == Direction::parameter);
    CHECK(type.find_settable("none") == nullptr);
    CHECK(type.find_readable("none") == nullptr);
}

TEST_CASE("a block is made with its defaults and scanned by its type alone") {
    const BlockType type = *two().find("doubler");
    alignas(Doubler) std::byte memory[sizeof(Doubler)] = {};
    type.construct(memory);
    const Field& in = *type.find_settable("value");
    const Field& out = *type.find_readable("value");
    CHECK(load(in.type, memory + in.offset) == Value(3.0));
    store(in.type, memory + in.offset, 5.0);
    type.scan_blocks(memory, 1, {.time = 0, .interval = 1, .index = 100}, {});
    CHECK(load(out.type, memory + out.offset) == Value(110.0));
}
