#include "runtime/st/vendors/instead.hpp"

#include <span>

#include "runtime/st/syntax/token.hpp"

namespace lineshaft::st {

namespace {

struct Instead {
    std::string_view name, instead;
};

constexpr Instead types_of_vendors[] = {
    {"s5time", "write TIME"},
    {"any", "write the type; a block for each"},
    {"variant", "write the type; a block for each"},
    {"pointer", "pass the variable as VAR_IN_OUT"},
    {"pid_compact", "write the controller as a FUNCTION_BLOCK"},
    {"program_alarm", "write a BOOL output, and expect it"},
    {"mb_client", "serve the machine: lineshaft serve --modbus"},
    {"mb_server", "serve the machine: lineshaft serve --modbus"},
    {"counter", "declare an instance of CTU, CTD or CTUD"},
    {"timer", "declare an instance of TON, TOF or TP"}};

constexpr Instead functions_of_vendors[] = {
    {"PEEK", "read the variable by its name"},
    {"PEEK_BOOL", "read the variable by its name"},
    {"POKE", "assign to the variable by its name"},
    {"POKE_BOOL", "assign to the variable by its name"},
    {"MOVE_BLK_VARIANT", "assign the array as a whole, or its elements in a FOR"},
    {"BLKMOV", "assign the structure as a whole"},
    {"Serialize", "assign the parts one by one"},
    {"Deserialize", "assign the parts one by one"},
    {"SIZEOF", "declare the size as a constant"},
    {"ADR", "pass the variable as VAR_IN_OUT"},
    {"REF", "pass the variable as VAR_IN_OUT"},
    {"TypeOf", "write a block for each type"},
    {"RD_SYS_T", "wire the time to a VAR_INPUT"},
    {"RD_LOC_T", "wire the time to a VAR_INPUT"},
    {"BCD16_TO_INT", "write WORD_BCD_TO_UINT(x) for a number without a sign"},
    {"INT_TO_BCD16", "write UINT_TO_BCD_WORD(x) for a number without a sign"},
    {"BCD32_TO_DINT", "write DWORD_BCD_TO_UDINT(x) for a number without a sign"},
    {"DINT_TO_BCD32", "write UDINT_TO_BCD_DWORD(x) for a number without a sign"},
    {"RUNTIME", "a controller's 'instruction_time' gives what code costs"},
    {"GET_ERROR", "a fault ends the scan and is the block's output 'error_id'"},
    {"GET_ERR_ID", "a fault ends the scan and is the block's output 'error_id'"},
    {"S_MOVE", "assign the STRING with ':='"},
    {"S_CONV", "write a conversion, as STRING_TO_INT(x) or INT_TO_STRING(x)"},
    {"T_CONV", "write a conversion, as TIME_TO_DINT(x)"},
    {"INT_TO_BCD", "write UINT_TO_BCD_WORD(x) for a number without a sign"},
    {"SCALE", "write SCALE_X(MIN := low, VALUE := NORM_X(...), MAX := high)"},
    {"UNSCALE", "write SCALE_X(MIN := low, VALUE := NORM_X(...), MAX := high)"},
    {"FILL", "assign the elements in a FOR"},
    {"JOIN", "write CONCAT(a, b, ...)"},
    {"DEMUX", "write a CASE"},
    {"WAIT", "count the time with a TON"},
    {"STP", "end the run with 'run: {until: ...}' in the program"},
    {"RE_TRIGR", "leave it out: 'maximum_cycle_time' says how long a scan may last"},
    {"WR_SYS_T", "wire the time to a VAR_INPUT"},
    {"GetInstanceName", "give the name as a VAR_INPUT of type STRING"},
    {"IS_ARRAY", "write a block for each type"},
    {"VAL_STRG", "write LREAL_TO_STRING(x) or DINT_TO_STRING(x)"},
    {"STRG_VAL", "write STRING_TO_LREAL(x) or STRING_TO_DINT(x)"},
    {"Chars_TO_Strg", "keep the characters in a STRING"},
    {"Strg_TO_Chars", "keep the characters in a STRING"}};

constexpr Instead inputs_of_vendors[] = {
    {"cam", "select the cam with MC_CamTableSelect, and give its CamTableID"}};

std::string_view instead_in(std::span<const Instead> rows, std::string_view name) {
    const Instead* row = find_called(rows, name, &Instead::name);
    return row ? row->instead : std::string_view();
}

}  // namespace

std::string_view instead_of_type(std::string_view name) {
    return instead_in(types_of_vendors, name);
}

std::string_view instead_of_function(std::string_view name) {
    return instead_in(functions_of_vendors, name);
}

std::string_view instead_of_input(std::string_view name) {
    return instead_in(inputs_of_vendors, name);
}

}  // namespace lineshaft::st
