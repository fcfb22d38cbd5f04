#include "runtime/st/code/machine.hpp"

#include <cstring>
#include <random>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "tests/runtime/st/instance.hpp"

using namespace lineshaft;

namespace {

st::Library compiled(const std::string& text, const st::Options& options = {}) {
    Diagnostics out;
    auto library = st::compile({st::source(text)}, standard_blocks(), out, options);
    INFO(text << out.render());
    REQUIRE(library);
    return std::move(*library);
}

/// Writes programs of what the generator fuses: arithmetic in one type, tests, loops, CASE, arrays.
class Writer {
  public:
    explicit Writer(unsigned seed) : random_(seed) {}

    std::string program() {
        type_ = one_of({"INT", "DINT", "LINT", "REAL", "LREAL"});
        is_real_ = type_.ends_with("REAL");
        std::string text = fmt::format(
            "PROGRAM Main\nVAR a : {0} := 3; b : {0} := 7; c : {0}; d : {0} := 2;\n"
            "t : ARRAY[0..9] OF {0}; i, j, k : DINT; f, g : BOOL; END_VAR\n",
            type_);
        for (int n = 2 + number(6); n > 0; --n) text += statement(2);
        return text + "k := k + 1;\nEND_PROGRAM\n";
    }

  private:
    int number(int below) { return static_cast<int>(random_() % static_cast<unsigned>(below)); }
    std::string one_of(const std::vector<std::string>& of) {
        return of[static_cast<std::size_t>(number(static_cast<int>(of.size())))];
    }
    std::string variable() { return one_of({"a", "b", "c", "d"}); }

    std::string operand() {
        if (number(5) == 0) return is_real_ ? "0.75" : "3";
        return number(5) == 0 ? "t[i MOD 10]" : variable();
    }
    std::string expression(int depth) {
        if (depth == 0) return operand();
        return fmt::format("({} {} {})", expression(number(depth)), one_of({"+", "-", "*"}),
                           expression(number(depth)));
    }
    std::string test() {
        return fmt::format("{} {} {}", operand(), one_of({"<", "<=", ">", ">=", "=", "<>"}),
                           operand());
    }

    std::string statement(int depth) {
        switch (number(depth > 0 ? 9 : 4)) {
            case 0:
                return fmt::format("t[k MOD 10] := {};\n", expression(2));
            case 1:
                return fmt::format("f := {}; g := NOT f;\n", test());
            case 2:
                return fmt::format("IF {} THEN {} := {}; END_IF;\n", test(), variable(), operand());
            case 4:
                return fmt::format("IF {} AND_THEN {} THEN {}ELSE {}END_IF;\n", test(), test(),
                                   statement(depth - 1), statement(depth - 1));
            case 5:
                return fmt::format("i := {};\nWHILE i {} 8 DO\n{}i := i + 1;\nEND_WHILE;\n",
                                   number(4), one_of({"<", "<="}), statement(0));
            case 6:
                return fmt::format("FOR j := 0 TO {} DO\n{}END_FOR;\n", number(5), statement(0));
            case 7:
                return choice(depth, 3 + number(12));
            case 8:
                return fmt::format("i := 0;\nREPEAT {}i := i + 1; UNTIL i > 3 END_REPEAT;\n",
                                   statement(0));
            default:
                return fmt::format("{} := {};\n", variable(), expression(4));
        }
    }
    std::string choice(int depth, int labels) {
        std::string text = fmt::format("CASE k MOD {} - 2 OF\n", labels + 2);
        for (int n = 0; n < labels; n += 2)
            text += fmt::format("{}{}: {}", n - 1,
                                one_of({"", fmt::format(", {}", n), fmt::format("..{}", n)}),
                                statement(depth - 1));
        return text + "ELSE " + statement(depth - 1) + "END_CASE;\n";
    }

