#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "runtime/model/device.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"
#include "runtime/model/wire.hpp"

namespace lineshaft {

/// Scans `count` blocks of a kind that stand one behind the other. True when one has an error.
using ScanBlocks = bool (*)(std::byte* first, std::size_t count, const Scan& now,
                            const Context& context);

/// A constant that comes to nothing together with the other constants of its block, as a rate above
/// what the chosen mode puts out.
struct Misfit {
    std::string_view field;
    std::string why;
};

/// True of a field that has one value all the time: neither wired nor set from outside.
using IsConstant = std::function<bool(std::string_view field)>;

struct KeptState;

/// Bytes of a block that others link into their lists.
struct LinkedPart {
    std::size_t place = 0, bytes = 0;
};

/// The bytes of an instance, by its number.
using InstanceAt = std::function<const std::byte*(std::int64_t instance)>;

/// Gives the name of an instance.
using NameOf = std::function<std::string(std::int64_t instance)>;

/// What the runtime knows of a kind of block: how to make one, how to call it, what it is made of.
/// What its texts and fields point to is static, or kept by `owner`.
struct BlockType {
    std::string_view name;
    std::string_view doc;
    std::span<const Field> fields;
    std::span<const TableField> tables;  ///< a block with `tables()` has some
    std::size_t size = 0;
    std::size_t alignment = 0;
    void (*make)(std::byte* place, const void* context) = nullptr;
    ScanBlocks scan_blocks = nullptr;
    ScanBlocks scan_before_all = nullptr;  ///< of one that its task scans before all others, and
    ScanBlocks scan_behind_all = nullptr;  ///< again behind them: the process image; or null
    MainInput main_input = {};
    DeviceCalls device = {};
    std::optional<Misfit> (*misfit)(const std::byte* block,
                                    const IsConstant& is_constant) = nullptr;  ///< or null
    /// What the first state of a block makes likely to be a mistake: a warning; or null.
    std::optional<Misfit> (*doubt)(const std::byte* block, const InstanceAt& at) = nullptr;
    void (*shift)(std::byte* block, std::int64_t by, const void* context) = nullptr;  ///< or null
    /// Whether a block may go on with a state that was kept, whatever its bytes are; or null: any
    /// that its fields admit. See KeptState.
    bool (*valid)(const std::byte* block, const KeptState& machine) = nullptr;
    /// Takes over of a kept state what outlives a scan, into a new block; or null: all of it.
    void (*take)(std::byte* block, const std::byte* kept, const void* context) = nullptr;
    /// What of a block others link into their lists, as the Job of a command.
    void (*add_links)(std::vector<LinkedPart>& parts, const BlockType& type) = nullptr;
    /// A block that was retained when others were not forgets what it was linked with, where that
    /// is not linked with it. Or null.
    void (*mend_links)(std::byte* block, const KeptState& machine) = nullptr;
    /// Whether it may give itself that parameter another value while it runs; or null: none.
    bool (*sets_parameter)(const Field& field) = nullptr;
    /// Where its last error came from, for people; empty: nobody can say. Or null.
    std::string (*why)(const std::byte* block, const Context& context,
                       const NameOf& name_of) = nullptr;
    std::optional<std::size_t> time_taken = {};  ///< place of what a scan took: std::int64_t [ns]
    std::string_view handle =
        {};  ///< `AXIS_REF`: how Structured Text calls references to it; or empty
    /// Structured Text: FUNCTIONs `"AXIS_REF.StatusWord"`, which sources read of such a
    /// reference as if they were its fields, `axis.StatusWord`; FUNCTION_BLOCKs. Or empty.
    std::string_view structured_text = {};
    bool single = false;                     ///< one a program, without an entry: a data block
    const void* context = nullptr;           ///< what all blocks of the kind share; may be null
    std::shared_ptr<const void> owner = {};  ///< of a kind that a program brings along

    bool is_device() const { return device.advance != nullptr; }
    void construct(std::byte* place) const { make(place, context); }

