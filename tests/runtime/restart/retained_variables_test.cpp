#include <cstring>
#include <fstream>
#include <random>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/restart/retain.hpp"
#include "runtime/run/link.hpp"
#include "runtime/run/single_run.hpp"
#include "runtime/st/library/text_variables.hpp"
#include "tests/folder.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// What is said of a variable and all that it is in.
enum class Said { nothing, retain, non_retain };

/// A scalar or a text somewhere in a declaration.
struct Leaf {
    std::string path;
    Said said = Said::nothing;
};

struct Declared {
    std::string type;
    std::vector<Leaf> leaves;
};

/// Writes a program whose blocks, structures and arrays are in each other, some of them retained.
class Writer {
  public:
    explicit Writer(std::mt19937_64& chance) : chance_(chance) {}

    std::string source() {
        const std::string globals = sections("VAR_GLOBAL", 2, "globals.");
        const std::string variables = sections("VAR", 3, "main.");
        return "TYPE Mode : (idle, busy, done); END_TYPE\n" + types_ + globals + "PROGRAM Main\n" +
               variables + "VAR scans : INT; END_VAR\nscans := scans + 1;\nEND_PROGRAM\n";
    }
    const std::vector<Leaf>& leaves() const { return leaves_; }

  private:
    std::uint64_t some(std::uint64_t count) { return chance_() % count; }

    Declared type(int depth) {
        static constexpr const char* plain[] = {
            "BOOL", "SINT",  "UINT", "DINT", "ULINT", "BYTE",       "LWORD",      "REAL", "LREAL",
            "TIME", "LTIME", "DATE", "DT",   "Mode",  "STRING[11]", "WSTRING[5]", "INT",  "STRING"};
        switch (depth > 0 ? some(6) : 0) {
            case 3:
                return array(type(depth - 1));
            case 4:
                return structure(depth - 1);
            case 5:
                return block(depth - 1);
            default:
                return {plain[some(std::size(plain))], {{""}}};
        }
    }

    Declared array(const Declared& element) {
        Declared made{"ARRAY[-1..1] OF " + element.type, {}};
        for (int i = -1; i <= 1; ++i)
            for (const Leaf& leaf : element.leaves)
                made.leaves.push_back({fmt::format("[{}]{}", i, leaf.path), leaf.said});
        return made;
    }

    Declared structure(int depth) {
        Declared made{fmt::format("S{}", ++count_), {}};
        std::string members;
        for (int i = 0; i < 2; ++i) {
            const Declared member = type(depth);
            members += fmt::format("m{} : {};\n", i, member.type);
            for (const Leaf& leaf : member.leaves)
                made.leaves.push_back({fmt::format(".m{}{}", i, leaf.path), leaf.said});
        }
        types_ += fmt::format("TYPE {} : STRUCT\n{}END_STRUCT END_TYPE\n", made.type, members);
        return made;
    }

    Declared block(int depth) {
        Declared made{fmt::format("B{}", ++count_), {}};
        const std::size_t first = leaves_.size();
        const std::string variables = sections(some(3) == 0 ? "VAR_OUTPUT" : "VAR", depth, ".");
        made.leaves.assign(leaves_.begin() + static_cast<std::ptrdiff_t>(first), leaves_.end());
        leaves_.resize(first);
        types_ += fmt::format("FUNCTION_BLOCK {}\n{};\nEND_FUNCTION_BLOCK\n", made.type, variables);
        return made;
    }

    std::string sections(std::string_view word, int depth, std::string_view before) {
        static constexpr const char* qualifiers[] = {"", " RETAIN", " PERSISTENT RETAIN",
                                                     " NON_RETAIN", " PERSISTENT"};
        std::string text;
        for (std::uint64_t i = 0; i < 2 + some(2); ++i) {
            const std::uint64_t chosen = some(std::size(qualifiers));
            const Said said = chosen == 0   ? Said::nothing
                              : chosen == 3 ? Said::non_retain
                                            : Said::retain;
            const Declared declared = type(depth);
            const std::string name = fmt::format("v{}", ++count_);
            text += fmt::format("{}{}\n{} : {};\nEND_VAR\n", word, qualifiers[chosen], name,
                                declared.type);
            for (const Leaf& leaf : declared.leaves)
                leaves_.push_back({fmt::format("{}{}{}", before, name, leaf.path),
                                   leaf.said == Said::nothing ? said : leaf.said});
        }
        return text;
    }

    std::mt19937_64& chance_;
    std::string types_;
    std::vector<Leaf> leaves_;
    int count_ = 0;
};

