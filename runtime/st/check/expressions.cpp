#include <algorithm>
#include <cmath>

#include "runtime/source/letters.hpp"
#include "runtime/source/units.hpp"
#include "runtime/source/utf8.hpp"
#include "runtime/st/check/checker_class.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft::st {

bool is_constant(const Expression& expression) {
    return expression.kind == Expression::Kind::constant && expression.type;
}

double as_real(const Expression& constant) {
    return constant.type->is_real() ? constant.constant.real
                                    : static_cast<double>(constant.constant.integer);
}

bool is_scl(const Expression& e) {
    return is_scl(e.place);
}

namespace {

using Kind = Type::Kind;

bool is_single(const Type& type) {
    return type.kind == Kind::real && type.bits == 32;
}

bool is_comparison(Word op) {
    return op >= Word::less && op <= Word::unequal;
}

bool is_logic(Word op) {
    return op == Word::and_ || op == Word::or_ || op == Word::xor_ || op == Word::and_then_ ||
           op == Word::or_else_;
}

}  // namespace

std::string describe(const Type& type) {
    if (type.kind != Kind::array || !type.name.empty()) return type.name;
    std::string bounds;
    const Type* element = &type;
    for (; element && element->kind == Kind::array && element->name.empty();
         element = element->element)
        bounds +=
            fmt::format("{}{}..{}", bounds.empty() ? "" : ", ", element->lower, element->upper);
    return fmt::format("ARRAY[{}] OF {}", bounds, element ? describe(*element) : "?");
}

const Type* Checker::check(Expression& e, const Type* expected) {
    using E = Expression::Kind;
    if (e.type) return e.type;
    const Type* type = nullptr;
    switch (e.kind) {
        case E::constant:
            type = check_constant(e, expected);
            break;
        case E::name:
            type = check_name(e, expected);
            break;
        case E::member:
            type = check_member(e);
            break;
        case E::index:
            type = check_index(e);
            break;
        case E::bit:
            type = check_bit(e);
            break;
        case E::call:
            type = check_call(e, false, expected);
            break;
        case E::unary:
            type = check_unary(e, expected);
            break;
        case E::binary:
            type = check_binary(e, expected);
            break;
        case E::typed:
            type = check_typed(e);
            break;
        case E::list:
        case E::repeated:
            return fail(
                "L0905", e.place, "a list of values stands in a declaration only",
                "declare a variable that begins with it, or assign the elements one by one");
        case E::converted:
            type = e.type;
    }
    return e.type = type;
}

// Literals.

const Type* Checker::check_constant(Expression& e, const Type*) {
    switch (e.token.word) {
        case Word::integer:
        case Word::real:
            return check_number(e);
        case Word::duration:
            return check_time(e);
        case Word::text:
            return check_text(e);
        default:
            return nullptr;
    }
}

const Type* Checker::check_number(Expression& e) {
    const std::string_view text = e.token.text;
    if (e.token.word == Word::real) {
        const auto value = read_real(text);
        if (!value) return fail("L0908", e.place, fmt::format("'{}' is out of range", text));
        e.constant.real = *value;
        return &any_real_type;
    }
    const auto value = read_integer(text);
    if (!value)
        return fail("L0908", e.place, fmt::format("'{}' is not a number of at most 64 bits", text),
                    "write 100, 1_000, 16#FF, 8#17 or 2#1010");
    e.constant.integer = *value;
    return text.find('#') == std::string_view::npos ? &any_integer_type : &any_bits_type;
}

const Type* Checker::check_time(Expression& e) {
    const std::string_view prefix = e.place.text().substr(0, e.place.text().find('#'));
    if (const Type* type = find_prefix(prefix); type && type->is_date()) {
        const auto value = read_time(e.token.text, type->kind);
        if (!value)
            return fail("L0908", e.place,
                        fmt::format("'{}' is not a {}", e.place.text(), type->name),
                        "write D#2020-02-29, TOD#12:30:15.25 or DT#2020-02-29-12:30:15");
        e.constant.integer = *value;
        return type;
    }
    if (same_name(prefix, "dtl")) return check_dtl(e);
    const auto value = read_duration(e.token.text);
    if (!value)
        return fail("L0908", e.place, fmt::format("'{}' is not a time", e.place.text()),
                    "write T#1h2m3.5s, with d, h, m, s, ms, us and ns in this order");
    e.constant.integer = *value;
    return &time_type;
}

std::optional<Wide> Checker::read_dtl(const Expression& e) {
    const auto value = read_moment(e.token.text);
    if (!value)
        fail("L0908", e.place, fmt::format("'{}' is not a DTL", e.place.text()),
             "write DTL#2020-02-29-12:30:15.25");
    return value;
}

const Type* Checker::check_dtl(Expression& e) {
    const auto value = read_dtl(e);
    if (!value) return nullptr;
    Expression* moment = make(Expression::Kind::constant, e);
    become(*moment, moment_type, {.integer = *value});
    e = *make_call("LDT_TO_DTL", moment);
    return check(e);
}

/// Of a function of the standard's own sources.
Expression* Checker::make_call(std::string_view function, Expression* argument) {
    Expression* call = make(Expression::Kind::call, *argument);
    call->operands[0] = make(Expression::Kind::name, *argument);
    call->operands[0]->token.text = function;
    call->arguments.push_back({.value = argument});
    return call;
}

const Type* Checker::check_text(Expression& e) {
    const auto text = read_text(e.token.text);
    if (!text)
        return fail("L0908", e.place, "'$' is not followed by one of its characters",
                    "write $$ for a '$', $' for a quote, $N for a new line, $0A for a byte");
    if (static_cast<Wide>(text->size()) > longest_text)
        return fail("L0908", e.place, fmt::format("the text has {} bytes", text->size()),
                    "a text has at most 32767 bytes");
    e.constant.text = *text;
    return &string_type;
}

