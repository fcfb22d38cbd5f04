#include "runtime/st/vendors/names.hpp"

#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::st {

namespace {

/// What vendors call otherwise: their names, each between two blanks.
struct Renamed {
    std::string_view standard, theirs;
};

constexpr Renamed types[] = {
    {"axis_ref",
     " to_axis to_speedaxis to_positioningaxis to_synchronousaxis to_externalencoder "
     "axis_ref_sm3 axis_ref_virtual_sm3 free_encoder_ref mcaxistype "},
    {"cam_ref", " to_cam to_cambase "},
    {"axes_group_ref", " axis_group_ref_sm3 to_kinematics "},
    {"path_ref", " mc_path_ref "},
    {"ton", " ton_time ton_ltime lton iec_timer iec_ltimer ton_sfb "},
    {"tof", " tof_time tof_ltime ltof tof_sfb "},
    {"tp", " tp_time tp_ltime ltp tp_sfb "},
    {"ctu_int", " iec_counter ctu_sfb "},
    {"ctu_dint", " iec_dcounter "},
    {"ctu_udint", " iec_udcounter "},
    {"ctu_sint", " iec_scounter "},
    {"ctu_usint", " iec_uscounter "},
    {"ctu_uint", " iec_ucounter "},
    // numbers of hardware, blocks, connections and events
    {"uint",
     " hw_any hw_device hw_dpmaster hw_dpslave hw_io hw_iosystem hw_submodule "
     "hw_module hw_interface hw_ieport hw_hsc hw_pwm hw_pto db_any db_www db_dyn port "
     "rtm pip "},
    {"int",
     " ob_any ob_delay ob_tod ob_cyclic ob_att ob_pcycle ob_hwint ob_diag ob_timeerror "
     "ob_startup "},
    {"word", " conn_any conn_prg conn_ouc "},
    {"dword", " conn_r_id event_any event_att event_hwint aom_ident "},
};

/// CODESYS' names of pins of flip-flops and counters, which others have besides.
constexpr Renamed pins[] = {
    {"r", " reset "}, {"ld", " load "}, {"s1", " set1 "}, {"s", " set "}, {"r1", " reset1 "}};

constexpr Renamed parts[] = {{"valid", " busy "},
                             {"homingmode", " mode "},
                             {"q", " qu qd "},
                             {"enablepositive", " enable_positive "},
                             {"enablenegative", " enable_negative "}};

constexpr Renamed arguments[] = {{"in", " str lr_in "},
                                 {"in1", " str1 string1 "},
                                 {"in2", " str2 string2 "},
                                 {"in3", " string3 "},
                                 {"in4", " string4 "},
                                 {"in5", " string5 "},
                                 {"l", " size "},
                                 {"l", " len "},
                                 {"p", " pos "}};

constexpr std::string_view libraries[] = {
    "standard",       "standard64",      "tc2_standard", "tc2_system",  "tc2_mc2",
    "sm3_basic",      "sm3_robotics",    "plcopen",      "system.math", "system.timer",
    "system.strings", "system.datetime", "tc2_math"};

constexpr AddedInput added_inputs[] = {{"StartMode"},       {"StopMode"},
                                       {"Restart"},         {"PositionControlled"},
                                       {"bRegulatorOn"},    {"bDriveStart"},
                                       {"Current", 0},      {"AbortAcceleration", 0},
                                       {"Override", 100},   {"SyncProfileReference", 1},
                                       {"SyncDirection", 3}};

/// What MC_MOVEABSOLUTE's and MC_MOVEVELOCITY's Direction and MC_HOME's Mode mean: 0 and 1 are
/// direct homing, 6, 7, 11 and 12 adjust an encoder or the set-point alike.
constexpr std::int64_t directions[] = {0, 1, 2, 0},
                       homing_modes[] = {0, 3, 4, 4, 4, 4, 3, 0, 4, 4, 4, 0, 3, 4};

constexpr Beginning of_siemens[] = {{"mc_moveabsolute", "Direction", 1},
                                    {"mc_movevelocity", "Velocity", 100},
                                    {"f_trig", "last", 1},
                                    {"ton", "keeps_pt", 1},
                                    {"tof", "keeps_pt", 1},
                                    {"tp", "keeps_pt", 1}};

/// Counters count in 16 bits without a sign. TwinCAT's F_TRIG gives no pulse at the first scan.
constexpr Beginning of_codesys[] = {{"ctu", "data_type", 7},
                                    {"ctd", "data_type", 7},
                                    {"ctud", "data_type", 7},
                                    {"f_trig", "last", 1}};

/// Its CTUD counts in INT.
constexpr Beginning of_automation_studio[] = {{"ctu", "data_type", 7}, {"ctd", "data_type", 7}};

/// Its counters stop, and its timers answer, where the standard's program text of them does.
constexpr Beginning of_matiec[] = {
    {"ctu", "stops_at_preset", 1},        {"ctd", "stops_at_preset", 1},
    {"ctud", "stops_at_preset", 1},       {"ctu_dint", "stops_at_preset", 1},
    {"ctd_dint", "stops_at_preset", 1},   {"ctud_dint", "stops_at_preset", 1},
    {"ctu_lint", "stops_at_preset", 1},   {"ctd_lint", "stops_at_preset", 1},
    {"ctud_lint", "stops_at_preset", 1},  {"ctu_udint", "stops_at_preset", 1},
    {"ctd_udint", "stops_at_preset", 1},  {"ctud_udint", "stops_at_preset", 1},
    {"ctu_ulint", "stops_at_preset", 1},  {"ctd_ulint", "stops_at_preset", 1},
    {"ctud_ulint", "stops_at_preset", 1}, {"ton", "answers_later", 1},
    {"tof", "answers_later", 1},          {"tp", "answers_later", 1}};

std::span<const Beginning> beginnings_of(Vendor vendor) {
    switch (vendor) {
        case Vendor::siemens:
            return of_siemens;
        case Vendor::codesys:
            return of_codesys;
        case Vendor::automation_studio:
            return of_automation_studio;
        case Vendor::matiec:
            return of_matiec;
        case Vendor::none:
            break;
    }
    return {};
}

/// Empty: it is none of theirs.
std::string_view standard_of(std::span<const Renamed> rows, std::string_view name) {
    const auto it =
        std::ranges::find_if(rows, [&](const Renamed& row) { return has_word(row.theirs, name); });
    return it == rows.end() ? std::string_view() : it->standard;
}

}  // namespace

