#include "runtime/st/syntax/dialect.hpp"

#include <algorithm>
#include <iterator>

#include "runtime/source/encoding.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft::st {

static constexpr std::string_view plain_text = standard_endings[0];

const Dialect iec = {.sign_precedes_power = true,
                     .constants_have_values = true,
                     .quotes_may_enclose_texts = true,
                     .named_inputs_may_be_left_out = true,
                     .programs_are_named = true,
                     .selects_by_texts = true,
                     .loops_begin_narrowed = true,
                     .references_take_addresses = true,
                     .ampersands_may_be_two = true,
                     .ignores_excess_values = true,
                     .axes_are_types = true,
                     .variables_hide_types = true,
                     .this_calls_methods = true,
                     .methods_may_leave_out_inputs = true,
                     .any_takes_literals = true,
                     .texts_grow_by_characters = true,
                     .number_of_text = NumberOfText::grouped_digits};

const Dialect simatic_ax = [] {
    Dialect made = iec;
    made.literals_are_characters = made.characters_may_be_missing = true;
    made.inputs_may_be_left_out = true;
    made.texts_grow_by_characters = false;
    return made;
}();

const Dialect automation_studio = [] {
    Dialect made = iec;
    made.capitals_count = made.dint_is_time = made.bool_is_number = made.bits_count_in_reals = true;
    made.texts_have_any_length = made.commas_may_end_lists = true;
    made.dint_becomes_real = made.lreal_becomes_real = made.enumerations_are_numbers = true;
    made.programs_are_named = false;
    made.most_aligned = 4;
    made.text_length = 80;
    made.vendor = Vendor::automation_studio;
    made.libraries = Libraries::automation_studio;
    made.axes_are_types = made.variables_hide_types = made.this_calls_methods = false;
    made.methods_may_leave_out_inputs = made.any_takes_literals = false;
    made.texts_grow_by_characters = false;
    made.number_of_text = NumberOfText::digits;
    made.takes_what_others_refuse = made.actions_are_of_callers = made.times_take_numbers = true;
    made.words_of_dates_count_seconds = made.in_outs_take_any_text = true;
    made.references_take_numbers = true;
    made.seconds_move_moments = true;
    made.ampersands_may_be_two = false;
    made.open_texts_end_with_lines = made.texts_end_at_zero = true;
    made.beyond_type = BeyondType::left_in_register;
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
                         .pins_have_long_names = true,
                         .vendor = Vendor::codesys,
                         .charts = ChartRules::codesys,
                         .other_choice = OtherChoice::last,
                         .extremes_keep_second = true,
                         .reckons_in_registers = true,
                         .goto_is_a_name = true,
                         .points_may_end_reals = true,
                         .has_sections_of_exports = true,
                         .texts_end_at_zero = true,
                         .texts_have_any_length = true,
                         .libraries = Libraries::codesys,
                         .takes_what_others_refuse = true,
                         .number_of_text = NumberOfText::grouped_digits,
                         .text_of_long_time = TimeForm::of_long_in_codesys,
                         .no_time_is_ms = true,
                         .truth_may_go_on = true,
                         .texts_have_255 = true,
                         .middle_begins_at_one = true,
                         .inserts_within_text = true,
                         .literals_wrap = true,
                         .underlines_may_repeat = true,
                         .long_numbers_become_real = true,
                         .bounds_have_32_bits = true,
                         .dates_take_times = true,
                         .blocks_begin_with_methods = true,
                         .has_implicit_checks = true,
                         .image_has_points = true,
                         .instance_root = "Device.Application",
                         .addresses_count = AddressCount::sizes,
                         .text_of_real = TextOfReal::of_codesys,
                         .most_aligned = 8,
                         .text_length = 80,
                         .long_numbers_count_time = true,
                         .reckons_in = 32,
                         .real_literals_are_lreal = true,
                         .loops_look_again = true,
                         .beyond_type = BeyondType::left_in_register,
                         .rounds_away = true,
                         .enumerations_begin_at_zero = true,
                         .by_zero = ByZero::leaves_zero,
                         .times_count_ms = true,
                         .dates_count_seconds = true,
                         .texts_are_windows_1252 = true};

static Dialect with_words(Dialect made) {
    made.addresses_count = AddressCount::words;
    return made;
}

const Dialect codesys_23 = [] {
    Dialect made = codesys;
    made.pointer_bytes = 4;
    return made;
}();

const Dialect word_addressed = with_words(codesys), word_addressed_23 = with_words(codesys_23);

