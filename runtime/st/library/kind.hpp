#pragma once

#include <deque>
#include <functional>

#include "runtime/st/library/compiled.hpp"
#include "runtime/st/library/text_variables.hpp"
#include "runtime/st/types/packed.hpp"

namespace lineshaft::st {

/// What the blocks of a kind share.
struct KindContext {
    const Compiled* made = nullptr;
    const Code* code = nullptr;            ///< of it
    const CodeRoutine* routine = nullptr;  ///< null: a data block
    bool is_plain = false;                 ///< has one, and nothing is looked at before a scan
    ScanStart start = {};
    const std::uint64_t* image = nullptr;
    std::size_t size = 0;
    Options options;
    std::string name, doc;
    std::vector<Field> fields;
    std::vector<TextVariable> texts;
    std::vector<std::string_view> shortened;  ///< see shortened_variables
    Retention retention = Retention::unsaid;  ///< of a data block: what its header says
    struct Check {
        std::uint32_t slot;
        const Type* type;
    };
    struct Part {
        std::size_t offset;
        const BlockType* kind;
    };
    std::vector<Part> with_moments;         ///< instances of the catalogue that remember when
    const Type* type = nullptr;             ///< of the instances
    std::vector<Check> checks;              ///< inputs narrower than what a wire brings
    std::vector<std::uint32_t> references;  ///< slots of VAR_IN_OUT, which a call fills
    /// Runs a test; what it says that does not hold goes to `failure`.
    std::function<std::string(std::byte* instance, const Context& context)> run_test = {};
    mutable std::string failure = {};  ///< of the last scan
};

/// What the block with the process image works by.
struct ImageKind {
    struct Place {
        std::uint64_t bit = 0;  ///< of the image
        PackedFormat format = {};
    };
    std::vector<Place> places;  ///< of each field
    std::vector<Field> fields;
    std::size_t bytes = 0;
    const std::uint64_t* image = nullptr;  ///< as it begins
    AddressCount count = AddressCount::bytes;
};

/// All that the kinds of a library refer to.
struct Library::Made : Compiled {
    std::deque<KindContext> kinds;
    ImageKind image;
    std::deque<std::string> names;                     ///< of fields
    std::deque<std::vector<std::string_view>> values;  ///< of enumerations
};

std::size_t element_slots(const Type& array);
/// The slots of a value; a text has room for all its characters.
std::size_t slots_of(const Type& type);

/// What the blocks of a kind of some library share; null of any other kind.
const KindContext* context_of(const BlockType& kind);

/// A kind of block without fields, whose instances are as the type's image.
KindContext& add_kind(Library::Made& made, std::string name, const Type& type,
                      const Options& options);

/// What the kind is compiled from; null of one that is not Structured Text, and of the image.
const Library::Made* made_of(const BlockType& kind);

BlockType block_type(KindContext& kind, const std::shared_ptr<const Library::Made>& made);

}  // namespace lineshaft::st