bool has_word(std::string_view words, std::string_view name) {
    return words.find(fmt::format(" {} ", lower(name))) != words.npos;
}

std::string_view standard_type_name(std::string_view name) {
    const std::string_view standard = standard_of(types, name);
    return standard.empty() ? name : standard;
}

std::string_view standard_part_name(std::string_view name) {
    const std::string_view pin = standard_of(pins, name);
    return pin.empty() ? standard_of(parts, name) : pin;
}

std::string long_part_name(std::string_view name) {
    const bool is_plcopens = std::ranges::any_of(name, [](char c) { return lower(c) != c; });
    if (is_plcopens) return std::string(name);
    const auto* pin = std::ranges::find(pins, name, &Renamed::standard);
    return upper(pin == std::end(pins) ? name : pin->theirs.substr(1, pin->theirs.size() - 2));
}

std::string_view standard_argument_name(std::string_view name) {
    const std::string_view standard = standard_of(arguments, name);
    return standard.empty() ? name : standard;
}

bool counts_for_axis(std::string_view member) {
    return has_word(" controldword override ", member);
}

bool is_vendor_library(std::string_view name) {
    return find_called(libraries, name) != nullptr;
}

bool is_open(const LibraryFile& file) {
    return file.library.find('.') == file.library.npos && !file.text.starts_with("{attribute");
}

std::string_view without_library(std::string_view name) {
    const std::size_t point = name.rfind('.');
    const bool has_library = point != name.npos && is_vendor_library(name.substr(0, point));
    return has_library ? name.substr(point + 1) : name;
}

const AddedInput* find_added_input(std::string_view name) {
    return find_called(added_inputs, name, &AddedInput::name);
}

Meanings meanings_of_numbers(std::string_view input) {
    if (input == "Direction") return {directions};
    if (input == "HomingMode") return {homing_modes, true};
    return {};
}

const Beginning* find_beginning(std::string_view kind, Vendor vendor) {
    return find_called(beginnings_of(vendor), kind, &Beginning::kind);
}

}  // namespace lineshaft::st