const Type* Checker::check_typed(Expression& e) {
    Expression& value = *e.operands[0];
    Token name = e.token;
    const Type* type = find_prefix(name.text);
    if (const NamedType* named = look_up(&Names::types, name)) type = named->type;
    if (!type) {
        if (resolve_name(name))
            fail("L0904", name.place, fmt::format("'{}' is not a type of values", name.text),
                 "write a type, as in INT#5");
        return nullptr;
    }
    if (type->kind == Kind::enumeration && value.kind == Expression::Kind::name)
        return check_value(e, *type, value.token);
    if (!check(value, type)) return nullptr;
    Expression* literal = &value;
    if (!coerce(literal, *type)) return nullptr;
    if (!is_constant(*literal))
        return fail("L0913", value.place, fmt::format("a number is due after '{}#'", name.text));
    become(e, *type, literal->constant);
    return type;
}

void Checker::become(Expression& e, const Type& type, Constant value) {
    e.kind = Expression::Kind::constant;
    e.type = &type;
    e.constant = std::move(value);
}

void Checker::become_boolean(Expression& e, bool value) {
    become(e, bool_type, {.integer = value});
}

// Names.

Variable* Checker::find_variable(const Token& token) {
    for (const Routine* r = routine_; r && !token.quoted; r = r->owner)
        if (const auto it = r->names.find(token.text); it != r->names.end()) return it->second;
    if (token.local) return nullptr;
    if (!is_standards(token)) {
        if (const auto it = globals_.find(token.text); it != globals_.end()) return it->second;
        if (Variable* constant = declare_early(token.text)) return constant;
    }
    return token.quoted && routine_ && routine_->names.contains(token.text)
               ? routine_->names.at(token.text)
               : nullptr;
}

const Type* Checker::check_name(Expression& e, const Type* expected) {
    const Token& token = e.token;
    if (expected && expected->kind == Kind::enumeration && !token.local) {
        const auto it = std::ranges::find_if(expected->values, [&](const std::string& known) {
            return same_name(known, token.text);
        });
        if (it != expected->values.end() && !find_variable(token)) {
            become(e, *expected, {.integer = it - expected->values.begin()});
            return expected;
        }
    }
    if (Variable* variable = find_variable(token))
        return variable->edge ? use_edge(e, *variable) : use(e, *variable);
    if (same_name(token.text, "true") || same_name(token.text, "false")) {
        become_boolean(e, same_name(token.text, "true"));
        return &bool_type;
    }
    if (const NamedValue* value = token.local ? nullptr : look_up(&Names::values, token)) {
        if (value->ambiguous)
            return fail("L0904", e.place,
                        fmt::format("'{}' is a value of several enumerations", token.text),
                        fmt::format("write {}#{}", value->type->name, token.text));
        become(e, *value->type, {.integer = static_cast<Wide>(value->index)});
        return value->type;
    }
    if (same_name(token.text, "eno") && routine_ && routine_->pou->kind != PouKind::data_block)
        return use(e, eno_of(*routine_));
    if (expected && expected->kind == Kind::handle && !token.local &&
        (token.quoted || !is_in_test()))
        return use_object(e, *object_type(*expected));
    return unknown_name(e);
}

const Type* Checker::use(Expression& e, Variable& variable) {
    variable.used = true;
    e.variable = &variable;
    if (!variable.type) return nullptr;
    if (variable.space == Space::constant) {
        become(e, *variable.type, variable.value);
        return variable.type;
    }
    if (variable.space == Space::global) depend(variable.type, e.place);
    if (routine_ && variable.type->is_object()) routine_->objects.push_back(variable.global);
    return variable.type;
}

// Technology objects, as Siemens has them: blocks of the program that sources name, `"Axis_1"`.

const Type* Checker::use_object(Expression& e, const Type& type) {
    Variable& variable = checked_.variables.emplace_back();
    variable.name = e.token;
    variable.text = e.token.text;
    variable.type = &type;
    declare_object(variable);
    return use(e, variable);
}

const Type* Checker::object_type(const Type& handle) {
    return standard_type(handle.standard->name);
}

/// `"Axis_1".Position`, where nothing else is called so.
bool Checker::is_object_of(const Expression& member) {
    const Expression& of = *member.operands[0];
    if (of.kind != Expression::Kind::name || of.type || !of.token.quoted) return false;
    if (find_variable(of.token) || find_routine(of.token)) return false;
    const Type* axis = standard_type("axis_ref");
    if (!axis || enumeration_of(member)) return false;
    return find_part(*axis, member.token.text) ||
           std::ranges::any_of(object_type(*axis)->members, [&](const Variable* field) {
               return same_name(field->text, member.token.text);
           });
}

/// What its kind says in Structured Text.
Routine* Checker::find_part(const Type& type, std::string_view name) {
    if (type.kind != Kind::handle && !type.is_object()) return nullptr;
    const auto it = standards_.routines.find(fmt::format("{}.{}", type.standard->handle, name));
    return it == standards_.routines.end() ? nullptr : it->second;
}

/// The function is called with what stands before the point.
const Type* Checker::check_part(Expression& member, Routine& part) {
    Expression* callee = make(Expression::Kind::name, member);
    callee->token = member.token;
    Expression call = *make(Expression::Kind::call, member);
    call.token = member.token;
    call.operands[0] = callee;
    call.arguments.push_back({.value = member.operands[0]});
    member = call;
    return check_routine_call(member, part, false);
}

const Type* Checker::unknown_name(Expression& e) {
    const std::string_view name = e.token.text;
    if (const Routine* routine = find_routine(e.token)) {
        if (routine->type)
            return fail("L0914", e.place, fmt::format("'{}' is a block, and has no value", name),
                        "declare an instance in VAR, and name that");
        return routine == routine_
                   ? fail("L0914", e.place, fmt::format("the function '{}' has no value", name),
                          fmt::format("declare of which type: FUNCTION {} : INT", name))
                   : fail("L0914", e.place, fmt::format("'{}' is a function", name),
                          fmt::format("call it: {}()", name));
    }
    return undeclared(e.token, e.place, visible_names());
}

