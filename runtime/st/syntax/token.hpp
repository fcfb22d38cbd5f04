#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "runtime/source/diagnostic.hpp"
#include "runtime/st/syntax/dialect.hpp"

namespace lineshaft::st {

enum class SourceKind : std::uint8_t {
    program,  ///< a user's
    tests,    ///< a user's, with TEST, SETUP and TEARDOWN beside blocks
    prelude,  ///< the standard's, which comes with lineshaft
    library,  ///< a vendor's, which comes with lineshaft
};

/// The dialect of a source. What a user says of it counts, whatever its text looks like.
const Dialect& dialect_of(const SourceFile& file, SourceKind kind);

/// A text that is compiled, and what was decided about it once, when it was read.
struct Source {
    std::shared_ptr<const SourceFile> file;
    const Dialect& dialect;
    SourceKind kind = SourceKind::program;

    std::string_view text() const { return file->text; }
    bool is_prelude() const { return kind == SourceKind::prelude; }
    bool is_library() const { return kind == SourceKind::library; }
    bool is_users() const { return !is_prelude() && !is_library(); }
    bool has_no_bodies() const { return st::has_no_bodies(file->path); }
};

/// Part of a source: bytes [begin, end) of its text.
struct Place {
    const Source* source = nullptr;
    std::uint32_t begin = 0, end = 0;

