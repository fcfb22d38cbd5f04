#include "runtime/debug/evaluation.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/syntax/parser.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft::debug {

struct Expression::Parsed {
    st::Tree tree;
    const st::Expression* root = nullptr;
};

namespace {

using E = st::Expression::Kind;
using st::Wide;
using st::Word;

struct Failed : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A value while it is reckoned with: at its seat, if it has one.
struct Operand {
    enum class Of : std::uint8_t { truth, whole, real, text, name, place };
    Of of = Of::whole;
    Wide whole = 0;
    double real = 0;
    std::string text = {};  ///< of a text; of a name that is no variable
    Seat seat = {};
    std::string unit = {};

    bool is_number() const { return of == Of::truth || of == Of::whole || of == Of::real; }
    double as_real() const { return of == Of::real ? real : static_cast<double>(whole); }
};

Operand of_truth(bool value) {
    return {.of = Operand::Of::truth, .whole = value};
}

Operand load(const Seat& seat, const std::string& unit) {
    using Kind = st::Type::Kind;
    Operand value{.seat = seat, .unit = unit};
    const st::Type& type = *seat.type;
    if (type.kind == Kind::text) {
        value.of = Operand::Of::text;
        value.text.assign(reinterpret_cast<const char*>(seat.at + 8),
                          static_cast<std::size_t>(read<std::uint64_t>(seat.at)));
    } else if (type.is_real()) {
        value.of = Operand::Of::real;
        value.real = read<double>(seat.at);
    } else if (type.is_scalar() || type.kind == Kind::enumeration) {
        value.of = type.kind == Kind::boolean ? Operand::Of::truth : Operand::Of::whole;
        value.whole = type.is_unsigned_64() ? Wide{read<std::uint64_t>(seat.at)}
                                            : Wide{read<std::int64_t>(seat.at)};
    } else {
        value.of = Operand::Of::place;
    }
    return value;
}

class Reckoning {
  public:
    Reckoning(const Frame& frame, const st::Checked& checked) : frame_(frame), checked_(checked) {}

    Operand value(const st::Expression& e) const {
        switch (e.kind) {
            case E::constant:
                return literal(e);
            case E::name:
                return named(e);
            case E::member:
                return member(e);
            case E::index:
                return element(e);
            case E::deref:
                return followed(e, value(*e.operands[0]));
            case E::bit:
                return bit(e);
            case E::typed:
                return typed(e);
            case E::unary:
                return unary(e);
            case E::binary:
                return binary(e);
            default:
                throw Failed(fmt::format("'{}' is not for a debugger, which changes nothing",
                                         e.place.text()));
        }
    }

  private:
    static Operand literal(const st::Expression& e) {
        const std::string_view text = e.token.text;
        if (e.token.word == Word::text)
            return {.of = Operand::Of::text, .text = st::read_text(text).value_or("")};
        if (e.token.word == Word::real)
            return {.of = Operand::Of::real, .real = st::read_real(text).value_or(NAN)};
        std::optional<Wide> whole;
        if (e.token.word == Word::integer) whole = st::read_integer(text);
        if (e.token.word == Word::duration) {
            using Kind = st::Type::Kind;
            for (const Kind kind : {Kind::time, Kind::date, Kind::clock, Kind::moment})
                if (!whole) whole = st::read_time(text, kind);
        }
        if (!whole) throw Failed(fmt::format("'{}' is no value", e.place.text()));
        return {.whole = *whole};
    }

    /// In the routine, or in the block that it is a method of.
    Operand named(const st::Expression& e) const {
        const std::string_view name = e.token.text;
        const st::Routine* block = nullptr;
        for (const st::Routine* routine = frame_.routine; routine; routine = routine->owner) {
            block = routine;
            const st::Variable* found = st::find_in(routine->names, name);
            if (!found) continue;
            const st::Variable& variable = *found;
            if (variable.space == st::Space::constant && variable.type->is_real())
                return {.of = Operand::Of::real, .real = variable.value.real};
            if (variable.space == st::Space::constant) return {.whole = variable.value.integer};
            return at(seat_of(variable, frame_.base, frame_), e, variable.unit);
        }
        if (st::same_name(name, "this") && block && block->type)
            return load({block->type, frame_.base, &frame_}, "");
        if (const st::Variable* global = global_of("", name))
            return at(seat_of(*global, frame_.base, frame_), e, global->unit);
        if (st::same_name(name, "true") || st::same_name(name, "false"))
            return of_truth(st::same_name(name, "true"));
        return {.of = Operand::Of::name, .text = std::string(name)};
    }

