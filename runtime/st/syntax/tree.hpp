#pragma once

#include <deque>
#include <memory_resource>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/model/address.hpp"
#include "runtime/st/syntax/constant.hpp"
#include "runtime/st/syntax/lexer.hpp"
#include "runtime/st/syntax/testing.hpp"
#include "runtime/st/syntax/token.hpp"

/// What the parser makes of a source, and what the checker notes in it.
namespace lineshaft {
struct BlockType;
}

namespace lineshaft::st {

struct Type;
struct Variable;
struct Routine;
struct StandardFunction;
struct Expression;

/// `a := 1`, `q => x`, or a value by position: of a call, an index, an initial value.
struct Argument {
    Token name = {};         ///< `end_of_file` by position
    bool is_output = false;  ///< `=>`, or meant so, which the checker finds
    Expression* value = nullptr;
    Variable* variable = nullptr;  ///< that it goes to or comes from, noted by the checker
    bool is_left_out = false;      ///< in a test: taken only if nothing was given before
    bool is_negated = false;       ///< `NOT q => x`
    Variable* made = nullptr;      ///< that has `value` in the call, of VAR_IN_OUT CONSTANT

    bool is_named() const { return name.word != Word::end_of_file; }
};

/// How a conversion differs from what its types say.
struct Conversion {
    bool truncates = false;    ///< a real number towards zero, else to the nearest
    bool rounds_away = false;  ///< a real number halfway from 0, else to the even one
    bool has_sign = false;     ///< into a text: `+5`, as SCL writes it
    bool is_attempt = false;   ///< of `?=`: none, if what is there is not of the type
    bool is_written = false;   ///< by the user, who says what is kept
    bool is_bcd = false;       ///< the bit string of both has a decimal digit in each four bits
};

/// Bits of a whole number or a bit string, from the lowest on.
struct BitRange {
    std::uint8_t first = 0, count = 0;
};

struct Expression {
    enum class Kind : std::uint8_t {
        constant,  ///< a literal, or what the checker has folded to one
        name,
        member,  ///< operands[0] . name
        index,   ///< operands[0] [arguments]
        bit,     ///< operands[0] . %X3, .%B1, .3
        call,    ///< operands[0] (arguments); of an ACTION's call operands[1] runs for the body
        unary,
        binary,
        typed,      ///< `INT#5`, `Colour#red`: token.text # operands[0]
        list,       ///< `[1, 4(0.0)]`: of arguments, or `(x := 1, y := 2)`, `(1, 2)`
        repeated,   ///< `4(0.0)`: operands[0] times what is in `arguments`
        deref,      ///< operands[0]^; of REFERENCE TO put in by the checker
        refer,      ///< where operands[0] is, put in by the checker
        converted,  ///< operands[0] to `type`, put in by the checker
        self,       ///< THIS; by its base's type SUPER; put in by the checker
    };

    Kind kind = Kind::constant;
    Word op = Word::end_of_file;  ///< of unary and binary
    std::uint16_t depth = 1;      ///< of the tree
    Token token = {};             ///< name, literal or operator
    Place place = {};
    Expression* operands[2] = {};
    std::vector<Argument> arguments = {};
    struct TypeText* of = nullptr;  ///< of a call that takes a type first, as `__NEW(Type, count)`

    // Noted by the checker.
    const Type* type = nullptr;    ///< null: wrong, already reported
    Constant constant = {};        ///< of a constant
    Conversion conversion = {};    ///< of what is converted
    BitRange bits = {};            ///< of `bit`
    Variable* variable = nullptr;  ///< that a name or a member means
    Routine* routine = nullptr;    ///< that a name means, or a call calls
    bool is_dispatched = false;    ///< a call: the instance says which routine
    bool has_else = false;         ///< a call of MUX: the last input is taken for a number of none
    const StandardFunction* standard = nullptr;  ///< that a call calls
    const BlockType* called_as = nullptr;  ///< a call: of an IEC_TIMER, which is any of the timers
    Expression* initial = nullptr;         ///< what it is to all of `a, b : INT := 2 + 3`