    std::mt19937 random_;
    std::string type_;
    bool is_real_ = false;
};

/// The values of all fields from the first variable on, as bits.
std::vector<std::uint64_t> values(const st::Library& library, st::Instances& instances) {
    std::vector<std::uint64_t> found;
    for (const Field& field : library.kinds()[0].fields)
        if (field.direction == Direction::local)
            std::memcpy(&found.emplace_back(), instances.memory(0) + field.offset, 8);
    return found;
}

std::int64_t time_taken(const st::Library& library, std::int64_t n) {
    st::Instances instances(library);
    const BlockType& kind = library.kinds()[0];
    store(lineshaft::Type::integer, instances.memory(0) + kind.find_settable("n")->offset, n);
    instances.scan(0, 1);
    REQUIRE(instances.faults().empty());
    return std::get<std::int64_t>(
        load(lineshaft::Type::integer, instances.memory(0) + *kind.time_taken));
}

/// A block with a FOR over n that has these statements in it.
std::string loop(const std::string& statements) {
    return "FUNCTION_BLOCK Job\nVAR_INPUT n : DINT; END_VAR\n"
           "VAR i, k : DINT; x, y : LREAL; f : BOOL; END_VAR\nFOR i := 1 TO n DO\n" +
           statements + "END_FOR;\nEND_FUNCTION_BLOCK\n";
}

}  // namespace

TEST_CASE("Structured Text: fused instructions do what plain ones do", "[st]") {
    for (unsigned seed = 0; seed < 2000; ++seed) {
        const std::string text = Writer(seed).program();
        INFO("seed " << seed << "\n" << text);
        const st::Library fused = compiled(text);
        const st::Library plain = compiled(text, {.times = st::InstructionTimes{}});
        st::Instances a(fused), b(plain);
        for (int scan = 0; scan < 30; ++scan) {
            a.scan(scan, 1);
            b.scan(scan, 1);
        }
        REQUIRE(a.faults() == b.faults());
        REQUIRE(values(fused, a) == values(plain, b));
    }
}

TEST_CASE("Structured Text: native code leaves the memory that the machine leaves", "[st]") {
    const auto compare = [](const std::string& text, const st::Options& options) {
        INFO(text);
        st::Options interpreted = options;
        interpreted.native = false;
        const st::Library fast = compiled(text, options), slow = compiled(text, interpreted);
        st::Instances a(fast), b(slow);
        for (int scan = 0; scan < 30; ++scan) {
            a.scan(scan, 1);
            b.scan(scan, 1);
            REQUIRE(a.memory() == b.memory());
        }
        CHECK(a.is_guarded());
        REQUIRE(a.faults() == b.faults());
        return a.faults();
    };
    for (unsigned seed = 0; seed < 500; ++seed) compare(Writer(seed).program(), {});
    const auto job = [](const std::string& statements) {
        return "FUNCTION Inner : DINT VAR_INPUT x, y : DINT; END_VAR\nInner := x / y;\n"
               "END_FUNCTION\nPROGRAM Main\nVAR a : DINT := 7; b, n : DINT; t : ARRAY[1..4] OF "
               "LINT; s : STRING[3]; END_VAR\nn := n + 1;\n" +
               statements + "\nEND_PROGRAM\n";
    };
    using Faults = std::vector<std::string>;
    CHECK(compare(job("b := Inner(a, 2) + Inner(a, 3);"), {}).empty());
    CHECK(compare(job("s := DINT_TO_STRING(n * 1000);"), {}).empty());
    CHECK(compare(job("b := Inner(a, b);"), {}) == Faults{"2 division_by_zero"});
    // Where two NaNs have other bits, of SQRT and of ATAN2, the first one is the sum and the
    // product.
    CHECK(compare("PROGRAM Main VAR a, b, s, t, p, q, r : LREAL; f, g, h : REAL; END_VAR\n"
                  "a := SQRT(-1.0 - a); b := ATAN2(a, a); s := a + b; t := b + a; p := a * b; "
                  "q := b * (a * 2.0); r := a + b * 2.0; f := TO_REAL(a) * TO_REAL(b); "
                  "g := TO_REAL(b) * TO_REAL(a); h := f + g; END_PROGRAM\n",
                  {})
              .empty());
    CHECK(compare(job("t[n] := n;"), {}) == Faults{"7 array_bounds"});
    CHECK(compare(job("WHILE TRUE DO b := b + 1; END_WHILE;"), {.fuel = 100}) ==
          Faults{"7 no_end"});
    CHECK(compare(job("WHILE TRUE DO b := Inner(a, 2); END_WHILE;"), {.fuel = 100}).size() == 1);
}