/// Told once in a block, unless it may be declared in what was not understood.
const Type* Checker::undeclared(const Token& name, Place place,
                                const std::vector<std::string>& names) {
    if (tree_.lost.contains(name.text) || !undeclared_[routine_].insert(name.text).second)
        return nullptr;
    const auto near = nearest(name.text, names);
    const auto in_name = [](char c) { return is_letter(c) || is_digit(c) || !is_ascii(c); };
    const bool is_text = name.quoted && (!std::ranges::all_of(name.text, in_name) ||
                                         (near.empty() && !is_scl(place)));
    return fail("L0904", place, fmt::format("'{}' is not declared", name.text),
                is_text ? "a text stands in '...', a name in \"...\"" : suggest(name.text, near));
}

std::vector<std::string> Checker::visible_names() const {
    std::vector<std::string> names;
    for (const Routine* r = routine_; r; r = r->owner)
        for (const Variable& variable : r->variables) names.emplace_back(variable.text);
    for (const auto& [name, variable] : globals_) names.emplace_back(name);
    for (const auto& [name, value] : users_.values) names.emplace_back(name);
    for (const auto& [name, routine] : users_.routines)
        if (!routine->type) names.emplace_back(name);
    std::ranges::sort(names);
    return names;
}

std::string_view standard_name(const Type& type, std::string_view name) {
    constexpr std::pair<std::string_view, std::string_view> others[] = {
        {"reset", "r"},    {"load", "ld"},         {"set1", "s1"}, {"set", "s"}, {"reset1", "r1"},
        {"busy", "valid"}, {"mode", "homingmode"}, {"qu", "q"},    {"qd", "q"}};
    if (type.kind != Kind::standard) return name;
    const auto has = [&](std::string_view known) {
        return std::ranges::any_of(type.members,
                                   [&](const Variable* m) { return same_name(m->text, known); });
    };
    const auto* it = std::ranges::find_if(
        others, [&](const auto& other) { return same_name(other.first, name); });
    return !has(name) && it != std::end(others) && has(it->second) ? it->second : name;
}

/// The enumeration of `Colour.red`; null if this is none.
const Type* Checker::enumeration_of(const Expression& member) {
    const Expression& of = *member.operands[0];
    if (of.kind != Expression::Kind::name || of.token.local) return nullptr;
    const Variable* variable = find_variable(of.token);
    if (variable && !(variable->type && variable->type->is_scalar())) return nullptr;
    const NamedType* named = look_up(&Names::types, of.token);
    const Type* type = named ? named->type : nullptr;
    return type && type->kind == Kind::enumeration ? type : nullptr;
}

/// The value of that name.
const Type* Checker::check_value(Expression& e, const Type& enumeration, const Token& name) {
    const auto found = std::ranges::find_if(
        enumeration.values, [&](const std::string& known) { return same_name(known, name.text); });
    if (found == enumeration.values.end())
        return fail("L0904", name.place,
                    fmt::format("{} has no value '{}'", enumeration.name, name.text),
                    suggest(name.text, enumeration.values));
    become(e, enumeration, {.integer = found - enumeration.values.begin()});
    return &enumeration;
}

const Type* Checker::check_member(Expression& e) {
    if (const Type* enumeration = enumeration_of(e)) return check_value(e, *enumeration, e.token);
    if (is_object_of(e)) use_object(*e.operands[0], *object_type(*standard_type("axis_ref")));
    const Type* type = check(*e.operands[0]);
    if (!type) return nullptr;
    if (Routine* part = find_part(*type, e.token.text)) return check_part(e, *part);
    if (type->kind == Kind::handle) {
        type = object_type(*type);
        convert(e.operands[0], *type);
    }
    const std::string_view name = standard_name(*type, e.token.text);
    if (type->kind == Kind::block) {
        Routine& routine = *type->routine;
        for (Variable& variable : routine.variables) {
            if (!same_name(variable.text, name)) continue;
            if (variable.space == Space::constant && is_in_test()) {
                become(e, *variable.type, variable.value);
                return variable.type;
            }
            if (variable.section == Section::temp || variable.space == Space::constant)
                return fail("L0904", e.token.place,
                            fmt::format("'{}' of {} is not seen from outside", name, type->name),
                            "make it a VAR_OUTPUT");
            variable.used = true;
            e.variable = &variable;
            return variable.type;
        }
    }
    for (Variable* member : type->members) {
        if (!same_name(member->text, name)) continue;
        e.variable = member;
        return member->type;
    }
    if (type->kind == Kind::array && same_name(name, "this")) {  // "Recipes".THIS[1]
        e = Expression(*e.operands[0]);
        return type;
    }
    std::vector<std::string> names;
    if (type->kind == Kind::block)
        for (const Variable& variable : type->routine->variables) names.emplace_back(variable.text);
    for (const Variable* member : type->members) names.emplace_back(member->text);
    if (names.empty())
        return fail("L0905", e.token.place, fmt::format("{} has no parts", describe(*type)),
                    "'.' takes a part of a structure or of an instance");
    if (type->is_object())
        for (const auto& [routine, part] : standards_.routines)
            if (routine.starts_with(std::string(type->standard->handle) + '.'))
                names.emplace_back(routine.substr(type->standard->handle.size() + 1));
    std::ranges::sort(names);
    return fail("L0904", e.token.place, fmt::format("{} has no '{}'", describe(*type), name),
                suggest(name, names));
}

const Type* Checker::check_index(Expression& e) {
    const Type* type = check(*e.operands[0]);
    for (Argument& argument : e.arguments) check(*argument.value);
    for (Argument& argument : e.arguments) {
        if (!type) return nullptr;
        const bool of_text = type->kind == Kind::text;
        if (type->kind != Kind::array && !of_text)
            return fail("L0905", argument.value->place,
                        fmt::format("{} has no elements", describe(*type)),
                        e.arguments.size() > 1 ? "there are more indices than dimensions" : "");
        const Type* given = argument.value->type;
        if (!given) return nullptr;
        if (!given->is_integer() && !given->is_bits())
            return fail("L0905", argument.value->place,
                        fmt::format("an index is a whole number, not {}", describe(*given)));
        const Wide value = argument.value->constant.integer;
        if (is_constant(*argument.value)) {
            const Wide lower = of_text ? 1 : type->lower,
                       upper = of_text ? type->length : type->upper;
            if (value < lower || value > upper)
                return fail("L0908", argument.value->place,
                            fmt::format("there is no element {}", to_string(value)),
                            fmt::format("the index goes from {} to {}", to_string(lower),
                                        to_string(upper)));
            argument.value->type = &lint_type;
        }
        type = of_text ? &char_type : type->element;
    }
    return type;
}

