#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "runtime/model/address.hpp"
#include "runtime/model/catalog.hpp"
#include "runtime/model/library_reference.hpp"
#include "runtime/st/code/machine.hpp"

namespace lineshaft::st {

struct Options {
    std::int64_t fuel =
        10'000'000;  ///< passes of loops and calls that one scan of a block may take
    std::optional<InstructionTimes> times = {};  ///< see `Library::counts`
    bool overflow_faults = false;  ///< an integer beyond its type is a fault: it does not wrap
    bool native = true;  ///< as the processor's code, where that is possible; see native_code()

    std::vector<LibraryReference> references =
        {};  ///< to libraries: names that nobody has may be of those that are not here

    std::vector<std::string> addresses =
        {};  ///< of the process image, and ranges of such, that a program's file names

    std::set<const SourceFile*>* foreign = nullptr;  ///< gets the sources that have such names

    bool operator==(const Options&) const = default;
};

/// Where the last scan of an instance ended with a fault.
struct FaultPlace {
    Fault fault = Fault::none;
    Mark mark;
    std::vector<std::string> calls;  ///< `Clamp (line 12)`, the innermost first
    std::string left = {};           ///< the variable that a reference was to, and is not
};

/// The kinds of block that sources bring along, to be used as those of the catalogue are: each
/// PROGRAM (ORGANIZATION_BLOCK) and FUNCTION_BLOCK, and each DATA_BLOCK and `VAR_GLOBAL`.
///
/// Fields of a kind: VAR_INPUT CONSTANT is a parameter, VAR_INPUT an input, VAR_OUTPUT an output,
/// VAR and VAR_TEMP a local. Only scalars are fields (a STRING is none); of arrays, structures and
/// instances each part is one, by its path: `table[3].x`, `delay.ET`. A kind and each signal of a
/// block take memory for each field, so of what stands in arrays `most_elements` are
/// fields, of other parts `most_parts`. REAL and LREAL are real, TIME an integer of unit
/// ns, all integers and bit strings integers (a ULINT from 2^63 on shows as negative), with the
/// limits of their type. `{unit := 'mm/s'}` gives a number its unit.
///
/// AXIS_REF in VAR or VAR_OUTPUT, of the kind or of instances in it, is a reference that may be
/// given, by its path.
///
/// A value that a wire brings into an input of a narrower type is checked when the block is
/// scanned: out of range is a fault, with the first instruction as its place.
///
/// A kind that has no variable `error` has two more outputs, `error` and `error_id` (a Fault), of
/// the last scan; in one that has, they are `fault` and `fault_id`. After a fault the scan ends,
/// what was written so far stays, and the next scan begins anew.
///
/// Each kind has a reference (Field::global) to each data block, and to each block of the program,
/// such as an axis, that it or what it runs names: an instance of that name must be among the
/// program's. Such a reference is called `"Recipe"`, with the quotes, so that an input may be
/// Recipe.
class Library {
  public:
    std::span<const BlockType> kinds() const { return kinds_; }

    /// Where an instance of a kind of this library had its fault when it was scanned.
    FaultPlace fault(const BlockType& kind, const std::byte* instance) const;

    /// Instructions of each class that its last scan took, calls of other blocks included; with
    /// Options::times; what they took is the kind's `time_taken`.
    std::span<const std::uint64_t, op_classes> counts(const std::byte* instance) const;

    /// What the CONFIGURATIONs of its sources have of programs: the kind of each, and where it
    /// stands.
    std::vector<std::pair<std::string_view, Mark>> configured_programs() const;

    /// Some other code of its sources calls that PROGRAM.
    bool is_called(std::string_view program) const;

    /// For tests and people: the code of all.
    std::string listing() const;

    struct Made;

  private:
    friend std::optional<Library> compile(
        const std::vector<std::shared_ptr<const SourceFile>>& sources, const Catalog& standard,
        Diagnostics& out, const Options& options);

    std::shared_ptr<const Made> made_;  ///< also the owner of each kind
    std::vector<BlockType> kinds_;
};

/// The variable of that name that is a STRING, as it is written; empty if there is none. Capital
/// letters make no difference.
std::string_view find_text(const BlockType& kind, std::string_view name);

/// Where a block of a kind of some library first cut a text short, which was too long for its
/// variable; empty if it never did. Of another kind empty.
std::optional<Mark> cut_text(const BlockType& kind, const std::byte* instance);

/// Compiles Structured Text (IEC 61131-3:2013, and the SCL of Siemens) of all `sources` together;
/// they see each other, and of `standard` the kinds as function blocks. Empty, with all that is
/// wrong in `out`, if anything is. `standard` must outlive the library.
std::optional<Library> compile(const std::vector<std::shared_ptr<const SourceFile>>& sources,
                               const Catalog& standard, Diagnostics& out,
                               const Options& options = {});

/// As the sources write addresses, of the block type that has the process image.
AddressCount count_of_addresses(const BlockType& image);

}  // namespace lineshaft::st
