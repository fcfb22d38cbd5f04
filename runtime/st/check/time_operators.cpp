#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/types.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

/// What is reckoned of TIMEs and numbers; in CODESYS and SCL a TIME is whole ms again, an LTIME in
/// ns.
const Type* become_time(Checking& c, Expression*& e, bool is_long) {
    const bool counts_ms = e->place.dialect().times_count_ms;
    e->type = !counts_ms ? &time_type : is_long ? &long_time_type(e->place) : &ltime_type;
    fold(c, e);
    return !e->type || is_long || !counts_ms ? e->type : convert(c, e, time_type);
}

/// What is reckoned of dates in ns is of the type again that is due, whole seconds or ms in 32
/// bits.
const Type* become_date(Checking& c, Expression*& e, const Type& type) {
    static constexpr std::string_view long_ones[] = {"ldate", "ltod", "ldt"};
    const auto place = static_cast<std::size_t>(type.kind) - static_cast<std::size_t>(Kind::date);
    const bool is_whole = e->place.dialect().dates_count_seconds && !type.counts_ns;
    e->type = is_whole ? find_elementary(long_ones[place]) : &type;
    fold(c, e);
    return is_whole ? convert(c, e, type) : e->type;
}

/// Whole seconds of a TIME beside a DT count there.
void become_whole_seconds(Checking& c, Expression*& time, const Type& moment) {
    if (time->place.dialect().dates_count_seconds && !moment.counts_ns)
        convert(c, time, moment_type);
}

/// DATE - DATE, in SCL an LTIME, TOD - TOD and DT - DT are a TIME; one is added to a TOD and a DT,
/// on either side, and in CODESYS to a DATE.
const Type* check_date_arithmetic(Checking& c, Expression*& e) {
    const Word op = e->op;
    if (op == Word::plus && e->operands[0]->type->kind == Kind::time)
        e = make_binary(c, e->place, e->token.place, op, e->operands[1], e->operands[0]);
    const Type &a = *e->operands[0]->type, &b = *e->operands[1]->type;
    const bool joins = op == Word::plus && a.kind == Kind::date && b.kind == Kind::clock;
    const bool distance = op == Word::minus && same_type(a, b);
    const bool moves = (op == Word::plus || op == Word::minus) && b.kind == Kind::time &&
                       (a.kind == Kind::clock || a.kind == Kind::moment ||
                        (a.kind == Kind::date && e->place.dialect().dates_take_times));
    if (!distance && !moves && !joins)
        return refuse_operands(
            c, *e, "a TIME is added to a TOD or a DT, and two dates have a TIME between them");
    const bool is_of_days = a.kind == Kind::date && e->place.dialect().dates_count_days;
    if (distance) return become_time(c, e, a.counts_ns || is_of_days);
    if (moves && a.kind == Kind::moment) become_whole_seconds(c, e->operands[1], a);
    const bool within_day =
        moves && a.kind == Kind::clock && !e->place.dialect().dates_count_seconds;
    if (!within_day) return become_date(c, e, joins ? moment_type : a);
    e->type = &moment_type;
    fold(c, e);
    constexpr Wide day = 86'400'000'000'000;
    const Wide time = (e->constant.integer % day + day) % day;
    e = is_constant(*e) ? make_constant(c, *e, clock_type, {.integer = time})
                        : make_converted(c, e, clock_type);
    return &clock_type;
}

}  // namespace

void become_moments(Checking& c, Expression& e) {
    for (Expression*& operand : e.operands)
        if (is_dtl(*operand->type)) check(c, operand = make_call(c, "DTL_TO_LDT", operand));
}

/// `time + 5` and `tod - 5` are of ms where a DINT is a TIME, and a LINT beside LTIME and LTOD of
/// ns.
static bool take_count(Checking& c, Expression& e) {
    const Type &time = *e.operands[0]->type, &number = *e.operands[1]->type;
    const bool counts = e.place.dialect().dint_is_time && number.is_integer() &&
                        (e.op == Word::plus || e.op == Word::minus) &&
                        (time.kind == Kind::time || time.kind == Kind::clock);
    if (!counts) return true;
    if (!coerce(c, e.operands[1], time.counts_ns ? lint_type : dint_type)) return false;
    convert(c, e.operands[1], time.counts_ns ? long_time_type(e.place) : time_type);
    return true;
}

/// `moment + 5` of B&R is of seconds. Empty: it is none.
static std::optional<const Type*> check_counted_seconds(Checking& c, Expression*& e) {
    const bool moves_by_seconds = e->place.dialect().seconds_move_moments;
    if (moves_by_seconds && e->op == Word::plus && e->operands[0]->type->is_integer())
        e = make_binary(c, e->place, e->token.place, e->op, e->operands[1], e->operands[0]);
    const Type& moment = *e->operands[0]->type;
    Expression*& number = e->operands[1];
    const bool is_it = moves_by_seconds && moment.kind == Kind::moment &&
                       number->type->is_integer() && (e->op == Word::plus || e->op == Word::minus);
    if (!is_it) return {};
    if (!coerce(c, number, lint_type)) return nullptr;
    Expression* second = make_constant(c, *number, lint_type, {.integer = 1'000'000'000});
    number = make_binary(c, number->place, number->place, Word::times, number, second);
    if (!check(c, number, &lint_type)) return nullptr;
    convert(c, number, moment);
    return become_date(c, e, moment);
}

const Type* check_time_arithmetic(Checking& c, Expression*& e) {
    const Word op = e->op;
    if (const auto type = check_counted_seconds(c, e)) return *type;
    if (!take_count(c, *e)) return nullptr;
    Expression *&left = e->operands[0], *&right = e->operands[1];
    if (left->type->is_date() || right->type->is_date()) return check_date_arithmetic(c, e);
    const bool both = left->type->kind == Kind::time && right->type->kind == Kind::time;
    const bool adds = op == Word::plus || op == Word::minus || op == Word::mod_;
    Expression*& number = left->type->kind == Kind::time ? right : left;
    if (!both) become_number(c, number);
    const bool scales = !both && number->type->is_number() &&
                        (op == Word::times || (op == Word::divided && &number == &right));
    if (!(both && adds) && !scales)
        return refuse_operands(
            c, *e,
            "times are added and subtracted, and multiplied or divided by a number; "
            "TIME_TO_LREAL gives a number of ms");
    if (scales) {
        const Type& to = number->type->is_real() ? lreal_type : lint_type;
        const bool is_long = number->type->is_unsigned_64();
        if (!is_long && !coerce(c, number, to)) return nullptr;
    }
    return become_time(c, e, left->type->counts_ns || right->type->counts_ns);
}

/// The clock is in ns, which a TIME of whole ms is cut from, and an LTIME beside one has; the
/// interval of a task is what it is.
const Type* check_scan_time(Checking& c, Expression*& e) {
    const StandardFunction& f = *e->standard;
    if (f.result == Generic::long_integer) return &lint_type;
    if (f.result == Generic::double_integer) return &dint_type;
    const bool counts_ms = e->place.dialect().times_count_ms && f.op != Op::interval_now;
    if (!counts_ms) return &time_type;
    e->type = &long_time_type(e->place);
    return f.result == Generic::long_time ? e->type : convert(c, e, time_type);
}

const Type* check_dtl_arithmetic(Checking& c, Expression*& e) {
    become_moments(c, *e);
    const Type* type = check_time_arithmetic(c, e);
    if (!type || type->kind != Kind::moment) return type;
    e->type = type;
    e = make_call(c, "LDT_TO_DTL", e);
    return check(c, e);
}

}  // namespace lineshaft::st
