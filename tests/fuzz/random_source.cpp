#include "tests/fuzz/random_source.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "runtime/model/catalog.hpp"

namespace lineshaft::test {

namespace {

enum class Kind {
    boolean,
    integer,
    bits,
    real,
    time,
    date,
    clock,
    moment,
    character,
    text,
    enumeration,
    array,
    structure,
    block,
    interface
};

struct Type {
    struct Part {
        std::string name;
        const Type* type = nullptr;
        bool writable = true;
    };

    Kind kind = Kind::boolean;
    std::string name = {};
    int bits = 64;
    bool is_signed = false;
    const Type* base = nullptr;          ///< of a subrange
    std::int64_t lower = 0, upper = -1;  ///< of a subrange; of a text `upper` is its length
    std::vector<std::pair<std::int64_t, std::int64_t>> ranges = {};  ///< of an array
    const Type* element = nullptr;
    std::vector<Part> parts = {};
    std::vector<std::string> values = {};  ///< of an enumeration
    bool counted = true;
    bool is_union = false;                ///< of a structure
    std::vector<const Type*> bases = {};  ///< of a block or an interface: all that it is as well
    bool is_abstract = false;
};

struct Variable {
    std::string name;
    const Type* type = nullptr;
    bool writable = true, global = false, constant = false;
    bool has_place = true;  ///< goes to VAR_IN_OUT, may be referred to
};

enum class Section { input, in_out, output };

struct Parameter {
    std::string name;
    const Type* type = nullptr;
    Section section = Section::input;
};

/// A function, a method, or what the call of an instance runs.
struct Callable {
    std::string name;
    const Type* result = nullptr;  ///< null: none
    const Type* of = nullptr;      ///< the block of a method or of an instance
    bool is_method = false;
    bool pure = true;  ///< changes nothing but its result
    std::vector<Parameter> parameters = {};
    bool is_abstract = false;
};

struct Parameters {
    std::vector<Variable> inputs, in_outs, outputs;
};

struct Method {
    Callable call;
    Parameters given;
};

/// A block that others derive from, or an interface.
struct Class {
    const Type* type = nullptr;
    Callable call = {};
    std::vector<Variable> given = {}, in_outs = {}, locals = {};  ///< those of its bases too
    std::vector<Method> methods = {};                             ///< likewise
};

/// What it uses of a variable.
enum class Use { read, write, place };

enum Strength { or_, xor_, and_, equal, compare, add, multiply, power, unary, atom };

struct Text {
    std::string text;
    int strength = atom;
};

Type elementary(Kind kind, std::string name, int bits, bool is_signed = false) {
    Type type;
    type.kind = kind;
    type.name = std::move(name);
    type.bits = bits;
    type.is_signed = is_signed;
    return type;
}

const std::vector<Type>& elementaries() {
    static const std::vector<Type> types = {
        elementary(Kind::integer, "INT", 16, true), elementary(Kind::boolean, "BOOL", 1),
        elementary(Kind::real, "LREAL", 64),        elementary(Kind::integer, "DINT", 32, true),
        elementary(Kind::real, "REAL", 32),         elementary(Kind::bits, "WORD", 16),
        elementary(Kind::time, "TIME", 64, true),   elementary(Kind::integer, "UDINT", 32),
        elementary(Kind::integer, "SINT", 8, true), elementary(Kind::integer, "LINT", 64, true),
        elementary(Kind::integer, "USINT", 8),      elementary(Kind::integer, "UINT", 16),
        elementary(Kind::integer, "ULINT", 64),     elementary(Kind::bits, "BYTE", 8),
        elementary(Kind::bits, "DWORD", 32),        elementary(Kind::bits, "LWORD", 64),
        elementary(Kind::time, "LTIME", 64, true),  elementary(Kind::character, "CHAR", 8),
        elementary(Kind::date, "DATE", 64, true),   elementary(Kind::clock, "TOD", 64, true),
        elementary(Kind::moment, "DT", 64, true),
    };
    return types;
}

const Type& named(std::string_view name) {
    return *std::ranges::find_if(elementaries(), [&](const Type& t) { return t.name == name; });
}

std::string digits(Wide value) {
    if (value < 0) return "-" + digits(-value);
    if (value < 10) return std::string(1, static_cast<char>('0' + static_cast<int>(value)));
    return digits(value / 10) + digits(value % 10);
}

bool is_whole(const Type& type) {
    return type.kind == Kind::integer || type.kind == Kind::bits;
}

bool contains(const Type& type, const Type& wanted, Use use) {
    if (&type == &wanted) return true;
    if (type.kind == Kind::array) return contains(*type.element, wanted, use);
    if (type.is_union && use == Use::place) return false;
    return std::ranges::any_of(type.parts, [&](const Type::Part& part) {
        return (part.writable || use == Use::read) && contains(*part.type, wanted, use);
    });
}

bool is_derived(const Type& type, const Type& base) {
    return &type == &base || std::ranges::find(type.bases, &base) != type.bases.end();
}

/// How many bytes a controller has of it; 0 of what has other bits than those of whole numbers,
/// some of which would be no value.
std::size_t whole_bytes(const Type& type) {
    if (is_whole(type)) return type.base ? 0 : static_cast<std::size_t>(type.bits / 8);
    std::size_t count = 0;
    if (type.kind == Kind::array) {
        count = whole_bytes(*type.element);
        for (const auto& [lower, upper] : type.ranges)
            count *= static_cast<std::size_t>(upper - lower + 1);
    }
    if (type.kind != Kind::structure) return count;
    for (const Type::Part& part : type.parts) {
        const std::size_t bytes = whole_bytes(*part.type);
        if (bytes == 0) return 0;
        count = type.is_union ? std::max(count, bytes) : count + bytes;
    }
    return count;
}

class SourceMaker {
  public:
    SourceMaker(Choices& choices, Pointers pointers) : choices_(choices), pointers_(pointers) {}

    std::string make() {
        subject_ = below(4);
        declare_types();
        declare_globals();
        for (std::size_t i = subject_ > 1 ? below(3) : 0; i > 0; --i) write_interface();
        for (std::size_t i = subject_ > 1 ? 2 + below(3) : 0; i > 0; --i) write_class();
        for (std::size_t i = below(3); i > 0; --i) write_function();
        for (std::size_t i = below(3); i > 0; --i) write_block();
        if (pointers_ == Pointers::wild) write_lender();
        write_program();
        return out_;
    }

    std::string make_constant(std::string_view type) {
        for (const Type& t : elementaries()) scalars_.push_back(&t);
        texts_.push_back(&types_.emplace_back(elementary(Kind::text, "STRING", 64)));
        return expression(named(type), 4).text;
    }

  private:
    std::size_t below(std::size_t count) { return choices_.below(count); }
    bool once_in(std::size_t times) { return choices_.once_in(times); }

    std::uint64_t word(int bytes) {
        std::uint64_t value = 0;
        for (int i = 0; i < bytes; ++i) value = value << 8 | below(256);
        return value;
    }

    std::string new_name(std::string_view stem) { return fmt::format("{}{}", stem, ++names_); }

    void line(std::string_view text) { out_ += fmt::format("{:{}}{}\n", "", 2 * indent_, text); }

    // Types.

    Type& add_type(Kind kind, std::string_view stem) {
        Type& type = types_.emplace_back();
        type.kind = kind;
        type.name = new_name(stem);
        return type;
    }

    void declare_types() {
        for (const Type& type : elementaries()) scalars_.push_back(&type);
        for (const int length : {20, 3, 254}) {
            Type& text = types_.emplace_back();
            text.kind = Kind::text;
            text.name = length == 254 ? "STRING" : fmt::format("STRING[{}]", length);
            text.upper = length;
            texts_.push_back(&text);
        }
        standard_block("TON", {{"in", "BOOL"}, {"pt", "TIME"}}, {{"q", "BOOL"}, {"et", "TIME"}});
        standard_block("TOF", {{"in", "BOOL"}, {"pt", "TIME"}}, {{"q", "BOOL"}, {"et", "TIME"}});
        standard_block("TP", {{"in", "BOOL"}, {"pt", "TIME"}}, {{"q", "BOOL"}, {"et", "TIME"}});
        standard_block("CTU", {{"cu", "BOOL"}, {"r", "BOOL"}, {"pv", "INT"}},
                       {{"q", "BOOL"}, {"cv", "INT"}});
        standard_block("CTD_DINT", {{"cd", "BOOL"}, {"ld", "BOOL"}, {"pv", "DINT"}},
                       {{"q", "BOOL"}, {"cv", "DINT"}});
        standard_block("CTUD_LINT",
                       {{"cu", "BOOL"}, {"cd", "BOOL"}, {"ld", "BOOL"}, {"pv", "LINT"}},
                       {{"qu", "BOOL"}, {"qd", "BOOL"}, {"cv", "LINT"}});
        standard_block("R_TRIG", {{"clk", "BOOL"}}, {{"q", "BOOL"}});
        standard_block("F_TRIG", {{"clk", "BOOL"}}, {{"q", "BOOL"}});
        standard_block("SR", {{"s1", "BOOL"}, {"r", "BOOL"}}, {{"q1", "BOOL"}});
        standard_block("RS", {{"s", "BOOL"}, {"r1", "BOOL"}}, {{"q1", "BOOL"}});
        const std::size_t count = below(8);
        if (count == 0) return;
        line("TYPE");
        ++indent_;
        for (std::size_t i = 0; i < count; ++i) declare_type();
        --indent_;
        line("END_TYPE");
    }

    using Names = std::initializer_list<std::pair<const char*, const char*>>;
    void standard_block(const char* name, Names inputs, Names outputs) {
        Type& type = types_.emplace_back();
        type.kind = Kind::block;
        type.name = name;
        Callable& call = callables_.emplace_back();
        call.of = &type;
        for (const auto& [part, of] : inputs) {
            type.parts.push_back({part, &named(of), true});
            call.parameters.push_back({part, &named(of), Section::input});
        }
        for (const auto& [part, of] : outputs) {
            type.parts.push_back({part, &named(of), false});
            call.parameters.push_back({part, &named(of), Section::output});
        }
        standard_.push_back(&type);
    }

    void declare_type() {
        switch (below(has_bytes() ? 8 : 6)) {
            case 0:
            case 1:
                return declare_structure();
            case 6:
            case 7:
                return declare_union();
            case 2:
                return declare_enumeration();
            case 3:
                return declare_subrange();
            case 5:
                return declare_flags();
            default: {
                Type& type = array_of(any_type());
                const std::string written = written_type(type);
                type.name = new_name("Row");
                line(fmt::format("{} : {};", type.name, written));
                aggregates_.push_back(&type);
            }
        }
    }

