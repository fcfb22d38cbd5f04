#include "runtime/st/functions/described.hpp"

namespace lineshaft::st {

namespace {

// clang-format off
constexpr DescribedFunction described_references[] = {
    {"ADR(IN: ANY): POINTER", "where a variable is, for a POINTER TO its type"},
    {"REF(IN: ANY): REF_TO", "a reference to a variable"},
    {"SIZEOF(IN: ANY): UDINT", "the bytes that a variable or a type has on a controller"},
    {"XSIZEOF(IN: ANY): ULINT", "the same as SIZEOF"},
    {"__ISVALIDREF(IN: REFERENCE): BOOL", "whether it refers to something"},
    {"__NEW(a type; count: ANY_INT): POINTER", "a new element of the type, or count in a row, 0 where so many are not free; a statement assigns it: pointer := __NEW(Motor);"},
    {"__DELETE(pointer: POINTER)", "calls FB_exit of what __NEW gave, gives it back and sets the pointer to 0; a statement of its own"},
    {"__POUNAME(): STRING", "the name of the block or function that it stands in"},
    {"__POSITION(): STRING", "the line and column that it stands at"},
};
constexpr DescribedFunction described_variants[] = {
    {"TypeOf(IN: VARIANT): a type", "compared with a variable or a type: whether both are of one type"},
    {"TypeOfElements(IN: VARIANT): a type", "the same of an array's elements"},
    {"IS_ARRAY(IN: VARIANT): BOOL", "whether it is an array"},
    {"VariantGet(SRC: VARIANT; DST: ANY)", "copies what SRC is to DST; of another type nothing, and ENO is FALSE"},
    {"VariantPut(SRC: ANY; DST: VARIANT)", "copies SRC to what DST is; of another type nothing, and ENO is FALSE"},
    {"MOVE_BLK_VARIANT(SRC: VARIANT; COUNT, SRC_INDEX, DEST_INDEX: ANY_INT; DEST: VARIANT): INT", "copies COUNT elements, counted from 0, of one array to those of another; gives 0 or a code of what is wrong"},
};
constexpr DescribedFunction described_dates[] = {
    {"CONCAT_DATE(YEAR, MONTH, DAY: ANY_INT): DATE", "the date; what is none is a fault"},
    {"CONCAT_TOD(HOUR, MINUTE, SECOND, MILLISECOND: ANY_INT): TOD", "the time of day"},
    {"CONCAT_LTOD(HOUR, MINUTE, SECOND, MILLISECOND: ANY_INT): LTOD", "the time of day"},
    {"CONCAT_DT(YEAR, MONTH, DAY, HOUR, MINUTE, SECOND, MILLISECOND: ANY_INT): DT", "the date and time of day"},
    {"CONCAT_LDT(YEAR, MONTH, DAY, HOUR, MINUTE, SECOND, MILLISECOND: ANY_INT): LDT", "the date and time of day"},
    {"SPLIT_DATE(IN: DATE; YEAR, MONTH, DAY => INT)", "takes a date apart"},
    {"SPLIT_TOD(IN: TOD; HOUR, MINUTE, SECOND, MILLISECOND => INT)", "takes a time of day apart"},
    {"SPLIT_LTOD(IN: LTOD; HOUR, MINUTE, SECOND, MILLISECOND => INT)", "takes a time of day apart"},
    {"SPLIT_DT(IN: DT; YEAR, MONTH, DAY, HOUR, MINUTE, SECOND, MILLISECOND => INT)", "takes a date and time of day apart"},
    {"SPLIT_LDT(IN: LDT; YEAR, MONTH, DAY, HOUR, MINUTE, SECOND, MILLISECOND => INT)", "takes a date and time of day apart"},
    {"DAY_OF_WEEK(IN: DATE): INT", "0 of a Sunday to 6 of a Saturday"},
    {"T_COMBINE(IN1: DATE; IN2: TOD): LDT", "the date with the time of day"},
    {"LDT_TO_DTL(IN: LDT): DTL", "the members of the structure DTL, whose WEEKDAY is 1 of a Sunday"},
    {"DT_TO_DTL(IN: DT): DTL", "the same of a DT"},
    {"DATE_TO_DTL(IN: DATE): DTL", "the same of a DATE, at midnight"},
    {"TOD_TO_DTL(IN: TOD): DTL", "the same of a TOD, on 1970-01-01"},
    {"DTL_TO_LDT(IN: DTL): LDT", "the date and time of day of the structure; what is none is a fault"},
    {"DTL_TO_DT(IN: DTL): DT", "its date and time of day"},
    {"DTL_TO_DATE(IN: DTL): DATE", "its date"},
    {"DTL_TO_TOD(IN: DTL): TOD", "its time of day"},
    {"DTL_TO_LTOD(IN: DTL): LTOD", "its time of day"},
    {"RD_SYS_T(OUT => DTL or LDT): INT", "the clock, which begins with the run at 1970-01-01; gives 0"},
    {"RD_LOC_T(OUT => DTL or LDT): INT", "the same: local time is UTC"},
    {"WR_SYS_T(IN: DTL or LDT): INT", "sets no clock, which is that of the run: gives 16#80B0"},
    {"TIME_TO_S5TIME(IN: TIME): S5TIME", "the nearest time that an S5TIME has, of the shortest base"},
    {"S5TIME_TO_TIME(IN: S5TIME): TIME", "the time of three digits and a base"},
    {"LTIME_TO_S5TIME(IN: LTIME): S5TIME", "the nearest time that an S5TIME has, of the shortest base"},
    {"S5TIME_TO_LTIME(IN: S5TIME): LTIME", "the time of three digits and a base"},
    {"RUNTIME(MEM: LREAL): LREAL", "the time since the call that left MEM [s], which it writes; within a scan none passes"},
};
constexpr DescribedFunction described_bytes[] = {
    {"PEEK(area, dbNumber, byteOffset: ANY_INT): BYTE", "a byte of the inputs, outputs or memory bits (areas 16#81, 16#82, 16#83; 16#1 and 16#2 are inputs and outputs, too), or of the data block with that number (16#84)"},
    {"PEEK_BYTE(area, dbNumber, byteOffset: ANY_INT): BYTE", "the same as PEEK"},
    {"PEEK_WORD(area, dbNumber, byteOffset: ANY_INT): WORD", "two bytes there, the highest first"},
    {"PEEK_DWORD(area, dbNumber, byteOffset: ANY_INT): DWORD", "four bytes there, the highest first"},
    {"PEEK_BOOL(area, dbNumber, byteOffset, bitOffset: ANY_INT): BOOL", "a bit there"},
    {"POKE(area, dbNumber, byteOffset: ANY_INT; value: ANY_WHOLE)", "writes a BYTE, WORD, DWORD or LWORD there, the highest byte first"},
    {"POKE_BOOL(area, dbNumber, byteOffset, bitOffset: ANY_INT; value: BOOL)", "writes a bit there"},
    {"READ_LITTLE(SRC_ARRAY: ARRAY; DEST_VARIABLE: ANY_ELEMENTARY; POS: DINT): INT", "a number out of bytes from POS on, the lowest first, behind which POS then is; gives 0 or a code of what is wrong"},
    {"READ_BIG(SRC_ARRAY: ARRAY; DEST_VARIABLE: ANY_ELEMENTARY; POS: DINT): INT", "the same, the highest byte first"},
    {"WRITE_LITTLE(SRC_VARIABLE: ANY_ELEMENTARY; DEST_ARRAY: ARRAY; POS: DINT): INT", "a number to bytes from POS on, the lowest first, behind which POS then is; gives 0 or a code of what is wrong"},
    {"WRITE_BIG(SRC_VARIABLE: ANY_ELEMENTARY; DEST_ARRAY: ARRAY; POS: DINT): INT", "the same, the highest byte first"},
    {"Serialize(SRC_VARIABLE: ANY; DEST_ARRAY: ARRAY; POS: DINT): INT", "the bytes of a variable, as an S7 has them, to an array from POS on; gives 0 or a code of what is wrong"},
    {"Deserialize(SRC_ARRAY: ARRAY; DEST_VARIABLE: ANY; POS: DINT): INT", "bytes of an array from POS on to a variable; gives 0 or a code of what is wrong"},
    {"BLKMOV(SRCBLK, DSTBLK: ANY): INT", "copies as many bytes as both have; gives 0 or a code of what is wrong"},
    {"UBLKMOV(SRCBLK, DSTBLK: ANY): INT", "the same as BLKMOV"},
    {"FILL(BVAL, BLK: ANY): INT", "writes the bytes of BVAL again and again, until BLK is full; gives 0"},
};
constexpr DescribedFunction described_digits[] = {
    {"INT_TO_BCD16(IN: INT): WORD", "three decimal digits, the four bits on the left all 1 below 0"},
    {"DINT_TO_BCD32(IN: DINT): DWORD", "seven decimal digits, the four bits on the left all 1 below 0"},
    {"BCD16_TO_INT(IN: WORD): INT", "the number of three decimal digits"},
    {"BCD32_TO_DINT(IN: DWORD): DINT", "the number of seven decimal digits"},
    {"INT_TO_BCD16_WORD(IN: INT): WORD", "the same as INT_TO_BCD16"},
    {"DINT_TO_BCD32_DWORD(IN: DINT): DWORD", "the same as DINT_TO_BCD32"},
    {"WORD_BCD16_TO_INT(IN: WORD): INT", "the same as BCD16_TO_INT"},
    {"DWORD_BCD32_TO_DINT(IN: DWORD): DINT", "the same as BCD32_TO_DINT"},
    {"BCDCPL(IN: DWORD): DWORD", "what seven decimal digits lack to 10000000"},
    {"BITSUM(IN: DWORD): INT", "how many bits are 1"},
    {"SEG(IN: WORD; OUT => DWORD)", "the segments g to a of four hexadecimal digits, a byte each"},
    {"SCALE(IN: INT; HI_LIM, LO_LIM: REAL; BIPOLAR: BOOL; OUT => REAL): WORD", "LO_LIM to HI_LIM of an analog value of 0 to 27648, or from -27648 on; gives 0, or 8 where IN is beyond"},
    {"UNSCALE(IN, HI_LIM, LO_LIM: REAL; BIPOLAR: BOOL; OUT => INT): WORD", "an analog value of 0 to 27648, or from -27648 on, of LO_LIM to HI_LIM; gives 0, or 8 where IN is beyond"},
    {"EDGE(IN: BOOL): BOOL", "whether IN is another than in the call before of the same place"},
    {"EDGEPOS(IN: BOOL): BOOL", "whether IN has become TRUE since that"},
    {"EDGENEG(IN: BOOL): BOOL", "whether IN has become FALSE since that"},
};
constexpr DescribedFunction described_characters[] = {
    {"STRG_VAL(IN: STRING; FORMAT: WORD; P: UINT; OUT => ANY_NUM)", "the number that a text has from character P on; where it has none OUT is 0 and ENO FALSE"},
    {"VAL_STRG(IN: ANY_NUM; SIZE, PREC: USINT; FORMAT: WORD; P: UINT; OUT: STRING)", "writes a number with PREC digits behind the point into SIZE characters of OUT from P on"},
    {"Strg_TO_Chars(Strg: STRING; pChars: DINT; Cnt => UINT; Chars: ARRAY)", "writes the characters of a text to elements from pChars on, counted from 0"},
    {"Chars_TO_Strg(Chars: ARRAY; pChars: DINT; Cnt: UINT; Strg: STRING)", "makes a text of Cnt elements from pChars on, of all that follow where Cnt is 0"},
    {"HTA(IN: ARRAY; N: UINT; OUT: STRING): WORD", "writes N bytes as two hexadecimal digits each; gives 0 or a code of what is wrong"},
    {"ATH(IN: STRING; N: UINT; OUT: ARRAY): WORD", "makes bytes of N hexadecimal digits; gives 0 or a code of what is wrong"},
};
constexpr DescribedSubject subjects[] = {
    {"references", described_references}, {"variants", described_variants}, {"dates", described_dates},
    {"bytes", described_bytes}, {"digits", described_digits}, {"characters", described_characters}};
// clang-format on

}  // namespace

std::span<const DescribedSubject> described_functions() {
    return subjects;
}

}  // namespace lineshaft::st