const Type* Checker::check_bit(Expression& e) {
    const Type* type = check(*e.operands[0]);
    if (!type) return nullptr;
    std::string_view text = e.token.text;
    int bits = 1;
    if (e.token.word == Word::direct) {
        const char letter = text.size() > 1 ? text[1] : '\0';
        const bool has_letter = letter < '0' || letter > '9';
        bits = !has_letter || letter == 'X' || letter == 'x' ? 1
               : letter == 'B' || letter == 'b'              ? 8
               : letter == 'W' || letter == 'w'              ? 16
               : letter == 'D' || letter == 'd'              ? 32
                                                             : 0;
        text.remove_prefix(std::min<std::size_t>(has_letter ? 2 : 1, text.size()));
    }
    const auto number = read_integer(text);
    if (!number || bits == 0)
        return fail("L0902", e.token.place, fmt::format("'{}' is not a bit", e.token.text),
                    "write .%X0 for a bit, .%B0 for a byte, .%W0 for a word");
    const bool whole = type->kind == Kind::bits || type->kind == Kind::integer;
    if (!whole)
        return fail("L0905", e.token.place, fmt::format("{} has no bits", describe(*type)),
                    "bits are those of BYTE to LWORD and of integers");
    if ((*number + 1) * bits > type->bits)
        return fail("L0908", e.token.place,
                    fmt::format("{} has no part '{}'", describe(*type), e.token.text),
                    fmt::format("its {} are 0 to {}",
                                bits == 1    ? "bits"
                                : bits == 8  ? "bytes"
                                : bits == 16 ? "words"
                                             : "double words",
                                type->bits / bits - 1));
    const Expression& part = *e.operands[0];
    const bool of_part = part.kind == Expression::Kind::bit;
    const Wide first = *number * bits + (of_part ? part.bits.first : 0);
    e.bits = {static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(bits)};
    if (of_part) e.operands[0] = part.operands[0];
    return bits == 1 ? &bool_type : &bits_type(bits);
}

// Operators.

const Type* Checker::check_unary(Expression& e, const Type* expected) {
    Expression*& operand = e.operands[0];
    const Type* type = check(*operand, expected);
    if (!type) return nullptr;
    reinterpret(e, e.op == Word::not_ ? Kind::integer : Kind::bits, expected);
    if (e.op == Word::not_) take_width(operand, expected);
    type = operand->type;
    const bool fits = e.op == Word::not_ ? type->kind == Kind::boolean || type->is_bits()
                                         : type->is_integer() || type->is_real() ||
                                               type->kind == Kind::time || type->is_bits();
    if (!fits)
        return fail("L0905", e.place,
                    fmt::format("{} does not go with {}", shown(e.op), describe(*type)),
                    e.op == Word::not_ ? "NOT takes a BOOL or a bit string" : "");
    if (e.op == Word::not_ && type->kind == Kind::any_bits)
        return fail("L0905", e.place, "the width of this number is not known",
                    "write its type: NOT WORD#16#FF");
    e.type = &type->plain();
    if (type->kind == Kind::any_bits) e.type = &any_integer_type;
    if (is_constant(*operand)) fold_unary(e, operand->constant);
    return e.type;
}

void Checker::fold_unary(Expression& e, const Constant& value) {
    const Type& type = *e.type;
    Constant result = value;
    if (e.op == Word::minus) {
        result.real = -value.real;
        result.integer = type.is_any() ? -value.integer : wrapped(type, -value.integer);
    } else if (e.op == Word::not_) {
        result.integer = wrapped(type, ~value.integer);
    }
    become(e, type, result);
}

/// `w AND NOT 16#FF`: the mask is as wide as what it is for.
void Checker::check_masks(Expression& e, const Type* expected) {
    const auto is_mask = [](const Expression& o) {
        return o.kind == Expression::Kind::unary && o.op == Word::not_ &&
               o.operands[0]->kind == Expression::Kind::constant;
    };
    for (const int i : {0, 1}) {
        if (!is_mask(*e.operands[i]) || is_mask(*e.operands[1 - i])) continue;
        const Type* other = check(*e.operands[1 - i]);
        check(*e.operands[i], other && other->kind == Kind::bits ? other : expected);
    }
}

const Type* Checker::check_binary(Expression& e, const Type* expected) {
    Expression *&left = e.operands[0], *&right = e.operands[1];
    const Type* wanted = is_comparison(e.op) || is_logic(e.op) ? nullptr : expected;
    const bool name_first = left->kind == Expression::Kind::name && is_comparison(e.op);
    if (name_first && !find_variable(left->token)) {
        check(*right);
        check(*left, right->type);
    }
    if (is_logic(e.op)) check_masks(e, expected);
    check(*left, wanted);
    check(*right, is_comparison(e.op) ? left->type : wanted);
    if (!left->type || !right->type) return nullptr;
    if (is_logic(e.op)) return check_logic(e);
    if (is_comparison(e.op)) return check_comparison(e);
    if (e.op == Word::power) return check_power(e, expected);
    return check_arithmetic(e, expected);
}

namespace {

/// A constant of another type loses nothing.
bool fits_as_constant(const Expression& e, const Type& to) {
    return is_constant(e) && e.type->is_integer() && to.is_integer() &&
           e.constant.integer >= smallest(to) && e.constant.integer <= largest(to);
}

/// The signed type that holds a constant which `typed` does not, and all of that; null if there is
/// none, or none is needed.
const Type* wider_for(const Expression& constant, const Type& typed) {
    if (constant.type->kind != Kind::any_integer || typed.kind != Kind::integer) return nullptr;
    const Wide value = constant.constant.integer;
    const auto holds = [&](const Type& type) {
        return value >= smallest(type) && value <= largest(type);
    };
    if (holds(typed.plain())) return nullptr;
    for (const Type* wider : {&dint_type, &lint_type})
        if (holds(*wider) && widens(typed, *wider)) return wider;
    return nullptr;
}

}  // namespace