const Dialect twincat = [] {
    Dialect made = codesys;
    made.addresses_count = AddressCount::bytes;
    made.beyond_type = BeyondType::fault;
    made.text_of_real = TextOfReal::rounded;
    made.libraries = Libraries::twincat;
    made.keeps_bits_of_register = true;
    made.instance_root = iec.instance_root;
    return made;
}();

const Dialect matiec = [] {
    Dialect made = codesys;
    made.vendor = Vendor::matiec;
    made.libraries = Libraries::matiec;
    made.number_of_text = NumberOfText::of_matiec;
    made.text_of_time = TimeForm::of_matiec;
    made.text_of_long_time = iec.text_of_long_time;
    made.no_time_is_ms = made.truth_may_go_on = made.texts_have_255 = false;
    made.middle_begins_at_one = made.inserts_within_text = made.literals_wrap = false;
    made.underlines_may_repeat = made.long_numbers_become_real = false;
    made.bounds_have_32_bits = made.dates_take_times = made.blocks_begin_with_methods = false;
    made.has_implicit_checks = made.image_has_points = false;
    made.instance_root = iec.instance_root;
    made.functions_are_in_c = made.functions_keep_widths = made.ands_end_early = true;
    made.disabled_calls_give_zero = true;
    made.pins_have_long_names = false;
    made.addresses_count = AddressCount::sizes_apart;
    made.text_of_real = TextOfReal::shortest;
    made.enumerations_begin_at_zero = made.rounds_away = false;
    made.real_literals_are_lreal = false;
    made.literals_suit_their_use = true;
    made.beyond_type = BeyondType::fault;
    made.charts = ChartRules::matiec;
    made.other_choice = OtherChoice::initial;
    made.crossed_limits = CrossedLimits::upper_or_lower;
    made.extremes_keep_second = made.reckons_in_registers = made.goto_is_a_name = false;
    made.points_may_end_reals = made.has_sections_of_exports = false;
    made.durations_may_stand_apart = true;
    made.texts_end_at_zero = false;
    made.times_count_ms = made.dates_count_seconds = made.texts_are_windows_1252 = false;
    made.most_aligned = iec.most_aligned;
    made.programs_run_as_written = true;
    made.text_length = 126;
    return made;
}();

const Dialect scl = {.sign_precedes_power = false,
                     .sets_variables_of_instances = true,
                     .real_results_reckon_as_real = true,
                     .dint_becomes_real = true,
                     .lreal_becomes_real = true,
                     .numbers_stand_for_names = true,
                     .texts_of_integers_have_signs = true,
                     .packs_as_s7 = true,
                     .begin_is_no_name = true,
                     .vendor = Vendor::siemens,
                     .has_s7_instructions = true,
                     .other_choice = OtherChoice::initial,
                     .crossed_limits = CrossedLimits::input,
                     .peripheries_are_image = true,
                     .dint_is_time = true,
                     .libraries = Libraries::siemens,
                     .number_of_text = NumberOfText::of_s7,
                     .text_of_long_time = TimeForm::plain,
                     .middle_begins_at_one = true,
                     .negative_counts_clear = true,
                     .outputs_may_be_assigned = true,
                     .copies_in_outs = true,
                     .has_no_pointers = true,
                     .return_gives_eno = true,
                     .inputs_take_any_integer = true,
                     .compares_structures = true,
                     .assigns_same_forms = true,
                     .subranges_are_integers = true,
                     .refuses_finer_times = true,
                     .times_have_signs = true,
                     .dates_count_days = true,
                     .dates_begin_1990 = true,
                     .truth_is_lowest_bit = true,
                     .nan_is_not_unequal = true,
                     .text_of_real = TextOfReal::with_exponent,
                     .long_numbers_count_time = true,
                     .beyond_type = BeyondType::lowest_bits,
                     .by_zero = ByZero::is_zero,
                     .times_count_ms = true,
                     .texts_are_windows_1252 = true,
                     .characters_may_be_missing = true,
                     .literals_suit_their_use = true};

/// `RESOURCE Res0 ON PLC` stands in a line of its own.
static bool is_of_matiec(std::string_view text) {
    const std::size_t on = text.find(" ON PLC");
    if (on == text.npos) return false;
    const std::size_t line = text.find_last_of("\r\n", on) + 1;
    const std::size_t word = text.find_first_not_of(" \t", line);
    const std::string_view named = text.substr(word, on - word);
    return named.starts_with("RESOURCE ") && named.rfind(' ') == named.find(' ');
}

/// `{attribute 'qualified_only'}`
static bool is_of_codesys(std::string_view text) {
    constexpr std::string_view word = "attribute '";
    const auto opens = [&](std::size_t at) {
        const std::size_t before = at == 0 ? text.npos : text.find_last_not_of(" \t", at - 1);
        return before != text.npos && text[before] == '{';
    };
    std::size_t at = text.find(word);
    while (at != text.npos && !opens(at)) at = text.find(word, at + 1);
    return at != text.npos;
}