    void declare_structure() {
        Type& type = add_type(Kind::structure, "Pair");
        line(fmt::format("{} : STRUCT", type.name));
        ++indent_;
        for (std::size_t i = 1 + below(4); i > 0; --i) {
            const Type& part = any_type();
            type.parts.push_back({new_name("m"), &part});
            line(fmt::format("{} : {}{};", type.parts.back().name, written_type(part),
                             initial(part)));
        }
        --indent_;
        line("END_STRUCT;");
        aggregates_.push_back(&type);
    }

    /// A real number of it is only read: bits of one that is none may differ.
    void declare_union() {
        Type& type = add_type(Kind::structure, "Raw");
        type.is_union = true;
        line(fmt::format("{} : UNION", type.name));
        ++indent_;
        for (std::size_t i = 2 + below(3); i > 0; --i) {
            const Type* part = &elementaries()[below(elementaries().size())];
            if (below(3) == 2) part = &array_of(named("BYTE"));
            if (below(4) == 3 && !aggregates_.empty()) part = choices_.one_of(aggregates_);
            if (part->kind != Kind::real && whole_bytes(*part) == 0) part = &named("DWORD");
            type.parts.push_back({new_name("m"), part, part->kind != Kind::real});
            line(fmt::format("{} : {};", type.parts.back().name, written_type(*part)));
        }
        --indent_;
        line("END_UNION;");
        aggregates_.push_back(&type);
    }

    /// As many BOOL as a bit string has bits.
    void declare_flags() {
        const Type& bits = named(below(2) == 0 ? "BYTE" : "WORD");
        const bool is_array = below(2) == 0;
        Type& type = add_type(is_array ? Kind::array : Kind::structure, "Flags");
        type.element = &named("BOOL");
        if (is_array) {
            type.ranges.emplace_back(-1, bits.bits - 2);
            line(fmt::format("{} : ARRAY[-1..{}] OF BOOL;", type.name, bits.bits - 2));
        } else {
            std::string parts;
            for (int i = 0; i < bits.bits; ++i) {
                type.parts.push_back({new_name("m"), type.element});
                parts += (i == 0 ? "" : ", ") + type.parts.back().name;
            }
            line(fmt::format("{} : STRUCT {} : BOOL; END_STRUCT;", type.name, parts));
        }
        aggregates_.push_back(&type);
        flags_.emplace_back(&type, &bits);
    }

    void declare_enumeration() {
        Type& type = add_type(Kind::enumeration, "Mode");
        type.counted = below(2) == 0;
        const char* const bases[] = {"", "SINT ", "UINT ", "DINT "};
        std::string text;
        std::int64_t number = 0;
        for (std::size_t i = 2 + below(4); i > 0; --i) {
            type.values.push_back(new_name("v"));
            text += (text.empty() ? "" : ", ") + type.values.back();
            number += static_cast<std::int64_t>(1 + below(20));
            if (!type.counted) text += fmt::format(" := {}", number);
        }
        line(fmt::format("{} : {}({});", type.name, bases[below(4)], text));
        scalars_.push_back(&type);
    }

    void declare_subrange() {
        Type& type = add_type(Kind::integer, "Part");
        const char* const bases[] = {"INT", "DINT", "USINT", "LINT", "SINT", "UINT"};
        type.base = &named(bases[below(6)]);
        type.bits = type.base->bits;
        type.is_signed = type.base->is_signed;
        type.lower = static_cast<std::int64_t>(below(20)) - (type.is_signed ? 10 : 0);
        type.upper = type.lower + 1 + static_cast<std::int64_t>(below(90));
        line(fmt::format("{} : {} ({}..{});", type.name, type.base->name, type.lower, type.upper));
        scalars_.push_back(&type);
    }

    const Type& any_scalar() { return *choices_.one_of(scalars_); }

    /// A type of values that are copied: no instance.
    const Type& any_type() {
        const std::size_t kind = below(8);
        if (kind == 7) return *choices_.one_of(texts_);
        if (kind > 4 && !aggregates_.empty()) return *choices_.one_of(aggregates_);
        return any_scalar();
    }

    Type& array_of(const Type& element) {
        Type& type = types_.emplace_back();
        type.kind = Kind::array;
        type.element = &element;
        const std::size_t longest = element.kind == Kind::array ? 2 : 3;
        for (std::size_t i = 1 + below(8) / 4 + below(8) / 7; i > 0; --i) {
            const std::int64_t lower = static_cast<std::int64_t>(below(4)) - 1;
            type.ranges.emplace_back(lower, lower + 1 + static_cast<std::int64_t>(below(longest)));
        }
        return type;
    }

    static std::string written_type(const Type& type) {
        if (!type.name.empty()) return type.name;
        std::string text;
        for (const auto& [lower, upper] : type.ranges)
            text += fmt::format("{}{}..{}", text.empty() ? "" : ", ", lower, upper);
        return fmt::format("ARRAY[{}] OF {}", text, written_type(*type.element));
    }

    /// Rows in several dimensions could be read in two ways.
    static bool can_begin(const Type& type) {
        if (type.kind >= Kind::block || type.is_union) return false;
        if (type.kind == Kind::array)
            return (type.ranges.size() == 1 || type.element->kind != Kind::array) &&
                   can_begin(*type.element);
        return std::ranges::all_of(type.parts,
                                   [](const Type::Part& part) { return can_begin(*part.type); });
    }

    std::string initial(const Type& type) {
        return !can_begin(type) || below(3) != 2 ? "" : " := " + initial_value(type);
    }

    std::string initial_value(const Type& type) {
        if (type.kind == Kind::structure) {
            const Type::Part& part = choices_.one_of(type.parts);
            return fmt::format("({} := {})", part.name, initial_value(*part.type));
        }
        if (type.kind != Kind::array) return literal(type).text;
        const std::string value = initial_value(*type.element);
        return below(2) == 0 ? fmt::format("[{}]", value) : fmt::format("[2({})]", value);
    }

    // Literals.

    Text literal(const Type& type) {
        switch (type.kind) {
            case Kind::boolean:
                return {below(2) == 0 ? "FALSE" : "TRUE"};
            case Kind::integer:
            case Kind::bits:
                return {whole_literal(type)};
            case Kind::real:
                return {fmt::format("{}#{}", type.name, real_number())};
            case Kind::time:
                return {time_literal()};
            case Kind::date:
                return {"D#" + day()};
            case Kind::clock:
                return {"TOD#" + clock()};
            case Kind::moment:
                return {fmt::format("DT#{}-{}", day(), clock())};
            case Kind::character: {
                const char* const characters[] = {"a", "B", "1", "$$", " ", "$'", "-", "$0A"};
                return {fmt::format("CHAR#'{}'", characters[below(8)])};
            }
            case Kind::text:
                return {text_literal()};
            default: {
                const std::string& value = choices_.one_of(type.values);
                return {below(3) == 2 ? value : fmt::format("{}#{}", type.name, value)};
            }
        }
    }

    Wide whole_number(const Type& type) {
        const bool is_subrange = type.base != nullptr;
        const Wide range = Wide{1} << type.bits;
        const Wide least = is_subrange ? type.lower : type.is_signed ? -range / 2 : 0;
        const Wide most = is_subrange ? type.upper : least + range - 1;
        Wide value = 0;
        switch (below(8)) {
            default:
                value = static_cast<Wide>(below(10));
                break;
            case 4:
                value = -static_cast<Wide>(below(100));
                break;
            case 5:
                value = below(2) == 0 ? most : least;
                break;
            case 6:
                value = static_cast<Wide>(word(type.bits / 8)) + least;
                break;
            case 7:
                value = (Wide{1} << below(64)) - 1 + static_cast<Wide>(below(3));
        }
        return std::clamp(value, least, most);
    }

    std::string whole_literal(const Type& type) {
        const Wide value = whole_number(type);
        const std::string& name = type.base ? type.base->name : type.name;
        if (value >= 0 && below(4) == 3) {
            if (below(3) == 2)
                return fmt::format("{}#2#{:b}", name, static_cast<std::uint64_t>(value));
            return fmt::format("{}#16#{:X}", name, static_cast<std::uint64_t>(value));
        }
        return fmt::format("{}#{}", name, digits(value));
    }

    std::string real_number() {
        const double part = static_cast<double>(below(200)) / 8;
        switch (below(6)) {
            default:
                return fmt::format("{:.3f}", part);
            case 3:
                return fmt::format("-{:.3f}", part);
            case 4:
                return fmt::format("{}.{}e{}", below(10), word(2),
                                   static_cast<int>(below(25)) - 12);
            case 5:
                return fmt::format("0.{}", word(3));
        }
    }

    std::string time_literal() {
        switch (below(6)) {
            default:
                return fmt::format("T#{}ms", below(50));
            case 2:
                return fmt::format("T#{}s_{}ms", below(60), below(250));
            case 3:
                return fmt::format("LT#-{}us", below(200));
            case 4:
                return fmt::format("TIME#{}.{}h", below(30), below(100));
            case 5:
                return fmt::format("LTIME#{}ns", word(4));
        }
    }

    std::string day() {
        return fmt::format("{}-{:02}-{:02}", 1960 + below(99), 1 + below(12), 1 + below(28));
    }

    std::string clock() {
        return fmt::format("{:02}:{:02}:{:02}.{}", below(24), below(60), below(60), below(100));
    }

    std::string text_literal() {
        const char* const pieces[] = {"a", "B", "12", "$$", "x y", "$'", "-7", "$0A", "0.5", "ab"};
        std::string text = "'";
        for (std::size_t i = below(5); i > 0; --i) text += pieces[below(10)];
        return text + "'";
    }

    // Variables.

    std::string spelled(const Variable& variable) {
        const std::size_t how = below(12);
        std::string name = variable.name;
        if (name.starts_with('%') || name == "THIS^" || name == "SUPER^") return name;
        if (how == 11)
            std::ranges::transform(name, name.begin(), [](char c) {
                return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
            });
        if (how > 8) return variable.global ? fmt::format("\"{}\"", name) : "#" + name;
        return name;
    }

    std::optional<std::string> place(const Type& wanted, bool write) {
        return place(wanted, write ? Use::write : Use::read);
    }

    static bool fits(const Variable& v, const Type& wanted, Use use) {
        return (v.writable || use == Use::read) && (v.has_place || use != Use::place) &&
               contains(*v.type, wanted, use);
    }

    bool is_there(const Type& wanted, Use use) const {
        return std::ranges::any_of(scope_, [&](const Variable& v) { return fits(v, wanted, use); });
    }

    std::optional<std::string> place(const Type& wanted, Use use) {
        std::vector<const Variable*> fitting;
        for (const Variable& v : scope_)
            if (fits(v, wanted, use)) fitting.push_back(&v);
        if (fitting.empty()) return {};
        ++reads_;
        const Variable& variable = *choices_.one_of(fitting);
        std::string text = spelled(variable);
        const Type* type = variable.type;
        while (type != &wanted) {
            if (type->kind == Kind::array) {
                text += indices(*type);
                type = type->element;
                continue;
            }
            std::vector<const Type::Part*> parts;
            for (const Type::Part& part : type->parts)
                if ((part.writable || use == Use::read) && contains(*part.type, wanted, use))
                    parts.push_back(&part);
            const Type::Part& part = *choices_.one_of(parts);
            text += "." + part.name;
            type = part.type;
        }
        return text;
    }