/// Brings both operands to one type, if there is one.
const Type* Checker::unite(Expression& e, const Type* expected) {
    Expression *&left = e.operands[0], *&right = e.operands[1];
    const Type &a = *left->type, &b = *right->type;
    const Type* common = nullptr;
    if (a.is_any() && b.is_any()) {
        common = a.is_real() ? &a : b.is_real() ? &b : &any_integer_type;
        if (a.kind == b.kind) common = &a;
    } else if (a.is_any()) {
        common = b.is_code ? &lint_type : &b.plain();
    } else if (b.is_any()) {
        common = a.is_code ? &lint_type : &a.plain();
    } else {
        common = common_type(a, b);
    }
    const auto real_of = [](const Type& any, const Type& typed) -> const Type* {
        if (any.kind != Kind::any_real || typed.kind != Kind::integer) return nullptr;
        return common_type(typed, real_type);
    };
    if (const Type* real = a.is_any() ? real_of(a, b) : real_of(b, a)) common = real;
    if (const Type* wider = a.is_any() ? wider_for(*left, b) : wider_for(*right, a))
        if (!expected || !expected->is_integer() || widens(*wider, *expected)) common = wider;
    const auto reckons_in = [&](const Type& type, const Expression& constant) {
        return common && expected && expected->is_integer() && !widens(*common, *expected) &&
               widens(type, *expected) && fits_as_constant(constant, type);
    };
    if (reckons_in(a, *right)) common = &a.plain();
    if (reckons_in(b, *left)) common = &b.plain();
    const bool narrows = expected && is_single(*expected) && common == &lreal_type && is_scl(e);
    if (narrows && !same_type(a, lreal_type) && !same_type(b, lreal_type)) common = &real_type;
    if (!common) {
        const bool numbers = a.is_number() && b.is_number();
        return fail(
            numbers ? "L0906" : "L0905", e.token.place,
            fmt::format("{} does not go with {} and {}", shown(e.op), describe(a), describe(b)),
            numbers
                ? fmt::format("convert one of them: {}_TO_{}(...)", a.plain().name, b.plain().name)
            : a.kind == Kind::enumeration || b.kind == Kind::enumeration
                ? "an enumeration's number is TO_INT(...)"
                : "");
    }
    return coerce(left, *common) && coerce(right, *common) ? common : nullptr;
}

/// `16#FF` has that of the bit string that is wanted.
void Checker::take_width(Expression*& e, const Type* expected) {
    if (e->type->kind == Kind::any_bits && expected && expected->kind == Kind::bits)
        coerce(e, *expected);
}

/// A bit string where a number is due.
void Checker::become_number(Expression*& e) {
    const Type& type = e->type->plain();
    if (type.kind == Kind::bits) convert(e, integer_type(type.bits, false));
}

/// Integers are joined as bit strings of their width. It is reckoned with bit strings as with
/// integers: with the wanted one, if that is wider.
void Checker::reinterpret(Expression& e, Kind from, const Type* expected) {
    for (Expression*& operand : e.operands) {
        if (!operand) continue;
        const Type& type = operand->type->plain();
        if (type.kind != from) continue;
        const bool wider =
            expected && expected->kind == Kind::integer && expected->bits > type.bits;
        convert(operand, from == Kind::integer ? bits_type(type.bits)
                         : wider               ? expected->plain()
                                               : integer_type(type.bits, false));
    }
}

const Type* Checker::check_logic(Expression& e) {
    const auto is_truth = [](const Expression* o) { return o->type->kind == Kind::boolean; };
    const bool of_truths = std::ranges::any_of(e.operands, is_truth);
    if (!of_truths) reinterpret(e, Kind::integer);
    const Type &a = *e.operands[0]->type, &b = *e.operands[1]->type;
    for (const Expression* operand : e.operands) {
        const Type& type = *operand->type;
        if (type.kind == Kind::boolean || type.is_bits() || type.kind == Kind::any_integer)
            continue;
        return fail("L0905", operand->place,
                    fmt::format("{} does not go with {}", shown(e.op), describe(type)),
                    type.is_number() ? "compare it first, as in 'x <> 0', or convert it to a WORD"
                                     : "it takes BOOL and bit strings");
    }
    const bool lazy = e.op == Word::and_then_ || e.op == Word::or_else_;
    if (lazy && (a.kind != Kind::boolean || b.kind != Kind::boolean))
        return fail("L0905", e.token.place, fmt::format("{} takes two BOOL", shown(e.op)));
    e.type = unite(e);
    if (e.type) fold(e);
    return e.type;
}

/// Of a CHAR and a STRING one becomes what the other is.
void Checker::unite_texts(Expression*& a, Expression*& b) {
    Expression*& character = a->type->is_character ? a : b;
    Expression*& text = a->type->is_character ? b : a;
    if (!character->type->is_character || text->type->kind != Kind::text) return;
    const bool single = is_constant(*text) && text->constant.text.size() == 1;
    single ? coerce(text, char_type) : coerce(character, string_type);
}

void Checker::become_moments(Expression& e) {
    for (Expression*& operand : e.operands)
        if (is_dtl(*operand->type)) check(*(operand = make_call("DTL_TO_LDT", operand)));
}

const Type* Checker::check_comparison(Expression& e) {
    unite_texts(e.operands[0], e.operands[1]);
    const auto is_kind = [&](Kind kind) {
        return std::ranges::any_of(e.operands,
                                   [&](const Expression* o) { return o->type->kind == kind; });
    };
    if (is_kind(Kind::bits) && is_kind(Kind::integer)) reinterpret(e, Kind::bits);
    if (is_dtl(*e.operands[0]->type) && is_dtl(*e.operands[1]->type)) become_moments(e);
    const Type &a = *e.operands[0]->type, &b = *e.operands[1]->type;
    const bool order = e.op != Word::equal && e.op != Word::unequal;
    if (a.kind == Kind::text && b.kind == Kind::text) return &bool_type;
    if (a.kind == Kind::text || b.kind == Kind::text)
        return fail(
            "L0905", e.token.place,
            fmt::format("'{}' does not go with {} and {}", shown(e.op), describe(a), describe(b)),
            "a STRING is compared with a STRING");
    for (const Type* type : {&a, &b}) {
        const bool fits = type->is_scalar() && !(order && type->kind == Kind::enumeration);
        if (!fits)
            return fail("L0905", e.token.place,
                        fmt::format("'{}' does not compare {}", shown(e.op), describe(*type)),
                        type->is_scalar()
                            ? "the values of an enumeration are equal or not; compare TO_INT(...)"
                            : "compare its parts one by one");
    }
    if (!unite(e)) return nullptr;
    e.type = &bool_type;
    fold(e);
    return e.type;
}

