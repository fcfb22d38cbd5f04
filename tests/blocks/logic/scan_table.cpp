#include "tests/blocks/logic/scan_table.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/source/units.hpp"

namespace lineshaft::test {

namespace {

using Row = std::vector<std::string>;

Row split(const std::string& line) {
    std::istringstream in(line);
    Row cells;
    for (std::string cell; in >> cell;) cells.push_back(cell);
    return cells;
}

/// `2400h+3ms`, `-5ms`, `0`.
std::int64_t time_of(const std::string& cell) {
    std::istringstream terms(cell);
    std::int64_t sum = 0;
    for (std::string term; std::getline(terms, term, '+');) {
        if (term == "0") continue;
        const auto ns = to_nanoseconds(std::get<Quantity>(parse_quantity(term)));
        REQUIRE(ns.has_value());
        sum += *ns;
    }
    return sum;
}

Value value_of(const Field& field, const std::string& cell) {
    if (field.type == Type::boolean) {
        REQUIRE((cell == "0" || cell == "1"));
        return cell == "1";
    }
    if (field.type == Type::enumeration) {
        const auto name = std::ranges::find(field.names, cell);
        REQUIRE(name != field.names.end());
        return name - field.names.begin();
    }
    if (field.unit == "ns") return time_of(cell);
    if (cell == "nan") return std::numeric_limits<double>::quiet_NaN();
    const auto quantity = std::get<Quantity>(parse_quantity(cell));
    if (field.type == Type::real) return quantity.number;
    REQUIRE(quantity.is_integer);
    return *whole_value(quantity.integer, Type::integer);
}

/// A block that a table drives.
class Driven {
  public:
    explicit Driven(std::string_view type) : type_(*catalog().find(type)), memory_(type_.size) {
        type_.construct(memory_.data());
    }

    void head(const Row& names) {
        const auto bar = std::ranges::find(names, "|");
        REQUIRE(bar != names.end());
        inputs_ = bar - names.begin();
        for (std::size_t i = 0; i < names.size(); ++i) {
            columns_.push_back(is_input(i) ? type_.find_settable(names[i])
                                           : type_.find_readable(names[i]));
            REQUIRE((columns_.back() || names[i] == "time" || names[i] == "|"));
        }
        has_time_ = names.front() == "time";
    }

    void scan(const Row& row, int calls) {
        REQUIRE(row.size() == columns_.size());
        if (has_time_) now_.time = time_of(row.front());
        for (std::size_t i = 0; i < row.size(); ++i)
            if (columns_[i] && is_input(i) && row[i] != ".")
                store(columns_[i]->type, slot(*columns_[i]), value_of(*columns_[i], row[i]));
        for (int call = 0; call < calls; ++call) type_.scan_blocks(memory_.data(), 1, now_, {});
        ++now_.index;
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (!columns_[i] || is_input(i)) continue;
            const Field& field = *columns_[i];
            INFO("output " << field.name);
            CHECK(format(load(field.type, slot(field))) == format(value_of(field, row[i])));
        }
    }

  private:
    static const Catalog& catalog() {
        static const Catalog blocks = standard_blocks();
        return blocks;
    }
    bool is_input(std::size_t column) const {
        return static_cast<std::ptrdiff_t>(column) < inputs_;
    }
    std::byte* slot(const Field& field) { return memory_.data() + field.offset; }

    const BlockType& type_;
    std::vector<std::byte> memory_;
    std::vector<const Field*> columns_;
    std::ptrdiff_t inputs_ = 0;
    bool has_time_ = false;
    Scan now_;
};

void run(std::string_view type, const ScanTable& table, int calls) {
    Driven block(type);
    std::istringstream lines{std::string(table.rows)};
    bool headed = false;
    for (std::string line; std::getline(lines, line);) {
        const Row row = split(line);
        if (row.empty()) continue;
        INFO(type << ", " << table.name << ", " << calls << " call(s) a scan:" << line);
        if (headed)
            block.scan(row, calls);
        else
            block.head(row);
        headed = true;
    }
}

}  // namespace

void check_tables(std::string_view type, Calls calls, std::initializer_list<ScanTable> tables) {
    for (const ScanTable& table : tables) {
        run(type, table, 1);
        if (calls == Calls::once_and_twice) run(type, table, 2);
    }
}

}  // namespace lineshaft::test
