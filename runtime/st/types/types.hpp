#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/model/address.hpp"
#include "runtime/model/catalog.hpp"
#include "runtime/st/syntax/tree.hpp"
#include "runtime/st/types/wide_text.hpp"

namespace lineshaft::st {

/// What a reference may be used for.
enum class Referring : std::uint8_t {
    alias,    ///< REFERENCE TO: its name means what it refers to
    ref,      ///< REF_TO
    pointer,  ///< POINTER TO: reckoned with, too
};

/// How values of a type are kept. Each scalar has a slot of 64 bits: an integer as std::int64_t
/// (ULINT and LWORD as std::uint64_t), a REAL as a double that a float holds too, an enumeration as
/// the number of its value. An array or structure has those of its parts one behind the other, a
/// text its length and then its characters, eight to a slot.
struct Type {
    enum class Kind : std::uint8_t {
        boolean,
        integer,    ///< SINT to ULINT
        bits,       ///< BYTE to LWORD
        real,       ///< REAL, LREAL
        time,       ///< TIME, LTIME [ns]
        handle,     ///< AXIS_REF: the number of an instance of `standard`, -1 of none
        date,       ///< DATE, LDATE: its midnight [ns since 1970-01-01]
        clock,      ///< TOD, LTOD [ns since midnight]
        moment,     ///< DT, LDT [ns since 1970-01-01]
        interface,  ///< of an INTERFACE, `routine`: the address of an instance, 0 of none
        text,       ///< STRING[length]
        enumeration,
        array,
        structure,
        union_,       ///< its members share bytes, which are packed: types/packed.hpp
        reference,    ///< REFERENCE TO, REF_TO, POINTER TO: `Piece` in code/code.hpp
        block,        ///< an instance of a FUNCTION_BLOCK or PROGRAM of the sources
        standard,     ///< an instance of a kind of the catalogue
        any_integer,  ///< of a number without type, before it is known where it goes
        any_real,
        any_bits,  ///< `16#FF`: a number that is a bit string where one is wanted
    };

    Kind kind = Kind::integer;
    bool is_signed = false;
    bool is_character = false;  ///< of bits: CHAR
    bool is_one_bit = false;    ///< of boolean: BIT, which has a byte together with its neighbours
    int bits = 64;              ///< of integer, bits, real
    std::string name = {};      ///< as messages show it
    std::uint32_t slots = 1;
    std::int64_t lower = 0, upper = -1;  ///< of an array's index; of a subrange's values, as a
                                         ///< slot has them
    bool is_subrange = false;
    bool is_unchecked = false;      ///< a subrange of CODESYS, and its enumeration that is not
                                    ///< strict: of constants alone
    bool has_named_values = false;  ///< `values` names some of a number (6.4.4.3)
    bool is_unnamed = false;        ///< STRUCT without a TYPE: any of its members is equal
    bool counts_ns = false;         ///< LTIME, LDATE, LTOD, LDT: as numbers they are in ns
    const Type* base = nullptr;     ///< of a subrange, named values, numbered enumeration; EXTENDS
    const Type* element = nullptr;  ///< of an array; what a reference is to, or null
    Referring referring = Referring::ref;  ///< of a reference
    bool has_inner = false;                ///< of an array: its element is its next dimension
    std::uint32_t length = 0;              ///< of a text, in characters
    bool is_wide = false;        ///< of a text: its characters are those of types/wide_text.hpp
    bool is_open = false;        ///< VAR_IN_OUT STRING: of what length is given; of a reference:
                                 ///< ARRAY[*], to the first element of what is given
    std::size_t dimensions = 1;  ///< of ARRAY[*]
    std::vector<Variable*> members = {};  ///< of a structure, a union
    std::uint8_t pack = 1;  ///< of these, of a block: bytes that a member is aligned to at most
    std::uint8_t pointer_bytes = 8;            ///< of a reference
    bool has_unknown_base = false;             ///< of a structure: which was told, or is lost
    std::vector<std::string> values = {};      ///< of an enumeration, of named values
    std::vector<std::int64_t> numbers = {};    ///< of its values
    std::vector<double> reals = {};            ///< instead of these, of named values of a REAL
    std::vector<Place> places = {};            ///< where these are declared; of the catalogue none
    bool counted = true;                       ///< those are 0, 1, 2, ...
    bool texts_are_names = false;              ///< TO_STRING gives a value's name, not its number
    bool is_qualified_only = false;            ///< its values are named as `Type.value` alone
    bool is_strict = false;                    ///< no number and no other's value becomes one
    bool has_numbers = false;                  ///< a source declares it: its numbers are known
    std::vector<std::int64_t> of_number = {};  ///< what SCL's numbers mean; -1, or beyond: nothing
    bool all_others_as_last = false;           ///< of them: beyond is as the last one
    bool is_code = false;  ///< of an enumeration: one that the standards make a WORD, as ErrorID
    Routine* routine = nullptr;  ///< of a block, of an interface
    const BlockType* standard = nullptr;
    std::vector<std::pair<std::string_view, Constant>> presets = {};  ///< parameters of `standard`
    Constant initial = {};
    const Expression* initial_value = nullptr;  ///< of a declared type