    std::string indices(const Type& array) {
        std::string text;
        for (const auto& [lower, upper] : array.ranges) {
            if (!text.empty()) text += below(4) == 3 ? "][" : ", ";
            text += index(lower, upper);
        }
        return "[" + text + "]";
    }

    std::string index(std::int64_t lower, std::int64_t upper) {
        const std::int64_t count = upper - lower + 1;
        const auto fixed = [&] {
            return std::to_string(
                lower + static_cast<std::int64_t>(below(static_cast<std::size_t>(count))));
        };
        const char* const types[] = {"INT", "DINT", "LINT", "SINT"};
        const std::size_t how = below(8);
        if (how < 3 || index_depth_ > 1) return fixed();
        const Type& type = named(types[below(upper > 127 ? 3 : 4)]);
        ++index_depth_;
        const auto variable = place(type, false);
        --index_depth_;
        if (!variable) return fixed();
        if (how == 7 && below(6) == 5) return *variable;
        if (how > 5) return fmt::format("ABS({} MOD {}) + {}", *variable, count, lower);
        return fmt::format("LIMIT({}, {}, {})", lower, *variable, upper);
    }

    // Expressions.

    static std::string wrapped(const Text& text, int least) {
        return text.strength < least ? "(" + text.text + ")" : text.text;
    }

    Text leaf(const Type& type) {
        for (const Variable& constant : constants_)
            if (constant.type == &type && below(4) == 3) return {constant.name};
        if (below(4) != 3)
            if (auto found = place(type, false)) return {*found};
        return literal(type);
    }

    /// `type`, or now and then one that widens to it, where both will do.
    const Type& narrower(const Type& type) { return below(6) == 5 ? widening(type) : type; }

    /// One that widens to it; `type` if there is none.
    const Type& widening(const Type& type) {
        std::vector<const Type*> fitting;
        for (const Type* t : scalars_)
            if (widens(*t, type)) fitting.push_back(t);
        return fitting.empty() ? type : *choices_.one_of(fitting);
    }

    static bool widens(const Type& from, const Type& to) {
        if (to.base) return false;
        if (from.base) return from.base == &to;
        if (from.kind == Kind::integer && to.kind == Kind::integer)
            return from.bits < to.bits && (to.is_signed || !from.is_signed);
        if (from.kind == Kind::integer && to.kind == Kind::real)
            return from.bits <= (to.bits == 32 ? 16 : 32);
        if (from.kind == Kind::time) return to.kind == Kind::time;
        return from.kind == to.kind && (from.kind == Kind::real || from.kind == Kind::bits) &&
               from.bits < to.bits;
    }

    Text expression(const Type& type, int depth) {
        if (type.kind == Kind::interface) return {instance(type).value_or("NULL")};
        if (type.kind >= Kind::array) return aggregate(type, depth);
        if (depth <= 0) return leaf(type);
        if (type.base) return into_subrange(type, depth);
        if (below(9) == 8)
            if (auto text = function_call(type, depth)) return *text;
        if (below(24) == 23)
            if (auto text = beside_call(type, depth)) return *text;
        switch (type.kind) {
            case Kind::boolean:
                return boolean(type, depth);
            case Kind::integer:
                return integer(type, depth);
            case Kind::bits:
                return bit_string(type, depth);
            case Kind::real:
                return real(type, depth);
            case Kind::time:
                return time(type, depth);
            case Kind::date:
            case Kind::clock:
            case Kind::moment:
                return date(type, depth);
            case Kind::character:
                return character(type, depth);
            case Kind::text:
                return text(type, depth);
            default:
                return enumeration(type, depth);
        }
    }

    std::string sub(const Type& type, int depth) { return expression(type, depth - 1).text; }

    /// Not known when compiling, so that nothing is refused for it.
    std::string varying(const Type& type, int depth) {
        const int before = reads_;
        const std::string made = sub(type, depth);
        return reads_ == before ? fmt::format("MOVE({})", made) : made;
    }

    Text into_subrange(const Type& type, int depth) {
        if (below(3) == 0) return leaf(type);
        if (below(8) == 7) return {fmt::format("MOVE({})", sub(*type.base, depth))};
        const std::string value = varying(*type.base, depth);
        return {fmt::format("LIMIT({}, {}, {})", type.lower, value, type.upper)};
    }

    Text binary(const char* op, int strength, const Type& left, const Type& right, int depth) {
        const Text a = expression(left, depth - 1), b = expression(right, depth - 1);
        return {
            fmt::format("{} {} {}",
                        wrapped(a, strength == compare || strength == equal ? add : strength), op,
                        wrapped(b, strength == compare || strength == equal ? add : strength + 1)),
            strength};
    }

    Text boolean(const Type& type, int depth) {
        const char* const lazy[] = {"AND", "OR", "XOR", "&", "AND_THEN", "OR_ELSE"};
        constexpr int strengths[] = {and_, or_, xor_, and_, and_, or_};
        switch (below(10)) {
            default:
                return leaf(type);
            case 1:
            case 2: {
                const std::size_t op = below(6);
                const Text a = expression(type, depth - 1), b = expression(type, depth - 1);
                const bool plain = op < 4;
                return {fmt::format("{} {} {}", wrapped(a, plain ? strengths[op] : equal), lazy[op],
                                    wrapped(b, plain ? strengths[op] + 1 : equal)),
                        plain ? strengths[op] : or_};
            }
            case 3:
                return {"NOT " + wrapped(expression(type, depth - 1), atom), unary};
            case 4:
            case 5:
            case 6:
                return comparison(depth);
            case 7:
                if (auto made = bit_of(1)) return *made;
                return leaf(type);
            case 8:
                return {fmt::format("IS_VALID({})",
                                    sub(named(below(2) == 0 ? "LREAL" : "REAL"), depth))};
            case 9:
                return selection(type, depth);
        }
    }

    Text comparison(int depth) {
        const char* const ops[] = {"<", "=", ">=", "<>", ">", "<="};
        const char* const names[] = {"LT", "EQ", "GE", "NE", "GT", "LE"};
        const std::size_t op = below(6);
        const Type& type = below(8) == 7 ? *choices_.one_of(texts_) : any_scalar();
        if (type.kind == Kind::enumeration) {
            if (auto found = place(type, false))
                return {
                    fmt::format("{} {} {}", *found, op % 2 == 0 ? "=" : "<>", literal(type).text),
                    equal};
            return leaf(named("BOOL"));
        }
        if (type.kind != Kind::text && below(6) == 5)
            return {fmt::format("{}({}, {})", names[op], sub(type, depth), sub(type, depth))};
        return binary(ops[op], op % 2 == 1 && op < 4 ? equal : compare, type, type, depth);
    }

    /// A part of a whole number: `.%X3`, `.3`, `.%B0`.
    std::optional<Text> bit_of(int bits) {
        std::vector<const Type*> fitting;
        for (const Type* t : scalars_)
            if (is_whole(*t) && !t->base && (t->bits > bits || bits == 1)) fitting.push_back(t);
        const Type& of = *choices_.one_of(fitting);
        const auto found = place(of, false);
        if (!found) return {};
        return Text{*found + part_of(of, bits, found->front() != '%')};
    }

    std::string part_of(const Type& of, int bits, bool may_be_short) {
        const std::size_t number = below(static_cast<std::size_t>(of.bits / bits));
        if (bits == 1 && below(3) == 2 && may_be_short) return fmt::format(".{}", number);
        const char letter = bits == 1 ? 'X' : bits == 8 ? 'B' : bits == 16 ? 'W' : 'D';
        return fmt::format(".%{}{}", letter, number);
    }

    Text selection(const Type& type, int depth) {
        const std::string first = sub(type, depth), second = sub(type, depth);
        const bool plain = type.kind == Kind::boolean || type.kind >= Kind::character;
        switch (plain ? below(3) : below(3 + (type.kind == Kind::bits ? 2 : 3))) {
            default:
                return {fmt::format("SEL({}, {}, {})", sub(named("BOOL"), depth), first, second)};
            case 1: {
                const Type& k = named(below(2) == 0 ? "INT" : "USINT");
                const std::string place = below(8) == 7
                                              ? sub(k, depth)
                                              : fmt::format("LIMIT(0, {}, 1)", varying(k, depth));
                if (below(3) != 2) return {fmt::format("MUX({}, {}, {})", place, first, second)};
                return {fmt::format("MUX(K := {}, IN0 := {}, INELSE := {})", sub(k, depth), first,
                                    second)};
            }
            case 2:
                return {fmt::format("MOVE({})", first)};
            case 3:
                return {fmt::format("MIN({}, {})", first, second)};
            case 4:
                return {fmt::format("MAX({}, {}, {})", first, second, sub(type, depth))};
            case 5:
                return {fmt::format("LIMIT({}, {}, {})", first, sub(type, depth), second)};
        }
    }

    /// An operation of numbers of `type`, the right one perhaps of a type that widens to it, or a
    /// number without type.
    Text arithmetic(const Type& type, int depth) {
        const char* const ops[] = {"+", "-", "*"};
        const std::size_t op = below(3);
        const int strength = op == 2 ? multiply : add;
        if (below(6) == 5) {
            const char* const names[] = {"ADD", "SUB", "MUL"};
            return {fmt::format("{}({}, {})", names[op], sub(type, depth), sub(type, depth))};
        }
        const int before = reads_;
        const Text a = expression(type, depth - 1);
        if (below(4) == 3 && reads_ != before) {
            const std::string number =
                type.kind == Kind::real ? fmt::format("{:.1f}", static_cast<double>(below(40)) / 4)
                                        : std::to_string(below(100));
            return {fmt::format("{} {} {}", wrapped(a, strength), ops[op], number), strength};
        }
        const Text b = expression(narrower(type), depth - 1);
        return {fmt::format("{} {} {}", wrapped(a, strength), ops[op], wrapped(b, strength + 1)),
                strength};
    }

    Text integer(const Type& type, int depth) {
        switch (below(12)) {
            default:
                return leaf(type);
            case 1:
            case 2:
            case 3:
                return arithmetic(type, depth);
            case 4:
                return division(type, depth);
            case 5: {
                const Text a = expression(type, depth - 1);
                return {"-" + wrapped(a, atom + (a.text.front() == '-')), unary};
            }
            case 6:
                return {fmt::format("ABS({})", sub(type, depth))};
            case 7:
                return shift(type, depth);
            case 8:
            case 9:
                return conversion(type, depth);
            case 10:
                return selection(type, depth);
            case 11:
                return {whole_of_other(type, depth)};
        }
    }