    std::string_view text() const { return source->text().substr(begin, end - begin); }
    const Dialect& dialect() const { return source->dialect; }
    Place to(Place last) const { return {source, begin, last.end}; }
    Mark mark() const;
};

/// Names are found without regard to case (ASCII).
struct SameName {
    using is_transparent = void;
    bool operator()(std::string_view a, std::string_view b) const;
};
struct NameHash {
    using is_transparent = void;
    std::size_t operator()(std::string_view name) const;
};
template <class T>
using NameMap = std::unordered_map<std::string_view, T, NameHash, SameName>;
using NameSet = std::unordered_set<std::string_view, NameHash, SameName>;

inline bool same_name(std::string_view a, std::string_view b) {
    return SameName{}(a, b);
}

// Every word and sign of the language, as it is shown in messages; CODESYS writes `__` before its
// own.
#define LINESHAFT_ST_WORDS(WORD, CODESYS)                                                                     \
    CODESYS(catch) CODESYS(endtry) CODESYS(finally) CODESYS(try)                                              \
    WORD(abstract) WORD(action) WORD(and) WORD(and_then) WORD(array) WORD(at) WORD(begin) WORD(by) WORD(case) \
    WORD(class) WORD(configuration) WORD(constant) WORD(continue) WORD(data_block) WORD(do)        \
    WORD(else) WORD(elsif) WORD(end_action) WORD(end_case) WORD(end_class) WORD(end_data_block)    \
    WORD(end_for) WORD(end_function) WORD(end_function_block) WORD(end_get) WORD(end_if)           \
    WORD(end_interface)                                                                            \
    WORD(end_method) WORD(end_namespace) WORD(end_network) WORD(end_organization_block)            \
    WORD(end_program) WORD(end_property) WORD(end_region) WORD(end_repeat) WORD(end_set) WORD(end_setup)         \
    WORD(end_struct) WORD(end_teardown) WORD(end_test) WORD(end_type) WORD(end_union)              \
    WORD(end_var) WORD(end_while) WORD(exit) WORD(extends) WORD(final) WORD(for) WORD(function)    \
    WORD(function_block) WORD(goto) WORD(if) WORD(implements) WORD(interface) WORD(internal)       \
    WORD(method) WORD(mod) WORD(namespace) WORD(network) WORD(non_retain) WORD(not) WORD(of)       \
    WORD(or) WORD(or_else) WORD(organization_block) WORD(override) WORD(pointer) WORD(private)     \
    WORD(program) WORD(property) WORD(protected) WORD(public) WORD(ref_to) WORD(region)            \
    WORD(repeat) WORD(retain) WORD(return) WORD(setup) WORD(struct) WORD(super) WORD(teardown)     \
    WORD(test) WORD(then) WORD(to) WORD(type) WORD(union) WORD(until) WORD(using) WORD(var)        \
    WORD(var_access) WORD(var_external) WORD(var_global) WORD(var_in_out) WORD(var_input)          \
    WORD(var_output) WORD(var_stat) WORD(var_temp) WORD(version) WORD(while) WORD(xor)

enum class Word : std::uint8_t {
#define WORD(name) name##_,
    LINESHAFT_ST_WORDS(WORD, WORD)
#undef WORD
    // What follows is no reserved word.
    end_of_file,
    name,      ///< `speed`, `#speed`, `"speed"`
    prefix,    ///< `INT#`, `Colour#`: what stands before a typed literal, without the `#`
    integer,   ///< `1_000`, `16#FF`
    real,      ///< `1.5`, `1e3`
    duration,  ///< what follows `T#`, `LTIME#`, `DT#`: `1h2m3.5s`, `2020-02-29-12:30:15`
    text,      ///< `'...'`, with its quotes
    direct,    ///< `%IX0.0`, `%I*`, and the `%X3` of a partial access
    assign,    ///< `:=`
    plus_assign,
    minus_assign,
    times_assign,
    divided_assign,
    set_assign,        ///< `S=`
    reset_assign,      ///< `R=`
    output,            ///< `=>`
    reference_assign,  ///< `REF=`
    attempt_assign,    ///< `?=`
    power,
    times,
    divided,
    plus,
    minus,
    less,
    less_or_equal,
    greater,
    greater_or_equal,
    equal,
    unequal,
    ampersand,
    caret,
    open,
    close,
    open_bracket,
    close_bracket,
    dot,
    range,  ///< `..`
    comma,
    semicolon,
    colon,
};

/// As messages show it: `END_IF`, `:=`, `a name`.
std::string_view shown(Word word);

/// The word of the language that is written so, whatever its capitals.
std::optional<Word> word_of(std::string_view text);

struct Sign {
    std::string_view text;
    Word word;
};

/// The longer ones first.
std::span<const Sign> signs();

struct Token {
    Word word = Word::end_of_file;
    bool quoted = false;  ///< `"Block"`, whose text has no quotes
    bool local = false;   ///< `#speed`, whose text has no `#`
    bool first_in_line = false;
    Place place = {};            ///< with quotes and `#`
    std::string_view text = {};  ///< of a name, a number, a text without its quotes
};

/// `ABS` of SCL is the instruction, `"ABS"` a block of the user's.
inline bool is_instruction_name(const Token& name) {
    return name.place.source && name.place.dialect().has_s7_instructions && !name.quoted &&
           !name.local;
}
inline bool is_users_name(const Token& name) {
    return name.place.source && name.place.dialect().has_s7_instructions && name.quoted;
}

/// Whether a name, or that of a token, is this one: `std::ranges::any_of(words, is_called(name))`.
inline auto is_called(std::string_view name) {
    struct IsCalled {
        std::string_view name;
        bool operator()(std::string_view other) const { return same_name(other, name); }
        bool operator()(const Token& other) const { return same_name(other.text, name); }
    };
    return IsCalled{name};
}

/// The first whose name it is; null: none.
template <class All, class Name = std::identity>
auto* find_called(All&& all, std::string_view name, Name name_of = {}) {
    const auto it = std::ranges::find_if(all, is_called(name), name_of);
    return it == std::ranges::end(all) ? nullptr : &*it;
}

/// What a map has for the name: a pointer, else where the value is; null: nothing.
template <class Map>
auto find_in(Map& map, std::string_view name) {
    const auto it = map.find(name);
    if constexpr (std::is_pointer_v<typename Map::mapped_type>)
        return it == map.end() ? nullptr : it->second;
    else
        return it == map.end() ? nullptr : &it->second;
}

}  // namespace lineshaft::st