    /// Capital letters make no difference.
    /// What a program may set (a parameter, an input, a reference), or what it may read (an output
    /// or a local, else an input or a parameter). An output may bear an input's name: `velocity` is
    /// set as the wanted one and read as the axis' own. Null when there is none.
    const Field* find_settable(std::string_view field) const;
    const Field* find_readable(std::string_view field) const;
    const TableField* find_table(std::string_view name) const;
};

/// Equal but for capital letters.
bool same_letters(std::string_view a, std::string_view b);

namespace detail {

template <class Block>
constexpr bool copied_as_bytes() {
    (void)std::bit_cast<std::array<std::byte, sizeof(Block)>>(Block{});
    return true;
}

}  // namespace detail

/// Whether a number that anybody may have put in is that of a block of this kind. A reference
/// (Direction::in_out) needs no such look: it has been checked when the program was loaded.
template <class Block>
bool is_instance(const Context& context, std::int64_t number) {
    if (number < 0 || number >= context.blocks) return false;
    const BlockType& type = *context.types[number];
    return !type.owner && type.name == Block::type;
}

/// Plain data: without pointers, references, unions, made by a constant expression, so that a
/// machine's state can be kept and restored as bytes.
template <class Block>
concept PlainData = std::is_trivially_copyable_v<Block> && requires {
    typename std::bool_constant<detail::copied_as_bytes<Block>()>;
};

/// A file of a vendor's library: Structured Text that a program takes along by the names it uses.
struct LibraryFile {
    std::string_view library;  ///< `Util`, `System.Timer`: the namespace that all of it stands in
    std::string_view path, text;
};

/// The kinds of block a program may use, by name.
class Catalog {
  public:
    /// A block is a struct with `type`, `doc`, `fields()` and `scan(const Scan&)`, or
    /// `scan(const Scan&, const Context&)`. An output `error` is its member `error`. It may have
    /// `misfit(const IsConstant&) const`, for what its limits cannot say,
    /// `doubt(const InstanceAt&) const`, for what is likely to be a mistake, and
    /// `why(const Context&, const NameOf&) const`, for what the number of its error cannot say. One
    /// that remembers moments has `shift(by)`, which moves them all by so many ns: a retained block
    /// goes on in another run. `is_valid(const Block&, const KeptState&)` beside it says which kept
    /// states it can go on with, where its fields cannot say that. An input that is mostly wired
    /// alone may be named as `main_input`.
    template <class Block>
    Catalog& add() {
        static_assert(PlainData<Block>);
        std::span<const TableField> tables;
        if constexpr (requires { Block::tables(); }) tables = Block::tables();
        std::string_view handle;
        if constexpr (requires { Block::handle; }) handle = Block::handle;
        std::string_view structured_text;
        if constexpr (requires { Block::structured_text; })
            structured_text = Block::structured_text;
        return add({.name = Block::type,
                    .doc = Block::doc,
                    .fields = Block::fields(),
                    .tables = tables,
                    .size = sizeof(Block),
                    .alignment = alignof(Block),
                    .make = [](std::byte* place, const void*) { new (place) Block{}; },
                    .scan_blocks = scan_blocks<Block>,
                    .main_input = main_input<Block>(),
                    .device = device_calls<Block>(),
                    .misfit = misfit<Block>(),
                    .doubt = doubt<Block>(),
                    .shift = shift<Block>(),
                    .valid = valid_state<Block>(),
                    .add_links = add_links<Block>(),
                    .mend_links = mend_links<Block>(),
                    .sets_parameter = sets_parameter<Block>(),
                    .why = why<Block>(),
                    .handle = handle,
                    .structured_text = structured_text});
    }

    Catalog& add(BlockType type) {
        types_.push_back(std::move(type));
        return *this;
    }

    /// A kind that others have and this catalogue does not, on purpose.
    Catalog& lack(std::string_view name, std::string_view instead) {
        lacking_.push_back({name, instead});
        return *this;
    }

    /// Where two libraries have a name, the first that has it is meant. Static.
    Catalog& add_libraries(std::span<const LibraryFile> files) {
        libraries_ = files;
        return *this;
    }

    const BlockType* find(std::string_view name) const;
    /// What to do instead of a kind that the catalogue lacks on purpose; empty for any other.
    std::string_view instead_of(std::string_view name) const;
    const std::vector<BlockType>& types() const { return types_; }
    std::vector<std::string> names() const;
    std::span<const LibraryFile> libraries() const { return libraries_; }

  private:
    template <class Block>
    static constexpr auto misfit() -> decltype(BlockType::misfit) {
        if constexpr (requires(const Block& block, const IsConstant& f) { block.misfit(f); })
            return [](const std::byte* block, const IsConstant& is_constant) {
                return std::launder(reinterpret_cast<const Block*>(block))->misfit(is_constant);
            };
        return nullptr;
    }

    template <class Block>
    static constexpr auto doubt() -> decltype(BlockType::doubt) {
        if constexpr (requires(const Block& block, const InstanceAt& at) { block.doubt(at); })
            return [](const std::byte* block, const InstanceAt& at) {
                return std::launder(reinterpret_cast<const Block*>(block))->doubt(at);
            };
        return nullptr;
    }

    template <class Block>
    static constexpr auto shift() -> decltype(BlockType::shift) {
        if constexpr (requires(Block & block) { block.shift(std::int64_t{}); })
            return [](std::byte* block, std::int64_t by, const void*) {
                std::launder(reinterpret_cast<Block*>(block))->shift(by);
            };
        return nullptr;
    }

