#pragma once

#include <map>
#include <optional>
#include <unordered_set>

#include "runtime/st/functions/emission.hpp"
#include "runtime/st/generate/generator.hpp"
#include "runtime/st/types/elementary.hpp"

namespace lineshaft::st {

using Kind = Type::Kind;
using E = Expression::Kind;
using S = Statement::Kind;

/// What a Slot counts: while a routine is being written its temporaries, constants and the frames
/// of the functions that it calls are counted from 0 each; the end of the routine puts them behind
/// its variables.
enum Region : std::uint32_t { temporary = 1U << 30, constant = 2U << 30, window = 3U << 30 };

constexpr std::uint32_t region_mask = 3U << 30;
constexpr Slot none = 0xFFFF'FFFF;

/// Instructions that go on where a later one will be: their numbers.
using Jumps = std::vector<std::uint32_t>;

/// The code that is being written: statements, expressions and calls, which are functions of the
/// files beside this one, all write into one list of instructions, with the same temporaries, jumps
/// that wait for their targets, and what may be fused with what comes next.
struct Writing {
    using Image = std::vector<std::uint64_t>;

    void put(Instruction instruction);
    void put(Op op, Slot a = 0, Slot b = 0, Slot c = 0, Slot d = 0);
    /// What the instruction gives is in `wanted`, if that is a slot, else in a new temporary.
    Slot emit(Op op, Slot wanted, Slot b, Slot c = 0);
    Slot result(Slot wanted) { return wanted == none ? new_temporary() : wanted; }
    std::uint32_t next() const { return static_cast<std::uint32_t>(code.instructions.size()); }

    void jump(Op op, Slot a, Slot b, Jumps& to);
    void land();  ///< the next instruction is gone to from elsewhere: nothing is fused with it
    void land(Jumps& jumps);

    Slot new_temporary(std::uint32_t slots = 1);
    Slot constant_slot(std::uint64_t bits);
    Slot constant_slot(const Type& type, const Constant& value);
    std::uint32_t table(IndexTable made);
    std::uint32_t routine_number(const Routine& called) const { return numbers.at(&called); }
    std::uint32_t standard_number(const BlockType& kind);

    void leave();

    /// A statement, or the condition of an ELSIF, begins with the next instruction.
    void begin_statement(Place at);
    /// The last instruction becomes a part of the one before.
    void join_statement();

    void cover(CoverPoint::Kind kind, Place at, std::size_t branch = 0);
    void cover_branch(const Statement& s, std::size_t branch) {
        cover(CoverPoint::Kind::branch, s.place, branch);
    }

    /// What was fused has left its temporary unwritten: nothing may read that before it is written
    /// again.
    void note_use(const Instruction& in);
    /// The last two instructions to one, where the second is the only one that reads what the first
    /// writes.
    void fuse();
    /// `IF a < b THEN x := y; END_IF`, the last instructions, to one without a jump.
    void fuse_guarded_move(Jumps& skip);
    /// A jump to a jump goes where that does.
    void thread(std::uint32_t instruction);
    /// Jumps go to addresses, which stay as the code is moved on as a whole.
    void link();

    Checked& checked;
    Diagnostics& out;
    CodeOptions options;
    bool fuses = true;
    Code code = {};
    std::vector<Assertion> assertions = {};
    bool has_tests = false;
    bool is_too_large = false;  ///< what is laid out, which was told: not all of it has a place
    std::unordered_map<const Type*, Image> images = {};
    std::unordered_map<const Routine*, Image> function_images = {};
    std::unordered_map<const Routine*, std::uint32_t> numbers = {};
    std::unordered_map<const BlockType*, std::uint32_t> standard_numbers = {};
    std::unordered_map<const Routine*, std::uint32_t> method_numbers = {};  ///< of what is found
    std::unordered_map<const Routine*, std::uint64_t> kinds = {};  ///< of instances, by their block
    struct ImageUse {
        std::uint32_t instruction;
        const Type* type;  ///< of a block, or null
        const Routine* function;
    };
    std::vector<ImageUse> image_uses = {};
    using Pieces = std::unordered_map<const void*, std::uint32_t>;  ///< numbers in Code::pieces
    Pieces pieces = {};                                             ///< of variables; of types THIS
    Pieces views = {};                                              ///< of overlays
    std::map<IndexTable, std::uint32_t> tables = {};                ///< their numbers

    /// What is known when all is laid out: so many times the place of a member, or the size of a
    /// type, is the stride of a table, or the distance of an Op::offset.
    struct Late {
        const Variable* member = nullptr;
        const Type* type = nullptr;
        std::uint64_t times = 1;
        bool is_stride = false;
        std::uint32_t at = 0;  ///< of the table, or of the instruction
    };
    std::vector<Late> late = {};
    std::unordered_set<const Routine*> laid_out = {};  ///< of rings, before they are written
    std::unordered_map<const Routine*, std::size_t> unwritten_parts =
        {};  ///< of blocks: bodies and methods

    // These are of the routine that is being written.
    Routine* routine = nullptr;
    Image* image = nullptr;
    std::uint32_t temporaries = 0, most_temporaries = 0, windows = 0;
    std::vector<std::uint64_t> constants = {};
    std::unordered_map<std::uint64_t, Slot> constant_slots = {};
    Place place = {};
    std::unordered_set<Slot> unwritten = {};  ///< temporaries
    std::uint32_t landed = 0;                 ///< the last instruction that a jump goes to
    struct Loop {
        Jumps exits, nexts;
    };
    std::vector<Loop> loops = {};
    struct Label {
        Jumps jumps;                      ///< from before it
        std::optional<std::uint32_t> at;  ///< its instruction
    };
    NameMap<Label> labels = {};
};

}  // namespace lineshaft::st