const Type* Checker::check_arithmetic(Expression& e, const Type* expected) {
    if (is_dtl(*e.operands[0]->type) || is_dtl(*e.operands[1]->type))
        return check_dtl_arithmetic(e);
    const Type &a = *e.operands[0]->type, &b = *e.operands[1]->type;
    if (a.is_time() || b.is_time()) return check_time_arithmetic(e);
    reinterpret(e, Kind::bits, expected);
    for (const Expression* operand : e.operands) {
        const Type& type = *operand->type;
        if (type.is_number() || type.is_any()) continue;
        std::string help;
        if (type.kind == Kind::boolean) help = "convert it: BOOL_TO_INT(...)";
        if (type.kind == Kind::enumeration) help = "convert it: TO_INT(...)";
        if (type.kind == Kind::text) help = "join texts with CONCAT(...)";
        return fail("L0905", operand->place,
                    fmt::format("'{}' does not go with {}", shown(e.op), describe(type)), help);
    }
    e.type = unite(e, expected);
    if (e.type && e.type->kind == Kind::any_bits) e.type = &any_integer_type;
    if (e.type && e.op == Word::mod_ && e.type->is_real())
        return fail("L0905", e.token.place, "MOD takes whole numbers",
                    "write a - TRUNC(a / b) * b");
    if (e.type) fold(e);
    return e.type;
}

/// TIME + TIME, TIME * number, TIME / number.
const Type* Checker::check_time_arithmetic(Expression& e) {
    Expression *&left = e.operands[0], *&right = e.operands[1];
    if (left->type->is_date() || right->type->is_date()) return check_date_arithmetic(e);
    const bool both = left->type->kind == Kind::time && right->type->kind == Kind::time;
    const bool adds = e.op == Word::plus || e.op == Word::minus || e.op == Word::mod_;
    Expression*& number = left->type->kind == Kind::time ? right : left;
    const bool scales = !both && number->type->is_number() &&
                        (e.op == Word::times || (e.op == Word::divided && &number == &right));
    if (!(both && adds) && !scales)
        return fail("L0905", e.token.place,
                    fmt::format("'{}' does not go with {} and {}", shown(e.op),
                                describe(*left->type), describe(*right->type)),
                    "times are added and subtracted, and multiplied or divided by a number; "
                    "TIME_TO_LREAL gives a number of ms");
    if (scales) {
        const Type& to = number->type->is_real() ? lreal_type : lint_type;
        const bool is_long = number->type->is_unsigned_64();
        if (!is_long && !coerce(number, to)) return nullptr;
    }
    e.type = &time_type;
    fold(e);
    return e.type;
}

/// DTL + TIME, TIME + DTL, DTL - TIME, and DTL - DTL, a TIME.
const Type* Checker::check_dtl_arithmetic(Expression& e) {
    become_moments(e);
    const Type* type = check_time_arithmetic(e);
    if (!type || type->kind != Kind::moment) return type;
    Expression* moved = make(e.kind, e);
    *moved = e;
    moved->type = type;
    e = *make_call("LDT_TO_DTL", moved);
    return check(e);
}

/// DATE - DATE, TOD - TOD and DT - DT are a TIME; one is added to a TOD and a DT, on either side.
const Type* Checker::check_date_arithmetic(Expression& e) {
    if (e.op == Word::plus && e.operands[0]->type->kind == Kind::time)
        std::swap(e.operands[0], e.operands[1]);
    const Type &a = *e.operands[0]->type, &b = *e.operands[1]->type;
    const bool joins = e.op == Word::plus && a.kind == Kind::date && b.kind == Kind::clock;
    const bool distance = e.op == Word::minus && same_type(a, b);
    const bool moves = (e.op == Word::plus || e.op == Word::minus) && b.kind == Kind::time &&
                       (a.kind == Kind::clock || a.kind == Kind::moment);
    if (!distance && !moves && !joins)
        return fail(
            "L0905", e.token.place,
            fmt::format("'{}' does not go with {} and {}", shown(e.op), describe(a), describe(b)),
            "a TIME is added to a TOD or a DT, and two dates have a TIME between them");
    const bool within_day = moves && a.kind == Kind::clock;
    e.type = distance ? &time_type : joins || within_day ? &moment_type : &a;
    fold(e);
    if (!within_day) return e.type;
    if (!is_constant(e)) return convert_result(e, moment_type, clock_type);
    constexpr Wide day = 86'400'000'000'000;
    become(e, clock_type, {.integer = (e.constant.integer % day + day) % day});
    return &clock_type;
}

const Type* Checker::check_power(Expression& e, const Type* expected) {
    Expression *&left = e.operands[0], *&right = e.operands[1];
    for (Expression*& operand : e.operands) become_number(operand);
    for (Expression* operand : e.operands)
        if (!operand->type->is_number())
            return fail("L0905", operand->place,
                        fmt::format("'**' does not go with {}", describe(*operand->type)));
    const bool whole = is_constant(*left) && is_constant(*right) &&
                       left->type->kind == Kind::any_integer &&
                       right->type->kind == Kind::any_integer && right->constant.integer >= 0;
    if (whole) {
        constexpr Wide most = Wide{1} << 64;
        Wide value = 1;
        for (Wide i = 0; i < right->constant.integer && value < most && value > -most; ++i)
            value = product(value, left->constant.integer);
        if (right->constant.integer <= 64 || left->constant.integer <= 1) {
            if (value >= most || value <= -most)
                return fail("L0908", e.place, "the result is out of range");
            become(e, any_integer_type, {.integer = value});
            return e.type;
        }
    }
    const auto is_narrow = [](const Type& t) { return t.is_any() || t.bits <= 32; };
    const bool wanted =
        (expected && is_single(*expected)) || is_single(*left->type) || is_single(*right->type);
    const bool narrow = wanted && is_narrow(*left->type) && is_narrow(*right->type);
    const Type& type = narrow ? real_type : lreal_type;
    const auto widen = [&](Expression*& operand) {
        if (widens(*operand->type, type) || operand->type->is_any()) return coerce(operand, type);
        convert(operand, type);
        return true;
    };
    return widen(left) && widen(right) ? &type : nullptr;
}

