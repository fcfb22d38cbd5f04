#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

constexpr std::string_view since_the_start = "the time of the scan since the start of the run";

template <Op op>
Slot emit_scan(Emission& e) {
    return e.result(op, 0);
}

constexpr Emit emit_time = emit_scan<Op::time_now>;

// clang-format off
/// All are kept in ns, so that a TIME and an LTIME hold the same.
constexpr StandardFunction times[] = {
    {"TIME(): TIME", since_the_start, Typing::scan_time, emit_time},
    {"LTIME(): LTIME", since_the_start, Typing::scan_time, emit_time},
    {"TIME_TCK(): TIME", since_the_start, Typing::scan_time, emit_time},
    {"TASK_CYCLE(): TIME", "the interval of the task that runs", Typing::scan_time, emit_scan<Op::interval_now>},
    {"TASK_SCANS(): LINT", "the scans of the task that runs, before this one", Typing::scan_time, emit_scan<Op::scans_now>},
    {"TASK_INDEX(): DINT", "the number of the task that runs, from 1 on in the order of the program", Typing::scan_time, emit_scan<Op::task_now>},
    {"ADD_TIME(IN1, IN2: TIME): TIME", "IN1 + IN2", Word::plus},
    {"ADD_LTIME(IN1, IN2: LTIME): LTIME", "IN1 + IN2", Word::plus},
    {"SUB_TIME(IN1, IN2: TIME): TIME", "IN1 - IN2", Word::minus},
    {"SUB_LTIME(IN1, IN2: LTIME): LTIME", "IN1 - IN2", Word::minus},
    {"MUL_TIME(IN1: TIME; IN2: ANY_NUM): TIME", "IN1 * IN2", Word::times},
    {"MUL_LTIME(IN1: LTIME; IN2: ANY_NUM): LTIME", "IN1 * IN2", Word::times},
    {"DIV_TIME(IN1: TIME; IN2: ANY_NUM): TIME", "IN1 / IN2", Word::divided},
    {"DIV_LTIME(IN1: LTIME; IN2: ANY_NUM): LTIME", "IN1 / IN2", Word::divided},
    {"MULTIME(IN1: TIME; IN2: ANY_NUM): TIME", "IN1 * IN2", Word::times},
    {"DIVTIME(IN1: TIME; IN2: ANY_NUM): TIME", "IN1 / IN2", Word::divided},
    {"ADD_TOD_TIME(IN1: TOD; IN2: TIME): TOD", "IN1 + IN2", Word::plus},
    {"ADD_LTOD_LTIME(IN1: LTOD; IN2: LTIME): LTOD", "IN1 + IN2", Word::plus},
    {"ADD_DT_TIME(IN1: DT; IN2: TIME): DT", "IN1 + IN2", Word::plus},
    {"ADD_LDT_LTIME(IN1: LDT; IN2: LTIME): LDT", "IN1 + IN2", Word::plus},
    {"SUB_DATE_DATE(IN1, IN2: DATE): TIME", "IN1 - IN2", Word::minus},
    {"SUB_LDATE_LDATE(IN1, IN2: LDATE): LTIME", "IN1 - IN2", Word::minus},
    {"SUB_TOD_TIME(IN1: TOD; IN2: TIME): TOD", "IN1 - IN2", Word::minus},
    {"SUB_LTOD_LTIME(IN1: LTOD; IN2: LTIME): LTOD", "IN1 - IN2", Word::minus},
    {"SUB_TOD_TOD(IN1, IN2: TOD): TIME", "IN1 - IN2", Word::minus},
    {"SUB_LTOD_LTOD(IN1, IN2: LTOD): LTIME", "IN1 - IN2", Word::minus},
    {"SUB_DT_TIME(IN1: DT; IN2: TIME): DT", "IN1 - IN2", Word::minus},
    {"SUB_LDT_LTIME(IN1: LDT; IN2: LTIME): LDT", "IN1 - IN2", Word::minus},
    {"SUB_DT_DT(IN1, IN2: DT): TIME", "IN1 - IN2", Word::minus},
    {"SUB_LDT_LDT(IN1, IN2: LDT): LTIME", "IN1 - IN2", Word::minus},
    {"CONCAT_DATE_TOD(IN1: DATE; IN2: TOD): DT", "the time of day IN2 of the date IN1", Word::plus},
    {"CONCAT_DATE_LTOD(IN1: DATE; IN2: LTOD): LDT", "the time of day IN2 of the date IN1", Word::plus},
    {"CONCAT_LDATE_TOD(IN1: LDATE; IN2: TOD): LDT", "the time of day IN2 of the date IN1", Word::plus},
    {"CONCAT_LDATE_LTOD(IN1: LDATE; IN2: LTOD): LDT", "the time of day IN2 of the date IN1", Word::plus},
    {"T_ADD(IN1: ANY_MAGNITUDE; IN2: TIME): ANY_MAGNITUDE", "IN1 + IN2, of a TIME, a TOD or a DT", Word::plus},
    {"T_SUB(IN1: ANY_MAGNITUDE; IN2: TIME): ANY_MAGNITUDE", "IN1 - IN2, of a TIME, a TOD or a DT", Word::minus},
    {"T_CONV(IN: ANY_ELEMENTARY): ANY_ELEMENTARY", "IN as what is wanted, as TIME_TO_DINT(IN) gives it; also of and to a DTL",
     Typing::wanted, nullptr},
    {"T_DIFF(IN1, IN2: ANY_MAGNITUDE): TIME", "IN1 - IN2, of two of DATE, TOD or DT", Word::minus},
};
// clang-format on

}  // namespace

constinit const Subject time_functions{"times", times};

}  // namespace lineshaft::st
