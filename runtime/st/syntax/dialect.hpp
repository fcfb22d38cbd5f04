#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "runtime/model/address.hpp"

namespace lineshaft::st {

/// Whose blocks of the standard differ from it.
enum class Vendor : std::uint8_t { none, automation_studio, codesys, matiec, siemens };

/// How REAL_TO_STRING writes 12.0: '12'; '12.0', as TwinCAT has it; the same, and of LREALs below 1
/// and of what is not finite otherwise, as CODESYS has it; '+1.200000E+1', as Siemens has it.
enum class TextOfReal : std::uint8_t { shortest, rounded, of_codesys, with_exponent };

/// What REAL_TO_USINT(300.0) is, beyond the type: a fault, 44, or what is left in a register, as
/// CODESYS has it (code/meaning.hpp, left_in_32).
enum class BeyondType : std::uint8_t { fault, lowest_bits, left_in_register };

/// x / 0 and x MOD 0 of whole numbers: faults; the latter 0; both 0.
enum class ByZero : std::uint8_t { fault, leaves_zero, is_zero };

/// MUX of a number that none of its inputs has and without INELSE: a fault, the last input, or what
/// its type begins with.
enum class OtherChoice : std::uint8_t { fault, last, initial };

/// LIMIT where MN is above MX: MX; MX if IN is above MN, else MN; IN.
enum class CrossedLimits : std::uint8_t { upper, upper_or_lower, input };

/// How a time is written: `T#1s500ms`, `D#2020-02-29`, `TOD#12:30:15.250`,
/// `DT#2020-02-29-12:30:15`; of LTIME and its like `LTIME#1s500ms`, `LDATE#2020-02-29`; of these in
/// CODESYS `LD#2020-02-29`, `LTIME#0ns`, and nine digits behind the point; in MatIEC six,
/// `TOD#12:30:15.250000`.
enum class TimeForm : std::uint8_t { plain, of_long, of_long_in_codesys, of_matiec };

/// What STRING_TO_INT and its like read: digits, with `_` between groups of them, signs and points
/// as an S7-1500 does, what MatIEC's library in C does.
enum class NumberOfText : std::uint8_t { digits, grouped_digits, of_s7, of_matiec };

/// Whose libraries have what a source names and does not declare.
enum class Libraries : std::uint8_t {
    plcopen,
    automation_studio,
    codesys,
    matiec,
    siemens,
    twincat
};

/// Whose rules a sequential function chart goes by: flags, last scans, order of actions.
enum class ChartRules : std::uint8_t { standard, codesys, matiec };

/// What one language of the name Structured Text means where another means something else. A source
/// has one dialect for good, see Source. All else is read alike in all of them.
struct Dialect {
    bool sign_precedes_power = false;           ///< `-2 ** 2` is 4, else -4
    bool constants_have_values = false;         ///< VAR CONSTANT without `:=` is told, which is 0
    bool quotes_may_enclose_texts = false;      ///< an undeclared `"..."` may be meant as a text
    bool named_inputs_may_be_left_out = false;  ///< of a function, where it has no value for them
    bool sets_variables_of_instances = false;   ///< `instance.x := 1;` also of VAR and VAR_OUTPUT
    bool real_results_reckon_as_real = false;   ///< a DINT and a REAL make a REAL where one is due
    bool dint_becomes_real = false;         ///< although a REAL does not hold every DINT: a warning
    bool lreal_becomes_real = false;        ///< although a REAL rounds it: a warning
    bool enumerations_are_numbers = false;  ///< a variable's number is a value, also another's
    bool numbers_stand_for_names = false;   ///< 1 for `mcPositiveDirection`, as Siemens counts them
    bool texts_of_integers_have_signs = false;  ///< INT_TO_STRING(5) is '+5', UINT_TO_STRING(5) '5'
    bool bits_count_in_reals = false;   ///< DWORD_TO_REAL(1) is 1.0, else the REAL of these bits
    bool commas_may_end_lists = false;  ///< `f(a, )`
    bool is_loose = false;              ///< `RETURN(done);`, `;;`, CONCAT(STR1 := a)
    bool programs_are_named = false;    ///< `Main.count` of a PROGRAM, of which there is one then
    bool texts_are_bytes = false;   ///< `text[0]` is the first BYTE, and a 0 ends the text; else
                                    ///< `text[1]` is the first CHAR
    bool selects_by_texts = false;  ///< CASE of a STRING, as SIMATIC AX has it
    bool loops_begin_narrowed = false;  ///< FOR in an INT from a DINT on, as there: a warning
    bool capitals_count = false;        ///< declarations of B&R: `a` and `A` are two names
    bool packs_as_s7 = false;           ///< bytes of packed memory: the highest first, words even
    bool begin_is_no_name = false;      ///< BEGIN ends the declarations, whatever follows
    bool seconds_move_moments = false;  ///< `moment + 5` of a DT
    bool pins_have_long_names = false;  ///< of the standard's blocks in messages: RESET, not r
    bool references_take_addresses = false;  ///< `r := ADR(x)` and `r <> 0` of a REFERENCE TO
    Vendor vendor = Vendor::none;            ///< whose instances begin as find_beginning says
    bool has_s7_instructions = false;        ///< VARIANT, DTL, S5 timers, ENO of functions, bytes
    ChartRules charts = ChartRules::standard;
    OtherChoice other_choice = OtherChoice::fault;
    CrossedLimits crossed_limits = CrossedLimits::upper;
    bool extremes_keep_second = false;     ///< MIN and MAX of two of which one is no number
    bool reckons_in_registers = false;     ///< UDINT and INT make a DINT, SHL by 33 places is by 1
    bool goto_is_a_name = false;           ///< JMP is the word
    bool points_may_end_reals = false;     ///< `10.`
    bool has_sections_of_exports = false;  ///< lines between declarations, as `.EXP` has them
    bool durations_may_stand_apart = false;  ///< `T# 1s`
    bool open_texts_end_with_lines = false;  ///< one that lacks its quote
    bool ampersands_may_be_two = false;      ///< `a && b`
    bool peripheries_are_image = false;      ///< `%IW4:P` is `%IW4`, `"tag":P` is `"tag"`
    bool dint_is_time = false;               ///< a DINT is a TIME in ms, and the other way
    bool texts_end_at_zero = false;          ///< a literal's `$00` ends it
    bool ignores_excess_values = false;      ///< of an array that has fewer elements
    bool texts_have_any_length = false;      ///< STRING[0], and a reference to it is one to any
    Libraries libraries = Libraries::plcopen;
    bool axes_are_types = false;        ///< `axis` of the catalogue is one, else in a TEST alone
    bool variables_hide_types = false;  ///< `Trace : Trace;` beside any TYPE, else beside blocks
    bool this_calls_methods = false;    ///< `f()` is a FUNCTION also where a METHOD has its name
    bool methods_may_leave_out_inputs = false;  ///< at the end of a call by position
    bool any_takes_literals = false;            ///< an ANY input is given INT#5
    bool texts_grow_by_characters = false;      ///< `text[6] := 'x'` of one of five characters
    bool takes_what_others_refuse = false;  ///< an instance in a function, UINT of a UINT and an
                                            ///< INT, `[COUNT(5)]`
    NumberOfText number_of_text = NumberOfText::digits;
    TimeForm text_of_time = TimeForm::plain, text_of_long_time = TimeForm::of_long;
    bool no_time_is_ms = false;          ///< TIME_TO_STRING(T#0s) is 'T#0ms', else 'T#0s'
    bool truth_may_go_on = false;        ///< STRING_TO_BOOL('TRUE?') is TRUE, of '1' FALSE
    bool texts_have_255 = false;         ///< what functions make, and LEN counts, else 254 and all
    bool middle_begins_at_one = false;   ///< MID with P of 0 is empty
    bool inserts_within_text = false;    ///< INSERT and REPLACE leave it as it is for a P behind it
    bool negative_counts_clear = false;  ///< INSERT, DELETE and REPLACE are empty if L is -1
    // CODESYS, and of it what TwinCAT has
    bool literals_wrap = false;              ///< an INT of 40000, a BYTE of -1: a warning
    bool underlines_may_repeat = false;      ///< `1__000`
    bool long_numbers_become_real = false;   ///< LINT and ULINT do where a REAL is due
    bool bounds_have_32_bits = false;        ///< UPPER_BOUND is no LINT where one is due
    bool dates_take_times = false;           ///< DATE + TIME
    bool blocks_begin_with_methods = false;  ///< SIZEOF of a block counts where these are
    bool has_implicit_checks = false;        ///< CheckBounds, CheckDivInt
    bool image_has_points = false;           ///< `%QW9.24.0` of a bus
    bool keeps_bits_of_register = false;     ///< BeyondType::fault is beyond a register, not the
                                             ///< type, whose lowest bits are kept
    std::string_view instance_root = "Project";  ///< before the name of a program in a path
    // MatIEC
    bool functions_are_in_c = false;     ///< conversions and texts by its library: TIMEs count s
    bool functions_keep_widths = false;  ///< an INT that was reckoned is cut before it is given
    bool ands_end_early = false;         ///< AND and OR of BOOLs look at the second where it counts
    bool disabled_calls_give_zero = false;  ///< `y := f(EN := FALSE);`, else y stays
    // B&R
    bool actions_are_of_callers = false;        ///< an ACTION of a file belongs to who runs it
    bool times_take_numbers = false;            ///< `timer.PT := 500`, of ms
    bool words_of_dates_count_seconds = false;  ///< DATE_TO_UINT, else days
    bool in_outs_take_any_text = false;         ///< VAR_IN_OUT of a STRING[20] a STRING[80]
    bool references_take_numbers = false;  ///< that are addresses, be they of its type; an array of
                                           ///< another length
    // Siemens
    bool outputs_may_be_assigned = false;  ///< `f(q := x)` takes the output, as STEP 7 V5 wrote it
    bool copies_in_outs = false;           ///< what is elementary, at the end of the call
    bool has_no_pointers = false;          ///< to a variable that a call was given
    bool return_gives_eno = false;         ///< `RETURN n > 0;`
    bool inputs_take_any_integer = false;  ///< also where one of several methods is chosen by types
    bool compares_structures = false;      ///< and arrays: `a = b`
    bool assigns_same_forms = false;       ///< structures without a name, arrays of other bounds
    bool subranges_are_integers = false;   ///< a BYTE has none
    bool refuses_finer_times = false;      ///< T#1us, else it is T#0s
    bool times_have_signs = false;         ///< those of whole ms; else T#0s - T#1ms is T#49d...
    bool dates_count_days = false;         ///< of any whole number
    bool dates_begin_1990 = false;         ///< a DATE and a DT, else with 1970
    bool truth_is_lowest_bit = false;      ///< INT_TO_BOOL(2) is FALSE
    bool nan_is_not_unequal = false;       ///< `x <> y` is FALSE, too, where one is no number
    AddressCount addresses_count = AddressCount::bytes;
    TextOfReal text_of_real = TextOfReal::shortest;
    std::uint8_t most_aligned = 1;         ///< bytes that a member of a structure begins at
    std::uint8_t pointer_bytes = 8;        ///< SIZEOF of a POINTER TO
    bool programs_run_as_written = false;  ///< those due at once, in spite of PRIORITY
    std::uint32_t text_length = 254;       ///< characters of a STRING without a length
    bool long_numbers_count_time = false;  ///< TIME_TO_LINT(T#1s) is 1000, else in ns
    std::uint8_t reckons_in = 0;  ///< bits, whole numbers that have fewer, until they are kept:
                                  ///< 32 as C and CODESYS have it; else in their own
    bool bool_is_number = false;  ///< a BOOL is 0 or 1 where a number is due
    bool real_literals_are_lreal = false;  ///< `i * 0.1` of an INT is an LREAL, else a REAL
    bool loops_look_again = false;         ///< FOR reads its limit and step in each pass, else once
    BeyondType beyond_type = BeyondType::fault;
    bool rounds_away = false;                 ///< REAL_TO_INT(2.5) is 3, else the even one
    bool enumerations_begin_at_zero = false;  ///< where one of its values is 0, else at the first
    ByZero by_zero = ByZero::fault;
    bool times_count_ms = false;       ///< a TIME is whole ms in 32 bits, also what is reckoned
    bool dates_count_seconds = false;  ///< a DT and a DATE are whole seconds, a TOD whole ms, in 32
                                       ///< bits, also what is reckoned
    bool texts_are_windows_1252 = false;  ///< a letter of 'Größe' is a byte, else UTF-8, as ever in
                                          ///< a WSTRING
    bool inputs_may_be_left_out = false;     ///< at the end of a call by position
    bool literals_are_characters = false;    ///< TO_INT('0') is 48, of the CHAR, else 0
    bool characters_may_be_missing = false;  ///< text[0] is read as $00 and not written, or a fault
    bool literals_suit_their_use = false;    ///< SEL(b, 1, 3) is real where that is due, and
                                             ///< EXPT(2, 3) whole; else the other way
};

/// IEC 61131-3:2013, the same as SIMATIC AX compiles it, what B&R declares in files of its own,
/// CODESYS and Beckhoff's TwinCAT, and the SCL of Siemens' TIA Portal. `matiec` is what Beremiz and
/// OpenPLC compile, in PLCopen XML and in text: as loose as CODESYS, with the standard's blocks and
/// texts. `codesys_23` is that of CoDeSys 2.3, of 32 bits, `word_addressed` CODESYS for devices
/// whose bits are those of words, as WAGO's.
extern const Dialect iec, simatic_ax, automation_studio, codesys, codesys_23, word_addressed,
    word_addressed_23, twincat, scl, matiec;

/// By the ending of a file's name: `.st` is the standard's, `.typ`, `.var`, `.fun` and what a
/// `.prg` puts together are B&R's, `.EXP` CoDeSys 2.3's, `.xml` CODESYS', `.TcPOU` and its like
/// TwinCAT's, others SCL. Any other text, `.txt`, `.iecst`, is as one in `.st`, behind whose name
/// it may say otherwise, `.scl.txt`. One in `.st` with `RESOURCE x ON PLC` is MatIEC's; with an
/// attribute, `{attribute 'x'}`, it is CODESYS'; with a line `NAMESPACE x` or `USING x;` it is
/// SIMATIC AX'; with a line that begins with DATA_BLOCK or ORGANIZATION_BLOCK it is SCL. One in
/// `.EXP` or `.xml` that has a bit above 7, `%IX0.12`, is of a word-addressed device.
const Dialect& dialect_of(std::string_view path, std::string_view text = {});

/// It is read as a `.st` is.
bool is_plain_text(std::string_view path);

/// A `.fun` of B&R: what it declares has its bodies elsewhere, and pins of any name.
bool has_no_bodies(std::string_view path);

/// What users call a dialect, and the ending of a file's name that has it.
struct DialectName {
    std::string_view name, ending;
};
/// `iec`, `codesys`, `twincat`, `scl`, `automation_studio`, `matiec`.
std::span<const DialectName> dialect_names();

/// From now on users' files in `.st` of which SourceFile::read_as says nothing have the dialect of
/// an ending, one of dialect_names(): by `--source-dialect`, for the whole process.
void read_plain_text_as(std::string_view ending);
/// That ending; empty at first, where each file has its own.
std::string_view plain_text_ending();

}  // namespace lineshaft::st