void Checker::fold(Expression& e) {
    if (!is_constant(*e.operands[0]) || !is_constant(*e.operands[1])) return;
    fold_binary(e, e.operands[0]->constant, e.operands[1]->constant);
}

void Checker::fold_binary(Expression& e, const Constant& a, const Constant& b) {
    const Type& operand = *e.operands[0]->type;
    const bool real = operand.is_real() || e.operands[1]->type->is_real();
    const double x = as_real(*e.operands[0]), y = as_real(*e.operands[1]);
    const bool less = real ? x < y : a.integer < b.integer;
    const bool same = real ? x == y : a.integer == b.integer;
    const bool more = real ? x > y : a.integer > b.integer;
    const bool divides = e.op == Word::divided || e.op == Word::mod_;
    if (divides && !real && b.integer == 0) {
        fail("L0908", e.operands[1]->place, "this divides by zero");
        e.type = nullptr;
        return;
    }
    Constant result;
    switch (e.op) {
        case Word::less:
            return become_boolean(e, less);
        case Word::less_or_equal:
            return become_boolean(e, less || same);
        case Word::greater:
            return become_boolean(e, more);
        case Word::greater_or_equal:
            return become_boolean(e, more || same);
        case Word::equal:
            return become_boolean(e, same);
        case Word::unequal:
            return become_boolean(e, !same);
        case Word::and_:
        case Word::and_then_:
            result.integer = a.integer & b.integer;
            break;
        case Word::or_:
        case Word::or_else_:
            result.integer = a.integer | b.integer;
            break;
        case Word::xor_:
            result.integer = a.integer ^ b.integer;
            break;
        case Word::plus:
            result = {a.integer + b.integer, x + y};
            break;
        case Word::minus:
            result = {a.integer - b.integer, x - y};
            break;
        case Word::times:
            result = {product(a.integer, b.integer), x * y};
            break;
        case Word::divided:
            result = {real ? 0 : a.integer / b.integer, x / y};
            break;
        case Word::mod_:
            result.integer = a.integer % b.integer;
            break;
        default:
            return;
    }
    const Type& type = *e.type;
    if (type.kind == Kind::time && real)
        result.integer = static_cast<Wide>(std::nearbyint(result.real));
    if (type.kind == Kind::real && type.bits == 32) result.real = static_cast<float>(result.real);
    if (!type.is_any() && !type.is_real()) result.integer = wrapped(type, result.integer);
    const Wide most = Wide{1} << 64;
    if (type.is_any() && (result.integer >= most || result.integer <= -most)) {
        fail("L0908", e.place, "the result is out of range");
        e.type = nullptr;
        return;
    }
    become(e, type, result);
}

// Conversions.

bool Checker::coerce_constant(Expression& e, const Type& to) {
    const Type& from = *e.type;
    const Wide value = e.constant.integer;
    const bool whole = from.kind == Kind::any_integer || from.kind == Kind::any_bits;
    if (to.is_real() && (whole || from.kind == Kind::any_real)) {
        double real = as_real(e);
        if (to.kind == Kind::real && to.bits == 32) real = static_cast<float>(real);
        if (!std::isfinite(real)) {
            fail("L0908", e.place,
                 fmt::format("'{}' is out of range for {}", e.place.text(), to.name));
            return false;
        }
        become(e, to, {.real = real});
        return true;
    }
    if (!whole) return refuse_conversion(e, to);
    const bool bit = to.kind == Kind::boolean && (value == 0 || value == 1);
    if (to.is_any() || bit) {
        e.type = &to;
        return true;
    }
    if (to.kind != Kind::integer && to.kind != Kind::bits) return refuse_conversion(e, to);
    const Wide pattern = Wide{1} << to.bits;
    const bool is_pattern = from.kind == Kind::any_bits && value < pattern && !to.is_subrange;
    if (!is_pattern && (value < smallest(to) || value > largest(to))) {
        fail("L0908", e.place,
             fmt::format("{} is out of range for {}", to_string(value), describe(to)),
             fmt::format("it goes from {} to {}", to_string(smallest(to)), to_string(largest(to))));
        return false;
    }
    become(e, to, {.integer = is_pattern ? wrapped(to, value) : value});
    return true;
}

/// A bit string stands for an integer of its width or a wider one, and the other way.
bool is_same_pattern(const Type& from, const Type& to) {
    const bool mixes = (from.kind == Kind::bits && to.kind == Kind::integer) ||
                       (from.kind == Kind::integer && to.kind == Kind::bits);
    return mixes && from.bits <= to.bits && !to.is_subrange;
}

/// SCL makes a REAL of a DINT, which loses above 2^24.
bool Checker::rounds(const Expression& e, const Type& to) {
    const Type& from = e.type->plain();
    if (!is_scl(e) || from.kind != Kind::integer || from.bits != 32 || !is_single(to)) return false;
    out_.warn("L0906", e.place.mark(),
              fmt::format("{} does not hold every {}", describe(to), from.name),
              fmt::format("write {}_TO_{}(...) where it is meant", from.name, to.name));
    return true;
}

/// Siemens gives a number where PLCopen has a name: `Direction := 1`.
bool Checker::coerce_number(Expression*& e, const Type& to) {
    if (!is_constant(*e)) {
        convert(e, to);
        return true;
    }
    const Wide number = e->constant.integer;
    const bool exists = number >= 0 && number < static_cast<Wide>(to.of_number.size());
    const std::int64_t value = exists ? to.of_number[static_cast<std::size_t>(number)] : -1;
    if (value < 0) {
        fail("L0908", e->place,
             fmt::format("{} has nothing for the number {}", to.name, to_string(number)),
             fmt::format("write one of its values, such as {}#{}", to.name, to.values.front()));
        return false;
    }
    become(*e, to, {.integer = value});
    return true;
}