Loaded load_own(const Folder& folder, const std::string& source, std::string_view more = {}) {
    std::ofstream(folder / "own.st", std::ios::binary) << source;
    std::ofstream(folder / "own.yaml", std::ios::binary)
        << "lineshaft: 1\ntasks: {main: {every: 10 ms}, other: {every: 20 ms}}\nsources: own.st\n"
           "blocks: {main: {type: Main, task: main}}\nrun: {for: 100 ms}\n"
        << more;
    Diagnostics out;
    auto loaded = load_program(folder / "own.yaml", {}, standard_blocks(), out);
    INFO(source << out.render());
    REQUIRE(loaded);
    return std::move(*loaded);
}

/// Where a scalar or a text stands, and how long it is.
struct Place {
    std::byte *live = nullptr, *published = nullptr;
    std::size_t size = 8;
    const Field* field = nullptr;  ///< null: a text

    std::string bytes() const { return {reinterpret_cast<const char*>(live), size}; }
};

Place find(Machine& machine, const std::string& path) {
    if (const Signal* signal = machine.find(path)) {
        const BlockPlace& block = machine.blocks[static_cast<std::size_t>(signal->port.instance)];
        return {machine.live(signal->port), machine.published(signal->port), 8,
                &block.type->fields[static_cast<std::size_t>(signal->port.field)]};
    }
    for (const BlockPlace& block : machine.blocks)
        for (const st::TextVariable& text : st::text_variables(*block.type))
            if (fmt::format("{}.{}", block.name, text.name) == path)
                return {block.live + text.offset, block.published + text.offset, 16, nullptr};
    FAIL("no variable " << path);
    return {};
}

/// Any value that it can have; of a text five bytes, which may be no UTF-8.
void make_other(const Place& place, std::mt19937_64& chance) {
    std::uint64_t bits = chance();
    std::byte value[16] = {};
    const auto put = [&](auto number) { std::memcpy(value, &number, sizeof number); };
    if (!place.field) {
        put(std::uint64_t{5});
        std::memcpy(value + 8, &bits, 5);
    } else if (place.field->type == Type::boolean) {
        put(bits % 2);
    } else if (place.field->type == Type::enumeration) {
        put(bits % place.field->names.size());
    } else if (place.field->type == Type::real) {
        float narrow = 0;
        std::memcpy(&narrow, &bits, sizeof narrow);
        if (std::isfinite(place.field->maximum))
            put(double{narrow});
        else
            put(bits);
    } else if (std::isfinite(place.field->maximum)) {
        const auto low = static_cast<std::int64_t>(place.field->minimum);
        const auto high = static_cast<std::int64_t>(place.field->maximum);
        put(low + static_cast<std::int64_t>(bits % static_cast<std::uint64_t>(high - low + 1)));
    } else {
        put(bits);
    }
    std::memcpy(place.live, value, place.size);
    std::memcpy(place.published, value, place.size);
}

RunReport run_own(Loaded& loaded, const Folder& folder) {
    RunOptions options;
    options.retain_path = folder / "own.retain";
    RunReport report = run(loaded, options);
    INFO(report.refused.render());
    CHECK(report.refused.empty());
    return report;
}

std::string text_in(Loaded& loaded, const std::string& path) {
    const Place place = find(loaded.linked.machine, path);
    std::uint64_t size = 0;
    std::memcpy(&size, place.live, sizeof size);
    return {reinterpret_cast<const char*>(place.live) + 8, size};
}

Value value_in(const Loaded& loaded, std::string_view signal) {
    const Signal* found = loaded.linked.machine.find(signal);
    REQUIRE(found);
    return found->value();
}

}  // namespace

TEST_CASE("what is retained is kept to the bit, and all else begins anew", "[retain]") {
    const unsigned seed = Catch::rngSeed() != 0 ? Catch::rngSeed() : 1;
    std::mt19937_64 chance(seed);
    std::size_t kept = 0, fresh = 0;
    for (int program = 0; program < 40; ++program) {
        const Folder folder;
        Writer writer(chance);
        const std::string source = writer.source();
        Loaded before = load_own(folder, source), after = load_own(folder, source);
        INFO("seed " << seed << "\n" << source);
        Loaded first = load_own(folder, source);
        for (const Leaf& leaf : writer.leaves())
            make_other(find(before.linked.machine, leaf.path), chance);
        const std::string path = folder / "own.retain";
        REQUIRE(write_retained(path, before.linked.machine, 0).empty());
        Diagnostics out;
        read_retained(path, after.linked.machine, out);
        INFO(out.render());
        REQUIRE(out.empty());
        for (const Leaf& leaf : writer.leaves()) {
            const bool is_kept = leaf.said == Said::retain;
            ++(is_kept ? kept : fresh);
            Loaded& wanted = is_kept ? before : first;
            INFO(leaf.path << (is_kept ? " is retained" : " is not retained"));
            const Place there = find(after.linked.machine, leaf.path);
            REQUIRE(there.bytes() == find(wanted.linked.machine, leaf.path).bytes());
            REQUIRE(std::memcmp(there.live, there.published, there.size) == 0);
        }
    }
    CHECK(kept > 100);
    CHECK(fresh > 100);
}

