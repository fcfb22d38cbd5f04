#pragma once

#include <algorithm>
#include <vector>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "tests/runtime/st/instance.hpp"
#include "tests/source_folder.hpp"

namespace lineshaft::test {

/// The library of files of programs/paper.
inline st::Library compiled(const std::vector<std::string>& files) {
    std::vector<std::shared_ptr<const SourceFile>> sources;
    for (const std::string& file : files)
        sources.push_back(st::read(test::in_source("programs/paper/" + file)));
    Diagnostics out;
    auto made = st::compile(sources, standard_blocks(), out);
    INFO(out.render());
    REQUIRE(made);
    return std::move(*made);
}

/// A function block in Structured Text with `Hand`, the same in C++, beside it: every scan gives
/// the same bits. Parameters and inputs are those of `Hand`, by their names;
/// but `by_source`, if any, which chooses the library.
template <class Hand>
struct Twin : Hand {
    void scan_both(const st::Library& library, std::string_view name, const Scan& now,
                   std::string_view by_source = {}) {
        const BlockType& block = *std::ranges::find(library.kinds(), name, &BlockType::name);
        if (memory.empty()) {
            memory.resize(block.size / 8);
            block.construct(place());
        }
        for (const Field& from : Hand::fields()) {
            if (from.direction == Direction::output || from.name == by_source) continue;
            const Field* to = find(block, from.name);
            INFO(from.name);
            REQUIRE(to);
            store(to->type, place() + to->offset, load(from.type, self() + from.offset));
        }
        if (const Field* cycle = find(block, "cycle"))
            store(cycle->type, place() + cycle->offset, seconds(now.interval));
        block.scan_blocks(place(), 1, now, {block.context, nullptr});
        Hand::scan(now);
        compare(block);
    }

  private:
    static const Field* find(const BlockType& block, std::string_view name) {
        const auto it = std::ranges::find_if(
            block.fields, [&](const Field& f) { return st::same_name(f.name, name); });
        return it == block.fields.end() ? nullptr : &*it;
    }

    std::byte* place() { return reinterpret_cast<std::byte*>(memory.data()); }
    std::byte* self() { return reinterpret_cast<std::byte*>(static_cast<Hand*>(this)); }

    void compare(const BlockType& block) {
        for (const Field& mine : Hand::fields()) {
            if (mine.direction != Direction::output) continue;
            const Field* its = find(block, mine.name);
            INFO(mine.name);
            REQUIRE(its);
            const std::string a = format(load(mine.type, self() + mine.offset));
            const std::string b = format(load(its->type, place() + its->offset));
            INFO(b << " in Structured Text, " << a << " in C++");
            REQUIRE(a == b);
        }
    }

    std::vector<std::uint64_t> memory;
};

}  // namespace lineshaft::test
