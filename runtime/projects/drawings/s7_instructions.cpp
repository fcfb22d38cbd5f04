#include "runtime/projects/drawings/s7_instructions.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "runtime/projects/drawings/s7_boxes.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace s7 {

namespace {

using st::same_name;

// Contacts.

Value contact(Running& r) {
    return r.and_(r.power, r.operand("operand"));
}
Value inverted_contact(Running& r) {
    return r.and_(r.power, r.not_(r.operand("operand")));
}

/// Whether `now` has just come, or gone; what it was is in `bit`.
Value edge_of(const Running& r, const Value& now, const Value& bit, bool is_rising) {
    return is_rising ? r.and_(now, r.not_(bit)) : r.and_(r.not_(now), bit);
}

/// An edge of the contact's operand.
Value edge_contact(Running& r, bool is_rising) {
    const Value bit = r.operand("bit"), signal = r.operand("operand"), edge = r.wire();
    r.assign(edge, edge_of(r, signal, bit, is_rising));
    r.assign(bit, signal);
    return r.and_(r.power, edge);
}
Value rising_contact(Running& r) {
    return edge_contact(r, true);
}
Value falling_contact(Running& r) {
    return edge_contact(r, false);
}

/// An edge of power; the pin without a name is the bit.
Value edge_of_power(Running& r, bool is_rising) {
    const Value bit = r.operand("bit"), edge = r.wire();
    const Value power = r.all.fixed(r.to, r.power, r.it.place);
    r.assign(edge, edge_of(r, power, bit, is_rising));
    r.assign(bit, power);
    return edge;
}
Value rising_power(Running& r) {
    return edge_of_power(r, true);
}
Value falling_power(Running& r) {
    return edge_of_power(r, false);
}

Value inverted_power(Running& r) {
    return r.not_(r.power);
}

/// A contact, or with an output a box.
Value comparison(Running& r) {
    const std::string_view sign = infix_of(std::string_view(r.it.name).substr(0, 2));
    const Value result = r.binary(r.operand("in1"), sign, r.operand("in2"));
    const auto* target = r.it.find("out");
    if (!target || target->value.is_empty()) return r.and_(r.power, result);
    const Value enabled = r.enable();
    r.open(enabled), r.assign(target->value, result), r.close(enabled);
    return enabled;
}

Value range_of(Running& r) {
    const Value in = r.operand("in");
    return r.and_(r.binary(r.operand("min"), " <= ", in), r.binary(in, " <= ", r.operand("max")));
}
Value in_range(Running& r) {
    return r.and_(r.power, range_of(r));
}
Value out_of_range(Running& r) {
    return r.and_(r.power, r.not_(range_of(r)));
}

Value valid(const Running& r) {
    Value made = r.word("IS_VALID(");
    made.text.append(r.operand("operand").text);
    made.text.write(")", r.it.place);
    made.form = Value::Form::atom;
    return made;
}
Value valid_contact(Running& r) {
    return r.and_(r.power, valid(r));
}
Value invalid_contact(Running& r) {
    return r.and_(r.power, r.not_(valid(r)));
}

// FBD: gates, whose first input is what leads to them.

Value gate(Running& r, Value (*join)(const Running&, const Value&, const Value&)) {
    Value made = r.it.find("in1") ? Value{} : r.power;
    for (const auto& pin : r.it.pins)
        if (!pin.is_output && !pin.value.is_empty())
            made = made.is_empty() ? pin.value : join(r, made, pin.value);
    return made;
}
Value and_gate(Running& r) {
    return gate(r, [](const Running& of, const Value& a, const Value& b) { return of.and_(a, b); });
}
Value or_gate(Running& r) {
    return gate(r, [](const Running& of, const Value& a, const Value& b) {
        return a.is_always ? a : of.or_(a, b);
    });
}
Value xor_gate(Running& r) {
    return gate(r, [](const Running& of, const Value& a, const Value& b) {
        return of.binary(a, " XOR ", b);
    });
}

// Coils.

Value coil(Running& r) {
    const Value power = r.enable();
    r.assign(r.operand("operand"), power);
    return power;
}
Value inverted_coil(Running& r) {
    const Value power = r.enable();
    r.assign(r.operand("operand"), r.not_(power));
    return power;
}

Value assigned_if(Running& r, std::string_view value) {
    const Value power = r.enable();
    r.open(power), r.assign(r.operand("operand"), r.word(value)), r.close(power);
    return power;
}
Value set_coil(Running& r) {
    return assigned_if(r, "TRUE");
}
Value reset_coil(Running& r) {
    return assigned_if(r, "FALSE");
}

Value edge_coil(Running& r, bool is_rising) {
    const Value power = r.all.fixed(r.to, r.power, r.it.place), bit = r.operand("bit");
    r.assign(r.operand("operand"), edge_of(r, power, bit, is_rising));
    r.assign(bit, power);
    return power;
}
Value rising_coil(Running& r) {
    return edge_coil(r, true);
}
Value falling_coil(Running& r) {
    return edge_coil(r, false);
}

/// `TOn_Coil(timer := #t, pt := T#1s)`
Value timer_coil(Running& r) {
    const Value power = r.enable();
    r.to.append(r.operand("timer", "operand").text);
    r.write(fmt::format(".{}(IN := ", r.it.name.substr(0, r.it.name.find('_'))));
    r.to.append(power.text);
    r.write(", PT := ");
    r.to.append(r.operand("pt", "value").text);
    r.write(");\n");
    return power;
}

/// `given` is nothing, or the time that it gets.
Value timer_command(Running& r, std::string_view function, const Value& given) {
    const Value power = r.enable();
    const Value timer = r.operand("timer", "operand");
    r.open(power);
    r.to.append(r.call(function, {{"PT", given}, {"TIMER", timer}}).text);
    r.write(";\n");
    r.close(power);
    return power;
}
Value timer_reset(Running& r) {
    return timer_command(r, "RESET_TIMER", {});
}
Value timer_preset(Running& r) {
    return timer_command(r, "PRESET_TIMER", r.operand("pt"));
}

Value jump(Running& r, const Value& when) {
    r.open(when);
    r.write("GOTO ");
    r.to.append(r.operand("label", "operand").text);
    r.write(";\n");
    r.close(when);
    return r.power;
}
Value jump_coil(Running& r) {
    return jump(r, r.enable());
}
Value inverted_jump_coil(Running& r) {
    return jump(r, r.not_(r.enable()));
}

Value returned(Running& r, std::string_view before) {
    const Value power = r.enable();
    r.open(power), r.write(fmt::format("{}RETURN;\n", before)), r.close(power);
    return power;
}
Value return_coil(Running& r) {
    return returned(r, "");
}
/// The block's ENO is FALSE.
Value failed_return_coil(Running& r) {
    return returned(r, "ENO := FALSE;\n");
}

/// Where both inputs are TRUE the one whose name has a 1 wins.
Value flip_flop(Running& r, bool set_wins) {
    const bool is_box = !r.it.callee.is_empty();
    const Value state = is_box ? r.it.callee : r.operand("operand");
    const Value other = is_box ? r.operand("operand") : r.word("FALSE");
    const auto input = [&](std::string_view name, std::string_view with_one, bool wins) {
        for (const std::string_view pin : {name, with_one})
            if (const auto* found = r.it.find(pin); found && !found->name.empty())
                return found->value;
        return wins ? other : r.power;
    };
    const Value set = input("s", "s1", set_wins), reset = input("r", "r1", !set_wins);
    const Value stays = r.and_(set_wins ? state : r.or_(set, state), r.not_(reset));
    r.assign(state, set_wins ? r.or_(set, stays) : stays);
    return state;
}
Value reset_set(Running& r) {
    return flip_flop(r, true);
}
Value set_reset(Running& r) {
    return flip_flop(r, false);
}

Value refused(Running& r) {
    r.out.add(code::not_supported, r.it.place,
              fmt::format("the instruction {} is not supported", r.it.name),
              "write it in a network of SCL");
    return r.power;
}

/// Names of SIMATIC SD, those of the help where they are others, and those of edition V20.
struct Row {
    Value (*run)(Running&);
    std::string_view names;                  ///< with a blank around each
    std::optional<std::string_view> pins{};  ///< likewise; `in#`: numbered. None: who calls is told
};
constexpr Row rows[] = {
    {contact, " contact ", " operand "},
    {inverted_contact, " i_contact ", " operand "},
    {rising_contact, " p_contact ", " operand bit "},
    {falling_contact, " n_contact ", " operand bit "},
    {rising_power, " p_trig ", " bit "},
    {falling_power, " n_trig ", " bit "},
    {inverted_power, " not ", ""},
    {comparison,
     " eq_contact ne_contact ge_contact gt_contact le_contact lt_contact eq ne ge gt le lt ",
     " in# out "},
    {in_range, " inrange in_range ", " min in max "},
    {out_of_range, " outrange out_range ", " min in max "},
    {valid_contact, " ok isvalidcontact ", " operand "},
    {invalid_contact, " nok not_ok isnotvalidcontact ", " operand "},
    {and_gate, " a ", " in# "},
    {or_gate, " o ", " in# "},
    {xor_gate, " x ", " in# "},
    {coil, " coil ", " operand "},
    {inverted_coil, " i_coil ", " operand "},
    {set_coil, " s_coil ", " operand "},
    {reset_coil, " r_coil ", " operand "},
    {rising_coil, " p_coil ", " operand bit "},
    {falling_coil, " n_coil ", " operand bit "},
    {timer_coil, " tp_coil ton_coil tof_coil tonr_coil ", " timer pt operand value "},
    {timer_reset, " rt_coil resetiectimercoil ", " timer operand "},
    {timer_preset, " pt_coil ", " timer operand pt "},
    {jump_coil, " jumpcoil ", " operand label "},
    {inverted_jump_coil, " i_jumpcoil ", " operand label "},
    {return_coil, " return returntrue returncoil ", ""},
    {failed_return_coil, " returnfalse ", ""},
    {reset_set, " s_rs rs ", " s s1 r r1 operand "},
    {set_reset, " s_sr sr ", " s s1 r r1 operand "},
    {move, " move ", " in out# "},
    {text_move, " s_move ", " in out "},
    {arithmetic, " add sub mul div mod and or xor ", " in# out "},
    {negation, " neg ", " in out "},
    {inversion, " inv ", " in out "},
    {power_of, " expt ", " in# out "},
    {increment, " inc ", " operand "},
    {decrement, " dec ", " operand "},
    {conversion, " convert ", " in out "},
    {limit, " limit ", " mn min in mx max out "},
    {scale, " scale scale_x ", " min value max out in hi_lim lo_lim bipolar ret_val "},
    {normalize, " normalize norm_x ", " min value max out "},
    {multiplexer, " mux "},
    {formula, " calculate calc "},
    {plain_function, " min max sel ", " in# g out "},
    {typed_function,
     " abs sqr sqrt ln exp sin cos tan asin acos atan frac round ceil floor trunc swap shl shr rol "
     "ror ",
     " in n out "},
    {text_conversion, " s_conv ", " in out "},
    {bits_set, " set_bf ", " s_bit operand count n "},
    {bits_reset, " reset_bf ", " s_bit operand count n "},
    {timer, " tp ton tof tonr "},
    {up_counter, " ctu "},
    {down_counter, " ctd "},
    {up_down_counter, " ctud "},
    {s5_timer, " s_pulse s_pext s_odt s_odts s_offdt sp se sd ss sf "},
    {s5_counter, " s_cu s_cd s_cud "},
    {s5_timer_coil, " sp_coil se_coil sd_coil ss_coil sf_coil spcoil secoil sdcoil sscoil sfcoil "},
    {s5_counter_coil, " cu_coil cd_coil sc_coil cucoil cdcoil sccoil "},
};

const Row* row_of(std::string_view name) {
    const std::string word = fmt::format(" {} ", lower(name));
    const auto has_name = [&](const Row& row) { return row.names.find(word) != row.names.npos; };
    const auto* found = std::ranges::find_if(rows, has_name);
    return found == std::end(rows) ? nullptr : found;
}

/// `in2` is one of the numbered `in#`.
bool has_pin(const Row& row, std::string_view pin) {
    const std::string small = lower(pin);
    const std::string_view stem(small.data(), small.find_last_not_of("0123456789") + 1);
    return !row.pins || row.pins->find(fmt::format(" {} ", small)) != row.pins->npos ||
           (stem != small && row.pins->find(fmt::format(" {}# ", stem)) != row.pins->npos);
}

/// What stands at a pin that the instruction does not have would be left out.
void refuse_other_pins(const Row& row, const S7Instruction& it, Diagnostics& out) {
    for (const auto& pin : it.pins)
        if (!pin.name.empty() && !has_pin(row, pin.name))
            out.add(code::not_supported, it.place,
                    fmt::format("the instruction {} has no {} '{}' here", it.name,
                                pin.is_output ? "output" : "input", pin.name),
                    "write it in a network of SCL");
}

bool is_unknown_form(std::string_view name) {
    const std::string small = lower(name);
    return small.ends_with("contact") || small.ends_with("coil");
}

}  // namespace

}  // namespace s7

