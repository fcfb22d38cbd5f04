#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// What the runtime knows of a kind of block: how to make one, how to call it, what it is made of.
struct BlockType {
    std::string_view name;
    std::string_view doc;
    std::span<const Field> fields;
    std::size_t size = 0;
    std::size_t alignment = 0;
    void (*construct)(std::byte* place) = nullptr;
    void (*scan)(std::byte* block, const Scan& now) = nullptr;

    /// What a program may set (a parameter or input), or what it may read (an output, else an input
    /// or parameter). An output may bear an input's name: `velocity` is set as the wanted one and
    /// read as the axis' own. Null when there is none.
    const Field* find_settable(std::string_view field) const;
    const Field* find_readable(std::string_view field) const;
};

/// The kinds of block a program may use, by name.
class Catalog {
  public:
    /// A block is a struct with `type`, `doc`, `fields()` and `scan(const Scan&)`. It is plain
    /// data, so that a machine's state can be kept and restored as bytes.
    template <class Block>
    Catalog& add() {
        static_assert(std::is_trivially_copyable_v<Block>);
        types_.push_back({Block::type, Block::doc, Block::fields(), sizeof(Block), alignof(Block),
                          [](std::byte* place) { new (place) Block{}; },
                          [](std::byte* block, const Scan& now) {
                              std::launder(reinterpret_cast<Block*>(block))->scan(now);
                          }});
        return *this;
    }

    const BlockType* find(std::string_view name) const;
    const std::vector<BlockType>& types() const { return types_; }
    std::vector<std::string> names() const;

  private:
    std::vector<BlockType> types_;
};

}  // namespace lineshaft