    /// A whole number made of a real one, or of texts.
    std::string whole_of_other(const Type& type, int depth) {
        const Type& any = *choices_.one_of(texts_);
        if (type.name == "DINT") {
            const char* const names[] = {"ROUND", "TRUNC", "FLOOR", "CEIL"};
            return fmt::format("{}({})", names[below(4)], small_real(depth));
        }
        if (type.name != "INT") return leaf(type).text;
        switch (below(4)) {
            default:
                return fmt::format("LEN({})", sub(any, depth));
            case 1:
                return fmt::format("FIND({}, {})", sub(any, depth), sub(any, depth));
            case 2:
                return fmt::format("ENCO({})", sub(named(below(2) == 0 ? "WORD" : "LWORD"), depth));
            case 3:
                return fmt::format("CHAR_TO_INT({})", sub(named("CHAR"), depth));
        }
    }

    std::string small_real(int depth) {
        return fmt::format("LIMIT(-100.0, {}, 120.0)",
                           varying(named(below(2) == 0 ? "LREAL" : "REAL"), depth));
    }

    Text division(const Type& type, int depth) {
        const bool divides = below(2) == 0;
        const Text a = expression(type, depth - 1);
        std::string by;
        if (below(4) != 3) {
            Wide number = whole_number(type);
            if (number == 0) number = 3;
            by = fmt::format("{}#{}", type.name, digits(number));
        } else {
            by = fmt::format("MOVE({})", sub(type, depth));
        }
        if (divides && below(6) == 5) return {fmt::format("DIV({}, {})", a.text, by)};
        return {fmt::format("{} {} {}", wrapped(a, multiply), divides ? "/" : "MOD", by), multiply};
    }

    Text shift(const Type& type, int depth) {
        const char* const names[] = {"SHL", "SHR", "ROL", "ROR"};
        const std::size_t name = below(4);
        const std::string in = sub(type, depth);
        const std::string n = below(3) != 2 ? std::to_string(below(70)) : sub(named("INT"), depth);
        if (below(3) == 2) return {fmt::format("{}(IN := {}, N := {})", names[name], in, n)};
        return {fmt::format("{}({}, {})", names[name], in, n)};
    }

    /// From any other scalar, or a text that is a number.
    Text conversion(const Type& type, int depth) {
        const Type& from = any_scalar();
        const bool whole = is_whole(type) || type.kind == Kind::time;
        if (from.base || &from == &type || from.kind == Kind::time)
            return time_conversion(type, depth);
        if (from.kind == Kind::enumeration && type.kind == Kind::time) return leaf(type);
        if (from.kind >= Kind::date && from.kind <= Kind::character && !is_whole(type))
            return leaf(type);
        std::string value = sub(from, depth);
        const bool same_bits = type.kind == Kind::bits && from.bits == type.bits;
        if (from.kind == Kind::real && same_bits) {
            value = fmt::format("SEL(IS_VALID({0}), {1}#0.0, {0})", value, from.name);
        } else if (from.kind == Kind::real && whole && below(12) != 11) {
            const bool small = type.bits == 8 || !type.is_signed;
            value = fmt::format("LIMIT({}.0, {}, {}.0)", type.is_signed ? -(small ? 100 : 9999) : 0,
                                varying(from, depth), small ? 120 : 30000);
            if (below(4) == 3) return {fmt::format("{}_TRUNC_{}({})", from.name, type.name, value)};
        }
        if (below(2) == 0) return {fmt::format("TO_{}({})", type.name, value)};
        return {fmt::format("{}_TO_{}({})", from.name, type.name, value)};
    }

    Text time_conversion(const Type& type, int depth) {
        if (type.kind == Kind::bits || type.kind == Kind::boolean || type.kind == Kind::time)
            return leaf(type);
        return {fmt::format("TIME_TO_{}({})", type.name, sub(named("TIME"), depth))};
    }

    Text bit_string(const Type& type, int depth) {
        const char* const ops[] = {"AND", "OR", "XOR"};
        constexpr int strengths[] = {and_, or_, xor_};
        switch (below(11)) {
            default:
                return leaf(type);
            case 1:
            case 2: {
                const std::size_t op = below(3);
                return binary(ops[op], strengths[op], type, type, depth);
            }
            case 8:
                return {fmt::format("SWAP({})", sub(type, depth))};
            case 9: {
                const std::string bit = fmt::format("DECO({})", sub(named("INT"), depth));
                return {type.bits == 32 ? bit : fmt::format("DWORD_TO_{}({})", type.name, bit)};
            }
            case 10:
                if (type.bits != 16) return leaf(type);
                return {fmt::format("UINT_TO_BCD_WORD(LIMIT(0, {}, 9999))",
                                    varying(named("UINT"), depth))};
            case 3:
                return {"NOT " + wrapped(expression(type, depth - 1), atom), unary};
            case 4:
                return shift(type, depth);
            case 5:
                return conversion(type, depth);
            case 6:
                return selection(type, depth);
            case 7:
                if (type.bits < 64)
                    if (auto made = bit_of(type.bits)) return *made;
                return leaf(type);
        }
    }

    Text real(const Type& type, int depth) {
        const char* const functions[] = {"SQRT", "SIN", "COS",  "ABS",  "EXP",  "LN", "TAN",
                                         "ATAN", "SQR", "FRAC", "ASIN", "ACOS", "LOG"};
        switch (below(12)) {
            default:
                return leaf(type);
            case 1:
            case 2:
            case 3:
            case 4:
                return arithmetic(type, depth);
            case 5:
                return binary("/", multiply, type, type, depth);
            case 6: {
                const Text a = expression(type, depth - 1);
                return {"-" + wrapped(a, atom), unary};
            }
            case 7:
                return {fmt::format("{}({})", functions[below(13)], sub(type, depth))};
            case 8:
                if (below(2) == 0)
                    return {fmt::format("ATAN2({}, {})", sub(type, depth), sub(type, depth))};
                return {fmt::format("{}({}, {}, {})", below(2) == 0 ? "NORM_X" : "SCALE_X",
                                    sub(type, depth), sub(type, depth), sub(type, depth))};
            case 9:
                return conversion(type, depth);
            case 10:
                return selection(type, depth);
            case 11: {
                const Text a = expression(type, depth - 1);
                if (below(3) == 0) return {fmt::format("EXPT({}, {})", a.text, sub(type, depth))};
                return {fmt::format("{} ** {}", wrapped(a, atom), below(4)), power};
            }
        }
    }

    Text time(const Type& type, int depth) {
        const Type& lint = named(below(2) == 0 ? "LINT" : "INT");
        switch (below(11)) {
            default:
                return leaf(type);
            case 10: {
                if (below(4) == 3) return {"TIME()"};
                const char* const dates[] = {"DT", "DATE", "TOD"};
                const Type& of = named(dates[below(3)]);
                return binary("-", add, of, of, depth);
            }
            case 1:
            case 2:
                return binary(below(2) == 0 ? "+" : "-", add, type, type, depth);
            case 3:
                return binary("*", multiply, type, lint, depth);
            case 4: {
                const Text a = expression(type, depth - 1);
                return {fmt::format("{} / {}", wrapped(a, multiply), 1 + below(100)), multiply};
            }
            case 5: {
                const Text a = expression(type, depth - 1);
                return {fmt::format("{} MOD {}", wrapped(a, multiply), "T#7ms"), multiply};
            }
            case 6: {
                const Text a = expression(type, depth - 1);
                return {fmt::format("{} * {}", wrapped(a, multiply), small_real(depth)), multiply};
            }
            case 7:
                return {"-" + wrapped(expression(type, depth - 1), atom), unary};
            case 8:
                return conversion(type, depth);
            case 9:
                return selection(type, depth);
        }
    }

    Text date(const Type& type, int depth) {
        const Type &moment = named("DT"), &time = named("TIME");
        switch (below(6)) {
            default:
                return leaf(type);
            case 3:
                return selection(type, depth);
            case 4:
                if (type.kind == Kind::moment)
                    return {fmt::format("CONCAT_DATE_TOD({}, {})", sub(named("DATE"), depth),
                                        sub(named("TOD"), depth))};
                return {fmt::format("DT_TO_{}({})", type.name, sub(moment, depth))};
            case 5:
                if (type.kind == Kind::date) return leaf(type);
                return binary(below(2) == 0 ? "+" : "-", add, type, time, depth);
        }
    }

    std::string position(int depth) {
        if (below(3) != 2) return std::to_string(1 + below(6));
        return fmt::format("LIMIT(1, {}, 9)", varying(named("INT"), depth));
    }

    /// One of a text, a number's, or the first of a text.
    Text character(const Type& type, int depth) {
        const Type& any = *choices_.one_of(texts_);
        switch (below(8)) {
            default:
                return leaf(type);
            case 3:
            case 4: {
                const auto from = place(any, false);
                if (!from) return leaf(type);
                return {fmt::format("{}[{}]", *from, index(1, 3))};
            }
            case 5:
                return {fmt::format("BYTE_TO_CHAR({})", sub(named("BYTE"), depth))};
            case 6:
                return {fmt::format("STRING_TO_CHAR({})", sub(any, depth))};
            case 7:
                return selection(type, depth);
        }
    }

    Text text(const Type&, int depth) {
        const Type& any = *choices_.one_of(texts_);
        switch (below(10)) {
            default:
                return leaf(any);
            case 9:
                return selection(any, depth);
            case 1:
                return {fmt::format("CONCAT({}, {})", sub(any, depth), sub(any, depth))};
            case 2:
                return {fmt::format("LEFT({}, {})", sub(any, depth), position(depth))};
            case 3:
                return {fmt::format("RIGHT({}, {})", sub(any, depth), position(depth))};
            case 4:
                return {fmt::format("MID({}, {}, {})", sub(any, depth), position(depth),
                                    position(depth))};
            case 5:
                return {fmt::format("INSERT({}, {}, {})", sub(any, depth), sub(any, depth),
                                    position(depth))};
            case 6:
                return {fmt::format("DELETE({}, {}, {})", sub(any, depth), position(depth),
                                    position(depth))};
            case 7:
                return {fmt::format("REPLACE({}, {}, {}, {})", sub(any, depth), sub(any, depth),
                                    position(depth), position(depth))};
            case 8: {
                const Type& from = elementaries()[below(elementaries().size())];
                if ((from.kind >= Kind::time && from.kind <= Kind::moment) ||
                    from.kind == Kind::boolean)
                    return leaf(any);
                return {fmt::format("{}_TO_STRING({})", from.name, sub(from, depth))};
            }
        }
    }

    Text enumeration(const Type& type, int depth) {
        switch (below(5)) {
            default:
                return leaf(type);
            case 2:
                return selection(type, depth);
            case 3:
                if (!type.counted) return leaf(type);
                return {fmt::format("TO_{}(LIMIT(0, {}, {}))", type.name,
                                    varying(named("INT"), depth), type.values.size() - 1)};
            case 4:
                if (!type.counted) return leaf(type);
                return {fmt::format("TO_{}({})", type.name,
                                    sub(named(below(2) == 0 ? "USINT" : "REAL"), depth))};
        }
    }

