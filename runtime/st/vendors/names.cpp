#include "runtime/st/vendors/names.hpp"

#include <algorithm>

#include "runtime/st/syntax/token.hpp"

namespace lineshaft::st {

namespace {

struct Renamed {
    std::string_view theirs, standard;
};

constexpr Renamed types[] = {{"to_axis", "axis_ref"},
                             {"to_speedaxis", "axis_ref"},
                             {"to_positioningaxis", "axis_ref"},
                             {"to_synchronousaxis", "axis_ref"},
                             {"axis_ref_sm3", "axis_ref"},
                             {"axis_ref_virtual_sm3", "axis_ref"},
                             {"to_cam", "cam_ref"},
                             {"axis_group_ref_sm3", "axes_group_ref"},
                             {"mc_path_ref", "path_ref"},
                             {"ton_time", "ton"},
                             {"tof_time", "tof"},
                             {"tp_time", "tp"},
                             {"ton_ltime", "ton"},
                             {"tof_ltime", "tof"},
                             {"tp_ltime", "tp"},
                             {"iec_timer", "ton"},
                             {"iec_ltimer", "ton"},
                             {"iec_counter", "ctu_int"},
                             {"iec_dcounter", "ctu_dint"},
                             {"iec_udcounter", "ctu_udint"},
                             {"iec_scounter", "ctu_sint"},
                             {"iec_uscounter", "ctu_usint"},
                             {"iec_ucounter", "ctu_uint"},
                             // numbers of hardware, blocks, connections and events
                             {"hw_any", "uint"},
                             {"hw_device", "uint"},
                             {"hw_dpmaster", "uint"},
                             {"hw_dpslave", "uint"},
                             {"hw_io", "uint"},
                             {"hw_iosystem", "uint"},
                             {"hw_submodule", "uint"},
                             {"hw_module", "uint"},
                             {"hw_interface", "uint"},
                             {"hw_ieport", "uint"},
                             {"hw_hsc", "uint"},
                             {"hw_pwm", "uint"},
                             {"hw_pto", "uint"},
                             {"db_any", "uint"},
                             {"db_www", "uint"},
                             {"db_dyn", "uint"},
                             {"port", "uint"},
                             {"rtm", "uint"},
                             {"pip", "uint"},
                             {"ob_any", "int"},
                             {"ob_delay", "int"},
                             {"ob_tod", "int"},
                             {"ob_cyclic", "int"},
                             {"ob_att", "int"},
                             {"ob_pcycle", "int"},
                             {"ob_hwint", "int"},
                             {"ob_diag", "int"},
                             {"ob_timeerror", "int"},
                             {"ob_startup", "int"},
                             {"conn_any", "word"},
                             {"conn_prg", "word"},
                             {"conn_ouc", "word"},
                             {"conn_r_id", "dword"},
                             {"event_any", "dword"},
                             {"event_att", "dword"},
                             {"event_hwint", "dword"},
                             {"aom_ident", "dword"}};

constexpr Renamed parts[] = {{"reset", "r"},
                             {"load", "ld"},
                             {"set1", "s1"},
                             {"set", "s"},
                             {"reset1", "r1"},
                             {"busy", "valid"},
                             {"mode", "homingmode"},
                             {"qu", "q"},
                             {"qd", "q"},
                             {"enable_positive", "enablepositive"},
                             {"enable_negative", "enablenegative"}};

constexpr Renamed arguments[] = {{"str", "in"},      {"str1", "in1"},   {"str2", "in2"},
                                 {"size", "l"},      {"len", "l"},      {"pos", "p"},
                                 {"string1", "in1"}, {"string2", "in2"}};

constexpr std::string_view libraries[] = {"standard",     "standard64",     "tc2_standard",
                                          "tc2_system",   "tc2_mc2",        "sm3_basic",
                                          "sm3_robotics", "plcopen",        "system.math",
                                          "system.timer", "system.strings", "system.datetime"};

constexpr AddedInput added_inputs[] = {
    {"StartMode"},    {"StopMode"},    {"Restart"},    {"PositionControlled"},
    {"bRegulatorOn"}, {"bDriveStart"}, {"Current", 0}, {"AbortAcceleration", 0},
    {"Override", 100}};

/// Of MC_MOVEABSOLUTE's and MC_MOVEVELOCITY's Direction, and of MC_HOME's Mode.
constexpr std::int64_t directions[] = {0, 1, 2, 0}, homing_modes[] = {0, -1, -1, -1, -1, -1, -1, 0};

}  // namespace

std::string_view standard_type_name(std::string_view name) {
    const auto* it = std::ranges::find_if(
        types, [&](const Renamed& renamed) { return same_name(renamed.theirs, name); });
    return it == std::end(types) ? name : it->standard;
}

std::string_view standard_part_name(std::string_view name) {
    const auto* it = std::ranges::find_if(
        parts, [&](const Renamed& renamed) { return same_name(renamed.theirs, name); });
    return it == std::end(parts) ? std::string_view() : it->standard;
}

std::string_view standard_argument_name(std::string_view name) {
    const auto* it = std::ranges::find_if(
        arguments, [&](const Renamed& renamed) { return same_name(renamed.theirs, name); });
    return it == std::end(arguments) ? name : it->standard;
}

bool is_vendor_library(std::string_view name) {
    return std::ranges::any_of(libraries,
                               [&](std::string_view known) { return same_name(known, name); });
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
    const auto* it = std::ranges::find_if(
        added_inputs, [&](const AddedInput& input) { return same_name(input.name, name); });
    return it == std::end(added_inputs) ? nullptr : it;
}

std::span<const std::int64_t> meanings_of_numbers(std::string_view input) {
    if (input == "Direction") return directions;
    if (input == "HomingMode") return homing_modes;
    return {};
}

}  // namespace lineshaft::st
