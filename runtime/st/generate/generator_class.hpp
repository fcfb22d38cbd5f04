#pragma once

#include <map>
#include <optional>
#include <unordered_set>

#include "runtime/st/functions/standard.hpp"
#include "runtime/st/generate/generator.hpp"
#include "runtime/st/types/elementary.hpp"

namespace lineshaft::st {

/// A slot as an operand. While a routine is being written its temporaries, constants and the frames
/// of the functions that it calls are counted from 0 each; finish() puts them behind its variables.
using Slot = std::uint32_t;

enum Region : std::uint32_t { temporary = 1U << 30, constant = 2U << 30, window = 3U << 30 };

constexpr Slot none = 0xFFFF'FFFF;

/// Where a value is.
struct Location {
    enum class Mode : std::uint8_t {
        slot,     ///< slot
        indexed,  ///< slot + what is in `index`
        address,  ///< what the address in slot `index` says, + offset
    };
    Mode mode = Mode::slot;
    Slot slot = 0, index = 0;
    std::uint32_t offset = 0;
    std::optional<std::uint32_t> byte = {};  ///< of a boolean in an instance of the catalogue
    Slot capacity = none;  ///< of a text of any length: what it holds is in that slot
};

/// What a call is given only when all its arguments are known.
struct Later {
    Location to;
    Slot slot;
    std::uint32_t slots = 0;  ///< of an array, a structure or a text
};

/// One class, though large: statements, expressions and calls write into one list of instructions
/// with the same temporaries, jumps that wait for their targets, and what may be fused with what
/// comes next.
class Generator {
  public:
    Generator(Checked& checked, Diagnostics& out, const CodeOptions& options)
        : checked_(checked), out_(out), options_(options) {}
    Generated generate();

  private:
    using Image = std::vector<std::uint64_t>;

    // layout.cpp
    std::uint32_t slots_of(const Type& type);
    void lay_out(Routine& block);
    void lay_out_function(Routine& routine);
    void lay_out_method(Routine& method);
    void place_variables(Routine& routine, std::uint32_t& at, auto condition);
    void fill(Image& image, std::uint32_t at, const Variable& variable);
    void fill_default(Image& image, std::uint32_t at, const Type& type);
    void fill(Image& image, std::uint32_t at, const Type& type, const Expression& value);
    void fill_elements(Image& image, std::uint32_t at, const Type& type, const Expression& list);
    void fill_data_block(Image& image, const Global& global);
    void finish_images();
    void check_size(std::uint64_t slots, Place place, std::string_view name);

    // generator.cpp
    void write(Routine& routine);
    void begin(Routine& routine);
    void finish(Routine& routine);
    void put(Op op, Slot a = 0, Slot b = 0, Slot c = 0, Slot d = 0);
    std::uint32_t next() const { return static_cast<std::uint32_t>(code_.instructions.size()); }
    void note_use(const Instruction& instruction);
    void fuse();
    void fuse_guarded_move(std::vector<std::uint32_t>& skip);
    void thread(std::uint32_t instruction);
    void link();
    void land();
    void land(std::vector<std::uint32_t>& jumps);
    void jump(Op op, Slot a, Slot b, std::vector<std::uint32_t>& to);
    Slot new_temporary(std::uint32_t slots = 1);
    Slot constant_slot(std::uint64_t bits);
    Slot constant_slot(const Type& type, const Constant& value);
    std::uint32_t table(IndexTable table);
    std::uint32_t routine_number(const Routine& routine);
    void write_block(const Block& block);
    void write_statement(const Statement& s);
    void write_if(const Statement& s);
    void write_case(const Statement& s);
    void test_label(const Statement& s, Slot selector, const Branch::Label& label, bool is_last,
                    std::vector<std::uint32_t>& here, std::vector<std::uint32_t>& past);
    std::optional<IndexTable> jump_table(const Statement& s) const;
    void write_choice(const Statement& s, Slot selector, const IndexTable& table);
    void write_for(const Statement& s);
    void write_loop(const Statement& s);
    bool repeat_test(std::uint32_t start, std::uint32_t end);
    void write_assignment(const Statement& s);
    void jump_unless(const Expression& condition, std::vector<std::uint32_t>& to);

