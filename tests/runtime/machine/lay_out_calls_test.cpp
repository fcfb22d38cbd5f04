#include <algorithm>
#include <random>

#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/run/link.hpp"
#include "runtime/scan/executive.hpp"
#include "tests/runtime/names/small_blocks.hpp"

using namespace lineshaft;

namespace {

/// Two kinds whose outputs tell in which order they ran.
template <int factor>
struct Mix {
    std::int64_t a = 0, b = 0, out = factor;

    static constexpr std::string_view type = factor == 3 ? "mix_3" : "mix_5";
    static constexpr std::string_view doc = "Mixes its inputs into its output";
    static std::span<const Field> fields() {
        static const Field table[] = {
            input("a", &Mix::a, "", "a number"),
            input("b", &Mix::b, "", "a number"),
            output("out", &Mix::out, "", "a number"),
        };
        return table;
    }
    static constexpr auto main_input = &Mix::b;
    void scan(const Scan&) { out = (factor * out + 7 * a + 11 * b + 1) % 1'000'003; }
};

struct Drawn {
    int factor = 3;
    int sources[2] = {};  ///< blocks; previous() where not before
};

class DrawnProgram {
  public:
    explicit DrawnProgram(std::mt19937& draw) {
        const auto below = [&](std::size_t n) { return static_cast<int>(draw() % n); };
        blocks_.resize(1 + draw() % 12);
        for (Drawn& block : blocks_) {
            block.factor = below(2) == 0 ? 3 : 5;
            for (int& source : block.sources) source = below(blocks_.size());
        }
    }

    std::string text() const {
        std::string text = "lineshaft: 1\ntasks: {t: {every: 1 ms}}\nrun: {for: 9 ms}\nblocks:\n";
        for (int i = 0; i < size(); ++i)
            text += fmt::format("  x{}: {{type: mix_{}, task: t, a: {}, b: {}}}\n", i, at(i).factor,
                                wire(i, 0), wire(i, 1));
        return text;
    }

    /// Outputs after ten scans, block by block in the order of the file.
    std::vector<std::int64_t> expected() const {
        std::vector<std::int64_t> out;
        for (const Drawn& block : blocks_) out.push_back(block.factor);
        for (int scan = 0; scan < 10; ++scan) {
            const auto before = out;
            for (int i = 0; i < size(); ++i) {
                std::int64_t inputs[2];
                for (int k = 0; k < 2; ++k) {
                    const int source = at(i).sources[k];
                    inputs[k] = (source < i ? out : before)[static_cast<std::size_t>(source)];
                }
                std::int64_t& value = out[static_cast<std::size_t>(i)];
                value = (at(i).factor * value + 7 * inputs[0] + 11 * inputs[1] + 1) % 1'000'003;
            }
        }
        return out;
    }

  private:
    int size() const { return static_cast<int>(blocks_.size()); }
    const Drawn& at(int i) const { return blocks_[static_cast<std::size_t>(i)]; }
    std::string wire(int i, int k) const {
        const int source = at(i).sources[k];
        const std::string name = fmt::format("x{}.out", source);
        return source < i ? name : "previous(" + name + ")";
    }

    std::vector<Drawn> blocks_;
};

Linked linked(const std::string& text, const Catalog& catalog) {
    Diagnostics out;
    const Program program = read_program(small_file(text), {}, out);
    Linked result = link(program, catalog, out);
    INFO(text << out.render());
    REQUIRE(out.empty());
    return result;
}

Linked linked(const std::string& text, bool second_first = false) {
    Catalog catalog;
    if (second_first)
        catalog.add<Mix<5>>().add<Mix<3>>();
    else
        catalog.add<Mix<3>>().add<Mix<5>>();
    return linked(text, catalog);
}

std::vector<std::size_t> sizes(const Linked& linked) {
    std::vector<std::size_t> sizes;
    for (const Call& call : linked.machine.tasks.front().calls) sizes.push_back(call.count);
    return sizes;
}

std::string program_of(const std::string& blocks) {
    return "lineshaft: 1\ntasks: {t: {every: 1 ms}}\nrun: {for: 9 ms}\nblocks:\n" + blocks;
}

/// Each chain with a wire of each transfer.
std::string chains(int count) {
    std::string blocks;
    for (int i = 0; i < count; ++i)
        blocks += fmt::format(
            "  t{0}: {{type: ton, task: t, in: NOT previous(t{0}.q), pt: {1} ms}}\n"
            "  e{0}: {{type: r_trig, task: t, clk: t{0}.q}}\n"
            "  d{0}: {{type: ctu, task: t, cu: e{0}.q, pv: previous(d{0}.cv)}}\n"
            "  f{0}: {{type: filter_pt1, task: t, in: d{0}.cv, time_constant: 5 ms}}\n",
            i, i % 3);
    return program_of(blocks);
}

}  // namespace

TEST_CASE("link: a chain does the same alone and beside others, with which its wires are rows") {
    Linked many = linked(chains(11), standard_blocks());
    std::vector<std::pair<Transfer, bool>> transfers;
    for (const Row& row : many.machine.tasks.front().wires.rows) {
        CHECK(row.count == 11);
        transfers.emplace_back(row.transfer, row.first.negates);
    }
    CHECK(transfers == std::vector<std::pair<Transfer, bool>>{{Transfer::boolean, true},
                                                              {Transfer::boolean, false},
                                                              {Transfer::boolean, false},
                                                              {Transfer::word, false},
                                                              {Transfer::widened, false}});
    Executive(many.machine).run({});
    for (const auto& [count, timers, filters] : {std::tuple{1, Feed::negated, Feed::widened},
                                                 std::tuple{2, Feed::two_some_negated, Feed::many},
                                                 std::tuple{3, Feed::many, Feed::many}}) {
        Linked few = linked(chains(count), standard_blocks());
        const Task& task = few.machine.tasks.front();
        CHECK(task.wires.rows.empty());
        CHECK(task.calls.front().feed == timers);
        CHECK(task.calls.back().feed == filters);
        Executive(few.machine).run({});
        for (const Signal& signal : few.machine.signals) {
            INFO(count << " chains, " << signal.name);
            CHECK(signal.value() == many.machine.find(signal.name)->value());
        }
    }
}

