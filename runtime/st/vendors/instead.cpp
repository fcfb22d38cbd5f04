#include <algorithm>
#include <span>

#include "runtime/st/vendors/names.hpp"

namespace lineshaft::st {

namespace {

struct Instead {
    std::string_view names, instead;
};

constexpr Instead types_of_vendors[] = {
    {" s5time ", "write TIME"},
    {" any ", "write VARIANT, or the type; a block for each"},
    {" pointer ", "pass the variable as VAR_IN_OUT"},
    {" pid_3step pid_temp cont_c cont_s pulsegen ", "write the controller as a FUNCTION_BLOCK"},
    {" mb_client mb_server ", "serve the machine: lineshaft serve --modbus"},
    {" datalogcreate datalogopen datalogwrite datalogclose datalogclear datalogdelete "
     "datalognewfile ",
     "leave it out: 'lineshaft run --trace' keeps what the run did"},
    {" recipeexport recipeimport ",
     "leave it out: the controller has no files here; keep recipes in a DATA_BLOCK"},
    {" tcon_ip_v4 tcon_ip_v4_sec tcon_ip_rfc tcon_param tcon_phys tcon_qdn tcon tdiscon tsend "
     "trcv tsend_c trcv_c tusend turcv ",
     "leave the connection out: nobody is at its other end here; a FUNCTION_BLOCK of this name "
     "with its outputs stands for it"},
};

/// Elsewhere a block of the user's own may have such a name.
constexpr Instead types_of_s7[] = {{" counter ", "declare an instance of CTU, CTD or CTUD"},
                                   {" timer ", "declare an instance of TON, TOF or TP"}};

constexpr Instead functions_of_vendors[] = {
    {" sizeof ", "declare the size as a constant"},
    {" adr ref ", "pass the variable as VAR_IN_OUT"},
    {" wr_sys_t ", "leave it out: the clock is that of the run, which begins 1970-01-01"},
    {" int_to_bcd ", "write INT_TO_BCD16(x)"},
    {" get_error get_err_id ", "a fault ends the scan and is the block's output 'error_id'"},
    {" s_move ", "assign the STRING with ':='"},
    {" join ", "write CONCAT(a, b, ...)"},
    {" topositioningaxisref tosynchronousaxisref tospeedaxisref asaxisref aspositioningaxisref "
     "assynchronousaxisref asspeedaxisref asexternalencoderref ",
     "declare the axis as VAR_IN_OUT of type TO_PositioningAxis: no number of a data block names "
     "one here"},
    {" qry_cint set_cint can_tint set_tint srt_dint ",
     "say the cycle of an OB in the program: tasks: {OB30: {cycle: 10 ms}}"},
    {" read_dbl writ_dbl create_db delete_db ",
     "copy with ':=': a data block has no load memory here"},
    {" getblockname getsymbolname getsymbolpath getsymbolforreference ",
     "give the name as a VAR_INPUT of type STRING"},
    {" gen_usrmsg gen_diag get_diag ",
     "leave it out: nobody reads messages of the controller here"},
    {" led get_im_data devicestates modulestates d_act_dp geo2log log2geo io2mod rd_addr get_name "
     "get_statioinfo ",
     "leave it out: the controller has no hardware here"},
    {" s_comp ", "compare the texts: a = b"},
    {" word_to_block_db ", "name the data block: no number names one here"},
    {" wr_loc_t set_timezone snc_rtcb ",
     "leave it out: the clock is that of the run, which begins 1970-01-01"},
    {" wait ", "count the time with a TON"},
    {" stp ", "end the run with 'run: {until: ...}' in the program"},
    {" re_trigr ", "leave it out: 'maximum_cycle_time' says how long a scan may last"},
    {" getinstancename ", "give the name as a VAR_INPUT of type STRING"}};

/// Where nobody declares them.
constexpr Instead names_of_vendors[] = {
    {" inc ", "if it is Omron's, write x := x + 1"},
    {" dec ", "if it is Omron's, write x := x - 1"},
    {" gettime getmytaskinterval timetonanosec nanosectotime testabit setabit resetabit memcopy "
     "arymove sizeofary dttostring p_on p_off p_firstrun p_first_runmode ",
     "this is of Omron's Sysmac Studio: declare a FUNCTION or a variable of this name"},
    {" cop cps jsr osri osrr tonr tofr rtor gsv ssv ",
     "this is an instruction of Rockwell's Logix: declare a FUNCTION or a FUNCTION_BLOCK of this "
     "name"},
    {" out_t out_c out_h ldp ldf ldpi ldfi plf rst dmov bmov fmov mep mef ",
     "this is an instruction of Mitsubishi's: declare a FUNCTION or a FUNCTION_BLOCK of this name"},
    {" re fe ", "if it is Schneider's, declare an R_TRIG or an F_TRIG, and take its Q"}};

/// What stands between '%' and a number there.
constexpr std::string_view areas_of_schneider = " s sw sd kw kd kf tm drs pls pwm vc msg ";

/// What numbers stand behind in the names of devices of Mitsubishi and Keyence.
constexpr std::string_view devices = " x y m d b w l r sm sd mr dm lr em tc ts tn cc cs cn ";

constexpr Instead inputs_of_vendors[] = {
    {" cam ", "select the cam with MC_CamTableSelect, and give its CamTableID"}};

std::string_view instead_in(std::span<const Instead> rows, std::string_view name) {
    const auto it =
        std::ranges::find_if(rows, [&](const Instead& row) { return has_word(row.names, name); });
    return it == rows.end() ? std::string_view() : it->instead;
}

}  // namespace

std::string_view instead_of_type(std::string_view name, Vendor vendor) {
    const std::string_view of_s7 =
        vendor == Vendor::siemens ? instead_in(types_of_s7, name) : std::string_view();
    return of_s7.empty() ? instead_in(types_of_vendors, name) : of_s7;
}

std::string_view instead_of_function(std::string_view name) {
    return instead_in(functions_of_vendors, name);
}

std::string_view instead_of_undeclared(std::string_view name, bool may_be_device) {
    const std::string_view instead = instead_in(names_of_vendors, name);
    const std::size_t digits = name.find_first_of("0123456789");
    const bool is_device = may_be_device && instead.empty() && digits != name.npos &&
                           name.find_first_not_of("0123456789", digits) == name.npos &&
                           has_word(devices, name.substr(0, digits));
    return is_device ? "if it is a device of Mitsubishi's or Keyence's controllers, declare it: "
                       "VAR_GLOBAL M0 : BOOL; D0 : INT; END_VAR"
                     : instead;
}

std::string_view instead_of_address(std::string_view address) {
    const std::size_t digits = address.find_first_of("0123456789");
    const bool is_schneiders = address.starts_with('%') && digits != address.npos &&
                               has_word(areas_of_schneider, address.substr(1, digits - 1));
    return is_schneiders ? "this is of Schneider's controllers: declare a variable for it"
                         : std::string_view();
}

std::string_view instead_of_input(std::string_view name) {
    return instead_in(inputs_of_vendors, name);
}

}  // namespace lineshaft::st
