#include "runtime/st/syntax/dialect.hpp"

#include <algorithm>
#include <iterator>

#include "runtime/source/letters.hpp"

namespace lineshaft::st {

const Dialect iec = {.sign_precedes_power = true,
                     .constants_have_values = true,
                     .quotes_may_enclose_texts = true,
                     .named_inputs_may_be_left_out = true,
                     .programs_are_named = true,
                     .selects_by_texts = true,
                     .loops_begin_narrowed = true,
                     .references_take_addresses = true};

const Dialect automation_studio = [] {
    Dialect made = iec;
    made.capitals_count = made.dint_is_time = made.bool_is_number = true;
    made.texts_have_any_length = made.commas_may_end_lists = true;
    made.dint_becomes_real = made.lreal_becomes_real = made.enumerations_are_numbers = true;
    made.programs_are_named = false;
    return made;
}();

const Dialect codesys = {.sign_precedes_power = true,
                         .quotes_may_enclose_texts = true,
                         .named_inputs_may_be_left_out = true,
                         .dint_becomes_real = true,
                         .lreal_becomes_real = true,
                         .enumerations_are_numbers = true,
                         .bits_count_in_reals = true,
                         .commas_may_end_lists = true,
                         .is_loose = true,
                         .programs_are_named = true,
                         .texts_are_bytes = true,
                         .texts_have_any_length = true,
                         .long_numbers_count_time = true,
                         .reckons_wide = true};

const Dialect scl = {.sign_precedes_power = false,
                     .sets_variables_of_instances = true,
                     .real_results_reckon_as_real = true,
                     .dint_becomes_real = true,
                     .lreal_becomes_real = true,
                     .numbers_stand_for_names = true,
                     .texts_of_integers_have_signs = true,
                     .packs_as_s7 = true,
                     .instances_begin_as_siemens = true,
                     .peripheries_are_image = true,
                     .dint_is_time = true,
                     .long_numbers_count_time = true,
                     .zero_divides_to_zero = true,
                     .texts_are_windows_1252 = true};

const Dialect& dialect_of(std::string_view path) {
    struct Ending {
        std::string_view ending;
        const Dialect& dialect;
    };
    static constexpr Ending endings[] = {{".st", iec},
                                         {".typ", automation_studio},
                                         {".var", automation_studio},
                                         {".fun", automation_studio},
                                         {".prg", automation_studio},
                                         {".exp", codesys},
                                         {".tcpou", codesys},
                                         {".tcdut", codesys},
                                         {".tcgvl", codesys},
                                         {".tcio", codesys},
                                         {".tctleo", codesys},
                                         {".plcproj", codesys},
                                         {".xml", codesys}};
    const std::string name = lower(path);
    const auto* it = std::ranges::find_if(
        endings, [&](const Ending& known) { return name.ends_with(known.ending); });
    return it == std::end(endings) ? scl : it->dialect;
}

}  // namespace lineshaft::st