    /// A whole array or structure: a variable of its type, or what a function gives.
    Text aggregate(const Type& type, int depth) {
        if (depth > 0 && below(3) == 2)
            if (auto made = function_call(type, 1)) return *made;
        if (depth > 1 && below(4) == 3) return selection(type, depth - 1);
        return {*place(type, false)};
    }

    // Calls.

    std::optional<Text> function_call(const Type& type, int depth) {
        std::vector<const Callable*> fitting;
        for (const Callable& callable : callables_)
            if (callable.result == &type && can_be_called(callable)) fitting.push_back(&callable);
        if (fitting.empty()) return {};
        const Callable& callable = *choices_.one_of(fitting);
        if (callable.of && callable.of->kind == Kind::interface) return {};
        const auto given = arguments(callable, depth - 1);
        if (!given) return {};
        const std::string of = callable.of ? receiver(callable) + "." : "";
        if (callable.is_abstract && of == "SUPER^.") return {};
        return Text{of + callable.name + *given};
    }

    /// A variable, often one that widens, beside a call, which may write it.
    std::optional<Text> beside_call(const Type& type, int depth) {
        if (type.kind != Kind::integer && type.kind != Kind::real) return {};
        const auto variable = place(below(2) == 0 ? type : widening(type), false);
        const auto call = variable ? function_call(type, depth) : std::nullopt;
        if (!call) return {};
        return Text{fmt::format("({} + {})", *variable, call->text)};
    }

    static Use use_of(const Callable& callable) {
        return callable.of->kind == Kind::interface ? Use::read : Use::write;
    }

    bool can_be_called(const Callable& callable) const {
        return !callable.of || is_there(*callable.of, use_of(callable));
    }

    /// An instance that the method, or the call, is of.
    std::string receiver(const Callable& callable) {
        return *place(*callable.of, use_of(callable));
    }

    /// What a variable of an interface is given, or a VAR_IN_OUT of a block's type.
    std::optional<std::string> instance(const Type& type) {
        std::vector<const Type*> fitting;
        for (const Class& one : classes_)
            if (is_derived(*one.type, type) && is_there(*one.type, Use::place))
                fitting.push_back(one.type);
        if (type.kind == Kind::interface && is_there(type, Use::read)) fitting.push_back(&type);
        if (fitting.empty()) return {};
        const Type& found = *choices_.one_of(fitting);
        return place(found, found.kind == Kind::interface ? Use::read : Use::place);
    }

    bool can_be_given(const Type& type) {
        const bool aggregate = type.kind == Kind::array || type.kind == Kind::structure;
        return !aggregate || is_there(type, Use::read);
    }

    /// `(a, b)` or `(a := a, q => b)`; none when there is no variable for a VAR_IN_OUT.
    std::optional<std::string> arguments(const Callable& callable, int depth) {
        const bool is_instance = callable.of && !callable.is_method;
        const bool by_name = is_instance || below(2) == 1;
        std::string text;
        for (const Parameter& p : callable.parameters) {
            std::string value;
            if (p.section == Section::input) {
                if (!can_be_given(*p.type) && !by_name) return {};
                if (by_name && (below(6) == 5 || !can_be_given(*p.type))) continue;
                value = expression(*p.type, depth).text;
            } else if (p.section == Section::in_out) {
                const auto found =
                    p.type->kind == Kind::block ? instance(*p.type) : place(*p.type, Use::place);
                if (!found) return {};
                value = *found;
            } else {
                if (!by_name || below(2) == 0) continue;
                const auto found = place(*p.type, Use::place);
                if (!found) continue;
                value = *found;
            }
            if (!text.empty()) text += ", ";
            if (by_name)
                text += fmt::format("{} {} ", p.name, p.section == Section::output ? "=>" : ":=");
            text += value;
        }
        if (!is_instance && text.empty()) return {};
        return "(" + text + ")";
    }

    /// Calls a method of the block at hand, which may be one that others replace.
    void call_own_method() {
        const Callable& callable = choices_.one_of(class_->methods).call;
        call_bounded([&] { call(callable, "THIS^." + callable.name); });
    }

    /// Calls an instance, a method or a function as a statement; its result goes somewhere or not.
    void call_something() {
        if (class_ && !class_->methods.empty() && below(2) == 1) return call_own_method();
        std::vector<const Callable*> fitting;
        for (const Callable& callable : callables_)
            if (can_be_called(callable)) fitting.push_back(&callable);
        const auto is_plain = [](const Callable* callable) { return !callable->is_method; };
        if (subject_ > 1 && below(2) == 1 && !std::ranges::all_of(fitting, is_plain))
            std::erase_if(fitting, is_plain);
        if (fitting.empty()) return assign();
        const Callable& callable = *choices_.one_of(fitting);
        std::string text = callable.name, guard;
        if (callable.of) {
            const std::string instance = receiver(callable);
            if (callable.is_abstract && instance == "SUPER^") return assign();
            text = callable.is_method ? instance + "." + callable.name : instance;
            if (callable.of->kind == Kind::interface && below(8) != 7) guard = instance;
        }
        if (!guard.empty()) line(fmt::format("IF {} <> NULL THEN", guard));
        if (callable.is_method && below(4) != 3)
            call_bounded([&] { call(callable, std::move(text)); });
        else
            call(callable, std::move(text));
        if (!guard.empty()) line("END_IF;");
    }

    void call(const Callable& callable, std::string text) {
        auto given = arguments(callable, 2);
        if (!given) return assign();
        const bool by_name = *given == "()" || given->find(" := ") != std::string::npos;
        if (by_name && below(4) == 3) {
            const bool empty = *given == "()";
            const std::string rest = empty ? "" : given->substr(1, given->size() - 2);
            std::string before = enable();
            if (empty) before.resize(before.size() - 2);
            given = fmt::format("({}{}{})", before, rest, enabled());
        }
        text += *given;
        if (callable.result && below(3) != 0)
            if (auto to = place(*callable.result, true)) return line(*to + " := " + text + ";");
        line(text + ";");
    }

    // Statements.

    void statements(std::size_t count) {
        ++indent_;
        for (; count > 0; --count) statement();
        --indent_;
    }

    void statement() {
        const bool deep = ++nesting_ > 3;
        switch (below(deep ? 8 : 16)) {
            default:
                assign();
                break;
            case 2:
                if (subject_ > 0 && below(2) == 1)
                    of_subject();
                else
                    rarer();
                break;
            case 3:
                accumulate();
                break;
            case 4:
                assign_bits();
                break;
            case 5:
            case 6:
                call_something();
                break;
            case 7:
                leave();
                break;
            case 8:
            case 9:
                write_if();
                break;
            case 10:
            case 11:
                write_case();
                break;
            case 12:
            case 13:
                write_for();
                break;
            case 14:
            case 15:
                write_loop();
        }
        --nesting_;
    }

    void assign() {
        const Type& type = any_type();
        const auto to = place(type, true);
        if (!to) return;
        line(fmt::format("{} := {};", *to,
                         expression(narrower(type), 1 + static_cast<int>(below(4))).text));
    }

    /// What programs with classes, or with bytes that are seen in two ways, have.
    void of_subject() {
        switch (below(4)) {
            default:
                return give_instance();
            case 1:
                return set_property();
            case 2:
                return use_memory();
            case 3:
                return move_pointer();
        }
    }

    bool has_bytes() const { return subject_ % 2 == 1; }

    /// What fewer programs have, of Siemens' SCL mostly.
    void rarer() {
        const Type& boolean = named("BOOL");
        switch (below(8)) {
            default:
                return assign();
            case 1:
                return assign_twice();
            case 2:
                if (const auto to = place(boolean, true))
                    line(fmt::format("{} {}= {};", *to, below(2) == 0 ? 'S' : 'R',
                                     expression(boolean, 2).text));
                return;
            case 3:
                return set_character();
            case 4:
                return scatter();
            case 5:
                return call_if_enabled();
            case 6:
                return set_timer();
            case 7:
                if (has_eno_) line(fmt::format("ENO := ENO XOR {};", sub(boolean, 2)));
        }
    }

    void give_instance() {
        if (interfaces_.empty()) return assign();
        const Type& type = *choices_.one_of(interfaces_)->type;
        const auto to = place(type, Use::write);
        if (!to) return assign();
        line(fmt::format("{} := {};", *to, expression(type, 1).text));
    }

    void set_property() {
        if (properties_.empty()) return assign();
        const auto& [of, property] = choices_.one_of(properties_);
        const auto instance = place(*of, of->kind == Kind::interface ? Use::read : Use::write);
        if (!instance || *instance == "SUPER^") return assign();
        const bool is_real = property.type->kind == Kind::real;
        line(fmt::format("{}.{} {} {};", *instance, property.name,
                         is_real && below(3) == 2 ? "+=" : ":=", sub(*property.type, 3)));
    }

    /// A variable, nothing but whole numbers, that may be seen as bytes.
    std::optional<Variable> variable_of_bytes() {
        std::vector<const Variable*> fitting;
        for (const Variable& v : scope_)
            if (v.writable && v.has_place && whole_bytes(*v.type) > 0 &&
                v.name.find_first_of("^[") == std::string::npos)
                fitting.push_back(&v);
        if (fitting.empty()) return {};
        return *choices_.one_of(fitting);
    }

    void use_memory() {
        const auto to = variable_of_bytes(), from = variable_of_bytes();
        if (!to) return assign();
        const std::size_t room = whole_bytes(*to->type), there = whole_bytes(*from->type);
        const std::size_t count = 1 + below(std::min(room, there));
        switch (below(3)) {
            case 0:
                return line(fmt::format("{}(ADR({}), ADR({}), {});",
                                        below(2) == 0 ? "MEMCPY" : "MEMMOVE", to->name, from->name,
                                        count));
            case 1:
                return line(fmt::format("MEMSET(ADR({}), {}, {});", to->name,
                                        below(2) == 0 ? "0" : sub(named("BYTE"), 2), count));
            default:
                if (const auto order = place(named("DINT"), true))
                    line(fmt::format("{} := MEMCMP(ADR({}), ADR({}), {});", *order, to->name,
                                     from->name, count));
        }
    }

    /// By some elements, now and then out of what it is in.
    void move_pointer() {
        if (walking_.empty()) return assign();
        const Variable& pointer = choices_.one_of(walking_);
        if (pointers_ == Pointers::wild) return move_wildly(pointer);
        line(fmt::format("{0} := {0} {1} {2}SIZEOF({3});", pointer.name, below(2) == 0 ? '+' : '-',
                         below(2) == 0 ? "" : "2 * ", pointer.type->name));
    }