    /// Of VAR_GLOBAL: `x`, and with the name of its list, whether programs have to write that or
    /// not.
    const st::Variable* global_of(std::string_view list, std::string_view name) const {
        const std::string full =
            list.empty() ? std::string(name) : fmt::format("{}.{}", list, name);
        for (const st::Global& global : checked_.globals)
            for (const st::Variable* variable : global.type->members) {
                const st::Source* source = variable->name.place.source;
                if (variable->space != st::Space::global || !source) continue;
                const bool is_of_list = st::same_name(variable->text, name) &&
                                        st::same_name(st::name_of_list(*source), list);
                if (st::same_name(variable->text, full) || is_of_list) return variable;
            }
        return nullptr;
    }

    /// What is there; of a REFERENCE TO what it is to.
    Operand at(const Seat& seat, const st::Expression& e, const std::string& unit) const {
        if (!seat.at) throw Failed(fmt::format("'{}' is not in the memory now", e.place.text()));
        const Operand found = load(seat, unit);
        return seat.type->is_alias() ? followed(e, found) : found;
    }

    Operand followed(const st::Expression& e, const Operand& reference) const {
        const st::Type* type = reference.seat.type;
        if (type && type->kind == st::Type::Kind::block) return reference;  // THIS^
        if (!type || !type->is_reference())
            throw Failed(fmt::format("'{}' is no pointer", e.operands[0]->place.text()));
        const Seat target = target_of(reference.seat);
        if (!target.at) throw Failed(fmt::format("'{}' is to nothing", e.place.text()));
        return load(target, "");
    }

    Operand bit(const st::Expression& e) const {
        const Operand whole = number(*e.operands[0]);
        std::string_view written = e.token.text;
        written.remove_prefix(std::min(written.find_first_of("0123456789"), written.size()));
        const auto place = st::read_integer(written);
        if (whole.of != Operand::Of::whole || !place || *place > 63) throw Failed(unknown(e));
        return of_truth((whole.whole >> static_cast<int>(*place) & 1) != 0);
    }

    Operand member(const st::Expression& e) const {
        const Operand whole = value(*e.operands[0]);
        if (whole.of == Operand::Of::name)
            if (const st::Variable* global = global_of(whole.text, e.token.text))
                return at(seat_of(*global, frame_.base, frame_), e, global->unit);
        if (whole.of != Operand::Of::place) throw Failed(unknown(e));
        const st::Type& type = *whole.seat.type;
        const bool has_parts =
            type.kind == st::Type::Kind::structure || type.kind == st::Type::Kind::block;
        const st::Variable* part = has_parts ? st::find_member(type, e.token.text) : nullptr;
        if (!part) throw Failed(unknown(e));
        const Seat seat =
            type.kind == st::Type::Kind::block
                ? seat_of(*part, whole.seat.at, frame_)
                : Seat{part->type, whole.seat.at + 8 * std::size_t{part->slot}, &frame_};
        if (!seat.at) throw Failed(unknown(e));
        return at(seat, e, part->unit);
    }

    Operand element(const st::Expression& e) const {
        Operand whole = value(*e.operands[0]);
        for (const st::Argument& argument : e.arguments) {
            if (whole.of != Operand::Of::place || whole.seat.type->kind != st::Type::Kind::array)
                throw Failed(unknown(e));
            const st::Type& array = *whole.seat.type;
            const Operand index = value(*argument.value);
            if (index.of != Operand::Of::whole || index.whole < array.lower ||
                index.whole > array.upper)
                throw Failed(fmt::format("'{}' is not an index from {} to {}",
                                         argument.value->place.text(), array.lower, array.upper));
            const auto at = static_cast<std::size_t>(index.whole - array.lower);
            whole =
                load({array.element, whole.seat.at + 8 * at * st::element_slots(array), &frame_},
                     whole.unit);
        }
        return whole;
    }

    /// `Mode#idle`, `INT#5`.
    Operand typed(const st::Expression& e) const {
        const Operand of_type = value(*e.operands[0]);
        if (of_type.of != Operand::Of::name) return of_type;
        for (const st::Type& type : checked_.types)
            if (type.has_values() && st::same_name(type.name, e.token.text))
                return {.whole = number_of(type, of_type.text)};
        throw Failed(unknown(e));
    }

    static Wide number_of(const st::Type& type, const std::string& name) {
        const std::string* value = st::find_called(type.values, name);
        if (!value) throw Failed(fmt::format("{} has no value '{}'", type.name, name));
        return type.kept(static_cast<std::size_t>(value - type.values.data()));
    }

    Operand unary(const st::Expression& e) const {
        Operand value = number(*e.operands[0]);
        if (e.op == Word::not_) {
            value.whole = value.of == Operand::Of::truth ? Wide{value.whole == 0} : ~value.whole;
        } else if (e.op == Word::minus) {
            value.whole = -value.whole;
            value.real = -value.real;
        }
        value.seat = {};
        return value;
    }

