#pragma once

#include <algorithm>
#include <concepts>
#include <map>
#include <optional>
#include <string>
#include <unordered_set>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/st/check/check.hpp"
#include "runtime/st/check/uses.hpp"
#include "runtime/st/types/elementary.hpp"

namespace lineshaft::st {

using Kind = Type::Kind;
using E = Expression::Kind;
using S = Statement::Kind;

struct NamedType {
    const TypeDeclaration* declaration = nullptr;
    const Type* type = nullptr;  ///< null until it is asked for, or if it is wrong
    bool visiting = false;       ///< being resolved: who asks now is part of it
};

/// A value of an enumeration.
struct NamedValue {
    const Type* type = nullptr;
    std::size_t index = 0;
    bool ambiguous = false;
};

/// What is declared beside the blocks.
struct Names {
    NameMap<NamedType> types;
    NameMap<NamedValue> values;
    NameMap<Routine*> routines;
    NameMap<std::vector<Routine*>> overloads;  ///< functions that share a name
    NameMap<Place> places;                     ///< of all of them
};

/// `g` of `.g`, which CODESYS writes of what is global.
inline std::string_view without_point(std::string_view name) {
    return name.starts_with('.') ? name.substr(1) : name;
}

inline bool is_prelude(const Token& name) {
    return name.place.source && name.place.source->is_prelude();
}

inline bool is_library(const Token& name) {
    return name.place.source && name.place.source->is_library();
}

/// Siemens' structure of a date and a time.
inline bool is_dtl(const Type& type) {
    return type.kind == Kind::structure && type.name == "DTL" &&
           std::ranges::any_of(type.members, is_prelude, &Variable::name);
}

/// What may be left out before names that stand in a scope.
struct Prefixes {
    const Scope* scope = nullptr;
    std::vector<std::string_view> paths = {};  ///< of namespaces, from the innermost on
    bool is_whole = true;                      ///< false: a USING is unknown
};

/// What is told to be wrong gives: no type, variable or node, and false.
struct Nothing {
    template <class T>
    operator T*() const {
        return nullptr;
    }
    template <std::same_as<bool> T>
    operator T() const {
        return false;
    }
};

/// What check() knows while it works. The work is done by functions that take it first, in a file
/// for each subject (README.md); what is here they all share. Put logic there, not here.
///
/// Whatever is wrong is told once, by `fail`, and noted where it was found: an expression without a
/// type, a variable or a named type without one. Who meets such a thing says nothing more.
struct Checking {
    Tree& tree;
    const Catalog& catalog;
    Evaluate evaluate;
    Diagnostics& out;
    Checked checked = {};

    std::vector<NameUse>* uses = nullptr;  ///< null: nobody asks
    Names users = {}, prelude = {};
    NameMap<bool> namespaces = {};  ///< `a`, `a.b`; false: there is none of that name, told once
    std::unordered_map<const Source*, std::vector<Prefixes>> prefixes =
        {};                                  ///< as the tree's scopes
    std::vector<Token> unknown_usings = {};  ///< namespaces that are not there
    std::vector<std::string_view> open_libraries =
        {};  ///< whose names are seen behind all others without theirs
    NameMap<Variable*> globals = {};
    /// What a name that nobody declares may be meant for: in all blocks, and in one.
    struct KnownNames {
        std::size_t count = 0;  ///< of those in all
        const Routine* routine = nullptr;
        std::vector<std::string> everywhere = {}, here = {};  ///< sorted
    } known_names = {};
    /// One of VAR_GLOBAL CONSTANT, and where it stands.
    struct GlobalConstant {
        const DeclarationBlock* block;
        const Declaration* declared;
    };
    /// Variables of B&R whose names differ from another's beside them in capitals alone, by whose
    /// they are and their names.
    std::map<std::pair<const Pou*, std::string_view>, Variable*> by_capitals = {};
    /// Names of global variables that stand in several lists, the first two of them.
    NameMap<std::pair<Token, Token>> in_several_lists = {};
    /// First bytes of CODESYS' addresses of a hierarchy that are beyond their area: `Q9.24.0`.
    std::map<std::string, std::uint32_t> points = {};
    /// `VAR_GLOBAL Axis_1 : AXIS_REF`, and which global it is.
    struct ListedAxis {
        std::string_view list, name;
        int global = -1;
    };
    NameMap<ListedAxis> listed_axes = {};                       ///< the first of each name
    std::unordered_map<int, Variable*> places_of_objects = {};  ///< by the number of the global
    NameMap<GlobalConstant> constants = {};  ///< by name; of a block as `Block.constant`
    std::deque<DeclarationBlock> constants_of_blocks = {};  ///< as lists of globals of their names
    std::unordered_set<const Declaration*> begun_constants = {};  ///< declared, or being so
    std::vector<std::pair<Type*, const TypeText*>> targets =
        {};  ///< of references, until all types are known
    bool knows_types = false;
    int hops = 0;  ///< from constant to constant that is declared later
    std::optional<NameMap<bool>> given_axes = {};  ///< names given to pins of axes, once asked for
    std::vector<Routine*> updates = {};  ///< of what the routine at hand names of libraries
    std::unordered_set<const Pou*> assigned_inputs = {};  ///< blocks that were warned of it
    NameMap<const Type*> catalog_types = {};
    std::map<Vendor, NameMap<const Type*>> types_of_vendors = {};  ///< that begin otherwise there
    bool has_tests = false;
    std::optional<NameMap<const Pou*>> blocks_by_name =
        {};  ///< of the sources, once asked for; without their namespaces
    std::unordered_map<const Pou*, std::unordered_set<const Pou*>> parts_of_blocks =
        {};  ///< that were asked for
    /// What __NEW makes of a type: its elements, one more of which stays as it begins, and how they
    /// are taken (blocks/libraries/__SYSTEM/memory.st).
    struct Pool {
        const Type* type = nullptr;
        Variable *elements = nullptr, *taken = nullptr;
    };
    std::deque<Pool> pools = {};
    /// `__DELETE(p);`, which is written when all pools are known.
    struct Deletion {
        Routine* routine = nullptr;
        Statement* statement = nullptr;
        Expression* pointer = nullptr;
    };
    std::vector<Deletion> deletions = {};
    std::vector<const Expression*> serializations = {};  ///< calls with a VARIANT
    std::vector<const Type*> types_of_variants = {};     ///< that TypeOf asks for, by number
    Type* statics = nullptr;                             ///< of the global that keep_once() fills
    Routine* begin_of_globals = nullptr;  ///< runs before all others; null: nothing is to be done