    /// To anything, by anything; out of what calls have.
    void move_wildly(const Variable& pointer) {
        const std::string &p = pointer.name, &type = pointer.type->name;
        const Type& dint = named("DINT");
        switch (below(8)) {
            default:
                return line(fmt::format("{0} := {0} + {1};", p, sub(dint, 2)));
            case 1:
                return line(fmt::format("{}[{}] := {};", p, sub(dint, 2), sub(*pointer.type, 2)));
            case 2:
                return line(fmt::format("MEMSET({} + {}, {}, {});", p, sub(dint, 1),
                                        sub(named("BYTE"), 1), sub(dint, 1)));
            case 3: {
                const std::string &other = choices_.one_of(walking_).name, count = sub(dint, 1);
                return line(fmt::format("MEMCPY({}, {} - {}, {});", p, other, below(9), count));
            }
            case 4:
            case 5:
                if (const auto to = place(*pointer.type, Use::place))
                    line(fmt::format("{} := ADR({});", p, *to));
                return;
            case 6:
                if (const auto to = place(*pointer.type, Use::write))
                    line(fmt::format("{} := {}^;", *to, p));
                return;
            case 7:
                return line(fmt::format("{} := {};", p,
                                        lends_.contains(type) ? lends_[type] + "()" : "NULL"));
        }
    }

    void assign_twice() {
        const Type& type = any_type();
        const auto first = place(type, true), second = place(type, true);
        if (first) line(fmt::format("{} := {} := {};", *first, *second, expression(type, 3).text));
    }

    /// Sets a character of a text that is long enough, mostly.
    void set_character() {
        const Type& any = *choices_.one_of(texts_);
        const auto text = place(any, true);
        if (!text) return assign();
        const std::size_t at = 1 + below(3);
        const std::string set =
            fmt::format("{}[{}] := {};", *text, at, expression(named("CHAR"), 2).text);
        line(below(10) == 9 ? set
                            : fmt::format("IF LEN({}) >= {} THEN {} END_IF;", *text, at, set));
    }

    void scatter() {
        if (flags_.empty()) return assign();
        const auto& [flags, bits] = choices_.one_of(flags_);
        const auto one = place(*flags, Use::place), other = place(*bits, Use::place);
        if (!one || !other) return assign();
        if (below(2) == 0) return line(fmt::format("SCATTER(IN := {}, OUT := {});", *other, *one));
        line(fmt::format("GATHER(IN := {}, OUT := {});", *one, *other));
    }

    void call_if_enabled() {
        const char* const names[] = {"ADD", "MUL", "MAX", "SUB"};
        const Type& type = named(below(2) == 0 ? "DINT" : "LREAL");
        const auto to = place(type, true);
        if (!to) return assign();
        line(fmt::format("{} := {}({}IN1 := {}, IN2 := {}{});", *to, names[below(4)], enable(),
                         sub(type, 2), sub(type, 2), enabled()));
    }

    std::string enable() { return fmt::format("EN := {}, ", sub(named("BOOL"), 2)); }

    std::string enabled() {
        const auto to = place(named("BOOL"), Use::place);
        return to ? fmt::format(", ENO => {}", *to) : "";
    }

    void set_timer() {
        const auto timer = place(*standard_[below(3)], true);
        if (!timer) return assign();
        if (below(2) == 0) return line(fmt::format("RESET_TIMER({});", *timer));
        line(fmt::format("PRESET_TIMER(PT := {}, TIMER := {});", sub(named("TIME"), 2), *timer));
    }

    void accumulate() {
        const Type& type = any_scalar();
        const auto to = place(type, true);
        if (!to || type.kind == Kind::enumeration || type.base) return;
        const bool number = type.kind == Kind::integer || type.kind == Kind::real;
        if (number) {
            const char* const ops[] = {"+=", "-=", "*="};
            return line(fmt::format("{} {} {};", *to, ops[below(3)], expression(type, 2).text));
        }
        line(fmt::format("{} := {};", *to, expression(type, 3).text));
    }

    void assign_bits() {
        const Type& type = *scalars_[below(16)];
        const auto to = is_whole(type) ? place(type, true) : std::nullopt;
        if (!to) return assign();
        const int bits = below(2) == 1 && type.bits > 8 ? 8 : 1;
        line(fmt::format("{}{} := {};", *to, part_of(type, bits, to->front() != '%'),
                         expression(named(bits == 1 ? "BOOL" : "BYTE"), 2).text));
    }

    void leave() {
        const char* const words[] = {"RETURN", "EXIT", "CONTINUE"};
        line(fmt::format("IF {} THEN {}; END_IF;", expression(named("BOOL"), 2).text,
                         words[loops_ > 0 ? below(3) : 0]));
    }

    void write_if() {
        line(fmt::format("IF {} THEN", expression(named("BOOL"), 3).text));
        statements(1 + below(2));
        for (std::size_t i = below(6) / 4; i > 0; --i) {
            line(fmt::format("ELSIF {} THEN", expression(named("BOOL"), 2).text));
            statements(below(2));
        }
        if (below(2) == 1) {
            line("ELSE");
            statements(1 + below(2));
        }
        line("END_IF;");
    }

    void write_case() {
        const Type& type = any_scalar();
        const bool fits = is_whole(type) || type.kind == Kind::enumeration;
        const Type& of = fits ? type : named("INT");
        line(fmt::format("CASE {} OF", varying(of, 2)));
        Wide next = of.base ? of.lower : of.is_signed ? -2 : 0;
        const Wide last = of.base ? of.upper : 120;
        for (std::size_t i = 0; i < 1 + below(4) && next < last; ++i) {
            if (of.kind == Kind::enumeration) {
                if (i >= of.values.size()) break;
                line(fmt::format("{}#{}:", of.name, of.values[i]));
            } else if (below(3) == 2 && next + 4 < last) {
                line(fmt::format("{}..{}, {}:", digits(next), digits(next + 2), digits(next + 4)));
                next += 5;
            } else {
                line(fmt::format("{}:", digits(next)));
                next += static_cast<Wide>(1 + below(3));
            }
            statements(1);
        }
        if (below(2) == 1) {
            line("ELSE");
            statements(1);
        }
        line("END_CASE;");
    }

    /// An own counter of the loop, which nothing else writes.
    std::string new_counter(const Type& type) {
        counters_.push_back({new_name("i"), &type, false});
        return counters_.back().name;
    }

    void body(std::size_t count) {
        ++loops_;
        statements(count);
        --loops_;
    }

    void write_for() {
        const char* const types[] = {"INT",   "DINT",  "SINT", "LINT",
                                     "USINT", "UDINT", "UINT", "ULINT"};
        const Type& type = named(types[below(8)]);
        const std::string counter = new_counter(type);
        const std::size_t passes = below(5);
        std::size_t from = below(10);
        if (below(8) == 7)
            from = (std::size_t{1} << (type.bits - (type.is_signed ? 1 : 0) - (type.bits == 64))) -
                   1 - passes;
        const bool down = type.is_signed && below(3) == 2;
        std::string limit = down ? std::to_string(static_cast<std::int64_t>(from) -
                                                  static_cast<std::int64_t>(passes))
                                 : std::to_string(from + passes);
        if (below(4) == 3 && !down) limit = fmt::format("MIN({}, {})", varying(type, 2), limit);
        const std::string step = down            ? " BY -1"
                                 : below(3) == 2 ? fmt::format(" BY {}", 1 + below(3))
                                                 : "";
        line(fmt::format("FOR {} := {} TO {}{} DO", counter, from, limit, step));
        scope_.push_back({counter, &type, false});
        body(1 + below(2));
        scope_.pop_back();
        line("END_FOR;");
    }

    void write_loop() {
        const std::string counter = new_counter(named("INT"));
        const std::string condition = wrapped(expression(named("BOOL"), 2), atom);
        const std::size_t passes = 1 + below(4);
        line(fmt::format("{} := 0;", counter));
        const bool is_while = below(2) == 0;
        line(is_while ? fmt::format("WHILE {} < {} AND {} DO", counter, passes, condition)
                      : std::string("REPEAT"));
        line(fmt::format("  {0} := {0} + 1;", counter));
        body(1 + below(2));
        line(is_while
                 ? "END_WHILE;"
                 : fmt::format("UNTIL {} >= {} OR {} END_REPEAT;", counter, passes, condition));
    }

    // Declarations.

    void section(std::string_view keyword, const std::vector<Variable>& variables,
                 bool with_initial) {
        if (variables.empty()) return;
        line(keyword);
        for (const Variable& v : variables)
            line(fmt::format("  {} : {}{};", v.name, written_type(*v.type),
                             v.constant     ? " := " + literal(*v.type).text
                             : with_initial ? initial(*v.type)
                                            : ""));
        line("END_VAR");
    }

    std::vector<Variable> variables(std::string_view stem, std::size_t count, bool writable) {
        std::vector<Variable> made;
        for (; count > 0; --count) made.push_back({new_name(stem), &variable_type(), writable});
        return made;
    }

    const Type& variable_type() {
        if (below(6) == 5) return array_of(any_type());
        return any_type();
    }

    void enter(const auto&... lists) {
        (scope_.insert(scope_.end(), lists.begin(), lists.end()), ...);
    }

    void declare_globals() {
        line("VAR_GLOBAL depth_of_calls : INT; END_VAR");
        if (below(4) == 3) {
            auto made = variables("g", 1 + below(3), true);
            section("VAR_GLOBAL", made, true);
            for (Variable& v : made) v.global = true;
            globals_ = made;
        }
        if (has_bytes()) declare_addresses();
        if (below(4) != 3) return;
        Type& type = add_type(Kind::structure, "DB");
        auto made = variables("d", 1 + below(3), true);
        line(fmt::format("DATA_BLOCK {}", type.name));
        section("VAR", made, true);
        line("BEGIN");
        line("END_DATA_BLOCK");
        for (const Variable& v : made) type.parts.push_back({v.name, v.type});
        globals_.push_back({type.name, &type, true, true});
    }

    /// Variables of whole numbers in the first bytes of each area, which cross as it happens, and
    /// addresses without a name.
    void declare_addresses() {
        const auto address = [&](int bits) {
            const char letter = bits == 1    ? 'X'
                                : bits == 8  ? 'B'
                                : bits == 16 ? 'W'
                                : bits == 32 ? 'D'
                                             : 'L';
            std::string text = fmt::format("%{}{}{}", "MQI"[below(3)], letter, below(12));
            if (bits == 1) text += fmt::format(".{}", below(8));
            return text;
        };
        for (std::size_t i = below(8) / 2; i > 0; --i) {
            const char* const types[] = {"INT", "WORD", "BOOL", "DINT", "BYTE", "LWORD", "USINT"};
            const Type& type = named(types[below(7)]);
            Variable made{new_name("im"), &type, true, true, false, false};
            const std::string at = address(type.bits);
            if (type.bits > 1 && below(3) == 2) made.type = &array_of(type);
            line(fmt::format("VAR_GLOBAL {} AT {} : {}{}; END_VAR", made.name,
                             made.type == &type ? at : address(8), written_type(*made.type),
                             initial(*made.type)));
            globals_.push_back(made);
        }
        for (std::size_t i = below(8) / 3; i > 0; --i) {
            const char* const types[] = {"WORD", "BYTE", "BOOL", "DWORD", "LWORD"};
            const Type& type = named(types[below(5)]);
            globals_.push_back({address(type.bits), &type, true, true, false, false});
        }
    }