const S7Instruction::Pin* S7Instruction::find(std::string_view pin) const {
    const auto has_name = [&](const Pin& one) { return st::same_name(one.name, pin); };
    const auto found = std::ranges::find_if(pins, has_name);
    return found == pins.end() ? nullptr : &*found;
}

Value S7Instruction::value(std::string_view pin) const {
    const Pin* found = find(pin);
    if (!found) found = find("");
    return found ? found->value : Value{};
}

bool S7Instructions::has_instance(std::string_view name) {
    const std::string small = lower(name);
    if (small == "r_trig" || small == "f_trig" || small.starts_with("mc_")) return true;
    const s7::Row* row = s7::row_of(name);
    using Run = Value (*)(s7::Running&);
    constexpr Run of_instances[] = {s7::timer,           s7::up_counter, s7::down_counter,
                                    s7::up_down_counter, s7::reset_set,  s7::set_reset};
    return row && std::ranges::find(of_instances, row->run) != std::end(of_instances);
}

Value S7Instructions::result_of(const S7Instruction& instruction) {
    for (const std::string_view which : {"DestType", "SrcType", "value_type"})
        if (const std::string type = s7::type_of(instruction, which); !type.empty())
            return words(variables_.make("_wire", type), instruction.place, type);
    out_.add(code::not_supported, instruction.place,
             fmt::format("the type of what {} gives is not known", instruction.name),
             "write it to a variable");
    return words("0", instruction.place);
}

Value S7Instructions::fixed(Excerpts& to, Value value, const Mark& place) {
    const bool is_wire = value.form == Value::Form::atom && value.text.text().starts_with("_wire");
    if (value.is_always || value.is_empty() || is_wire) return value;
    return kept_in(to, variables_.make("_wire", "BOOL"), value, place);
}

Value S7Instructions::run(Excerpts& to, const S7Instruction& instruction, Value power,
                          bool goes_on) {
    constexpr std::size_t longest = 4096;  // bytes of an expression
    if (power.text.text().size() > longest) power = fixed(to, std::move(power), instruction.place);
    s7::Running r{*this, out_, variables_, to, instruction, std::move(power), goes_on};
    const s7::Row* row = s7::row_of(instruction.name);
    if (row) s7::refuse_other_pins(*row, instruction, out_);
    if (row) return row->run(r);
    if (!instruction.callee.is_empty()) return s7::called(r);
    return s7::is_unknown_form(instruction.name) ? s7::refused(r) : s7::other_function(r);
}

}  // namespace lineshaft::projects