    bool is_integer() const { return kind == Kind::integer || kind == Kind::any_integer; }
    bool is_bits() const { return kind == Kind::bits || kind == Kind::any_bits; }
    bool is_date() const { return kind >= Kind::date && kind <= Kind::moment; }
    bool is_time() const { return kind == Kind::time || is_date(); }
    bool is_real() const { return kind == Kind::real || kind == Kind::any_real; }
    bool is_number() const { return is_integer() || is_real() || kind == Kind::any_bits; }
    bool is_any() const { return kind >= Kind::any_integer; }
    bool is_scalar() const { return kind < Kind::text || kind == Kind::enumeration || is_any(); }
    /// A reference to a block of the program, or an array of them: passed on by value.
    bool is_handle() const {
        return kind == Kind::handle || (kind == Kind::array && element->is_handle());
    }
    /// References to it are values, `AXIS_REF`.
    bool is_object() const { return kind == Kind::standard && !standard->handle.empty(); }
    bool is_reference() const { return kind == Kind::reference; }
    /// ARRAY[*]: where its first element is.
    bool is_open_array() const { return is_reference() && is_open; }
    bool is_alias() const { return is_reference() && referring == Referring::alias; }
    bool is_pointer() const { return is_reference() && referring == Referring::pointer; }
    bool is_instance() const { return kind == Kind::block || kind == Kind::standard; }
    bool is_unsigned_64() const {
        return (is_bits() || kind == Kind::integer || kind == Kind::time) && !is_signed &&
               bits == 64;
    }
    /// A text's room, and the bytes that its slots have room for.
    TextRoom room() const { return {length, is_wide}; }
    std::uint32_t text_bytes() const { return is_wide ? 3 * length : length; }
    /// Its length, its bytes, and the one that a controller has behind them for a 0.
    std::uint32_t text_slots() const { return 1 + (text_bytes() + 1U + 7U) / 8; }
    std::uint64_t count() const { return static_cast<std::uint64_t>(upper - lower) + 1; }
    /// What an array of all its dimensions has as elements.
    const Type& innermost() const { return has_inner ? element->innermost() : *element; }
    const Type& plain() const { return is_subrange || has_named_values ? *base : *this; }
    /// What a variable of it may have in a run.
    const Type& in_a_run() const { return is_unchecked ? *base : *this; }
    bool has_values() const { return kind == Kind::enumeration || has_named_values; }
    /// The first of an enumeration's values that has the number; null: none has.
    const std::string* name_of(Wide number) const {
        const auto it = std::ranges::find(numbers, number);
        return it == numbers.end() ? nullptr
                                   : &values[static_cast<std::size_t>(it - numbers.begin())];
    }
};

inline bool Expression::is_character() const {
    return kind == Kind::index && operands[0]->type && operands[0]->type->kind == Type::Kind::text;
}

/// What a reference to a part of it is in: a variable, a variable of an instance, what another
/// reference is to, or a call. Elements and members of structures are parts.
const Expression& root_of(const Expression& place);

/// The bytes that a controller's memory has of a value, one variable behind the other: what SIZEOF
/// is, and what a POINTER is reckoned in.
std::uint64_t bytes_of(const Type& type);

/// Bytes of which its place there is a multiple.
std::uint64_t alignment_of(const Type& type);

/// The next multiple.
constexpr std::uint64_t rounded_up(std::uint64_t number, std::uint64_t to) {
    return (number + to - 1) / to * to;
}

/// Where a member of a UNION begins [bits]: at 0, but of a STRUCT OVERLAP as AT says.
std::uint64_t place_in_union(const Variable& member);

/// Where a member of the structure or block begins that is behind so many bits, and the end of it
/// [bits]. What is no BIT begins at a byte.
std::uint64_t begin_behind(std::uint64_t bits, const Type& member, const Type& whole);
std::uint64_t end_behind(std::uint64_t bits, const Type& member, const Type& whole);

/// A block or a structure with a base that was told, or is lost: what it has besides is not known.
bool lacks_base(const Type& type);

/// A function or a method is called in it, which may write variables.
bool has_call(const Expression& expression);

/// Where a variable is.
enum class Space : std::uint8_t {
    frame,      ///< of its routine, or of the block that a method belongs to
    reference,  ///< its slot has the address: VAR_IN_OUT
    global,     ///< of a data block: `global` is its number
    image,      ///< of the process image: `address` says where
    constant,   ///< nowhere: its value is known
    overlay,    ///< of another variable, `seen`, whose bytes it is a view of
};

struct Variable {
    Token name = {};
    const Type* type = nullptr;
    Section section = Section::local;
    bool constant = false;
    Retention retention = Retention::unsaid;
    Space space = Space::frame;
    std::uint32_t slot = 0;  ///< in the frame, the structure or the data block
    std::uint32_t byte = 0;  ///< of a boolean of a kind of the catalogue, in its memory
    bool is_byte = false;
    int global = -1;
    int named = -1;  ///< an AXIS_REF that is to this global, a block of the program, all the time
    ImageAddress address = {};     ///< in the process image, or within its STRUCT OVERLAP
    bool is_direct = false;        ///< no variable: an address that code names
    Section pin = Section::local;  ///< `AT %I*`, `%Q*`: input or output of its block for programs
    Constant value = {};           ///< of a constant scalar
    Variable* seen = nullptr;      ///< of an overlay
    Expression* initial = nullptr;
    std::string unit = {};
    const Pou* of = nullptr;  ///< null: a member of a structure, or of the catalogue
    Access access = Access::unsaid;
    bool used = false;
    bool is_set = false;                 ///< of one in the image: sources write it
    const Variable* bound_of = nullptr;  ///< ARRAY[*] whose lower or upper bound this is
    const std::vector<Argument>* constructed = nullptr;  ///< arguments of FB_init
    Variable* edge = nullptr;    ///< of `x : BOOL R_EDGE`: the R_TRIG whose Q its name means inside
    std::string_view text = {};  ///< its name
    std::string_view doc = {};   ///< comments, as they are written
    /// Type of the POINTER whose place this member of a UNION keeps, as the number that it has.
    const Type* pointer = nullptr;