    // values.cpp
    Slot value(const Expression& e, Slot wanted = none);
    void value_to(const Expression& e, Slot to);
    Slot value_before(const Expression& e, const Expression& later);
    Slot result(Slot wanted) { return wanted == none ? new_temporary() : wanted; }
    Slot unary(const Expression& e, Slot wanted);
    Slot binary(const Expression& e, Slot wanted);
    Slot exact(Word op, const Type& type, Slot a, Slot b, Slot wanted);
    Slot within(const Type& type, Slot slot);
    Slot comparison(const Expression& e, Slot wanted);
    Slot lazy(const Expression& e);
    Slot bit(const Expression& e, Slot wanted);
    Slot converted(const Expression& e, Slot wanted);
    Slot convert(Slot from_slot, const Type& from, const Type& to, bool truncates, Slot wanted);
    Slot look_up(Slot slot, const std::vector<std::int64_t>& numbers);
    Slot convert_real(Slot slot, const Type& from, const Type& to, bool truncates, Slot wanted);
    Slot convert_date(Slot slot, const Type& from, const Type& to, Slot wanted);
    Slot convert_time(Slot slot, const Type& from, const Type& to, Slot wanted);
    Slot emit(Op op, Slot wanted, Slot b, Slot c = 0);
    Location locate(const Expression& e);
    Location locate_element(const Expression& e);
    Location as_address(Location location);
    Slot address_of(Location location);
    Slot capacity_of(const Location& text, const Type& type);
    Location locate_object(const Expression& e);
    Location part(Location of, const Variable& member);
    Location part(Location of, std::uint32_t slots);
    Slot load(const Location& from, Slot wanted = none);
    void store(const Location& to, Slot from);
    void copy(const Location& to, const Location& from, std::uint32_t slots);
    void assign(const Location& to, const Type& type, const Expression& from);
    void copy_value(const Location& to, const Type& type, const Expression& from);
    Slot text_address(const Expression& e);
    Slot new_text(Slot& address);
    Slot text_function(const Expression& e);
    Slot text_conversion(const Expression& e);
    void append(Slot to, Slot from, Slot first, Slot count);
    Slot character(const Expression& e, Slot wanted);
    void store_bits(const Expression& target, Slot bits);

    // generator_calls.cpp
    Slot call(const Expression& e, Slot wanted);
    Location method_base(const Expression& e);
    std::uint32_t standard_number(const BlockType& kind);
    void call_instance(const Expression& e);
    Location call_routine(const Expression& e);
    void give_left_out(const Location& frame, const Expression& e);
    void refer(const Location& to, const Variable& variable, const Expression& value,
               std::vector<Later>& later);
    void give(const Location& frame, const Expression& e, const Routine& routine);
    void take(const Location& frame, const Expression& e);
    Slot standard(const Expression& e, Slot wanted);
    Slot reset_timer(const Expression& timer);
    Slot extremum(const Expression& e, bool greatest, Slot wanted);
    Slot several(const Expression& e, std::size_t first);
    Slot value_or_address(const Expression& e, Slot wanted);

    // generator_tests.cpp
    struct Compared {
        Slot holds = none, found = none, wanted = none, tolerance = none;
    };
    void advance_time(Slot by);
    void write_test_statement(const Expression& e);
    Location calls_of(const Expression& instance);
    Location locate_global(const Variable& variable);
    Compared compared(const Expression& e);
    Slot relation(TestCall test, const Type& type, Slot a, Slot b);
    void write_distance(const Expression& e);
    void write_equal(const Expression& e, const Type& type, const Location& a, const Location& b,
                     const std::string& path);
    void write_assertion(const Expression& e, const Compared& values, const Type* part = nullptr,
                         const std::string& path = {});
    void count_call(const Location& calls, std::vector<std::uint32_t>& runs);
    void begin_mockable(const Routine& routine);
    void cover(CoverPoint::Kind kind, Place place, std::size_t branch = 0);
    void cover_branch(const Statement& s, std::size_t branch) {
        cover(CoverPoint::Kind::branch, s.place, branch);
    }

    Checked& checked_;
    Diagnostics& out_;
    CodeOptions options_;
    bool fuses_ = true;
    Code code_;
    std::vector<Assertion> assertions_;
    bool has_tests_ = false;
    const SourceFile* test_file_ = nullptr;
    std::unordered_map<const Type*, Image> images_;
    std::unordered_map<const Routine*, Image> function_images_;
    std::unordered_map<const Routine*, std::uint32_t> numbers_;
    std::unordered_map<const BlockType*, std::uint32_t> standard_numbers_;
    struct ImageUse {
        std::uint32_t instruction;
        const Type* type;  ///< of a block, or null
        const Routine* function;
    };
    std::vector<ImageUse> image_uses_;
    std::map<IndexTable, std::uint32_t> tables_;  ///< their numbers

    // Of the routine that is being written.
    Routine* routine_ = nullptr;
    Image* image_ = nullptr;
    std::uint32_t temporaries_ = 0, most_temporaries_ = 0, windows_ = 0;
    std::vector<std::uint64_t> constants_;
    std::unordered_map<std::uint64_t, Slot> constant_slots_;
    Place place_ = {};
    std::unordered_set<Slot> unwritten_;  ///< temporaries
    std::uint32_t landed_ = 0;            ///< the last instruction that a jump goes to
    struct Loop {
        std::vector<std::uint32_t> exits, nexts;
    };
    std::vector<Loop> loops_;
};

/// An opcode of a family, for a type: `add_sint` and DINT give `add_dint`.
Op of_type(Op first, const Type& type);

}  // namespace lineshaft::st