    template <class Block>
    static constexpr auto valid_state() -> decltype(BlockType::valid) {
        if constexpr (requires(const Block& block, const KeptState& m) { is_valid(block, m); })
            return [](const std::byte* block, const KeptState& machine) {
                return is_valid(*std::launder(reinterpret_cast<const Block*>(block)), machine);
            };
        return nullptr;
    }

    template <class Block>
    static constexpr auto sets_parameter() -> decltype(BlockType::sets_parameter) {
        if constexpr (requires(const Field& field) { Block::sets_parameter(field); })
            return &Block::sets_parameter;
        return nullptr;
    }

    template <class Block>
    static constexpr auto mend_links() -> decltype(BlockType::mend_links) {
        if constexpr (requires(Block & block, const KeptState& m) { mend(block, m); })
            return [](std::byte* block, const KeptState& machine) {
                mend(*std::launder(reinterpret_cast<Block*>(block)), machine);
            };
        return nullptr;
    }

    template <class Block>
    static constexpr auto add_links() -> decltype(BlockType::add_links) {
        if constexpr (requires { Block::linked_part; })
            return [](std::vector<LinkedPart>& parts, const BlockType&) {
                parts.push_back(
                    {detail::offset_of(Block::linked_part), sizeof(Block{}.*Block::linked_part)});
            };
        return nullptr;
    }

    template <class Block>
    static constexpr auto why() -> decltype(BlockType::why) {
        if constexpr (requires(const Block& b, const Context& c, const NameOf& n) { b.why(c, n); })
            return [](const std::byte* block, const Context& context, const NameOf& name_of) {
                return std::launder(reinterpret_cast<const Block*>(block))->why(context, name_of);
            };
        return nullptr;
    }

    template <class Block>
    static bool scan_blocks(std::byte* first, std::size_t count, const Scan& now,
                            const Context& context) {
        bool error = false;
        Block* block = std::launder(reinterpret_cast<Block*>(first));
        for (; count > 0; --count, ++block) {
            if constexpr (requires { block->scan(now, context); })
                block->scan(now, context);
            else
                block->scan(now);
            if constexpr (requires { block->error; }) error |= block->error;
        }
        return error;
    }

    template <class Block, Transfer transfer, bool two>
    static bool feed_and_scan(const FedBlock& fed, const Scan& now) {
        Block& block = *std::launder(reinterpret_cast<Block*>(fed.first));
        auto& input = block.*Block::main_input;
        if constexpr (two) deliver<transfer>(fed.copies[1]);
        const auto value = fetch<transfer>(fed.copies[0]);
        input = std::bit_cast<std::remove_reference_t<decltype(input)>>(value);
        block.scan(now);
        if constexpr (requires { block.error; }) return block.error;
        return false;
    }

    template <class Block>
    static MainInput main_input() {
        MainInput found;
        if constexpr (requires { Block::main_input; }) {
            found.offset = detail::offset_of(Block::main_input);
            const auto set = [&](Feed feed, FeedAndScan scan) {
                found.scan[static_cast<std::size_t>(feed)] = scan;
            };
            using Input = std::remove_cvref_t<decltype(Block{}.*Block::main_input)>;
            constexpr bool is_boolean = std::is_same_v<Input, bool>;
            constexpr Transfer as_is = is_boolean ? Transfer::plain : Transfer::word;
            set(is_boolean ? Feed::boolean : Feed::word, feed_and_scan<Block, as_is, false>);
            set(is_boolean ? Feed::two_booleans : Feed::two_words,
                feed_and_scan<Block, as_is, true>);
            if constexpr (is_boolean) {
                set(Feed::negated, feed_and_scan<Block, Transfer::negated, false>);
                set(Feed::two_some_negated, feed_and_scan<Block, Transfer::boolean, true>);
            }
            if constexpr (std::is_same_v<Input, double>)
                set(Feed::widened, feed_and_scan<Block, Transfer::widened, false>);
        }
        return found;
    }

    template <class Block>
    static constexpr DeviceCalls device_calls() {
        DeviceCalls calls;
        if constexpr (Device<Block>) {
            calls.next_event_time = [](const std::byte* block) {
                return std::launder(reinterpret_cast<const Block*>(block))->next_event_time();
            };
            calls.advance = [](std::byte* block, std::int64_t time, PulseSink* sink) {
                std::launder(reinterpret_cast<Block*>(block))->advance(time, sink);
            };
            calls.publish = [](std::byte* block, std::int64_t time) {
                std::launder(reinterpret_cast<Block*>(block))->publish(time);
            };
        }
        return calls;
    }

    struct Lacking {
        std::string_view name, instead;
    };

    std::vector<BlockType> types_;
    std::vector<Lacking> lacking_;
    std::span<const LibraryFile> libraries_;
};

}  // namespace lineshaft
