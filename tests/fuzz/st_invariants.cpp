#include "tests/fuzz/st_invariants.hpp"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "runtime/model/random.hpp"
#include "runtime/st/library/library.hpp"

namespace lineshaft::test {

namespace {

/// In a scan: an input that takes longer than libFuzzer waits finds nothing.
constexpr std::int64_t most_passes = 100'000;

/// An instance of each kind of a library.
class Blocks {
  public:
    explicit Blocks(const st::Library& library) : library_(library) {
        for (const BlockType& kind : library.kinds()) {
            starts_.push_back(memory_.size());
            memory_.resize(memory_.size() + kind.size / 8);
        }
        find_places();
        for (std::size_t i = 0; i < starts_.size(); ++i) library.kinds()[i].construct(places_[i]);
        for (std::size_t i = 0; i < starts_.size(); ++i) bind(i);
    }

    /// All programs; their inputs have other values now and then.
    void scan(int number, Random& random) {
        const Scan now{number * std::int64_t{7'000'000}, 7'000'000, number};
        for (std::size_t i = 0; i < starts_.size(); ++i) {
            const BlockType& kind = library_.kinds()[i];
            if (!kind.doc.starts_with("PROGRAM")) continue;
            if (random.below(4) == 0) set_inputs(kind, places_[i], random);
            const bool error = kind.scan_blocks(places_[i], 1, now, {kind.context, places_.data()});
            const bool told = library_.fault(kind, places_[i]).fault != st::Fault::none;
            disagrees |= error != told;
        }
    }

    /// The same memory elsewhere: nothing in it may be an address.
    void move() {
        auto elsewhere = memory_;
        std::swap(memory_, elsewhere);
        find_places();
    }

    const std::vector<std::uint64_t>& memory() const { return memory_; }
    bool disagrees = false;

  private:
    void find_places() {
        places_.clear();
        for (const std::size_t start : starts_)
            places_.push_back(reinterpret_cast<std::byte*>(memory_.data() + start));
    }

    void bind(std::size_t i) {
        for (const Field& field : library_.kinds()[i].fields) {
            if (field.direction != Direction::in_out) continue;
            std::int64_t number = 0;
            for (const BlockType& kind : library_.kinds()) {
                if (kind.name == field.refers)
                    store(Type::integer, places_[i] + field.offset, number);
                ++number;
            }
        }
    }

    static void set_inputs(const BlockType& kind, std::byte* block, Random& random) {
        for (const Field& field : kind.fields) {
            if (field.direction != Direction::input) continue;
            const std::int64_t whole = random.around_zero(100);
            if (field.type == Type::boolean)
                store(field.type, block + field.offset, whole > 0);
            else if (field.type == Type::real)
                store(field.type, block + field.offset, static_cast<double>(whole) / 8);
            else if (is_integer(field.type))
                store(field.type, block + field.offset,
                      whole < 0 && field.minimum >= 0 ? -whole : whole);
        }
    }

    const st::Library& library_;
    std::vector<std::uint64_t> memory_;
    std::vector<std::size_t> starts_;
    std::vector<std::byte*> places_;
};

}  // namespace

std::string broken_invariant(const std::string& text, int scans, std::uint64_t seed,
                             const Catalog& catalog) {
    Diagnostics out;
    const auto file = std::make_shared<const SourceFile>(SourceFile{"random.st", text});
    const auto library = st::compile({file}, catalog, out, {.fuel = most_passes});
    const auto interpreted =
        st::compile({file}, catalog, out, {.fuel = most_passes, .native = false});
    if (!library) return out.render();
    Random first(seed, "inputs"), second = first;
    Blocks whole(*library), parted(*interpreted);
    const int resumed =
        static_cast<int>(Random(seed, "resume").below(static_cast<std::uint64_t>(scans)));
    for (int i = 0; i < scans; ++i) whole.scan(i, first);
    for (int i = 0; i < scans; ++i) {
        if (i == resumed) parted.move();
        parted.scan(i, second);
    }
    if (whole.disagrees) return "the outcome of a scan is not what its header says";
    if (whole.memory() != parted.memory())
        return fmt::format("other bytes where native code is off, moved at scan {}", resumed);
    return {};
}

}  // namespace lineshaft::test