    /// Whether its value is that of one call only.
    bool ends_with_call() const {
        const bool of_call = of && (of->kind == PouKind::function || of->kind == PouKind::method);
        return space == Space::frame && (section == Section::temp || of_call);
    }

    /// Whether a call may give it, by position or by name.
    bool is_parameter() const {
        return !bound_of && (section == Section::input || section == Section::in_out ||
                             section == Section::output);
    }

    /// By a call, with `=>`: an output, and ENO, which is a temporary.
    bool can_be_taken() const { return section == Section::output || section == Section::temp; }
};

struct Routine;

/// A call that a routine has, or an instance whose body and methods it may call.
struct Called {
    Routine* routine = nullptr;
    Place place = {};
    bool through_reference = false;  ///< of an instance that a reference is to
    bool is_call = false;            ///< not an instance that it has

    /// The callee may have another frame than the one that runs.
    bool may_recur() const;
};

/// What runs: the body of a POU, or a method.
struct Routine {
    const Pou* pou = nullptr;
    std::string name = {};     ///< `Clamp`, `Motor.Start`
    Routine* owner = nullptr;  ///< of a method: its block
    std::deque<Variable> variables = {};
    NameMap<Variable*> names = {};
    std::vector<Routine*> own_methods = {};         ///< of a block, in their order
    NameMap<Routine*> methods = {};                 ///< those of its bases too
    NameMap<Routine*> getters = {}, setters = {};   ///< of PROPERTY
    NameMap<std::vector<Routine*>> overloads = {};  ///< methods that share a name
    Routine* base = nullptr;                        ///< of a block: what it EXTENDS
    std::vector<Routine*> interfaces = {};          ///< IMPLEMENTS; of an interface its bases
    bool has_unknown_base = false;                  ///< which was told, or is lost
    Routine* overrides = nullptr;                   ///< of a method: that of a base
    bool is_replaced = false;                       ///< by what derives from its block
    bool is_declared = false;                       ///< its variables are
    bool is_dispatched = false;                     ///< a call may find it by the instance
    bool dispatches = false;                        ///< calls what is found by an instance
    Variable* result = nullptr;
    Variable* eno = nullptr;         ///< the flag that callers may take, if one does
    Type* type = nullptr;            ///< of its instances, of a block
    Block body = {};                 ///< as checked: what its statements stand for
    Block before = {}, behind = {};  ///< copies that a CONFIGURATION asks for around it
    Block initials = {};  ///< assignments of constants: its variables begin so, whatever they say
    Block begins = {}, call_begins = {};  ///< what comes before it, once and in each call
    Variable* begun = nullptr;            ///< of a block: that the first was done
    std::vector<Called> calls = {};
    std::vector<const Routine*> finds = {};  ///< as its calls name what instances find
    bool is_looped = false;  ///< calls of it through references are found by the instance
    int ring = 0;  ///< of routines that call one another in a ring: the number of that; else 0
    int plain_ring = 0;             ///< and by calls that no instance finds
    bool is_measured = false;       ///< its size is being reckoned
    bool is_met = false;            ///< in its ring is a call that an instance finds
    bool runs_rings = false;        ///< it is in a ring, or calls what may be
    std::vector<int> objects = {};  ///< globals that are blocks of the program, and that it names
    enum class State : std::uint8_t { fresh, visiting, done } state = State::fresh;