TEST_CASE("link: whatever is called together, values are those of the file's order") {
    std::mt19937 draw(1);
    std::size_t blocks = 0, calls = 0;
    for (int i = 0; i < 500; ++i) {
        const DrawnProgram program(draw);
        Linked result = linked(program.text(), i % 2 == 1);
        Executive(result.machine).run({});
        std::vector<std::int64_t> found;
        for (std::size_t k = 0; k < program.expected().size(); ++k)
            found.push_back(
                std::get<std::int64_t>(result.machine.find(fmt::format("x{}.out", k))->value()));
        INFO(program.text());
        REQUIRE(found == program.expected());
        blocks += found.size();
        calls += result.machine.tasks.front().calls.size();
    }
    CHECK(calls < blocks * 9 / 10);
}

TEST_CASE("link: blocks of one kind that do not wait for each other are one call") {
    CHECK(sizes(linked(program_of("  a: {type: mix_3, task: t}\n"
                                  "  b: {type: mix_5, task: t, a: a.out}\n"
                                  "  c: {type: mix_3, task: t, a: previous(c.out)}\n"
                                  "  d: {type: mix_5, task: t, a: c.out}\n"))) ==
          std::vector<std::size_t>{2, 2});
}

TEST_CASE("link: a chain is called link by link") {
    CHECK(sizes(linked(program_of("  a: {type: mix_3, task: t}\n"
                                  "  b: {type: mix_3, task: t, a: a.out}\n"
                                  "  c: {type: mix_3, task: t, a: b.out}\n"))) ==
          std::vector<std::size_t>{1, 1, 1});
}

namespace {

/// Two values that change, as wires see them.
struct Sources {
    alignas(8) std::byte values[2][8] = {};

    void draw(std::mt19937& random, Type type) {
        for (auto& value : values) {
            const auto drawn = static_cast<std::int64_t>(random() % 7) - 3;
            store(type, value,
                  type == Type::boolean ? Value(drawn > 0)
                  : type == Type::real  ? Value(static_cast<double>(drawn) / 2)
                                        : Value(drawn));
        }
    }
};

bool is_of_booleans(Feed feed) {
    return feed >= Feed::boolean && feed <= Feed::two_some_negated;
}

/// A block of the kind, fed by one or two wires.
struct FedBlockOfKind {
    const BlockType& type;
    std::vector<std::byte> memory = std::vector<std::byte>(type.size);
    Call call;

    FedBlockOfKind(const BlockType& kind, Feed feed, const Sources& sources) : type(kind) {
        type.construct(memory.data());
        call.first = memory.data();
        call.count = 1;
        call.size = type.size;
        call.scan = type.scan_blocks;
        call.feed = feed;
        const bool negates = feed == Feed::negated || feed == Feed::two_some_negated;
        call.copies[0] = {sources.values[0], call.first + type.main_input.offset, negates};
        for (const Field& field : type.fields)
            if (field.direction == Direction::input && field.offset != type.main_input.offset &&
                size_of(field.type) == (is_of_booleans(feed) ? 1 : 8))
                call.copies[1] = {sources.values[1], call.first + field.offset};
    }

    std::string values() const {
        std::string text;
        for (const Field& field : type.fields)
            text += fmt::format(
                "{}: {:02x}\n", field.name,
                fmt::join(std::span(memory).subspan(field.offset, size_of(field.type)), ""));
        return text;
    }
};

Type source_type(Feed feed, const BlockType& type) {
    if (is_of_booleans(feed)) return Type::boolean;
    const bool is_real = type.main_input.scan[static_cast<std::size_t>(Feed::widened)] != nullptr;
    return is_real && feed != Feed::widened ? Type::real : Type::integer;
}

}  // namespace

TEST_CASE("a block that is fed and scanned at once does as one that is fed, then scanned") {
    int kinds = 0;
    for (const BlockType& type : standard_blocks().types())
        for (std::size_t i = 0; i < static_cast<std::size_t>(Feed::many); ++i) {
            const FeedAndScan at_once = type.main_input.scan[i];
            if (!at_once) continue;
            const auto feed = static_cast<Feed>(i);
            Sources sources;
            FedBlockOfKind plain(type, feed, sources), fed(type, feed, sources);
            const bool two = feed == Feed::two_booleans || feed == Feed::two_some_negated ||
                             feed == Feed::two_words;
            if (two && !plain.call.copies[1].target) continue;
            fed.call.run = at_once;
            ++kinds;
            std::mt19937 random(7);
            for (std::int64_t scan = 0; scan < 200; ++scan) {
                sources.draw(random, source_type(feed, type));
                const Scan now{scan * 1'000'000, 1'000'000, scan};
                const bool error = plain.call.run(plain.call, now);
                INFO(type.name << " in scan " << scan);
                REQUIRE(fed.call.run(fed.call, now) == error);
                REQUIRE(fed.values() == plain.values());
            }
        }
    CHECK(kinds >= 30);
}