    TestCall test = TestCall::none;  ///< the statement of tests that a call is

    /// `s[3]` of a text, which is no place of its own.
    bool is_character() const;

    /// Whether a list is `(x := 1, y := 2)`, `(1, 2)` or `()`.
    bool is_structure() const {
        return token.word == Word::open || (!arguments.empty() && arguments.front().is_named());
    }

    /// Whether a list has lists of elements again, `[[1, 2], 2([3, 4])]`, not structures,
    /// `[(x := 1)]`.
    bool is_nested() const {
        for (const Argument& argument : arguments) {
            const Expression& e = *argument.value;
            if (e.kind == Kind::list && !e.is_structure()) return true;
            if (e.kind == Kind::repeated && e.is_nested()) return true;
        }
        return false;
    }
};

struct Statement;
using Block = std::vector<Statement*>;

/// The condition of an IF, or the values of a CASE, and what is then done.
struct Branch {
    using Label = std::pair<Expression*, Expression*>;  ///< from, to; to may be null

    Expression* condition = nullptr;
    std::vector<Label> labels = {};
    Block body = {};
};

struct Statement {
    enum class Kind : std::uint8_t {
        assign,
        call,
        if_,
        case_,
        for_,
        while_,
        repeat,
        exit,
        continue_,
        return_,
        try_,      ///< `__TRY` of CODESYS
        label,     ///< `name:`, its name in `value`
        goto_,     ///< the label's name in `value`
        action,    ///< `a;`, which only an action can mean: its name in `value`
        sequence,  ///< several one behind the other, put in by the checker for one
    };

    Kind kind = Kind::assign;
    Word op = Word::assign;  ///< `:=`, `+=`, `REF=`
    Place place = {};
    Expression* target =
        nullptr;  ///< of an assignment; of a FOR its variable; what __CATCH fills in
    Expression* value = nullptr;  ///< assigned, called, tested; of a FOR its first one
    Expression *limit = nullptr, *step = nullptr;  ///< of a FOR
    std::vector<Branch> branches = {};  ///< of IF and CASE; of __TRY its __CATCH and its __FINALLY
    Block body = {};  ///< of a loop, a sequence, a __TRY; of IF and CASE what ELSE does
};

// A sequential function chart as it is written: IEC 61131-3:2013, 6.7.

/// `pump(L, T#5s);` of a step.
struct ChartAssociation {
    Token action = {};           ///< an ACTION, or a BOOL
    Token qualifier = {};        ///< `end_of_file`: none, which is N
    Expression* time = nullptr;  ///< of L, D, SD, DS and SL
};

struct ChartStep {
    Token name = {};
    bool is_initial = false;
    std::vector<ChartAssociation> associations = {};
};

/// The steps of `from` are left, and those of `to` entered, once all of `from` are active and the
/// condition holds. Of several out of one step the first that may go does.
struct ChartTransition {
    Place place = {};
    std::vector<Token> from = {}, to = {};
    Expression* condition = nullptr;
    Token priority = {};  ///< `end_of_file`: none, behind those that have one
};

struct Chart {
    std::vector<ChartStep> steps = {};
    std::vector<ChartTransition> transitions = {};
};

/// A type as it is written.
struct TypeText {
    enum class Kind : std::uint8_t {
        name,
        array,
        structure,
        union_,
        enumeration,
        subrange,
        text,
        reference,  ///< to `element`; `name` is its first word
    };