TEST_CASE("Structured Text: what is common takes few instructions", "[st]") {
    const auto listing = [](const std::string& statements) {
        return compiled(
                   "PROGRAM Main\nVAR i, n : DINT; x, y : LREAL; t : ARRAY[1..4] OF LREAL; "
                   "END_VAR\n" +
                   statements + "END_PROGRAM\n")
            .listing();
    };
    const auto has = [](const std::string& text, const char* name) {
        return text.find(name) != std::string::npos;
    };
    CHECK(has(listing("x := x * y + x;\n"), "mul_add_lreal"));
    CHECK(has(listing("x := y - x * y;\n"), "mul_from_lreal"));
    CHECK(has(listing("x := t[i];\n"), "load_element"));
    CHECK(has(listing("IF x > y THEN x := y; END_IF;\n"), "move_if_lt_float"));
    CHECK(has(listing("WHILE i < n DO i := i + 1; END_WHILE;\n"), "count_lt_dint"));
    CHECK(has(listing("WHILE x * 2.0 < y DO x := x + 1.0; END_WHILE;\n"), "repeat_if_lt_float"));
}

TEST_CASE("Structured Text: a loop takes time in proportion to its passes", "[st]") {
    std::mt19937 random(7);
    for (int round = 0; round < 50; ++round) {
        st::InstructionTimes times;
        for (auto& time : times) time = static_cast<std::int64_t>(random() % 1000);
        INFO("round " << round);
        const char* const body = "x := x * 0.5 + y; IF x > 3.0 THEN k := k + 1; END_IF;\n";
        const st::Library once = compiled(loop(body), {.times = times});
        const st::Library twice = compiled(loop(std::string(body) + body), {.times = times});
        const std::int64_t first = time_taken(once, 1), pass = time_taken(once, 2) - first;
        for (const std::int64_t n : {3, 10, 1000}) {
            CHECK(time_taken(once, n) == first + (n - 1) * pass);
            const std::int64_t more = time_taken(twice, n) - time_taken(once, n);
            CHECK(more % n == 0);
            CHECK(more / n <= pass);
        }
    }
}

TEST_CASE("Structured Text: instructions take the times of their classes", "[st]") {
    st::InstructionTimes times{};
    times[static_cast<std::size_t>(st::OpClass::real)] = 192;
    CHECK(time_taken(compiled(loop("x := x * 0.5 + y;\n"), {.times = times}), 100) ==
          2 * 100 * 192);
    times = {};
    times[static_cast<std::size_t>(st::OpClass::boolean)] = 30;
    CHECK(time_taken(compiled(loop("f := NOT f;\n"), {.times = times}), 100) == 100 * 30);
    times.fill(std::int64_t{1} << 62);
    CHECK(time_taken(compiled(loop("f := NOT f;\n"), {.times = times}), 100) == never);
}

TEST_CASE("Structured Text: an instance has the same bytes wherever in a page it stands", "[st]") {
    const st::Library library = compiled(
        "PROGRAM Main\nVAR a : STRING[12] := '-7-7$$'; b, c : STRING[12] := '$0A-7$0Aa';\n"
        "less, same : BOOL; n : INT; END_VAR\n"
        "c := CONCAT(a, b); n := FIND(b, 'a'); same := a = b; less := a < b;\nEND_PROGRAM\n");
    const BlockType& kind = library.kinds().front();
    constexpr std::size_t page = 4096 / 8;
    std::vector<std::uint64_t> memory(2 * page + kind.size / 8), first;
    for (std::size_t start = 0; start < page; ++start) {
        std::byte* const place = reinterpret_cast<std::byte*>(memory.data() + start);
        kind.construct(place);
        kind.scan_blocks(place, 1, {0, 1'000'000, 0}, {.kind = kind.context});
        const auto begin = memory.begin() + static_cast<std::ptrdiff_t>(start);
        const std::vector<std::uint64_t> bytes(begin,
                                               begin + static_cast<std::ptrdiff_t>(kind.size / 8));
        if (first.empty()) first = bytes;
        INFO(start << " words further");
        REQUIRE(bytes == first);
    }
}