TEST_CASE("a retained counter knows the edge that it has seen, a timer its time", "[retain]") {
    const Folder folder;
    const std::string source = R"(
FUNCTION_BLOCK Station
VAR RETAIN parts : CTU; name : STRING := 'new'; END_VAR
VAR scans, limit : INT := 7; END_VAR
parts(CU := TRUE, PV := limit);
scans := scans + 1;
IF scans = 9 THEN name := CONCAT(name, '+'); END_IF;
END_FUNCTION_BLOCK
PROGRAM Main
VAR station, other : Station; END_VAR
VAR RETAIN delay : TON; edge : R_TRIG; seen : INT; wide : WSTRING[3] := "ä"; END_VAR
VAR PERSISTENT table : ARRAY[0..9999] OF UINT; at : POINTER TO UINT := ADR(table[3]); END_VAR
station(); other();
delay(IN := TRUE, PT := T#150MS);
edge(CLK := TRUE);
IF edge.Q THEN seen := seen + 1; END_IF;
table[9999] := table[9999] + 1;
at^ := 5;
wide := "b";
END_PROGRAM
)";
    for (int restart = 1; restart <= 3; ++restart) {
        Loaded loaded = load_own(folder, source);
        const RunReport report = run_own(loaded, folder);
        CHECK(report.result.message.empty());
        CHECK(value_in(loaded, "main.station.parts.cv") == Value(std::int64_t{1}));
        CHECK(value_in(loaded, "main.other.parts.cv") == Value(std::int64_t{1}));
        CHECK(value_in(loaded, "main.seen") == Value(std::int64_t{1}));
        CHECK(value_in(loaded, "main.delay.q") == Value(restart > 1));
        CHECK(value_in(loaded, "main.table[3]") == Value(std::int64_t{5}));
        CHECK(text_in(loaded, "main.station.name") ==
              "new" + std::string(static_cast<std::size_t>(restart), '+'));
        CHECK(text_in(loaded, "main.wide") == "b");
    }
}

TEST_CASE("what is retained begins once in all runs, a reference in each", "[retain]") {
    const Folder folder;
    const std::string source = R"(
VAR_GLOBAL start : INT := 3; END_VAR
VAR_GLOBAL RETAIN total : INT := start + 1; END_VAR
FUNCTION_BLOCK Part
VAR RETAIN count : INT := start * 2; END_VAR
VAR n : INT := start; p : POINTER TO INT := ADR(n); END_VAR
p^ := p^ + 1; count := count + 1;
END_FUNCTION_BLOCK
PROGRAM Main
VAR RETAIN whole : Part; END_VAR
VAR part : Part; END_VAR
whole(); part(); total := total + 1;
END_PROGRAM
)";
    std::int64_t scans = 0;
    for (int restart = 1; restart <= 3; ++restart) {
        Loaded loaded = load_own(folder, source);
        const RunReport report = run_own(loaded, folder);
        CHECK(report.result.message.empty());
        const std::int64_t now = report.result.scans[0];
        scans += now;
        CHECK(value_in(loaded, "globals.total") == Value(4 + scans));
        CHECK(value_in(loaded, "main.part.count") == Value(6 + scans));
        CHECK(value_in(loaded, "main.whole.count") == Value(6 + scans));
        CHECK(value_in(loaded, "main.part.n") == Value(3 + now));
    }
}

TEST_CASE("headers of data blocks and attributes say what is retained, too", "[retain]") {
    const Folder folder;
    const std::string source = R"(
DATA_BLOCK Kept
RETAIN
VAR a : INT; END_VAR
VAR NON_RETAIN b : INT; END_VAR
BEGIN
END_DATA_BLOCK
DATA_BLOCK Fresh
NON_RETAIN
VAR a : INT; END_VAR
VAR RETAIN b : INT; END_VAR
BEGIN
END_DATA_BLOCK
PROGRAM Main
VAR
    {attribute 'TcRetain'}
    c : INT;
    d : INT;
END_VAR
Kept.a := Kept.a + 1; Kept.b := Kept.b + 1; Fresh.a := Fresh.a + 1; Fresh.b := Fresh.b + 1;
c := c + 1; d := d + 1;
END_PROGRAM
)";
    std::int64_t scans = 0;
    for (int restart = 1; restart <= 2; ++restart) {
        Loaded loaded = load_own(folder, source);
        const std::int64_t now = run_own(loaded, folder).result.scans[0];
        scans += now;
        CHECK(value_in(loaded, "Kept.a") == Value(scans));
        CHECK(value_in(loaded, "Kept.b") == Value(now));
        CHECK(value_in(loaded, "Fresh.a") == Value(now));
        CHECK(value_in(loaded, "Fresh.b") == Value(scans));
        CHECK(value_in(loaded, "main.c") == Value(scans));
        CHECK(value_in(loaded, "main.d") == Value(now));
    }
}