    Operand number(const st::Expression& e) const {
        Operand operand = value(e);
        if (operand.of == Operand::Of::name) throw Failed(unknown(e));
        if (!operand.is_number()) throw Failed(fmt::format("'{}' is no number", e.place.text()));
        return operand;
    }

    Operand binary(const st::Expression& e) const {
        Operand a = value(*e.operands[0]);
        if (e.op == Word::and_then_ && a.whole == 0) return of_truth(false);
        if (e.op == Word::or_else_ && a.whole != 0) return of_truth(true);
        Operand b = value(*e.operands[1]);
        const auto mean = [](Operand& name, const Operand& other) {
            const bool is_value = name.of == Operand::Of::name && other.seat.type &&
                                  other.seat.type->kind == st::Type::Kind::enumeration;
            if (is_value) name = {.whole = number_of(*other.seat.type, name.text)};
        };
        mean(a, b);
        mean(b, a);
        if (a.of == Operand::Of::text && b.of == Operand::Of::text)
            return compared(e, a.text.compare(b.text), 0);
        if (!a.is_number()) throw Failed(unknown(*e.operands[0]));
        if (!b.is_number()) throw Failed(unknown(*e.operands[1]));
        const bool is_real = a.of == Operand::Of::real || b.of == Operand::Of::real;
        if (!st::is_comparison(e.op)) return reckoned(e, a, b, is_real);
        return is_real ? compared(e, a.as_real(), b.as_real()) : compared(e, a.whole, b.whole);
    }

    template <class T>
    static Operand compared(const st::Expression& e, const T& a, const T& b) {
        const auto truth = st::compare(e.op, a, b);
        if (!truth) throw Failed(fmt::format("'{}' compares nothing", e.place.text()));
        return of_truth(*truth);
    }

    static Operand reckoned(const st::Expression& e, const Operand& a, const Operand& b,
                            bool is_real) {
        const bool joins = st::is_logic(e.op), is_rest = e.op == Word::mod_;
        if (e.op == Word::power)
            return {.of = Operand::Of::real, .real = std::pow(a.as_real(), b.as_real())};
        if (is_real && (joins || is_rest))
            throw Failed(fmt::format("'{}' is not for real numbers", e.place.text()));
        if (!is_real && (is_rest || e.op == Word::divided) && b.whole == 0)
            throw Failed("a division by zero");
        const auto made = st::operate(e.op, {a.whole, a.as_real()}, {b.whole, b.as_real()});
        if (is_real) return {.of = Operand::Of::real, .real = made.real};
        return {.of = joins && a.of == b.of ? a.of : Operand::Of::whole, .whole = made.integer};
    }

    static std::string unknown(const st::Expression& e) {
        return fmt::format("'{}' is not known here", e.place.text());
    }

    const Frame& frame_;
    const st::Checked& checked_;
};

Shown show_operand(const std::string& text, const Operand& value) {
    if (value.seat.type) return show(text, value.seat, value.unit);
    switch (value.of) {
        case Operand::Of::truth:
            return {.name = text, .value = value.whole != 0 ? "TRUE" : "FALSE"};
        case Operand::Of::real:
            return {.name = text, .value = fmt::format("{}", value.real)};
        case Operand::Of::text:
            return {.name = text, .value = st::text_literal(value.text)};
        default:
            return {.name = text, .value = st::to_string(value.whole)};
    }
}

}  // namespace

Expression::Expression(std::string text)
    : text_(std::move(text)), parsed_(std::make_unique<Parsed>()) {
    Diagnostics wrong;
    const auto file = std::make_shared<SourceFile>(SourceFile{
        "watch.st", fmt::format("FUNCTION watch : BOOL\nwatch := {}\n;\nEND_FUNCTION\n", text_)});
    st::parse(st::read_tokens(file, wrong), parsed_->tree, wrong);
    const auto& units = parsed_->tree.units;
    if (!wrong.empty())
        error_ = wrong.list().front().message;
    else if (units.size() != 1 || units[0]->body.size() != 1)
        error_ = "it is not one expression";
    else
        parsed_->root = units[0]->body[0]->value;
}

Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;

Evaluated Expression::value(const Frame& frame, const st::Checked& checked) const {
    if (!error_.empty()) return {error_};
    try {
        const Operand found = Reckoning(frame, checked).value(*parsed_->root);
        if (found.of == Operand::Of::name) return {fmt::format("'{}' is not known here", text_)};
        Evaluated evaluated{.shown = show_operand(text_, found)};
        if (found.of == Operand::Of::truth) evaluated.truth = found.whole != 0;
        return evaluated;
    } catch (const Failed& why) {
        return {why.what()};
    }
}

}  // namespace lineshaft::debug