    bool lends = false;           ///< something refers to a variable of its calls
    bool holds_instance = false;  ///< of its calls, which is not put aside

    const Variable *mock_flag = nullptr, *mock_value = nullptr;  ///< of a function: MOCK_FUNCTION

    bool is_function() const { return pou->kind == PouKind::function; }
    bool is_test() const { return owner && owner->pou->is_tests; }
    bool is_interface() const { return pou->kind == PouKind::interface; }
    /// It is an interface's: declared, and nothing that runs.
    bool is_prototype() const { return is_interface() || (owner && owner->is_interface()); }
    bool has_instances() const {
        return pou->kind == PouKind::function_block || pou->kind == PouKind::program;
    }

    // What the generator gives it.
    std::uint32_t temps_begin = 0;    ///< first slot of what is initialised at each call
    std::uint32_t variables_end = 0;  ///< behind its own variables
    std::uint32_t frame = 0;          ///< slots with temporaries and what its functions need
    std::uint32_t activation = 0;     ///< slot with the number of a call, of one that `lends`
    std::uint32_t depth = 0;          ///< levels of calls below it
    std::uint32_t levels = 0;         ///< that its instance has room for, of a block
    std::uint32_t first = 0;          ///< of a method: slot of the first that is given to it
    std::uint32_t mark = 0;           ///< slot that says that it runs; 0: it has none
    bool may_dispatch = false;        ///< or what it calls
    bool may_recur = false;           ///< it is in a plain ring, or calls what may be
};

/// A block's variables, those of its bases first.
std::vector<Variable*> all_variables(const Routine& block);
/// How many numbers and texts there are in structures and arrays; else 1.
Wide count_parts(const Type& type);
/// Whether there is a reference to a block of the program in it, such as AXIS_REF.
bool has_handle(const Type& type);

/// Whether it, or one of its bases, has a variable of that name.
bool declares(const Routine& block, std::string_view name);
/// What the arguments are written as: `int,real`. Those of one name differ in it.
std::string signature_of(const Pou& routine);
/// The method of the block that is called as `like`, one of another block, is; null: it has none.
Routine* find_method(const Routine& block, const Routine& like);
/// What of the block stands for a method or a body, which it has or inherits; null: nothing.
const Routine* find_routine(const Routine& block, const Routine& wanted);
/// The block is the other one, or derives from it; the block or interface implements it.
bool is_a(const Routine& block, const Routine& other);

/// `VAR_GLOBAL`, or a DATA_BLOCK: memory that all blocks see.
struct Global {
    std::string name;
    const Type* type = nullptr;  ///< structure, or block
    const Pou* pou = nullptr;
    const Variable* object = nullptr;  ///< a block of the program, which sources name only
    bool is_statics = false;           ///< it has what VAR_STAT declares in functions
};

/// The instance that has a program's process image. No name of a source is like it.
inline constexpr std::string_view image_name = "%";

/// What sources see of the process image: bytes of a global of its own, area by area; of each area
/// size by size, where these are apart.
struct Image {
    static constexpr std::size_t sizes = 5, parts = areas * sizes;  ///< X, B, W, D, L

    int global = -1;  ///< none: no source names an address
    std::vector<Variable*> variables = {};
    bool sizes_are_apart = false;  ///< as the dialect of the first source that names one has it
    AddressCount count = AddressCount::bytes;  ///< as a program's file, and traces, write addresses
    std::vector<ImageAddress> named = {};      ///< by a program's file
    std::uint32_t begins[parts] = {};          ///< [bytes]
    std::uint32_t bytes = 0;

    /// The number of the bit at an address, from that of the first byte on.
    std::uint64_t bit_of(const ImageAddress& at) const {
        return 8 * (std::uint64_t{begins[part_of(at)]} + at.byte) + at.bit;
    }
    std::size_t part_of(const ImageAddress& at) const {
        const std::size_t size = at.bits == 1 ? 0 : std::bit_width(at.bits / 8U);
        return static_cast<std::size_t>(at.area) * sizes + (sizes_are_apart ? size : 0);
    }
};

}  // namespace lineshaft::st