/// `%IX0.12`
static bool has_bit_of_word(std::string_view text) {
    for (std::size_t at = text.find('%'); at != text.npos; at = text.find('%', at + 1)) {
        const std::size_t end = text.find_first_not_of("IQMXiqmx.0123456789", at + 1);
        const std::string_view address = text.substr(at, end - at);
        const auto bit = read_address(address, AddressCount::words);
        if (bit && bit->bits == 1 && address.find('.') != address.npos &&
            !read_address(address, AddressCount::sizes))
            return true;
    }
    return false;
}

/// A line begins with `DATA_BLOCK "Data"` or `ORGANIZATION_BLOCK "Main"`.
static bool is_of_siemens(std::string_view text) {
    for (const std::string_view word : {"DATA_BLOCK", "ORGANIZATION_BLOCK"})
        for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
            const std::size_t name = text.find_first_not_of(" \t", at + word.size());
            const bool begins_line = at == 0 || text[at - 1] == '\n';
            if (begins_line && name != text.npos && text[name] == '"') return true;
        }
    return false;
}

/// A line is `NAMESPACE Plant.Axes` or `USING System.Timer;`.
static bool is_of_ax(std::string_view text) {
    for (const std::string_view word : {"NAMESPACE ", "USING "})
        for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
            const std::size_t line = text.find_last_of("\r\n", at) + 1;
            const std::size_t end = std::min(text.find_first_of("\r\n;/(", at), text.size());
            std::string_view name = text.substr(at, end - at);
            name.remove_prefix(word.size());
            name = name.substr(0, name.find_last_not_of(" \t") + 1);
            const bool is_name = !name.empty() && name.find_first_of(" \t:'\"") == name.npos,
                       begins_line = text.find_first_not_of(" \t", line) == at,
                       ends_well = word == "NAMESPACE " || text.substr(end, 1) == ";";
            if (is_name && begins_line && ends_well) return true;
        }
    return false;
}

const Dialect& dialect_of(std::string_view path, std::string_view text) {
    struct Ending {
        std::string_view ending;
        const Dialect& dialect;
    };
    static constexpr Ending endings[] = {
        {".scl.txt", scl},           {".exp.txt", codesys_23},    {".typ", automation_studio},
        {".var", automation_studio}, {".fun", automation_studio}, {".prg", automation_studio},
        {".exp", codesys_23},        {".tcpou", twincat},         {".tcdut", twincat},
        {".tcgvl", twincat},         {".tcio", twincat},          {".tctleo", twincat},
        {".plcproj", twincat},       {".xml", codesys},           {".matiec", matiec},
        {".codesys", codesys}};
    const std::string name = lower(path);
    const auto* it = std::ranges::find_if(
        endings, [&](const Ending& known) { return name.ends_with(known.ending); });
    const bool is_plain = is_plain_text(path);
    if (it == std::end(endings) && !is_plain) return scl;
    const Dialect& said = is_plain ? iec : it->dialect;
    if (&said == &iec && is_of_matiec(text)) return matiec;
    if (&said == &iec && is_of_codesys(text)) return codesys;
    if (&said == &iec && is_of_siemens(text)) return scl;
    if (&said == &iec && is_of_ax(text)) return simatic_ax;
    const bool is_older = &said == &codesys_23;
    if ((is_older || &said == &codesys) && has_bit_of_word(text))
        return is_older ? word_addressed_23 : word_addressed;
    return said;
}

bool is_plain_text(std::string_view path) {
    const std::string name = lower(path);
    const auto ends = [&](std::string_view ending) { return name.ends_with(ending); };
    return (std::ranges::any_of(standard_endings, ends) ||
            std::ranges::any_of(any_text_endings, ends)) &&
           !ends(".scl.txt") && !ends(".exp.txt");
}

bool has_no_bodies(std::string_view path) {
    return lower(path).ends_with(".fun");
}

std::span<const DialectName> dialect_names() {
    static constexpr DialectName names[] = {{"iec", plain_text},           {"codesys", ".codesys"},
                                            {"twincat", ".tcpou"},         {"scl", ".scl"},
                                            {"automation_studio", ".prg"}, {"matiec", ".matiec"}};
    return names;
}

static std::string_view plain_text_is_read_as;

void read_plain_text_as(std::string_view ending) {
    plain_text_is_read_as = ending;
}

std::string_view plain_text_ending() {
    return plain_text_is_read_as;
}

}  // namespace lineshaft::st
