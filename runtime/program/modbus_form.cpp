#include <fmt/format.h>

#include "runtime/program/program.hpp"
#include "runtime/program/program_parts.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

struct Mapped {
    Node signal;
    std::optional<Node> type, scale, write;
    bool little = false, low_first = false;
};

const Form& register_form() {
    static const Form form = form_of<Mapped>(
        {.name = "register",
         .what = "a register",
         .doc = "a signal in a table of Modbus; 100: SIGNAL alone is one that is only read. A "
                "range of the process image, %MW0..%MW99, stands in one register behind the other",
         .keys = {
             key<&Mapped::signal>("signal", a_signal, "what is read there, and written").must(),
             key<&Mapped::type>(
                 "type",
                 one_of("a type of registers", {"int16", "uint16", "int32", "uint32", "int64",
                                                "uint64", "real32", "real64"}),
                 "of its value, in one register, two or four; unless said real32 of a real, "
                 "int32 of an integer, uint16 of a boolean or an enumeration"),
             key<&Mapped::scale>("scale", a_value,
                                 "what one in the register is, such as 0.001 mm; the signal's "
                                 "unit unless said"),
             key<&Mapped::little>("order", one_of("an order of bytes", {"big", "little"}),
                                  "of the bytes in a register; Modbus has big")
                 .by_default("big"),
             key<&Mapped::low_first>("words",
                                     one_of("an order of words", {"high_first", "low_first"}),
                                     "of the registers of one value")
                 .by_default("high_first"),
             key<&Mapped::write>("write", a_boolean,
                                 "clients may write it, if serve has --allow-write; for coils "
                                 "and holding registers")
                 .by_default("false")}});
    return form;
}

Shape registers() {
    return numbered("an address", 0, 65535, either({a_form(register_form), a_signal}));
}

template <ModbusTable Table>
void read_registers(const Reader& read, const Node& node, Program& program) {
    if (!accept(read, registers(), node, "a table of Modbus")) return;
    for (const auto& [address, value] : node.entries) {
        Mapped mapped{.signal = value, .type = {}, .scale = {}, .write = {}};
        if (value.is_map()) read_form(register_form(), read, value, mapped);
        if (mapped.signal.is_empty())
            read.fail(code::entry_is_missing, value,
                      fmt::format("there is no signal at the address {}", address.text),
                      "name one, or leave the address out");
        else
            program.registers.push_back({Table, address, mapped.signal, mapped.type, mapped.scale,
                                         mapped.little, mapped.low_first, mapped.write});
    }
}

}  // namespace

const Form& modbus_form() {
    using enum ModbusTable;
    static const Form form = form_of<Program>(
        {.name = "modbus",
         .what = "'modbus'",
         .doc = "which signals clients of Modbus/TCP find where, see 'lineshaft serve --modbus'. "
                "Addresses count from 0",
         .keys = {key<read_registers<coils>>("coils", registers(), "bits that may be written"),
                  key<read_registers<discrete_inputs>>("discrete_inputs", registers(),
                                                       "bits that are only read"),
                  key<read_registers<holding_registers>>(
                      "holding_registers", registers(), "registers of 16 bits that may be written"),
                  key<read_registers<input_registers>>(
                      "input_registers", registers(), "registers of 16 bits that are only read")}});
    return form;
}

void read_modbus(const Reader& read, const Node& node, Program& program) {
    read_form(modbus_form(), read, node, program);
}

}  // namespace lineshaft