bool Checker::coerce(Expression*& e, const Type& to) {
    if (!e->type) return false;
    const Type& from = *e->type;
    if (from.kind == Kind::text && to.kind == Kind::text) {
        if (is_constant(*e) && e->constant.text.size() > to.length)
            out_.warn("L0908", e->place.mark(),
                      fmt::format("the text has {} bytes, and {} keeps {}", e->constant.text.size(),
                                  describe(to), to.length),
                      "declare the STRING longer");
        return true;
    }
    if (&from == &to || same_type(from, to)) return true;
    if (!to.of_number.empty() && from.is_integer() && is_scl(*e)) return coerce_number(e, to);
    if (from.is_any()) return coerce_constant(*e, to);
    if (from.is_object() && to.kind == Kind::handle && from.standard == to.standard) {
        convert(e, to);
        return true;
    }
    if (to.is_character && is_constant(*e) && e->constant.text.size() == 1) {
        become(*e, to, {.integer = static_cast<unsigned char>(e->constant.text[0])});
        return true;
    }
    if (from.is_character && to.kind == Kind::text) {
        convert(e, to);
        return true;
    }
    if (to.is_subrange && same_type(from.plain(), to.plain())) {
        if (is_constant(*e) && (e->constant.integer < to.lower || e->constant.integer > to.upper)) {
            fail("L0908", e->place,
                 fmt::format("{} is out of range for {}", to_string(e->constant.integer),
                             describe(to)));
            return false;
        }
        convert(e, to);
        return true;
    }
    if (from.kind == Kind::enumeration && to.kind == Kind::enumeration && from.name == to.name &&
        from.values == to.values)
        return true;
    if (fits_as_constant(*e, to)) {
        become(*e, to, {.integer = e->constant.integer});
        return true;
    }
    const bool fits =
        from.is_scalar() && (widens(from, to) || is_same_pattern(from, to) || rounds(*e, to));
    if (!fits) return refuse_conversion(*e, to);
    convert(e, to);
    return true;
}

bool Checker::refuse_conversion(const Expression& e, const Type& to) {
    const Type& from = *e.type;
    const bool of_literal = from.kind == Kind::any_real;
    if (of_literal && !to.is_real() && to.is_number()) {
        fail("L0906", e.place, fmt::format("expected {}, found a real number", describe(to)),
             "write a whole number, or convert it: ROUND(...)");
        return false;
    }
    if ((from.is_number() || from.is_bits()) && (to.is_number() || to.is_bits())) {
        const bool counts =
            from.kind == Kind::bits && to.is_real();  // DWORD_TO_REAL keeps the bits
        const std::string source = from.is_any() ? "LINT"
                                   : counts      ? integer_type(from.bits, false).name
                                                 : from.plain().name;
        fail("L0906", e.place, fmt::format("{} does not hold every {}", describe(to), from.name),
             fmt::format("write {}_TO_{}(...) where it is meant", source, to.plain().name));
        return false;
    }
    std::string help;
    if (to.kind == Kind::time && from.is_number())
        help = from.is_any() ? "write a time with its unit: T#500ms"
                             : fmt::format("write {}_TO_TIME(...), of ms", from.plain().name);
    if (to.kind == Kind::structure && describe(to) == describe(from))
        help = "declare a TYPE, and both variables of that";
    if (to.is_character && from.kind == Kind::text) help = "a CHAR is one character: 'A'";
    if (to.kind == Kind::boolean && from.is_number()) help = "compare it, as in 'x <> 0'";
    if (to.kind == Kind::enumeration && !to.values.empty())
        help = fmt::format("write one of its values, such as {}#{}", to.name, to.values.front());
    if (from.kind == Kind::time && to.is_number())
        help = fmt::format("write TIME_TO_{}(...)", to.is_any() ? "LREAL" : to.plain().name);
    if (from.kind == Kind::enumeration && to.kind == Kind::integer)
        help = fmt::format("write TO_{}(...)", to.plain().name);
    fail("L0905", e.place, fmt::format("expected {}, found {}", describe(to), describe(from)),
         help);
    return false;
}

/// Puts a conversion in, or converts a constant at once.
void Checker::convert(Expression*& e, const Type& to) {
    if (is_constant(*e) && fold_conversion(*e, to)) return;
    Expression* converted = make(Expression::Kind::converted, *e);
    converted->operands[0] = e;
    converted->type = &to;
    e = converted;
}

bool Checker::fold_conversion(Expression& e, const Type& to) {
    const Type& from = *e.type;
    if (from.kind == Kind::text || to.kind == Kind::text) return false;
    if (from.kind == Kind::enumeration) {
        if (!to.is_integer() || to.is_subrange) return false;
        const auto value = static_cast<std::size_t>(e.constant.integer);
        become(e, to,
               {.integer = wrapped(to, from.counted ? e.constant.integer : from.numbers[value])});
        return true;
    }
    if (to.is_real() && from.is_bits()) return false;
    if (from.is_date() || to.is_date()) return false;
    if ((from.kind == Kind::time) != (to.kind == Kind::time)) return false;
    if (to.is_real()) {
        double value = as_real(e);
        if (to.bits == 32)
            value =
                from.is_real() ? static_cast<float>(value) : static_cast<float>(e.constant.integer);
        become(e, to, {.real = value});
        return true;
    }
    if (from.is_real()) return false;
    if (to.kind == Kind::enumeration) return false;
    become(e, to,
           {.integer = to.kind == Kind::boolean ? Wide{e.constant.integer != 0}
                                                : wrapped(to.plain(), e.constant.integer)});
    return true;
}

std::optional<Wide> Checker::check_whole(Expression*& e, const Type& type) {
    if (!check(*e, &type)) return {};
    if (!evaluate(*e)) {
        if (e->type)
            fail("L0913", e->place, "a constant is due here", "declare it in VAR CONSTANT");
        return {};
    }
    if (!coerce(e, type)) return {};
    return e->constant.integer;
}

}  // namespace lineshaft::st
