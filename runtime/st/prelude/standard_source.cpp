#include "runtime/st/prelude/standard_source.hpp"

#include <algorithm>

namespace lineshaft::st {

namespace {

// Of the calendar: Howard Hinnant, "chrono-Compatible Low-Level Date Algorithms", days_from_civil
// and civil_from_days, for years of four digits.
constexpr std::string_view written = R"(
TYPE DTL : STRUCT
    YEAR : UINT := 1970;
    MONTH : USINT := 1;
    DAY : USINT := 1;
    WEEKDAY : USINT := 5;  // 1 is Sunday
    HOUR, MINUTE, SECOND : USINT;
    NANOSECOND : UDINT;
END_STRUCT END_TYPE

FUNCTION days_of_civil : LINT  // since 1970-01-01
VAR_INPUT YEAR : LINT(0..9999); MONTH : LINT(1..12); DAY : LINT(1..31); END_VAR
VAR_TEMP y, doy, last : LINT; days_to_end : LINT(0..30); END_VAR
    last := SEL(MONTH = 4 OR MONTH = 6 OR MONTH = 9 OR MONTH = 11, 31, 30);
    IF MONTH = 2 THEN
        last := SEL(YEAR MOD 4 = 0 AND (YEAR MOD 100 <> 0 OR YEAR MOD 400 = 0), 28, 29);
    END_IF;
    days_to_end := last - DAY;  // no 30th of February
    y := YEAR + 400 - SEL(MONTH <= 2, 0, 1);
    doy := (153 * ((MONTH + 9) MOD 12) + 2) / 5 + DAY - 1;
    days_of_civil := 365 * y + y / 4 - y / 100 + y / 400 + doy - 719468 - 146097;
END_FUNCTION

FUNCTION LDT_TO_DTL : DTL
VAR_INPUT IN : LDT; END_VAR
VAR CONSTANT DAY : LINT := 86_400_000_000_000; END_VAR
VAR_TEMP ns, days, doe, yoe, doy, mp : LINT; END_VAR
    ns := LDT_TO_LINT(IN) MOD DAY;
    IF ns < 0 THEN ns := ns + DAY; END_IF;
    days := (LDT_TO_LINT(IN) - ns) / DAY + 719468;
    doe := days MOD 146097;
    yoe := (doe - doe / 1460 + doe / 36524 - doe / 146096) / 365;
    doy := doe - (365 * yoe + yoe / 4 - yoe / 100);
    mp := (5 * doy + 2) / 153;
    LDT_TO_DTL.DAY := LINT_TO_USINT(doy - (153 * mp + 2) / 5 + 1);
    LDT_TO_DTL.MONTH := LINT_TO_USINT(SEL(mp < 10, mp - 9, mp + 3));
    LDT_TO_DTL.YEAR := LINT_TO_UINT(yoe + days / 146097 * 400 + SEL(mp < 10, 1, 0));
    LDT_TO_DTL.WEEKDAY := LINT_TO_USINT((days + 3) MOD 7 + 1);
    LDT_TO_DTL.HOUR := LINT_TO_USINT(ns / 3_600_000_000_000);
    LDT_TO_DTL.MINUTE := LINT_TO_USINT(ns / 60_000_000_000 MOD 60);
    LDT_TO_DTL.SECOND := LINT_TO_USINT(ns / 1_000_000_000 MOD 60);
    LDT_TO_DTL.NANOSECOND := LINT_TO_UDINT(ns MOD 1_000_000_000);
END_FUNCTION

FUNCTION clock_of : LINT  // [ns]
VAR_INPUT HOUR : LINT(0..23); MINUTE, SECOND : LINT(0..59); ns : LINT(0..999_999_999); END_VAR
    clock_of := ((HOUR * 60 + MINUTE) * 60 + SECOND) * 1_000_000_000 + ns;
END_FUNCTION

FUNCTION DTL_TO_LDT : LDT
VAR_INPUT IN : DTL; END_VAR
    DTL_TO_LDT := LINT_TO_LDT(days_of_civil(IN.YEAR, IN.MONTH, IN.DAY) * 86_400_000_000_000 +
                              clock_of(IN.HOUR, IN.MINUTE, IN.SECOND, IN.NANOSECOND));
END_FUNCTION

FUNCTION DTL_TO_DT : DT
VAR_INPUT IN : DTL; END_VAR
    DTL_TO_DT := DTL_TO_LDT(IN);
END_FUNCTION

FUNCTION DTL_TO_DATE : DATE
VAR_INPUT IN : DTL; END_VAR
    DTL_TO_DATE := DT_TO_DATE(DTL_TO_LDT(IN));
END_FUNCTION

FUNCTION DTL_TO_TOD : TOD
VAR_INPUT IN : DTL; END_VAR
    DTL_TO_TOD := DT_TO_TOD(DTL_TO_LDT(IN));
END_FUNCTION

FUNCTION DTL_TO_LTOD : LTOD
VAR_INPUT IN : DTL; END_VAR
    DTL_TO_LTOD := DT_TO_TOD(DTL_TO_LDT(IN));
END_FUNCTION

FUNCTION DT_TO_DTL : DTL
VAR_INPUT IN : DT; END_VAR
    DT_TO_DTL := LDT_TO_DTL(IN);
END_FUNCTION

FUNCTION DATE_TO_DTL : DTL
VAR_INPUT IN : DATE; END_VAR
    DATE_TO_DTL := LDT_TO_DTL(DATE_TO_DT(IN));
END_FUNCTION

FUNCTION T_COMBINE : LDT
VAR_INPUT IN1 : DATE; IN2 : TOD; END_VAR
    T_COMBINE := CONCAT_DATE_TOD(IN1, IN2);
END_FUNCTION

FUNCTION CONCAT_DATE : DATE
VAR_INPUT YEAR, MONTH, DAY : LINT; END_VAR
    CONCAT_DATE := LINT_TO_DATE(days_of_civil(YEAR, MONTH, DAY) * 86_400_000_000_000);
END_FUNCTION

FUNCTION CONCAT_TOD : TOD
VAR_INPUT HOUR, MINUTE, SECOND, MILLISECOND : LINT; END_VAR
    CONCAT_TOD := LINT_TO_TOD(clock_of(HOUR, MINUTE, SECOND, MILLISECOND * 1_000_000));
END_FUNCTION

FUNCTION CONCAT_DT : DT
VAR_INPUT YEAR, MONTH, DAY, HOUR, MINUTE, SECOND, MILLISECOND : LINT; END_VAR
    CONCAT_DT := CONCAT_DATE_TOD(CONCAT_DATE(YEAR, MONTH, DAY),
                                 CONCAT_TOD(HOUR, MINUTE, SECOND, MILLISECOND));
END_FUNCTION

FUNCTION CONCAT_LTOD : LTOD
VAR_INPUT HOUR, MINUTE, SECOND, MILLISECOND : LINT; END_VAR
    CONCAT_LTOD := CONCAT_TOD(HOUR, MINUTE, SECOND, MILLISECOND);
END_FUNCTION

FUNCTION CONCAT_LDT : LDT
VAR_INPUT YEAR, MONTH, DAY, HOUR, MINUTE, SECOND, MILLISECOND : LINT; END_VAR
    CONCAT_LDT := CONCAT_DT(YEAR, MONTH, DAY, HOUR, MINUTE, SECOND, MILLISECOND);
END_FUNCTION

FUNCTION SPLIT_DT
VAR_INPUT IN : DT; END_VAR
VAR_OUTPUT YEAR, MONTH, DAY, HOUR, MINUTE, SECOND, MILLISECOND : INT; END_VAR
VAR_TEMP d : DTL; END_VAR
    d := LDT_TO_DTL(IN);
    YEAR := UINT_TO_INT(d.YEAR);
    MONTH := d.MONTH;
    DAY := d.DAY;
    HOUR := d.HOUR;
    MINUTE := d.MINUTE;
    SECOND := d.SECOND;
    MILLISECOND := UDINT_TO_INT(d.NANOSECOND / 1_000_000);
END_FUNCTION

FUNCTION SPLIT_DATE
VAR_INPUT IN : DATE; END_VAR
VAR_OUTPUT YEAR, MONTH, DAY : INT; END_VAR
    SPLIT_DT(DATE_TO_DT(IN), YEAR => YEAR, MONTH => MONTH, DAY => DAY);
END_FUNCTION

FUNCTION SPLIT_TOD
VAR_INPUT IN : TOD; END_VAR
VAR_OUTPUT HOUR, MINUTE, SECOND, MILLISECOND : INT; END_VAR
    SPLIT_DT(LINT_TO_DT(TOD_TO_LINT(IN)), HOUR => HOUR, MINUTE => MINUTE, SECOND => SECOND,
             MILLISECOND => MILLISECOND);
END_FUNCTION

FUNCTION SPLIT_LTOD
VAR_INPUT IN : LTOD; END_VAR
VAR_OUTPUT HOUR, MINUTE, SECOND, MILLISECOND : INT; END_VAR
    SPLIT_TOD(IN, HOUR => HOUR, MINUTE => MINUTE, SECOND => SECOND, MILLISECOND => MILLISECOND);
END_FUNCTION

FUNCTION SPLIT_LDT
VAR_INPUT IN : LDT; END_VAR
VAR_OUTPUT YEAR, MONTH, DAY, HOUR, MINUTE, SECOND, MILLISECOND : INT; END_VAR
    SPLIT_DT(IN, YEAR => YEAR, MONTH => MONTH, DAY => DAY, HOUR => HOUR, MINUTE => MINUTE,
             SECOND => SECOND, MILLISECOND => MILLISECOND);
END_FUNCTION

FUNCTION_BLOCK TONR  // adds up the time that IN is there, until R
VAR_INPUT IN, R : BOOL; PT : TIME; END_VAR
VAR_OUTPUT Q : BOOL; ET : TIME; END_VAR
VAR last : TIME; runs : BOOL; END_VAR
    IF runs AND IN THEN ET := MIN(ET + TIME() - last, PT); END_IF;
    IF R THEN ET := T#0s; END_IF;
    Q := NOT R AND (Q OR IN AND ET >= PT);
    last := TIME();
    runs := IN;
END_FUNCTION_BLOCK

TYPE TONR_TIME : TONR; TONR_LTIME : TONR; END_TYPE

FUNCTION DAY_OF_WEEK : INT  // 0 is Sunday
VAR_INPUT IN : DATE; END_VAR
VAR_TEMP d : DTL; END_VAR
    d := DATE_TO_DTL(IN);
    DAY_OF_WEEK := d.WEEKDAY - 1;
END_FUNCTION
)";

/// Its blocks and types that are to be called.
constexpr std::string_view names[] = {
    "DTL",         "LDT_TO_DTL",  "DTL_TO_LDT",  "DTL_TO_DT", "DTL_TO_DATE", "DTL_TO_TOD",
    "DTL_TO_LTOD", "DT_TO_DTL",   "DATE_TO_DTL", "T_COMBINE", "CONCAT_DATE", "CONCAT_TOD",
    "CONCAT_DT",   "CONCAT_LTOD", "CONCAT_LDT",  "SPLIT_DT",  "SPLIT_DATE",  "SPLIT_TOD",
    "SPLIT_LTOD",  "SPLIT_LDT",   "DAY_OF_WEEK", "TONR",      "TONR_TIME",   "TONR_LTIME"};

}  // namespace