    /// The body is written first, for it makes the counters.
    std::string written_body(std::size_t count, const Callable* recurring = nullptr) {
        std::string before;
        std::swap(out_, before);
        counters_.clear();
        statements(count);
        if (recurring) {
            call_itself(*recurring);
            statements(1 + below(2));
        }
        std::swap(out_, before);
        return before;
    }

    /// What it calls may come back, no deeper than `depth_of_calls`.
    void call_bounded(const auto& calls) {
        ++indent_;
        line("IF depth_of_calls < 4 THEN");
        ++indent_;
        line("depth_of_calls := depth_of_calls + 1;");
        calls();
        line("depth_of_calls := depth_of_calls - 1;");
        --indent_;
        line("END_IF;");
        --indent_;
    }

    void call_itself(const Callable& callable) {
        call_bounded([&] { write_call_of_itself(callable); });
    }

    /// A method gives on what it was given as VAR_IN_OUT.
    void write_call_of_itself(const Callable& callable) {
        if (callable.is_method) {
            std::string given;
            for (const Parameter& p : callable.parameters) {
                if (p.section == Section::output || !can_be_given(*p.type)) continue;
                given += fmt::format(
                    "{}{} := {}", given.empty() ? "" : ", ", p.name,
                    p.section == Section::in_out ? p.name : expression(*p.type, 2).text);
            }
            line(fmt::format("{0} := {1}{0}({2});", callable.name, below(2) == 1 ? "THIS." : "",
                             given));
        } else {
            call(callable, callable.name);
        }
    }

    Parameters parameters(Callable& callable, bool pure) {
        Parameters made;
        made.inputs = variables("a", 1 + below(3), false);
        if (!interfaces_.empty() && below(4) == 3)
            made.inputs.push_back({new_name("a"), choices_.one_of(interfaces_)->type, false});
        if (!pure) {
            made.in_outs = variables("r", below(3), true);
            made.outputs = variables("q", below(3), true);
            if (!blocks_.empty() && below(4) == 3)
                made.in_outs.push_back({new_name("r"), choices_.one_of(blocks_)->type, true});
        }
        note(callable, made);
        return made;
    }

    static void note(Callable& callable, const Parameters& made) {
        for (const Variable& v : made.inputs)
            callable.parameters.push_back({v.name, v.type, Section::input});
        for (const Variable& v : made.in_outs)
            callable.parameters.push_back({v.name, v.type, Section::in_out});
        for (const Variable& v : made.outputs)
            callable.parameters.push_back({v.name, v.type, Section::output});
    }

    void declare(const Parameters& parameters, bool with_initial = true) {
        section("VAR_INPUT", parameters.inputs, with_initial);
        section("VAR_IN_OUT", parameters.in_outs, false);
        section("VAR_OUTPUT", parameters.outputs, with_initial);
    }

    void write_routine(Callable& callable, const std::string& keyword) {
        write_routine(callable, keyword, parameters(callable, callable.pure), true);
    }

    void write_head(const Callable& callable, const std::string& keyword) {
        line(fmt::format("{} {} : {}", keyword, callable.name,
                         callable.result ? written_type(*callable.result) : "Void"));
    }

    void write_routine(const Callable& callable, const std::string& keyword,
                       const Parameters& given, bool with_initial) {
        const auto locals = variables("t", below(callable.is_method ? 2 : 4), true);
        const std::size_t kept = scope_.size();
        enter(given.inputs, given.in_outs, given.outputs, locals);
        if (callable.result) scope_.push_back({callable.name, callable.result});
        has_eno_ = true;
        const bool recurs = !callable.pure && callable.result && below(3) == 2;
        const std::string body =
            written_body(1 + below(callable.is_method ? 2 : 5), recurs ? &callable : nullptr);
        write_head(callable, keyword);
        declare(given, with_initial);
        section("VAR", locals, true);
        section("VAR_TEMP", counters_, false);
        out_ += body;
        scope_.resize(kept);
    }

    // Classes.

    Method new_method(const Type& of) {
        Method made;
        made.call.of = &of;
        made.call.is_method = true;
        made.call.pure = false;
        made.call.result = result_type();
        made.call.name = new_name("Do");
        made.given.inputs = variables("a", 1 + below(4) / 3, false);
        made.given.in_outs = variables("r", below(4) / 3, true);
        made.given.outputs = variables("q", below(4) / 3, true);
        if (!interfaces_.empty() && below(6) == 5)
            made.given.inputs.push_back({new_name("a"), choices_.one_of(interfaces_)->type, false});
        note(made.call, made.given);
        return made;
    }

    static void take_over(Class& derived, Type& type, const Class& base) {
        type.bases.push_back(base.type);
        type.bases.insert(type.bases.end(), base.type->bases.begin(), base.type->bases.end());
        type.parts.insert(type.parts.end(), base.type->parts.begin(), base.type->parts.end());
        for (const Method& method : base.methods) {
            derived.methods.push_back(method);
            derived.methods.back().call.of = &type;
        }
    }

    const Type& property_type() {
        const char* const types[] = {"LREAL", "BOOL", "TIME"};
        return named(types[below(3)]);
    }

    void write_interface() {
        Type& type = add_type(Kind::interface, "Like");
        Class made{&type};
        std::string extends;
        if (!interfaces_.empty() && below(2) == 1) {
            const Class& base = *choices_.one_of(interfaces_);
            take_over(made, type, base);
            extends = " EXTENDS " + base.type->name;
        }
        line("INTERFACE " + type.name + extends);
        for (std::size_t i = 1 + below(2); i > 0; --i) {
            made.methods.push_back(new_method(type));
            write_head(made.methods.back().call, "METHOD");
            declare(made.methods.back().given, false);
            line("END_METHOD");
        }
        if (below(3) == 2) {
            type.parts.push_back({new_name("Prop"), &property_type(), false});
            line(fmt::format("PROPERTY {} : {} GET END_GET SET END_SET END_PROPERTY",
                             type.parts.back().name, type.parts.back().type->name));
            properties_.emplace_back(&type, type.parts.back());
        }
        line("END_INTERFACE");
        for (const Method& method : made.methods) callables_.push_back(method.call);
        classes_.push_back(std::move(made));
        interfaces_.push_back(&classes_.back());
    }

    /// A method that replaces what a base has, or is the first of its name.
    void write_method(Class& of, Method& method, const char* kind, std::string& text) {
        std::string before;
        std::swap(out_, before);
        method.call.is_abstract = of.type->is_abstract && below(3) == 2;
        if (method.call.is_abstract) {
            write_head(method.call, "METHOD PUBLIC ABSTRACT");
            declare(method.given, false);
        } else {
            write_routine(method.call, fmt::format("METHOD PUBLIC {}", kind), method.given, false);
        }
        line("END_METHOD");
        std::swap(out_, before);
        text += before;
    }

    void write_property(Class& of, const Type::Part& property, std::string& text) {
        text += fmt::format("PROPERTY {} : {}\n", property.name, property.type->name);
        for (const bool is_get : {true, false}) {
            const std::size_t kept = scope_.size();
            scope_.push_back({property.name, property.type, is_get});
            has_eno_ = false;
            text += is_get ? "GET\n" : "SET\n";
            const std::string body = written_body(1 + below(2));
            std::string declared, before;
            std::swap(out_, declared);
            section("VAR", counters_, false);
            std::swap(out_, declared);
            text += declared + body + (is_get ? "END_GET\n" : "END_SET\n");
            scope_.resize(kept);
        }
        text += "END_PROPERTY\n";
        properties_.emplace_back(of.type, property);
    }

    /// Its methods call those before them, which may be replaced, and those of the base.
    void write_class() {
        const Class* base = blocks_.empty() || below(4) == 3 ? nullptr : choices_.one_of(blocks_);
        const Class* interface =
            interfaces_.empty() || below(3) == 0 ? nullptr : choices_.one_of(interfaces_);
        if (base && interface && is_derived(*base->type, *interface->type)) interface = nullptr;
        Type& type = add_type(Kind::block, "Unit");
        Class& made = classes_.emplace_back();
        made.type = &type;
        class_ = &made;
        if (base) {
            take_over(made, type, *base);
            made.call = base->call;
            made.given = base->given;
            made.in_outs = base->in_outs;
            made.locals = base->locals;
        }
        type.is_abstract = below(4) == 3;
        made.call.of = &type;
        made.call.pure = false;
        std::vector<Method> inherited;
        std::swap(inherited, made.methods);
        scope_ = globals_;
        Parameters given;
        given.inputs = variables("a", base ? below(2) : 1 + below(2), false);
        given.outputs = variables("q", below(2), true);
        if (!base) given.in_outs = variables("r", below(6) / 4, true);
        note(made.call, given);
        auto locals = variables("s", 1 + below(3), true);
        instances(locals);
        if (!interfaces_.empty() && below(2) == 1)
            locals.push_back({new_name("link"), choices_.one_of(interfaces_)->type, true});
        for (const auto* list : {&given.inputs, &given.outputs})
            made.given.insert(made.given.end(), list->begin(), list->end());
        made.in_outs.insert(made.in_outs.end(), given.in_outs.begin(), given.in_outs.end());
        made.locals.insert(made.locals.end(), locals.begin(), locals.end());
        enter(made.given, made.locals);
        scope_.push_back({"THIS^", &type});
        if (base) scope_.push_back({"SUPER^", base->type, true, false, false, false});
        for (const auto* list : {&given.inputs, &given.outputs, &locals})
            for (const Variable& v : *list)
                type.parts.push_back({v.name, v.type, list == &given.inputs});
        std::string methods;
        const auto add = [&](Method method, const char* kind) {
            method.call.of = &type;
            if (kind) write_method(made, method, kind, methods);
            made.methods.push_back(method);
            callables_.push_back(method.call);
        };
        for (Method& method : inherited) {
            const bool replaces = (method.call.is_abstract && !type.is_abstract) || below(2) == 1;
            add(method, replaces ? "OVERRIDE" : nullptr);
        }
        if (interface) write_promised(type, made, *interface, add, methods);
        for (std::size_t i = below(base ? 2 : 3); i > 0; --i) add(new_method(type), "");
        if (below(3) == 2) {
            const Type::Part property{new_name("Prop"), &property_type(), false};
            write_property(made, property, methods);
            type.parts.push_back(property);
        }
        enter(made.in_outs);
        has_eno_ = true;
        const std::string body = written_body(1 + below(2));
        line(fmt::format("FUNCTION_BLOCK {}{}{}{}", type.is_abstract ? "ABSTRACT " : "", type.name,
                         base ? " EXTENDS " + base->type->name : "",
                         interface ? " IMPLEMENTS " + interface->type->name : ""));
        declare(given);
        section("VAR", locals, true);
        section("VAR_TEMP", counters_, false);
        out_ += body + methods;
        line("END_FUNCTION_BLOCK");
        class_ = nullptr;
        blocks_.push_back(&made);
        callables_.push_back(made.call);
        if (!type.is_abstract) own_.push_back(&type);
    }