    Kind kind = Kind::name;
    Token name = {};  ///< also of the base of an enumeration or a subrange
    Place place = {};
    std::vector<std::pair<Expression*, Expression*>> ranges = {};  ///< of array and subrange
    Expression* length = nullptr;                                  ///< STRING[length]
    TypeText* element = nullptr;
    Token base = {};                  ///< of a structure that extends another
    std::string_view pack_mode = {};  ///< of a structure: `{attribute 'pack_mode' := '1'}`
    std::vector<struct Declaration*> members = {};
    std::vector<Argument> values = {};  ///< of an enumeration, with their numbers if given
    bool is_qualified_only = false;     ///< its values are named as `Type.value` alone
    bool overlaps = false;              ///< STRUCT OVERLAP: members may share bytes
    bool is_strict = false;             ///< `{attribute 'strict'}`: it takes its own values alone
};

/// Whether a variable outlives the run. Unsaid: as the instance that it is in.
enum class Retention : std::uint8_t { unsaid, retain, non_retain };

/// `a, b : INT := 5;` has one for each name.
struct Declaration {
    Token name = {};
    TypeText* type = nullptr;  ///< null: of CONST, whose value has one
    Expression* initial = nullptr;
    Token at = {};    ///< `%QW4`, or another variable, behind AT; else `end_of_file`
    Token edge = {};  ///< R_EDGE or F_EDGE behind the type; else `end_of_file`
    std::string_view unit = {};
    Place unit_place = {};
    std::string_view doc = {};  ///< the comments behind it
    bool is_path = false;       ///< `{attribute 'instance-path'}`: a text that names its instance
    Retention retention = Retention::unsaid;
};

enum class Section : std::uint8_t {
    input,
    output,
    in_out,
    local,
    temp,
    global,
    external,
    result,
    kept,     ///< VAR_INST of a method: stays in its instance
    static_,  ///< VAR_STAT: there is one of it, however many instances or calls
};

/// Who may name a variable or a method of a block.
enum class Access : std::uint8_t { unsaid, public_, protected_, internal_, private_ };

struct DeclarationBlock {
    Section section = Section::local;
    bool constant = false;
    Retention retention = Retention::unsaid;
    Access access = Access::unsaid;
    bool is_lost = false;            ///< not understood
    std::string_view list = {};      ///< of VAR_GLOBAL: its file's name, without the ending, or
                                     ///< the library's
    bool is_qualified_only = false;  ///< named as `list.x` alone
    std::vector<Declaration*> declarations = {};
};

enum class PouKind : std::uint8_t {
    program,
    function_block,  ///< also a CLASS
    function,
    method,
    data_block,
    interface,
};

/// What of a PROPERTY a method is.
enum class Accessor : std::uint8_t { none, get, set };

/// `{attribute 'no_assign'}` of a FUNCTION_BLOCK: whether an instance is assigned to another one.
enum class Copying : std::uint8_t { allowed, warned, refused };

/// A program organization unit.
struct Pou {
    PouKind kind = PouKind::program;
    Token name = {};
    Place place = {};            ///< its first line
    TypeText* result = nullptr;  ///< null: none
    TypeText* base = nullptr;    ///< of a data block that is an instance, or a structure
    std::string_view doc = {};   ///< the comments before it, else below its first line
    Access access = Access::unsaid;
    bool is_class = false, is_abstract = false, is_final = false, is_override = false;
    bool is_generic = false;              ///< VAR_GENERIC is the first of `blocks`
    Accessor accessor = Accessor::none;   ///< of a method
    bool is_monitored = false;            ///< `{attribute 'monitoring' := 'call'}` of a PROPERTY
    std::vector<Token> bases = {};        ///< behind EXTENDS
    std::vector<Token> implemented = {};  ///< behind IMPLEMENTS
    Copying copying = Copying::allowed;
    bool follows_init = false;   ///< a method that is called once behind FB_init
    bool is_action = false;      ///< of a method, and of a function that is one beside all blocks
    bool is_lost = false;        ///< not understood
    bool is_configured = false;  ///< made of a PROGRAM for one that a CONFIGURATION has of it
    bool is_tests = false;  ///< a file of tests: SETUP, TEARDOWN and each TEST is a method of it
    Retention retention = Retention::unsaid;  ///< of a data block: of what its sections leave open
    std::string_view number = {};  ///< of a data block: what `{S7_BlockNumber := "5"}` says
    std::vector<DeclarationBlock> blocks = {};
    Block body = {};
    Chart* chart = nullptr;  ///< instead of a body
    std::vector<Pou*> methods = {};
};

struct TypeDeclaration {
    Token name = {};
    TypeText* type = nullptr;
    Expression* initial = nullptr;
    bool is_lost = false;          ///< not understood
    bool texts_are_names = false;  ///< `{attribute 'to_string'}`
};

/// Part of a source where names may be written without the namespace that they are in: a namespace,
/// or what a USING is for.
struct Scope {
    const Scope* outer = nullptr;
    std::uint32_t begin = 0, end = 0;  ///< bytes of the source
    std::string_view path = {};        ///< of the namespace, with those around it: `a.b`
    std::vector<Token> usings = {};    ///< namespaces, `a.b`
};

/// `gain := g` or `cnt => total` of a program in a CONFIGURATION: `own` is the program's.
struct Connection {
    Expression *own = nullptr, *other = nullptr;
    bool is_output = false;
};

/// `PROGRAM P1 WITH Fast : Main(gain := g);`
struct ProgramInstance {
    std::string_view path = {};        ///< `R1.P1`, or without a RESOURCE `Cell.P1`
    std::string_view whole_path = {};  ///< with the CONFIGURATION before it
    Token name = {}, type = {};
    std::vector<Connection> connections = {};
};

/// `R1.P1.lamp AT %QX0.3 : BOOL := TRUE;` of VAR_CONFIG.
struct ConfiguredVariable {
    Expression* path = nullptr;
    std::string_view resource = {};  ///< that it stands in
    Token at = {};                   ///< `end_of_file`: none
    TypeText* type = nullptr;        ///< null: none is said
    Expression* initial = nullptr;
};

/// A block with VAR_GENERIC, to be read again for each list of values.
struct GenericBlock {
    const Pou* pou = nullptr;
    Tokens tokens = {};  ///< its own, and the end
    Scope* scope = nullptr;
};

/// `Stack<10>` somewhere.
struct GenericUse {
    std::string_view block = {};  ///< `Stack`
    std::string written = {};     ///< `<10>`, without blanks
    std::vector<Expression*> values = {};
};

/// Owns all nodes, so that they need no owners among themselves.
struct Tree {
    std::vector<std::shared_ptr<const Source>> sources;  ///< that all places refer to
    std::pmr::monotonic_buffer_resource memory;          ///< of the nodes: a deque asks for each
    std::pmr::deque<Expression> expressions{&memory};
    std::pmr::deque<Statement> statements{&memory};
    std::pmr::deque<TypeText> type_texts{&memory};
    std::pmr::deque<Declaration> declarations{&memory};
    std::pmr::deque<Pou> pous{&memory};
    std::deque<Chart> charts;

    std::unordered_map<const Source*, std::deque<Scope>>
        scopes;                     ///< those within others behind them
    std::deque<std::string> names;  ///< that no source has as they are

    std::vector<std::string> addresses;  ///< that the program's file names beside the sources'

    std::vector<TypeDeclaration> types;  ///< in the order of the sources, as all lists
    std::vector<Pou*> units;             ///< all but methods
    std::vector<DeclarationBlock> globals;
    std::vector<ProgramInstance> instances;
    std::vector<ConfiguredVariable> configured;
    std::deque<GenericBlock> generics;
    std::vector<GenericUse> generic_uses;
    NameMap<bool> lost;  ///< what stands in those not understood; true: their names

    void leave_lost_out() {
        for (const TypeDeclaration& type : types)
            if (type.is_lost) lost[type.name.text] = true;
        for (const Pou* unit : units)
            if (unit->is_lost) lost[unit->name.text] = true;
        std::erase_if(types, [](const auto& type) { return type.is_lost; });
        std::erase_if(units, [](const auto* unit) { return unit->is_lost; });
        std::erase_if(globals, [](const auto& block) { return block.is_lost; });
    }
};

}  // namespace lineshaft::st