const std::shared_ptr<const SourceFile>& standard_source() {
    static const auto source = std::make_shared<const SourceFile>(
        SourceFile{"(standard functions)", std::string(written)});
    return source;
}

bool uses_standard_source(const Tokens& tokens) {
    static const NameSet set(std::begin(names), std::end(names));
    return std::ranges::any_of(tokens.tokens, [](const Token& token) {
        const bool is_name = token.word == Word::name || token.word == Word::prefix;
        return is_name && token.text.size() >= 3 && set.contains(token.text);
    });
}

std::shared_ptr<const SourceFile> source_of(const BlockType& type) {
    return std::make_shared<const SourceFile>(
        SourceFile{"(" + std::string(type.name) + ")", std::string(type.structured_text)});
}

bool uses_source_of(const BlockType& type, const Tokens& tokens) {
    const std::string_view text = type.structured_text;
    if (text.empty()) return false;
    NameSet said;
    const auto add = [&](const std::string& before, char end) {
        for (std::size_t at = text.find(before); at != text.npos; at = text.find(before, at)) {
            at += before.size();
            said.insert(text.substr(at, text.find(end, at) - at));
        }
    };
    add("FUNCTION \"" + std::string(type.handle) + '.', '"');
    add("FUNCTION_BLOCK ", '\n');
    return std::ranges::any_of(tokens.tokens, [&](const Token& token) {
        return token.word == Word::name && said.contains(token.text);
    });
}

bool is_standard_source(const SourceFile& source) {
    return source.path.starts_with('(') && source.path.ends_with(')');
}

}  // namespace lineshaft::st