    /// What the interface asks for and no base has.
    void write_promised(Type& type, Class& made, const Class& interface, const auto& add,
                        std::string& text) {
        type.bases.push_back(interface.type);
        type.bases.insert(type.bases.end(), interface.type->bases.begin(),
                          interface.type->bases.end());
        for (const Method& method : interface.methods)
            if (std::ranges::none_of(made.methods, [&](const Method& known) {
                    return known.call.name == method.call.name;
                }))
                add(method, "");
        for (const Type::Part& property : interface.type->parts)
            if (std::ranges::none_of(type.parts, [&](const Type::Part& known) {
                    return known.name == property.name;
                })) {
                write_property(made, property, text);
                type.parts.push_back(property);
            }
    }

    const Type* result_type() { return below(6) == 5 ? nullptr : &any_type(); }

    void write_function() {
        Callable callable;
        callable.pure = below(3) != 2;
        callable.result = callable.pure ? &any_type() : result_type();
        callable.name = new_name("Fun");
        scope_ = callable.pure ? std::vector<Variable>() : globals_;
        write_routine(callable, "FUNCTION");
        line("END_FUNCTION");
        callables_.push_back(std::move(callable));
    }

    void write_block() {
        Type& type = add_type(Kind::block, "Unit");
        Callable call;
        call.of = &type;
        call.pure = false;
        scope_ = globals_;
        const Parameters given = parameters(call, false);
        auto locals = variables("s", 1 + below(4), true);
        const auto temps = variables("t", below(3), true);
        instances(locals);
        // A method may run before any call has given the references, which is a fault.
        enter(given.inputs, given.outputs, locals);
        const bool risky = below(4) == 3;
        if (risky) enter(given.in_outs);
        std::string methods;
        std::vector<Callable> made;
        for (std::size_t i = below(3); i > 0; --i) made.push_back(write_method(type, methods));
        if (!risky) enter(given.in_outs);
        enter(temps);
        has_eno_ = true;
        const std::string body = written_body(2 + below(5));
        line("FUNCTION_BLOCK " + type.name);
        declare(given);
        section("VAR", locals, true);
        section("VAR_TEMP", temps, true);
        section("VAR_TEMP", counters_, false);
        out_ += body + methods;
        line("END_FUNCTION_BLOCK");
        for (const Variable& v : given.inputs) type.parts.push_back({v.name, v.type, true});
        for (const Variable& v : given.outputs) type.parts.push_back({v.name, v.type, false});
        for (const Variable& v : locals) type.parts.push_back({v.name, v.type, false});
        own_.push_back(&type);
        callables_.push_back(std::move(call));
        std::ranges::move(made, std::back_inserter(callables_));
    }

    Callable write_method(const Type& of, std::string& text) {
        Callable method;
        method.of = &of;
        method.is_method = true;
        method.pure = false;
        method.result = result_type();
        method.name = new_name("Do");
        std::string before;
        std::swap(out_, before);
        write_routine(method, "METHOD PUBLIC");
        line("END_METHOD");
        std::swap(out_, before);
        text += before;
        return method;
    }

    void instances(std::vector<Variable>& locals) {
        for (std::size_t i = below(3) + (subject_ > 1 && !own_.empty()); i > 0; --i) {
            const Type* type = choices_.one_of(standard_);
            if (!own_.empty() && below(subject_ > 1 ? 4 : 2) != 0) type = choices_.one_of(own_);
            if (below(5) == 4) type = &array_of(*type);
            locals.push_back({new_name("fb"), type});
        }
    }

    /// Statements that give references variables that are in scope; what they refer to is in scope
    /// from then on, too.
    std::string references(std::string& declared) {
        std::string bound;
        for (std::size_t i = below(6) / 2; i > 0; --i) {
            const Type& type = any_type();
            const auto target = type.name.empty() ? std::nullopt : place(type, Use::place);
            const std::string_view letters = target ? std::string_view(*target) : "";
            const auto first = letters.find_first_not_of('#');
            const bool is_part_of_standard_block =
                first != letters.npos && same_letters(letters.substr(first, 2), "fb");
            if (!target || is_part_of_standard_block) continue;
            const std::string name = new_name("r");
            const std::size_t how = below(3);
            const char* const words[] = {"REFERENCE TO", "REF_TO", "POINTER TO"};
            const char* const given[] = {"{} REF= {};\n", "{} := REF({});\n", "{} := ADR({});\n"};
            declared += fmt::format("VAR {} : {} {}; END_VAR\n", name, words[how], type.name);
            bound += fmt::format(fmt::runtime(given[how]), name, *target);
            scope_.push_back({how == 0 ? name : name + "^", &type});
        }
        for (const Class* one : blocks_) {
            const auto target = below(3) == 2 ? instance(*one->type) : std::nullopt;
            if (!target) continue;
            const std::string name = new_name("r");
            declared += fmt::format("VAR {} : REFERENCE TO {}; END_VAR\n", name, one->type->name);
            bound += fmt::format("{} REF= {};\n", name, *target);
            scope_.push_back({name, one->type});
        }
        for (const Class* one : interfaces_) {
            const std::string name = new_name("i");
            declared += fmt::format("VAR {} : {}; END_VAR\n", name, one->type->name);
            if (below(8) != 7)
                bound += fmt::format("{} := {};\n", name, expression(*one->type, 1).text);
            scope_.push_back({name, one->type});
        }
        for (std::size_t i = has_bytes() ? 1 + below(4) : 0; i > 0; --i)
            bound += see_bytes(declared);
        return bound;
    }

    /// A pointer into a variable, or a second view of it: `p^`, `p[2]`, `view` are in scope then.
    std::string see_bytes(std::string& declared) {
        const auto seen = variable_of_bytes();
        if (!seen) return {};
        const char* const types[] = {"BYTE", "INT", "WORD", "DINT", "USINT", "LWORD"};
        const Type* type = &named(types[below(6)]);
        const Type* element = seen->type;
        while (element->kind == Kind::array) element = element->element;
        if (below(2) == 0 && is_whole(*element)) type = element;
        const std::size_t room = whole_bytes(*seen->type),
                          step = static_cast<std::size_t>(type->bits / 8);
        if (room < step) return {};
        if (below(4) == 3 && !seen->global && !seen->name.starts_with('r')) {
            Type& view = array_of(*type);
            view.ranges = {{0, static_cast<std::int64_t>(room / step) - 1}};
            const std::string name = new_name("view");
            declared +=
                fmt::format("VAR {} AT {} : {}; END_VAR\n", name, seen->name, written_type(view));
            scope_.push_back({name, &view, true, false, false, false});
            return {};
        }
        const std::string name = new_name("p");
        std::size_t shift = below(room - step + 1);
        if (type == element) shift -= shift % step;
        declared += fmt::format("VAR {} : POINTER TO {}; END_VAR\n", name, type->name);
        scope_.push_back({name + "^", type, true, false, false, false});
        for (int i = 0; i < 3; ++i) {
            const std::size_t at = below(room / step);
            scope_.push_back({fmt::format("{}[{}]", name,
                                          static_cast<std::int64_t>(at) -
                                              static_cast<std::int64_t>(shift / step)),
                              type, true, false, false, false});
        }
        walking_.push_back({name, type});
        return fmt::format("{0} := ADR({1});\n{0} := {0} + {2};\n", name, seen->name, shift);
    }

    /// A function that gives where a variable of its call is.
    void write_lender() {
        const Type& type = named(below(2) == 0 ? "BYTE" : "DINT");
        const std::string name = new_name("Lend");
        line(fmt::format("FUNCTION {} : POINTER TO {}", name, type.name));
        line(fmt::format("VAR local : ARRAY[0..3] OF {}; END_VAR", type.name));
        line(fmt::format("{} := ADR(local[{}]);", name, below(4)));
        line("END_FUNCTION");
        lends_[type.name] = name;
    }

    void write_program() {
        scope_ = globals_;
        std::vector<Variable> inputs;
        for (std::size_t i = 1 + below(4); i > 0; --i)
            inputs.push_back(
                {new_name("in"), &elementaries()[below(elementaries().size())], false});
        for (std::size_t i = below(3); i > 0; --i)
            constants_.push_back({new_name("c"), &any_scalar(), false, false, true});
        auto locals = variables("x", 2 + below(10), true);
        instances(locals);
        const auto temps = variables("t", below(3), true);
        enter(inputs, locals, temps);
        has_eno_ = false;
        std::string declared;
        const std::string bound = references(declared);
        const std::string body = bound + "depth_of_calls := 0;\n" + written_body(below(20));
        line("PROGRAM Main");
        section("VAR_INPUT", inputs, false);
        section("VAR CONSTANT", constants_, false);
        section("VAR", locals, true);
        section("VAR_TEMP", temps, true);
        section("VAR", counters_, false);
        out_ += declared + body;
        line("END_PROGRAM");
    }

    Choices& choices_;
    std::string out_;
    int names_ = 0, indent_ = 0, nesting_ = 0, loops_ = 0, index_depth_ = 0, reads_ = 0;
    bool has_eno_ = false;
    Pointers pointers_;
    const Class* class_ = nullptr;  ///< that is being written
    std::size_t subject_ = 0;       ///< 1: UNION, pointers, addresses; 2: classes; 3: both
    std::deque<Type> types_;
    std::vector<const Type*> scalars_, texts_, aggregates_, standard_, own_;
    std::vector<std::pair<const Type*, const Type*>> flags_;  ///< and bit strings of as many bits
    std::deque<Callable> callables_;
    std::vector<Variable> globals_, scope_, counters_, constants_;
    std::deque<Class> classes_;
    std::vector<const Class*> interfaces_, blocks_;
    std::vector<std::pair<const Type*, Type::Part>> properties_;  ///< and what has them
    std::vector<Variable> walking_;             ///< pointers, and what they are to
    std::map<std::string, std::string> lends_;  ///< functions that give a pointer to such a type
};

}  // namespace

std::string random_source(Choices& choices, Pointers pointers) {
    return SourceMaker(choices, pointers).make();
}

std::string random_constant(Choices& choices, std::string_view type) {
    return SourceMaker(choices, Pointers::tame).make_constant(type);
}

}  // namespace lineshaft::test
