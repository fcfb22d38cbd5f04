#pragma once

#include <array>
#include <atomic>
#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/model/catalog.hpp"
#include "runtime/model/scan.hpp"
#include "runtime/st/code/opcodes.hpp"
#include "runtime/st/code/shapes.hpp"
#include "runtime/st/code/slots.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::st {

/// Characters that the result of a function of texts may have; of CODESYS, TwinCAT: 255.
inline constexpr std::int64_t longest_result = 254, longest_result_of_codesys = 255;

struct Instruction {
    Op op = Op::leave;
    std::uint32_t a = 0, b = 0, d = 0;
    std::uint64_t c = 0;
};
static_assert(sizeof(Instruction) == 24);

/// A slot of a routine's frame that has a constant of it, and is never written.
struct ConstantSlot {
    std::uint32_t slot = 0;
    std::uint64_t bits = 0;
    auto operator<=>(const ConstantSlot&) const = default;
};

/// Slots of a frame.
struct SlotRange {
    std::uint32_t first = 0, end = 0;
};

/// The most slots of a block's memory behind its frame for the frames of calls that recur.
inline constexpr std::uint32_t pile_slots = 16384;
/// Slots that each of them has besides.
inline constexpr std::uint32_t record_end = 4;

struct CodeRoutine {
    std::string name;
    std::uint32_t entry = 0, end = 0;  ///< instructions
    std::uint32_t frame = 0;           ///< slots that it may use, from its base on
    std::uint32_t depth = 0;   ///< levels of calls below it, but for those found by instances
    std::uint32_t levels = 0;  ///< that an instance which runs it has room for
    std::uint32_t mark = 0;    ///< slot that says that it runs; 0: it has none
    std::vector<ConstantSlot> constants = {};  ///< by their slots
    /// What its call changes of another on its instance: nothing, from its results on, if no ring.
    SlotRange variables = {}, temporaries = {};
    bool holds_instance = false;  ///< of a call, which is not put aside
    SlotRange pile = {};          ///< where the frames of calls that recur are

    std::uint32_t kept() const {
        return variables.end - variables.first + temporaries.end - temporaries.first;
    }
};

/// The method of a kind of instance that a call finds.
struct FoundRoutine {
    std::uint32_t routine = 0;
    std::uint32_t depth = 0;  ///< levels of calls below it
    std::uint64_t first = 0;  ///< slot of the first that is given to it; 0: it has no such method
};

/// What an Op::cover counts the passes of.
struct CoverPoint {
    enum class Kind : std::uint8_t { function, branch, statement };
    Kind kind = Kind::statement;
    Place place = {};
    std::uint32_t branch = 0;  ///< of the IF, the CASE or the loop at `place`
    std::string name = {};     ///< of a function
};

/// Where a statement of a user's source begins.
struct StatementStart {
    std::uint32_t instruction = 0;
    bool is_inner = false;  ///< with the second half of what was fused to that instruction
    Place place = {};
};

/// `__TRY`: where a fault of these instructions, or of what they call, goes on.
struct Handler {
    std::uint32_t first = 0, end = 0;  ///< instructions
    std::uint32_t entry = 0;           ///< the instruction that __CATCH begins with
};

struct Native;
class Probe;

/// Is told of assertions that do not hold, while what they stand in runs.
class Witness {
  public:
    virtual ~Witness() = default;
    /// `frame` is the address of the frame that runs, `depth` how many calls do. True: what runs
    /// ends there, with Fault::assertion.
    virtual bool ends_at(std::uint64_t instruction, std::uint64_t frame, std::uint64_t depth) = 0;
    /// ADVANCE_TIME: in the scan that it was given. False for a time that would go back, or end.
    virtual bool let_pass(std::int64_t time, std::int64_t interval) = 0;
};

/// What all the sources together are compiled to.
struct Code {
    std::vector<Instruction> instructions;
    std::vector<Place> places;               ///< of each instruction
    std::vector<StatementStart> statements;  ///< by their instructions
    std::vector<CodeRoutine> routines;
    std::vector<IndexTable> tables;
    std::vector<std::int64_t> numbers;       ///< of enumerations; addresses of jumps
    std::vector<std::uint64_t> images;       ///< frames as they begin
    std::vector<const BlockType*> standard;  ///< kinds of the catalogue that are called
    std::uint32_t globals = 0;
    std::vector<FoundRoutine> found;  ///< by kind of instance, and number of what is called
    std::uint32_t methods = 0;        ///< how many numbers there are
    bool has_kinds = false;           ///< an instance says which it is
    bool has_references = false;
    std::vector<Piece> pieces;         ///< what references refer to
    std::vector<Shape> shapes;         ///< of those, and of what is wanted of them
    std::vector<ShapeMember> members;  ///< of structures
    std::vector<Handler> handlers;     ///< the inner ones first
    std::vector<CoverPoint> points;    ///< only with coverage
    std::unique_ptr<std::atomic<std::uint64_t>[]> hits;  ///< of each of them
    mutable Witness* witness = nullptr;  ///< of tests; without one an assertion ends what runs
    /// What an instruction of each class takes [ns], where what is executed is counted.
    std::optional<InstructionTimes> times;
    /// Null: the machine interprets it. What is counted has none.
    std::shared_ptr<const Native> native;
    mutable Probe* probe = nullptr;  ///< a debugger's that looks at scans

    std::uint32_t left_slot() const { return globals_slot + globals; }
    std::uint32_t kind_slot() const { return left_slot() + (has_references ? 1 : 0); }
    /// Where the calls that run begin.
    std::uint32_t calls_slot() const { return kind_slot() + (has_kinds ? 1 : 0); }

    /// A call of a kind of the catalogue.
    void call_block(std::byte* block, std::uint32_t number, const Scan& now,
                    const Context& context) const {
        const BlockType& type = *standard[number];
        if (!type.context) return void(type.scan_blocks(block, 1, now, context));
        Context inner = context;
        inner.kind = type.context;
        type.scan_blocks(block, 1, now, inner);
    }

    /// The instruction at a jump's address; none of this code if it is not one.
    std::uint64_t place_of(std::uint64_t address) const {
        const auto first = reinterpret_cast<std::uint64_t>(instructions.data());
        const std::uint64_t distance = address - first;
        return distance % sizeof(Instruction) == 0 ? distance / sizeof(Instruction) : ~distance;
    }
};

/// Empty when every operand is within its routine's frame, every jump within its routine, every
/// call's callee within the caller's frame, and every table is there; else what is wrong.
std::string verify(const Code& code);

/// An instruction a line: `12  add_lreal 4 5 6`.
std::string listing(const Code& code);

}  // namespace lineshaft::st