    Routine* routine = nullptr;  ///< that is being checked
    /// The variable whose initial value is being checked, and the way to the part at hand.
    struct Beginning {
        Variable* variable = nullptr;
        const Variable* member = nullptr;  ///< or a member of a declared type
        std::vector<std::pair<std::string_view, std::int64_t>> path = {};  ///< members, or indices
        bool is_constructed = false;  ///< FB_init comes before, so that constants are assigned, too
        bool is_made = false;         ///< something of it is assigned
    } beginning = {};
    std::unordered_set<const Statement*> beginnings = {};  ///< whose targets others may not assign
    std::unordered_set<const Statement*> renewals = {};    ///< by which an instance begins anew
    std::unordered_map<const Type*, bool> types_with_commands = {};  ///< structures and blocks
    /// Whose constants a member of a structure that a routine writes out may begin with.
    std::unordered_map<const Variable*, Routine*> routines_of_members = {};
    /// What members begin with that is no constant: each variable of their type assigns it.
    std::unordered_map<const Variable*, Expression*> begins_of_members = {};
    /// Members that begin with others of their structure, and those before them.
    std::unordered_map<const Variable*, std::span<Variable* const>> members_before = {};
    int loops = 0;                     ///< around the statement
    bool is_before_finally = false;    ///< the statement stands in a __TRY that has a __FINALLY
    std::vector<NameSet> labels = {};  ///< of each list of statements around it
    std::unordered_map<const Routine*, NameSet> undeclared = {};  ///< names that were told
    std::span<const LibraryReference> missing_libraries = {};     ///< that a project refers to
    NameMap<Place> foreign = {};  ///< names that may be of a library that is not here

    /// An error.
    Nothing fail(const char* code, Place place, std::string message, std::string help = {});
    void warn(const char* code, Place place, std::string message, std::string help);

    /// What a name means, for who asks.
    void note(Place at, const Variable& variable);
    void note(Place at, const Routine& called);
    void note(Place at, const Type& type, Place declared = {});
    void note(Place at, const NamedType& named);
    void note_value(Place at, const Type& enumeration, std::size_t value);

    /// What a name is. The prelude and libraries see nothing of the user's; what they declare he
    /// sees where he has no such name. All are global, so a point in front says nothing more.
    template <class T>
    auto look_up(NameMap<T> Names::*map, Token name) {
        name.text = without_point(name.text);
        if (!is_prelude(name))
            if (auto* found = find_inside_out(users.*map, name)) return found;
        return find_in(prelude.*map, name.text);
    }
    /// In the namespaces around the name, in those that are used there, beside all, then in
    /// libraries.
    template <class T>
    auto find_inside_out(NameMap<T>& map, const Token& name) {
        if (is_users_name(name))
            if (auto* found = find_in(map, name.text)) return found;
        if (const Prefixes* here = prefixes_at(name.place))
            for (const std::string_view path : here->paths)
                if (auto* found = find_in(map, fmt::format("{}.{}", path, name.text))) return found;
        if (!is_library(name) || name.text.find('.') != name.text.npos)
            if (auto* found = find_in(map, name.text)) return found;
        return find_in_libraries(map, name.text);
    }
    template <class T>
    auto find_in_libraries(NameMap<T>& map, std::string_view name) {
        decltype(find_in(map, name)) found = nullptr;
        for (const std::string_view library : open_libraries)
            if (!found) found = find_in(map, fmt::format("{}.{}", library, name));
        return found;
    }
    /// Null: there is no namespace, and none is used.
    const Prefixes* prefixes_at(Place place) const;
    Routine* find_routine(const Token& name);
    Names& names_beside(const Token& name) { return is_prelude(name) ? prelude : users; }

    /// What nobody has may be of a library that is not here: all such names are told at once.
    bool may_be_foreign(const Token& name);

    /// A type, block or function of the user's that was not understood.
    bool is_lost(const Token& name) const;
    bool is_in_test() const { return routine && routine->is_test(); }

    Type& make_type(Kind kind, std::string name);
    /// A variable that no source declares, of a routine, or of what is beside them; `at` is where
    /// messages say it is.
    Variable& make_variable(Routine& routine, const Token& at, std::string_view text,
                            const Type* type);
    Variable& make_variable(const Token& at, std::string_view text, const Type* type);
    Routine& make_routine(Pou& pou, std::string name);
};

}  // namespace lineshaft::st
